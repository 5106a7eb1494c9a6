"""Print plans as YAML, for people to review and to be compared.

The text is the tree of the plan. It names leaves by their paths, and bytes by their offsets in a
step's map. Comments help the reader, and mean nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from firm_hdl.model import PRIMITIVE_OF
from firm_hdl.plan.tree import (
    Charge,
    Constant,
    Count,
    Fixed,
    Item,
    Leaf,
    Loop,
    Pad,
    Part,
    Plan,
    Run,
    Slice,
    Step,
    numbered,
)

__all__ = ["counted", "to_yaml"]

LEGEND = """\
# How to read it: the plan is a list of steps, runs and loops, in the order of the packet.
#   step                one cycle's work on the next bytes of the packet, in this order:
#     rest of: s.items    the last bus word of a run, which may be short, and the NUL after it;
#                         nothing if the run has no items and no NUL, or was not reached
#     align: 4            padding up to a multiple of 4 bytes, counted from the end of the header
#     4..7: stamp.sec     bytes 4 to 7 from here are this leaf (least significant byte first)
#     at 8: x.trigger     a leaf without bytes, valid here
#   run: s.items        a bus word of items per cycle. The length "count" says how many items there
#                       are, at most "limit"; all but the rest are taken here. If the count is a
#                       number, the run has no rest. "align" is padding before the first item.
#   loop                the body, as often as "count" says
"""
CHARGE_LEGEND = """\
#   charge: 8 from 512  a length of 512 or more claims 8 bytes of a budget for each item; "less 14"
#                       gives 14 bytes back; "of 999" renews the budget, with 999 bytes
"""
# Words that YAML 1.1 does not read as text.
WORDS = frozenset({"yes", "no", "on", "off", "true", "false", "null", "y", "n"})


def to_yaml(plan: Plan) -> str:
    """Print a plan. Plans with equal texts are equal."""
    return "".join(f"{line}\n" for line in _Printer(plan).lines())


@dataclass(slots=True)
class _Printer:
    plan: Plan
    paths: list[str] = field(init=False)
    # The offset in the packet; `None` after the first bytes that not every packet has there.
    at: int | None = 0

    def __post_init__(self) -> None:
        self.paths = [_plain(str(leaf)) for leaf in self.plan.leaves]

    def lines(self) -> Iterator[str]:
        plan = self.plan
        runs = len(plan.run_of)
        steps = len(plan.steps) - runs
        yield (
            f"# Plan of {plan.message} on {plan.wire}, bus of {counted(plan.bus_bytes, 'byte')}: "
            f"{counted(len(plan.leaves), 'leaf', 'leaves')}, {counted(steps, 'step')}, "
            f"{counted(runs, 'run')}, {counted(plan.levels, 'loop level')}."
        )
        yield from LEGEND.splitlines()
        if plan.has_claims:
            yield from CHARGE_LEGEND.splitlines()
        yield f"message: {_plain(plan.message)}"
        yield f"wire: {plan.wire}"
        yield f"bus_bytes: {plan.bus_bytes}"
        yield f"max_message_bytes: {plan.max_message_bytes}"
        yield "leaves:" if plan.leaves else "leaves: {}"
        for leaf, path in zip(plan.leaves, self.paths, strict=True):
            yield f"  {path}: {_leaf(leaf)}"
        yield "plan:"
        yield from (f"  {line}" for line in self.block(plan.items, 0))

    def block(self, items: Sequence[Item], first: int) -> Iterator[str]:
        for index, item in numbered(items, first):
            match item:
                case Step():
                    yield f"- step:{self.note(index, item.bytes, item.align == 1)}"
                    yield from (f"    {line}" for line in self.step(item))
                case Run():
                    size = None
                    if isinstance(item.count, Constant):
                        size = item.count.number * self.plan.leaves[item.leaf].item_bytes
                    yield f"- run: {self.paths[item.leaf]}{self.note(index, size, item.align == 1)}"
                    yield from (f"  {line}" for line in self.count(item.count))
                    if item.align != 1:
                        yield f"  align: {item.align}"
                    if item.has_tail:
                        yield "  tail: follows"
                case Loop():
                    self.at = None
                    yield "- loop:"
                    yield from (f"    {line}" for line in self.count(item.count))
                    yield "    body:"
                    yield from (f"    {line}" for line in self.block(item.body, index))

    def note(self, index: int, size: int | None, is_next: bool) -> str:
        """Return the number of a step and, if they are fixed, its bytes of the packet."""
        start = self.at if is_next else None
        self.at = None if start is None or size is None else start + size
        if start is None or not size:
            return f"  # {index}"
        return f"  # {index}: packet {'byte' if size == 1 else 'bytes'} {_range(start, size)}"

    def count(self, count: Count) -> Iterator[str]:
        if isinstance(count, Constant):
            yield f"count: {count.number}"
            return
        yield f"count: {self.paths[count.leaf]}{', with NUL' if count.nul else ''}"
        yield f"limit: {count.limit}"
        if count.charge is not None:
            yield f"charge: {_charge(count.charge)}"

    def step(self, step: Step) -> Iterator[str]:
        if step.rest is not None:
            yield f"rest of: {self.paths[step.rest]}"
        if step.align != 1:
            yield f"align: {step.align}"
        empty: list[str] = []
        for at, item in step.places:
            text = self.slice(item)
            if not item.bytes:
                empty.append(text)
                continue
            yield from _at(at, empty)
            empty = []
            yield f"{_range(at, item.bytes)}: {text}"
        yield from _at(step.bytes, empty)

    def slice(self, item: Slice) -> str:
        match item:
            case Pad():
                return "(padding)"
            case Fixed():
                return f"({item.data.hex(' ')} {'checked' if item.check else 'ignored'})"
            case Part():
                return self.part(item)

    def part(self, part: Part) -> str:
        leaf = self.plan.leaves[part.leaf]
        text = str(leaf)
        if leaf.kind == "items":
            text += f", {counted(part.size // leaf.item_bytes, 'item')}"
        if part.first or part.bytes != part.size:
            text += f", bytes {_range(part.first, part.bytes)} of {part.size}"
        if part.last is not None:
            text += ", last" if part.last == "always" else ", last in its loop"
        return _plain(text)


def counted(number: int, noun: str, plural: str = "") -> str:
    """Write a number with its noun; the plural has an ``s`` unless it is given."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def _at(at: int, texts: Sequence[str]) -> Iterator[str]:
    """Yield the leaves without bytes at an offset."""
    if texts:
        yield f"at {at}: " + (texts[0] if len(texts) == 1 else f"[{', '.join(texts)}]")


def _plain(text: str) -> str:
    return f'"{text}"' if text.lower() in WORDS else text


def _range(at: int, size: int) -> str:
    return str(at) if size == 1 else f"{at}..{at + size - 1}"


def _leaf(leaf: Leaf) -> str:
    if leaf.kind in ("trigger", "length"):
        return leaf.kind
    text = leaf.type
    if leaf.signed and (leaf.type, False) in PRIMITIVE_OF:
        text = f"signed {leaf.type}"
    return f"{text} x {leaf.lanes}" if leaf.kind == "items" else text


def _charge(charge: Charge) -> str:
    text = f"{charge.bytes} from {charge.charged_from}"
    text = f"{text} less {charge.padding_credit}" if charge.padding_credit else text
    return text if charge.budget is None else f"{text} of {charge.budget}"
