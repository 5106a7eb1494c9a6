"""Records in VHDL, for data and valid and for ready, and tie-off constants."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

__all__ = ["Element", "record_elements", "stream_record"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Element:
    """An element of a record of streams.

    Attributes
    ----------
    name, type, ready_type : str
    idle, all_ready : str
        Values of `type` with valid 0, and of `ready_type` with ready 1.
    comment : tuple of str
        Comment lines above the element.
    remark : str
        Comment behind the element, on the same line.
    """

    name: str
    type: str
    ready_type: str
    idle: str
    all_ready: str
    comment: tuple[str, ...] = ()
    remark: str = ""


def record_elements(elements: Sequence[tuple[str, str, str, Iterable[str]]]) -> Iterator[str]:
    """Yield elements of a record, given by name, type, comment behind, and lines above."""
    width = max(len(name) for name, *_ in elements)
    # Types of other packages are long, and do not count for the columns.
    short = [len(kind) for _, kind, *_ in elements if not kind.startswith("work.")]
    kinds = max(short, default=0) + 1
    for name, kind, remark, above in elements:
        yield from above
        yield f"    {name:{width}} : {kind + ';':{kinds}}{remark}".rstrip() + "\n"


def stream_record(base: str, elements: Sequence[Element]) -> Iterator[str]:
    """Yield the types ``base_t`` and ``base_ready_t``, and ``BASE_IDLE`` and ``BASE_ALL_READY``."""
    width = max(len(element.name) for element in elements)
    yield f"\n  type {base}_t is record\n"
    yield from record_elements([(e.name, e.type, e.remark, e.comment) for e in elements])
    yield f"  end record;\n\n  type {base}_ready_t is record\n"
    yield from (f"    {each.name:{width}} : {each.ready_type};\n" for each in elements)
    yield "  end record;\n"
    for what, kind in (("idle", "t"), ("all_ready", "ready_t")):
        values = ",\n".join(
            f"    {each.name:{width}} => {getattr(each, what)}" for each in elements
        )
        yield f"\n  constant {base.upper()}_{what.upper()} : {base}_{kind} := (\n{values});\n"
