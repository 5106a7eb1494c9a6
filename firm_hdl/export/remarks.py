"""Text of definitions as comments in VHDL and Verilog: printable ASCII without tool directives.

`mark` is the comment mark of the language: ``--`` or ``//``.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator

from firm_hdl.model import Field

__all__ = ["origin", "quoted", "remark", "unit_of"]

_PLAIN = str.maketrans(
    {
        "°": "deg",
        "²": "^2",
        "³": "^3",
        "µ": "u",
        "\N{EN DASH}": "-",
        "\N{EM DASH}": "-",
        "\N{RIGHT SINGLE QUOTATION MARK}": "'",
        "\N{LEFT DOUBLE QUOTATION MARK}": '"',
        "\N{RIGHT DOUBLE QUOTATION MARK}": '"',
    }
)


def remark(text: str, indent: str = "  ", mark: str = "//") -> Iterator[str]:
    """Yield text as comment lines of at most 100 columns, in ASCII."""
    for line in text.splitlines():
        for part in _wrapped(line, 97 - len(indent)):
            yield f"{indent}{mark} {part}".rstrip() + "\n"


def quoted(text: str, indent: str = "  ", mark: str = "//") -> Iterator[str]:
    """Yield a comment of a definition; each line keeps the ``#`` that it has in the definition.

    Tools interpret comments that begin with certain words, such as ``synthesis`` and ``psl``, as
    directives. The ``#`` comes before the text of the definition, so no comment begins with such a
    word.
    """
    for line in text.splitlines():
        for part in _wrapped(line, 95 - len(indent)):
            yield f"{indent}{mark} # {part}".rstrip() + "\n"


def _wrapped(line: str, columns: int) -> list[str]:
    return textwrap.wrap(_ascii(line).rstrip(), columns, break_long_words=False) or [""]


def _ascii(text: str) -> str:
    """Return a line in printable ASCII."""
    plain = text.translate(_PLAIN).encode("ascii", "backslashreplace").decode()
    return re.sub(r"[^ -~]", " ", plain.expandtabs(4))


def origin(source: Field, name: str) -> str:
    """Describe the ROS field of a record member: type and unit, and the name if it is another.

    * `name`: name of the member in the record.
    """
    what = str(source.type)
    if source.name != name:
        what = f"{source.name}: {what}"
    return f"{what}{unit_of(source.unit)}"


def unit_of(unit: str | None) -> str:
    """Return a unit in brackets; empty if there is none."""
    return f" [{_ascii(unit)}]" if unit else ""
