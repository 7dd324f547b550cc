"""Progress bars on stderr: a bar where somebody watches, a line at the end where not."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def shown(what: str) -> Iterator[Callable[[float], None]]:
    """
    Show the progress of one task.

    :param what: the task, in a word or two.
    :return: a function to call with the part that is done, 0 to 1.
    """
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bars:
        task = bars.add_task(what, total=1.0)

        def update(done: float) -> None:
            bars.update(task, completed=done)

        yield update
