"""Records of streams as packed structs in SystemVerilog, and their tie-off constants."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from firm_hdl.export.records import Member, Record
from firm_hdl.export.remarks import quoted

__all__ = ["guarded", "package_name", "stream_structs", "struct"]


def package_name(package: str) -> str:
    """Return the name of a message type's package, given the name of its VHDL package.

    The two names differ, because a simulator of both languages may have them in one library.

    >>> package_name("std_msgs_msg_header_cdr_8_pkg")
    'std_msgs_msg_header_cdr_8_sv_pkg'
    """
    return f"{package.removesuffix('_pkg')}_sv_pkg"


def guarded(package: str, text: Iterable[str]) -> str:
    """Put the text of a package between include guards, as several folders have the same file."""
    macro = package.upper()
    return "".join([f"`ifndef {macro}\n`define {macro}\n\n", *text, "\n`endif\n"])


def struct(name: str, members: Sequence[tuple[str, str, str, Iterable[str]]]) -> Iterator[str]:
    """Yield a struct; its members are given by name, type, comment after it, and lines above."""
    # Long types of other packages do not widen the column.
    width = max((len(kind) for _, kind, *_ in members if "::" not in kind), default=0)
    yield "\n  typedef struct packed {\n"
    for member, kind, remark, above in members:
        yield from above
        comment = f"  // {remark}" if remark else ""
        yield f"    {kind:{width}} {member};{comment}\n"
    yield f"  }} {name};\n"


def stream_structs(record: Record) -> Iterator[str]:
    """Yield the types and constants of a record."""
    stem, members = record.stem, record.members
    yield from struct(
        f"{stem}_t",
        [
            (each.name, _of(each, f"{each.stem}_t"), each.remark, quoted(each.comment, "    "))
            for each in members
        ],
    )
    yield from struct(
        f"{stem}_ready_t",
        [
            (each.name, "logic" if each.is_leaf else _of(each, f"{each.stem}_ready_t"), "", ())
            for each in members
        ],
    )
    yield f"\n  localparam {stem}_t {stem.upper()}_IDLE = '0;\n"
    yield f"  localparam {stem}_ready_t {stem.upper()}_ALL_READY = '1;\n"


def _of(member: Member, name: str) -> str:
    """Return a name of the package that declares a member's type."""
    return f"{package_name(member.package)}::{name}" if member.package else name
