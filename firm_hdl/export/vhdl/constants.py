"""Constants of a message type in VHDL, and text from definitions as VHDL comments.

An integer becomes a vector of its own width and sign, so that it compares with a field as it is and
64 bits are no matter; a float becomes a real and its bits; a string its bytes on the wire.
"""

from __future__ import annotations

import re
import struct
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import isfinite

from firm_hdl.export.vhdl.tree import snake
from firm_hdl.model import Constant, Field, Message, Primitive
from firm_hdl.names.identifiers import first_free, scope_names
from firm_hdl.vhdl.names import PREDEFINED, USED

__all__ = ["Named", "comment", "declarations", "named_constants", "origin", "quoted"]

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Named:
    """A constant, and what it is called.

    Attributes
    ----------
    owner : Message
        Whose it is: the message's own, or that of a type that it contains.
    name : str
        In VHDL.
    """

    owner: Message
    constant: Constant
    name: str


def comment(text: str, indent: str = "  ") -> Iterator[str]:
    """Yield text as comment lines of at most 100 columns, in ASCII, which every tool reads."""
    for line in text.splitlines():
        for part in _wrapped(line, 97 - len(indent)):
            yield f"{indent}-- {part}".rstrip() + "\n"


def quoted(text: str, indent: str = "  ") -> Iterator[str]:
    """Yield a comment of a definition, each line with the ``#`` that it has there.

    Tools take what some comments begin with as an order to them, such as ``synthesis`` and ``psl``.
    Which words these are, nobody can know; so no line of a definition begins a comment.
    """
    for line in text.splitlines():
        for part in _wrapped(line, 95 - len(indent)):
            yield f"{indent}-- # {part}".rstrip() + "\n"


def _wrapped(line: str, columns: int) -> list[str]:
    return textwrap.wrap(ascii_of(line).rstrip(), columns, break_long_words=False) or [""]


def ascii_of(text: str) -> str:
    """Give a line in printable ASCII."""
    plain = text.translate(_PLAIN).encode("ascii", "backslashreplace").decode()
    return re.sub(r"[^ -~]", " ", plain.expandtabs(4))


def origin(source: Field, name: str) -> str:
    """Say in a comment what a member of a record is in ROS.

    Parameters
    ----------
    name : str
        What it is called in VHDL.
    """
    what = str(source.type)
    if source.name != name:
        what = f"{source.name}: {what}"
    return f"  -- {what}{_unit(source.unit)}"


def _unit(unit: str | None) -> str:
    return f" [{ascii_of(unit)}]" if unit else ""


def named_constants(message: Message, taken: Iterable[str], *, nested: bool = True) -> list[Named]:
    """Name the constants of a message; with `nested`, those of all types in it.

    `taken` is in lower case.

    The message's own keep their names, as far as these do not hide what VHDL code needs (`ERROR` is
    a severity, and `NS` a unit); the others start with the name of their type.
    """
    found: dict[str, tuple[Message, Constant]] = {}
    hiding = {*USED, *PREDEFINED, *taken}
    for owner in _types(message) if nested else [message]:
        prefix = "" if owner is message else f"{snake(owner.base_name).upper()}_"
        for constant in owner.constants:
            name = f"{prefix}{constant.name}"
            if name.lower() in hiding:
                name = f"{name}_CONSTANT"
            # Two packages may have a type of one name.
            while name in found:
                name = f"{name}_{owner.package}"
            found[name] = (owner, constant)
    given: Mapping[str, str] = scope_names(found, hiding)
    return [
        Named(owner=owner, constant=constant, name=given[name])
        for name, (owner, constant) in found.items()
    ]


def _types(message: Message) -> list[Message]:
    """List a message and the types in it, each once, as fields name them."""
    found: dict[str, Message] = {}

    def visit(kind: Message) -> None:
        if kind.name not in found:
            found[kind.name] = kind
            for item in kind.fields:
                inner = item.element_type
                if isinstance(inner, Message):
                    visit(inner)

    visit(message)
    return list(found.values())


def declarations(named: Iterable[Named], taken: Iterable[str]) -> Iterator[str]:
    """Yield the declarations, type by type."""
    owner: Message | None = None
    named = list(named)
    used = {*taken, *(entry.name.lower() for entry in named)}
    widths = {
        id(entry.owner): max(len(other.name) for other in named if other.owner is entry.owner)
        for entry in named
    }
    for entry in named:
        if entry.owner is not owner:
            owner = entry.owner
            yield f"\n  -- Constants of {owner.name}.\n"
        constant = entry.constant
        unit = _unit(constant.unit)
        yield from quoted(constant.comment)
        if isinstance(constant.type, Primitive):
            name = entry.name.ljust(widths[id(owner)])
            yield from _number(name, constant.type, constant.value, unit, used)
        else:
            yield f"  constant {entry.name} : string :=\n    {_string(constant.value)};\n"


def _number(name: str, kind: Primitive, value: object, unit: str, used: set[str]) -> Iterator[str]:
    assert isinstance(value, bool | int | float)
    bits, digits = 8 * kind.bytes, 2 * kind.bytes
    if kind.kind == "bool":
        yield f"  constant {name} : std_logic := '{int(value)}';\n"
    elif kind.kind == "int":
        vector = "signed" if kind.signed else "unsigned"
        number = int(value)
        literal = f'x"{number % (1 << bits):0{digits}x}"'
        remark = f"{kind} {number}{unit}"
        yield f"  constant {name} : {vector}({bits - 1} downto 0) := {literal};  -- {remark}\n"
    else:
        number_ = float(value)
        if isfinite(number_):
            yield f"  constant {name} : real := {_real(number_)};  -- {kind}{unit}\n"
        if not kind.has_wire_format:
            return  # Nobody knows its bits.
        bits_name = first_free(f"{name.rstrip()}_BITS", used)
        used.add(bits_name.lower())
        image = _float_bits(number_, kind.bytes)
        yield (
            f"  constant {bits_name} : std_logic_vector({bits - 1} downto 0) :="
            f' x"{image:0{digits}x}";\n'
        )


def _float_bits(value: float, size: int) -> int:
    if size == 8:
        return int(struct.unpack("<Q", struct.pack("<d", value))[0])
    try:
        packed = struct.pack("<f", value)
    except OverflowError:
        packed = struct.pack("<f", float("inf") if value > 0 else float("-inf"))
    return int(struct.unpack("<I", packed)[0])


def _real(value: float) -> str:
    """Write a real literal, which needs a point and may have no exponent without one."""
    mantissa, _, exponent = repr(value).partition("e")
    point = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"{point}e{int(exponent)}" if exponent else point


def _string(value: object) -> str:
    """Write the bytes of a string as an expression, in lines that are not too long."""
    data = value if isinstance(value, bytes) else str(value).encode("utf-8", "surrogatepass")
    parts = []
    # No literal has `--`: what follows is for some tools a comment, also within quotation marks.
    for piece in re.findall(rb"(?:[ -,.-~]|-(?!-)){1,80}|-|[^ -~]", data):
        if len(piece) == 1 and not 32 <= piece[0] < 127:
            parts.append(f"character'val({piece[0]})")
        else:
            parts.append('"' + piece.decode("ascii").replace('"', '""') + '"')
    # A lone character is no string.
    if not parts or (len(parts) == 1 and parts[0].startswith("character")):
        parts.insert(0, '""')
    return " &\n    ".join(parts)
