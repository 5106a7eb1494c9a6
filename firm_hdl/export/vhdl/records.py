"""Records of streams in VHDL, and their tie-off constants."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from firm_hdl.export.records import Member, Record
from firm_hdl.export.vhdl.constants import quoted

__all__ = ["record_elements", "stream_record"]


def record_elements(elements: Sequence[tuple[str, str, str, Iterable[str]]]) -> Iterator[str]:
    """Yield elements of a record, given by name, type, comment after it, and lines above."""
    width = max(len(name) for name, *_ in elements)
    # Long types of other packages do not widen the column.
    short = [len(kind) for _, kind, *_ in elements if not kind.startswith("work.")]
    kinds = max(short, default=0) + 1
    for name, kind, remark, above in elements:
        yield from above
        comment = f"  -- {remark}" if remark else ""
        yield f"    {name:{width}} : {kind + ';':{kinds}}{comment}".rstrip() + "\n"


def stream_record(record: Record) -> Iterator[str]:
    """Yield the types and constants of a record."""
    base, members = record.stem, record.members
    width = max(len(each.name) for each in members)
    yield f"\n  type {base}_t is record\n"
    yield from record_elements(
        [
            (each.name, _of(each, f"{each.stem}_t"), each.remark, quoted(each.comment, "    "))
            for each in members
        ]
    )
    yield f"  end record;\n\n  type {base}_ready_t is record\n"
    for each in members:
        kind = "std_logic" if each.is_leaf else _of(each, f"{each.stem}_ready_t")
        yield f"    {each.name:{width}} : {kind};\n"
    yield "  end record;\n"
    idle = {each.name: _of(each, f"{each.stem.upper()}_IDLE") for each in members}
    ready = {
        each.name: "'1'" if each.is_leaf else _of(each, f"{each.stem.upper()}_ALL_READY")
        for each in members
    }
    for what, kind, values in (("IDLE", "t", idle), ("ALL_READY", "ready_t", ready)):
        listed = ",\n".join(f"    {name:{width}} => {value}" for name, value in values.items())
        yield f"\n  constant {base.upper()}_{what} : {base}_{kind} := (\n{listed});\n"


def _of(member: Member, name: str) -> str:
    """Return a name of the package that declares a member's type."""
    return f"work.{member.package}.{name}" if member.package else name
