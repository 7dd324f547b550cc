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


@contextmanager
def told() -> Iterator[Callable[[str, float], None]]:
    """
    Show the progress of a task that says what it is doing.

    :return: a function to call with what is being done and the part that is done, 0 to 1.
    """
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True, highlight=False)
    columns = (TextColumn('{task.description}'), BarColumn(), TimeElapsedColumn())
    with Progress(
        *columns, console=console, transient=True, disable=not console.is_terminal
    ) as bars:
        task = bars.add_task('starting', total=1.0)
        last, farthest = '', 0.0

        def report(what: str, done: float) -> None:
            nonlocal last, farthest
            # a search that looks again is no farther back than it was
            farthest = max(farthest, done)
            bars.update(task, description=what, completed=farthest)
            if not console.is_terminal and what != last:
                console.print(f'{farthest:4.0%} {what}')
            last = what

        yield report
