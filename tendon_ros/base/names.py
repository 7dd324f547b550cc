"""Names that a user lists in one text, on the command line and in parameters of nodes alike."""

from __future__ import annotations


def names_in(text: str) -> list[str]:
    """
    Return the names that a text lists.

    :param text: names with commas between them, and perhaps spaces.
    :return: those that are there.
    """
    return [name for part in text.split(',') if (name := part.strip())]
