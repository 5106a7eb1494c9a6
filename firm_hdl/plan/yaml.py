"""Print plans as YAML, for people to review and for tools to read back.

The text names leaves by their paths, and bytes by their offsets in a step's window. Each step shows
all that an FPGA engineer needs to review it. Comments help the reader and are not read back.
Reading is in :mod:`firm_hdl.plan.yaml_reader`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from firm_hdl.model import PRIMITIVE_OF
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    Begin,
    BeginArray,
    BeginLoop,
    BeginRun,
    Exits,
    Fixed,
    Jump,
    Leaf,
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
# How to read it: a step is one cycle's work, on a window of bytes of the packet.
#   4..7: stamp.sec     bytes 4 to 7 of the window are this leaf (least significant byte first)
#   at 8: x.trigger     a leaf without bytes, valid here
#   begin               starts what a length or a constant counts: a run of items, of which the
#                       bytes "head" may be taken in the same cycle, or a loop. A count of 0 goes
#                       to "next" at once. "gap" is padding in front of the first item.
#   run                 repeats the step, a bus word at a time, until the run is done
#   align               the step starts at a multiple of this, counted from behind the header
#   next                what follows; "loop 0 again" if that loop has elements left
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
            f"# Plan of {plan.message} on {plan.wire}, bus of {_count(plan.bus_bytes, 'byte')}: "
            f"{_count(len(plan.leaves), 'leaf', 'leaves')}, {_count(len(plan.runs), 'run')}, "
            f"{_count(plan.levels, 'loop level')}, {_count(len(plan.steps), 'step')}."
        )
        yield from LEGEND.splitlines()
        yield f"message: {_plain(plan.message)}"
        yield f"wire: {plan.wire}"
        yield f"bus_bytes: {plan.bus_bytes}"
        yield f"max_message_bytes: {plan.max_message_bytes}"
        yield f"header_bytes: {plan.header_bytes}"
        yield f"slack_bytes: {plan.slack_bytes}"
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
        if step.align != 1:
            yield f"align: {step.align}"
        if step.bytes != sum(item.bytes for item in step.slices):
            yield f"bytes: {step.bytes}"
        yield from self.slices(step.slices)
        if isinstance(step, RunStep):
            yield f"run: {self.paths[self.plan.runs[step.run].items]}, up to {_bytes(step.head)}"
        if step.begin is not None:
            yield from _short("begin", self.begin(step.begin, step.bytes))
        yield from _exits(step.exits)

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
            text += f", {_count(count, 'item')}"
        if part.bytes != part.size or part.size != natural:
            text += f", bytes {_range(part.first, part.bytes)} of {part.size}"
        if part.last:
            text += ", last"
        if part.last_level is not None:
            text += f", last of loop {part.last_level}"
        return _plain(text)

    def begin(self, begin: Begin, at: int) -> dict[str, str]:
        entries: dict[str, str] = {}
        match begin:
            case BeginLoop(level=level):
                entries["loop"] = str(level)
            case BeginRun(run=run) | BeginArray(run=run):
                entries["run"] = _plain(self.paths[self.plan.runs[run].items])
        match begin:
            case BeginLoop(length=length, limit=limit) | BeginRun(length=length, limit=limit):
                entries |= {"count": _plain(self.paths[length]), "limit": str(limit)}
            case BeginArray(count=count):
                entries |= {"constant": str(count), "limit": str(count)}
        if self.plan.has_nul(begin):
            entries["terminated"] = "true"
        if not isinstance(begin, BeginLoop):
            entries |= {"gap": str(begin.gap)} if begin.gap else {}
            entries |= {"head": _range(at + begin.gap, begin.head)} if begin.head else {}
        if begin.body is not None:
            entries["body"] = _jump(begin.body)
        return entries


def _count(number: int, noun: str, plural: str = "") -> str:
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def _bytes(number: int) -> str:
    return _count(number, "byte")


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
    words = ["NUL behind"] if run.terminated else []
    words += [] if run.last else ["tail behind"]
    return f"[{', '.join(words)}]"


def _jump(jump: Jump) -> str:
    target = "end" if jump.step is None else f"step {jump.step}"
    if not jump.enter:
        return target
    # Semicolons, as a comma would end the text in flow style.
    return f"{target} with " + "; ".join(f"{_counter(c)} = {n}" for c, n in jump.enter)


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
    at, run_bytes, jump = 0, 0, plan.start
    # Steps with fixed offsets form one chain: it ends at the first loop or variable length.
    while jump.step is not None and jump.step not in repeated:
        step = plan.steps[jump.step]
        size = step.bytes
        if isinstance(step, RunStep):
            entered = dict(jump.enter).get(RUN_COUNTER)
            size = run_bytes if entered is None else entered * plan.item_bytes(step.run)
        if step.align != 1 or places[jump.step]:
            break
        noun = "byte" if size == 1 else "bytes"
        places[jump.step] = f"packet {noun} {_range(at, size)}" if size else ""
        at += size
        begin, jump = step.begin, step.exits.default
        if begin is None:
            continue
        if not isinstance(begin, BeginArray):
            break
        at += begin.gap
        run_bytes = begin.count * plan.item_bytes(begin.run)
        if begin.body is None:
            at += run_bytes
            continue
        in_head = plan.bus_bytes if begin.head else 0
        at, run_bytes, jump = at + in_head, run_bytes - in_head, begin.body
    return places

