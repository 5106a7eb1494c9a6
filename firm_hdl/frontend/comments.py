"""Assign comments to fields, and find the unit that a comment names.

The rule is that of ``rosidl_adapter`` (``parse_message_string``, ``process_comments``), used for
both dialects. Comment lines at the very top describe the message. A comment above a definition, or
after it on the same line, describes that definition. An indented comment line continues the comment
of the definition before it.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from itertools import groupby

__all__ = ["CommentCollector", "condense"]


def condense(lines: list[str]) -> tuple[str, str | None]:
    """Take the unit out of comment lines and join what is left.

    Parameters
    ----------
    lines : list of str
        Comment lines without their ``#``.

    Returns
    -------
    tuple of str and (str or None)
        The comment and its unit. Common indentation and empty lines at both ends are removed, and
        several empty lines become one. The unit is the text in brackets, if there is exactly one.
    """
    units = list(_units("\n".join(lines)))
    unit = None
    if len(units) == 1:
        ((text, unit),) = units
        lines = [line.replace(text, "") for line in lines]
    kept: list[str] = []
    for is_empty, group in groupby(lines, key=lambda line: line == ""):
        kept += [""] if is_empty else group
    return textwrap.dedent("\n".join(kept)).strip("\n"), unit


def _units(comment: str) -> Iterator[tuple[str, str]]:
    r"""Yield each ``[unit]`` with the blanks in front of it, and the unit alone.

    A comma inside the brackets means a range, not a unit. The regular expression
    ``\s*\[([^,\]]+)\]`` finds the same, but not in linear time.
    """
    for part in comment.split(","):
        *closed, _ = part.split("]")
        for piece in closed:
            before, bracket, unit = piece.partition("[")
            if bracket and unit:
                blanks = before[len(before.rstrip()) :]
                yield f"{blanks}[{unit}]", unit


class CommentCollector:
    """Assigns each comment to a definition while the lines of a text are read."""

    def __init__(self) -> None:
        self.head: list[str] = []
        self._is_head = True
        self._pending: list[str] = []
        self._last: list[str] | None = None

    def add(self, comment: str, *, is_indented: bool, is_alone: bool) -> None:
        """Take one comment.

        Parameters
        ----------
        comment : str
            The whole comment, from its first ``#`` to the end of the line.
        is_indented : bool
            Whether blanks precede the comment. Ignored unless `is_alone`.
        is_alone : bool
            Whether the line has no definition.
        """
        text = comment.lstrip("#").rstrip()
        if not is_alone:
            self._pending.append(text)
        elif not is_indented:
            (self.head if self._is_head else self._pending).append(text)
        elif self._last is not None:
            self._last.append(text)

    def end_head(self) -> None:
        """Note a line that is not a comment in the first column."""
        self._is_head = False

    def claim(self) -> list[str]:
        """Give a new definition the comments above it and in its line.

        Returns
        -------
        list of str
            The list still grows while indented comment lines follow.
        """
        self._last, self._pending = self._pending, []
        return self._last
