"""Print plans as YAML, for people to review and for tools to read back.

The text names leaves by their paths, and bytes by their offsets in a step's map. Each step shows
all that an FPGA engineer needs to review it. Comments help the reader and are not read back.
Reading is in :mod:`firm_hdl.plan.yaml_reader`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from firm_hdl.model import PRIMITIVE_OF
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    ArrayEnd,
    Begin,
    BeginLoop,
    Claim,
    Exits,
    Fixed,
    Jump,
    Leaf,
    LoopEnd,
    Pad,
    Part,
    Plan,
    Run,
    RunStep,
    Slice,
    Step,
)
from firm_hdl.plan.yaml_reader import from_yaml

__all__ = ["from_yaml", "to_yaml"]

LEGEND = """\
# How to read it: a step is one cycle's work on the next bytes of the packet, in this order:
#   rest of: s.items    the last bus word of a run, which may be short, and the NUL after it;
#                       nothing if the run is empty or was not started
#   align: 4            padding up to a multiple of 4 bytes, counted from the end of the header
#   4..7: stamp.sec     bytes 4 to 7 from here are this leaf (least significant byte first)
#   at 8: x.trigger     a leaf without bytes, valid here
#   starts              a run of items or a loop over elements: as many as the length "count" says,
#                       at most "limit"; "align" is padding before the first item. "body" is
#                       the next step if the loop has elements, or the run more than one bus word.
#   words of: s.items   a bus word of a run; repeated until only the rest is left, or, if the count
#                       is constant, until the run is done
#   next                the step in the next cycle; "loop 0 again" if that loop has elements left
"""
CLAIMS_LEGEND = """\
#   claims: 8 from 512  a length of 512 or more claims 8 bytes of a budget for each item; "less 14"
#                       gives 14 bytes back; "of 999" renews the budget, with 999 bytes
"""
COLUMNS = 100
# Words that YAML 1.1 does not read as text.
WORDS = frozenset({"yes", "no", "on", "off", "true", "false", "null", "y", "n"})


def to_yaml(plan: Plan) -> str:
    """Print a plan; :func:`from_yaml` reads an equal plan back."""
    return "".join(f"{line}\n" for line in _Printer(plan).lines())


@dataclass(slots=True)
class _Printer:
    plan: Plan
    paths: list[str] = field(init=False)

    def __post_init__(self) -> None:
        self.paths = [str(leaf) for leaf in self.plan.leaves]

    def lines(self) -> Iterator[str]:
        plan = self.plan
        yield (
            f"# Plan of {plan.message} on {plan.wire}, bus of {counted(plan.bus_bytes, 'byte')}: "
            f"{counted(len(plan.leaves), 'leaf', 'leaves')}, {counted(len(plan.runs), 'run')}, "
            f"{counted(plan.levels, 'loop level')}, {counted(len(plan.steps), 'step')}."
        )
        yield from LEGEND.splitlines()
        if any(step.begin is not None and step.begin.claim for step in plan.steps):
            yield from CLAIMS_LEGEND.splitlines()
        yield f"message: {_plain(plan.message)}"
        yield f"wire: {plan.wire}"
        yield f"bus_bytes: {plan.bus_bytes}"
        yield f"max_message_bytes: {plan.max_message_bytes}"
        yield f"header_bytes: {plan.header_bytes}"
        yield f"max_trailing_bytes: {plan.max_trailing_bytes}"
        yield f"levels: {plan.levels}"
        yield "leaves:" if plan.leaves else "leaves: {}"
        for leaf, path in zip(plan.leaves, self.paths, strict=True):
            yield f"  {_plain(path)}: {_leaf(leaf)}"
        yield "runs:" if plan.runs else "runs: {}"
        for run in plan.runs:
            yield f"  {_plain(self.paths[run.items])}: {_run(run)}"
        yield f"start: {_jump(plan.start)}"
        yield "steps:" if plan.steps else "steps: {}"
        notes = _notes(plan)
        for index, step in enumerate(plan.steps):
            note = f"  # {notes[index]}" if notes[index] else ""
            yield f"  step {index}:{note}"
            yield from (f"    {line}" for line in self.step(step))

    def step(self, step: Step) -> Iterator[str]:
        if step.rest is not None:
            yield f"rest of: {self.run(step.rest)}"
        if step.align != 1:
            yield f"align: {step.align}"
        if step.bytes != sum(item.bytes for item in step.slices):
            yield f"bytes: {step.bytes}"
        yield from self.slices(step.slices)
        if isinstance(step, RunStep):
            yield f"words of: {self.run(step.run)}"
        if step.begin is not None:
            yield from _short("starts", self.begin(step.begin))
        yield from _exits(step.exits)

    def run(self, run: int) -> str:
        return _plain(self.paths[self.plan.runs[run].items])

    def slices(self, slices: tuple[Slice, ...]) -> Iterator[str]:
        index = 0
        while index < len(slices):
            item = slices[index]
            index += 1
            if item.bytes:
                yield f"{_range(item.at, item.bytes)}: {self.slice(item)}"
                continue
            texts = [self.slice(item)]
            while index < len(slices) and (slices[index].at, slices[index].bytes) == (item.at, 0):
                texts.append(self.slice(slices[index]))
                index += 1
            yield f"at {item.at}: " + (texts[0] if len(texts) == 1 else f"[{', '.join(texts)}]")

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
        text = self.paths[part.leaf]
        natural = leaf.item_bytes
        if leaf.kind == "items":
            count = part.size // leaf.item_bytes
            natural *= count
            text += f", {counted(count, 'item')}"
        if part.first or part.bytes != part.size or part.size != natural:
            text += f", bytes {_range(part.first, part.bytes)} of {part.size}"
        match part.end:
            case ArrayEnd():
                text += ", last"
            case LoopEnd(level=level):
                text += f", last of loop {level}"
        return _plain(text)

    def begin(self, begin: Begin) -> dict[str, str]:
        count = {"count": _plain(self.paths[begin.length]), "limit": str(begin.limit)}
        if begin.claim is not None:
            count["claims"] = _claim(begin.claim)
        if isinstance(begin, BeginLoop):
            return {"loop": str(begin.level), **count, "body": _jump(begin.body)}
        entries = {"run": self.run(begin.run), **count}
        if begin.align != 1:
            entries["align"] = str(begin.align)
        return {**entries, "body": _jump(begin.body)}


def counted(number: int, noun: str, plural: str = "") -> str:
    """Write a number with its noun; the plural has an ``s`` unless it is given."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def _plain(text: str) -> str:
    return f'"{text}"' if text.lower() in WORDS else text


def _range(at: int, size: int) -> str:
    return str(at) if size == 1 else f"{at}..{at + size - 1}"


def _leaf(leaf: Leaf) -> str:
    if leaf.kind == "trigger":
        return "trigger"
    text = "length" if leaf.kind == "length" and leaf.type == "uint32" else leaf.type
    if leaf.signed and (leaf.type, False) in PRIMITIVE_OF:
        text = f"signed {leaf.type}"
    return f"{text} x {leaf.lanes}" if leaf.kind == "items" else text


def _run(run: Run) -> str:
    words = ["counted" if run.counted else "constant count"]
    words += ["with NUL"] if run.terminated else []
    words += [] if run.last else ["with tail"]
    return f"[{', '.join(words)}]"


def _jump(jump: Jump) -> str:
    target = "end" if jump.step is None else f"step {jump.step}"
    if not jump.enter:
        return target
    # Semicolons, as a comma would end the text in flow style.
    return f"{target} with " + "; ".join(f"{_counter(c)} = {n}" for c, n in jump.enter)


def _claim(claim: Claim) -> str:
    text = f"{claim.bytes} from {claim.least}"
    text = f"{text} less {claim.saved}" if claim.saved else text
    return text if claim.total is None else f"{text} of {claim.total}"


def _counter(counter: int | str) -> str:
    return counter if isinstance(counter, str) else f"loop {counter}"


def _exits(exits: Exits) -> Iterator[str]:
    if not exits.repeats:
        yield f"next: {_jump(exits.default)}"
        return
    entries = {f"loop {level} again": _jump(jump) for level, jump in exits.repeats}
    yield from _short("next", {**entries, "else": _jump(exits.default)})


def _short(key: str, entries: dict[str, str]) -> Iterator[str]:
    """Yield a mapping, in one line if that is short enough."""
    text = f"{key}: {{{', '.join(f'{name}: {value}' for name, value in entries.items())}}}"
    if len(text) <= COLUMNS - 4:
        yield text
        return
    yield f"{key}:"
    for name, value in entries.items():
        yield f"  {name}: {value}"


def _notes(plan: Plan) -> list[str]:
    """Return a comment for each step: its bytes of the packet if they are fixed, and its loops."""
    notes = [[place] if place else [] for place in _places(plan)]
    for (level, first), (last, name) in sorted(_loops(plan).items()):
        for index in range(first, last + 1):
            notes[index].append(f"in loop {level} ({name})")
    return [", ".join(words) for words in notes]


def _loops(plan: Plan) -> dict[tuple[int, int], tuple[int, str]]:
    """Return, by level and first step of each loop, its last step and the name of its count."""
    names: dict[tuple[int, int], str] = {}
    for jump in plan.jumps():
        for counter, count in jump.enter:
            if isinstance(counter, int) and jump.step is not None:
                names[counter, jump.step] = f"{count} times"
    for step in plan.steps:
        begin = step.begin
        if isinstance(begin, BeginLoop) and begin.body.step is not None:
            names[begin.level, begin.body.step] = str(plan.leaves[begin.length])
    loops: dict[tuple[int, int], tuple[int, str]] = {}
    # A loop whose last step starts a run has an exit in that step and another after the run.
    for last, step in enumerate(plan.steps):
        for level, jump in step.exits.repeats:
            if jump.step is not None:
                loops[level, jump.step] = (last, names.get((level, jump.step), "?"))
    return loops


def _places(plan: Plan) -> list[str]:
    """Return the bytes of the packet that each step takes, if they are the same in every packet."""
    places = [""] * len(plan.steps)
    repeated = {jump.step for step in plan.steps for _, jump in step.exits.repeats}
    at, jump = 0, plan.start
    # Steps with fixed offsets form one chain: it ends at the first loop or variable length.
    while jump.step is not None and jump.step not in repeated:
        step = plan.steps[jump.step]
        size = step.bytes
        if isinstance(step, RunStep):
            size = dict(jump.enter).get(RUN_COUNTER, 0) * plan.item_bytes(step.run)
        if step.align != 1 or places[jump.step]:
            break
        noun = "byte" if size == 1 else "bytes"
        places[jump.step] = f"packet {noun} {_range(at, size)}" if size else ""
        at += size
        if step.begin is not None:
            break
        jump = step.exits.default
    return places
