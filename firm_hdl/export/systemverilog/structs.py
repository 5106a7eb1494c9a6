"""Packed structs in SystemVerilog, for data and valid and for ready, and tie-off constants."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

__all__ = ["Member", "constant", "guarded", "stream_structs", "struct"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Member:
    """A member of a struct of streams.

    Attributes
    ----------
    name, type, ready_type : str
    comment : tuple of str
        Comment lines above the member.
    remark : str
        Comment behind the member, on the same line.
    """

    name: str
    type: str
    ready_type: str = "logic"
    comment: tuple[str, ...] = ()
    remark: str = ""


def guarded(package: str, text: Iterable[str]) -> str:
    """Put the text of a package between include guards, as several folders have the same file."""
    macro = package.upper()
    return "".join([f"`ifndef {macro}\n`define {macro}\n\n", *text, "\n`endif\n"])


def struct(name: str, members: Sequence[Member], *, ready: bool = False) -> Iterator[str]:
    """Yield the typedef of data and valid, or with `ready` that of ready."""
    kinds = [member.ready_type if ready else member.type for member in members]
    # Types of other packages are long, and do not count for the columns.
    width = max((len(kind) for kind in kinds if "::" not in kind), default=0)
    yield "\n  typedef struct packed {\n"
    for member, kind in zip(members, kinds, strict=True):
        if not ready:
            yield from member.comment
        remark = "" if ready else member.remark
        yield f"    {kind:{width}} {member.name};{remark}\n"
    yield f"  }} {name};\n"


def constant(kind: str, name: str, value: str) -> str:
    """Write the declaration of a constant."""
    return f"  localparam {kind} {name} = {value};\n"


def stream_structs(base: str, members: Sequence[Member]) -> Iterator[str]:
    """Yield the types ``base_t`` and ``base_ready_t``, and ``BASE_IDLE`` and ``BASE_ALL_READY``."""
    yield from struct(f"{base}_t", members)
    yield from struct(f"{base}_ready_t", members, ready=True)
    yield "\n"
    yield constant(f"{base}_t", f"{base.upper()}_IDLE", "'0")
    yield constant(f"{base}_ready_t", f"{base.upper()}_ALL_READY", "'1")
