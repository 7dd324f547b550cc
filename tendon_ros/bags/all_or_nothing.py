"""Bags that are taken away again where the disk refuses a part of them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tendon_ros.base.errors import OutputError


@contextmanager
def all_or_nothing(path: Path) -> Iterator[None]:
    """
    Say of a bag that could not be written what is true of it: that nothing of it is left.

    What its writer says names the folder that it writes to, and what to do with what is in there.

    :param path: of the bag that was asked for.
    :return: a context to write it in; who enters it takes away what is not whole.
    :raises OutputError: in place of that of the writer.
    """
    try:
        yield
    except OutputError as error:
        raise OutputError(
            f'{path}: cannot be written ({error.__cause__}), nothing of it is left; make room, or '
            'give a path where there is'
        ) from error
