"""Read plans that :mod:`firm_hdl.plan.yaml` printed and a user may have edited.

Only the syntax is checked here, and errors have line numbers. :func:`firm_hdl.plan.check` checks
whether the plan is sound.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TypeAlias, TypeVar

import yaml

from firm_hdl.model import PRIMITIVE_OF
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    ArrayEnd,
    Begin,
    BeginLoop,
    BeginRun,
    Claim,
    Exits,
    Fixed,
    Jump,
    Leaf,
    LoopEnd,
    MapStep,
    Pad,
    Part,
    Plan,
    Run,
    RunStep,
    Slice,
    Step,
)
from firm_hdl.wire import RULES

__all__ = ["compose", "from_yaml"]

Entries: TypeAlias = "dict[str, yaml.Node]"
T = TypeVar("T")

NUMBERS = ("bus_bytes", "max_message_bytes", "header_bytes", "max_trailing_bytes", "levels")
KEYS = ("message", "wire", *NUMBERS, "leaves", "runs", "start", "steps")
MOST_LEVELS = 16
MOST_SHOWN = 400
# Numbers have at most 18 digits: more are none of a plan, and Python refuses to read thousands.
LEAF = re.compile(r"(?:(trigger|length)|(signed )?(\w+)(?: x (\d{1,18}))?)")
RANGE = re.compile(r"(?:at (\d{1,18})|(\d{1,18})(?:\.\.(\d{1,18}))?)")
FIXED = re.compile(r"\(((?:[0-9a-f]{2} )+)(checked|ignored)\)")
RUN_WORDS = ("counted", "constant count", "with NUL", "with tail")
PART = re.compile(
    r"([\w.]+)(?:, (\d{1,18}) items?)?(?:, bytes (\d{1,18})(?:\.\.(\d{1,18}))? of (\d{1,18}))?"
    r"(?:(, last)(?: of loop (\d{1,18}))?)?"
)
JUMP = re.compile(r"(?:end|step (\d{1,18}))(?: with (.+))?")
CLAIM = re.compile(r"(\d{1,18}) from (\d{1,18})(?: less (\d{1,18}))?(?: of (\d{1,18}))?")
COUNTER = re.compile(r"(?:loop (\d{1,18})|run) = (\d{1,18})")


def from_yaml(text: str) -> Plan:
    """Read a plan.

    Raises
    ------
    ValueError
        If the text is not YAML or not that of a plan; the message starts with the line.
    """
    node = compose(text)
    if node is None:
        raise ValueError("Line 1: a plan must be a mapping, not empty")
    return _Reader().plan(node)


def compose(text: str) -> yaml.Node | None:
    """Parse a text into a tree; `None` if it is empty.

    Aliases are refused: a text with few of them can stand for a tree without an end.

    Raises
    ------
    ValueError
        If the text is not YAML, or has an alias or more levels than a plan; the message starts
        with the line.
    """
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        root = yaml.compose(text, Loader=loader)
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, max(0, text.find(chr(error.character))))
        raise ValueError(f"Line {line + 1}: not YAML: {error.reason}") from None
    except yaml.MarkedYAMLError as error:
        line = 0 if error.problem_mark is None else error.problem_mark.line
        raise ValueError(f"Line {line + 1}: not YAML: {error.problem}") from None
    except (RecursionError, ValueError, OverflowError) as error:
        # Half of a surrogate pair; the others are of the loader in Python.
        line = text.count("\n", 0, getattr(error, "start", 0))
        raise ValueError(f"Line {line + 1}: not YAML that a plan can have") from None
    seen: set[int] = set()
    level = [] if root is None else [root]
    for _ in range(MOST_LEVELS):
        below: list[yaml.Node] = []
        for node in level:
            if id(node) in seen:
                raise _error(node, "a plan has no aliases")
            seen.add(id(node))
            if isinstance(node, yaml.MappingNode):
                below += [each for pair in node.value for each in pair]
            elif isinstance(node, yaml.SequenceNode):
                below += node.value
        level = below
    if level:
        raise _error(level[0], "a plan is not nested so deep")
    return root


def _error(node: yaml.Node, problem: str) -> ValueError:
    if len(problem) > MOST_SHOWN:
        problem = f"{problem[:MOST_SHOWN]}..."
    return ValueError(f"Line {node.start_mark.line + 1}: {problem}")


def _entries(node: yaml.Node, what: str) -> Entries:
    if not isinstance(node, yaml.MappingNode):
        raise _error(node, f"{what} must be a mapping")
    result: Entries = {}
    for key, value in node.value:
        name = _text(key, "a key")
        if name in result:
            raise _error(key, f"{what} has {name!r} twice")
        result[name] = value
    return result


def _text(node: yaml.Node, what: str) -> str:
    if not isinstance(node, yaml.ScalarNode):
        raise _error(node, f"{what} must be a single value")
    return str(node.value)


def _number(node: yaml.Node, what: str) -> int:
    text = _text(node, what)
    if not re.fullmatch("[0-9]{1,18}", text):
        raise _error(node, f"{what} must be a number, not {text!r}")
    return int(text)


def _match(pattern: re.Pattern[str], node: yaml.Node, what: str) -> re.Match[str]:
    text = _text(node, what)
    found = pattern.fullmatch(text)
    if found is None:
        raise _error(node, f"{text!r} is not {what}")
    return found


def _take(entries: Entries, key: str, read: Callable[[yaml.Node, str], T]) -> T | None:
    return read(entries.pop(key), key) if key in entries else None


def _claim(node: yaml.Node, _: str) -> Claim:
    each, least, saved, total = _match(CLAIM, node, "what a length claims").groups()
    return Claim(
        bytes=int(each),
        least=int(least),
        saved=int(saved or 0),
        total=None if total is None else int(total),
    )


class _Reader:
    leaves: tuple[Leaf, ...]
    runs: tuple[Run, ...]

    def plan(self, node: yaml.Node) -> Plan:
        entries = _entries(node, "a plan")
        for key in KEYS:
            if key not in entries:
                raise _error(node, f"the plan has no {key!r}")
        for key in entries:
            if key not in KEYS:
                raise _error(entries[key], f"a plan has no {key!r}")
        name = _text(entries["wire"], "wire")
        wire = next((wire for wire in RULES if wire == name), None)
        if wire is None:
            wires = " or ".join(map(repr, RULES))
            raise _error(entries["wire"], f"wire must be {wires}, not {name!r}")
        leaves = _entries(entries["leaves"], "leaves")
        self.leaves = tuple(self.leaf(path, value) for path, value in leaves.items())
        self.indices = {path: index for index, path in enumerate(leaves)}
        runs = _entries(entries["runs"], "runs")
        self.runs = tuple(self.run(path, value) for path, value in runs.items())
        self.run_indices = {path: index for index, path in enumerate(runs)}
        numbers = {key: _number(entries[key], key) for key in NUMBERS}
        return Plan(
            message=_text(entries["message"], "message"),
            wire=wire,
            leaves=self.leaves,
            runs=self.runs,
            start=self.jump(entries["start"], "start"),
            steps=self.steps(entries["steps"]),
            **numbers,
        )

    # Tables.

    def leaf(self, path: str, node: yaml.Node) -> Leaf:
        found = _match(LEAF, node, "a leaf")
        names = tuple(path.split("."))
        special, signed, name, lanes = found.groups()
        if special == "trigger":
            return Leaf(path=names, kind="trigger", type="bool", signed=False)
        if special == "length":
            return Leaf(path=names, kind="length", type="uint32", signed=False)
        if not any((name, sign) in PRIMITIVE_OF for sign in (False, True)):
            raise _error(node, f"{name!r} is not a primitive")
        # Without the word "signed", the type decides the sign; `byte` and `char` are unsigned.
        is_signed = bool(signed) or (name, False) not in PRIMITIVE_OF
        if (name, is_signed) not in PRIMITIVE_OF:
            raise _error(node, f"{name!r} cannot be signed")
        if lanes is None:
            return Leaf(path=names, kind="scalar", type=name, signed=is_signed)
        return Leaf(path=names, kind="items", type=name, signed=is_signed, lanes=int(lanes))

    def run(self, path: str, node: yaml.Node) -> Run:
        items = node.value if isinstance(node, yaml.SequenceNode) else [node]
        words = [_text(item, f"run {path!r}") for item in items]
        for word in words:
            if word not in RUN_WORDS:
                raise _error(node, f"run {path!r} has no {word!r}")
        if ("counted" in words) == ("constant count" in words):
            raise _error(node, f"run {path!r} must have one of 'counted' and 'constant count'")
        return Run(
            items=self.index(self.indices, path, node),
            counted="counted" in words,
            terminated="with NUL" in words,
            last="with tail" not in words,
        )

    def index(self, table: dict[str, int], path: str, node: yaml.Node) -> int:
        if path not in table:
            kind = "leaf" if table is self.indices else "run"
            raise _error(node, f"the plan has no {kind} {path!r}")
        return table[path]

    # Steps.

    def jump(self, node: yaml.Node, what: str) -> Jump:
        found = _match(JUMP, node, f"a jump ({what})")
        step, loads = found.groups()
        enter: list[tuple[int | str, int]] = []
        for load in loads.split("; ") if loads else ():
            counter = COUNTER.fullmatch(load)
            if counter is None:
                raise _error(node, f"{load!r} is not a counter and a number")
            level, count = counter.groups()
            enter.append((RUN_COUNTER if level is None else int(level), int(count)))
        return Jump(enter=tuple(enter), step=None if step is None else int(step))

    def steps(self, node: yaml.Node) -> tuple[Step, ...]:
        steps: list[Step] = []
        for name, value in _entries(node, "steps").items():
            if name != f"step {len(steps)}":
                raise _error(value, f"expected step {len(steps)}, not {name!r}")
            steps.append(self.step(_entries(value, name), value))
        return tuple(steps)

    def step(self, entries: Entries, node: yaml.Node) -> Step:
        given = _take(entries, "align", _number)
        align = 1 if given is None else given
        size = _take(entries, "bytes", _number)
        rest = _take(entries, "rest of", lambda each, _: self.path(self.run_indices, each))
        run = _take(entries, "words of", lambda each, _: self.path(self.run_indices, each))
        begin = _take(entries, "starts", lambda each, _: each)
        exits = _take(entries, "next", lambda each, _: self.exits(each))
        if exits is None:
            raise _error(node, "the step has no 'next'")
        slices = [item for key, each in entries.items() for item in self.slices(key, each)]
        if run is not None:
            if rest is not None or begin is not None or slices or size:
                raise _error(node, "a step with 'words of' has no rest, bytes or start of its own")
            return RunStep(align=align, run=run, exits=exits)
        total = sum(item.bytes for item in slices) if size is None else size
        return MapStep(
            rest=rest,
            align=align,
            bytes=total,
            slices=tuple(slices),
            begin=None if begin is None else self.begin(begin),
            exits=exits,
        )

    def exits(self, node: yaml.Node) -> Exits:
        if isinstance(node, yaml.ScalarNode):
            return Exits(default=self.jump(node, "next"))
        entries = _entries(node, "next")
        if "else" not in entries:
            raise _error(node, "next has no 'else'")
        default = self.jump(entries.pop("else"), "else")
        repeats: list[tuple[int, Jump]] = []
        for key, value in entries.items():
            found = re.fullmatch(r"loop (\d{1,18}) again", key)
            if found is None:
                raise _error(value, f"next has no {key!r}")
            repeats.append((int(found[1]), self.jump(value, key)))
        return Exits(repeats=tuple(repeats), default=default)

    def begin(self, node: yaml.Node) -> Begin:
        entries = _entries(node, "starts")
        run = _take(entries, "run", lambda each, _: self.path(self.run_indices, each))
        level = _take(entries, "loop", _number)
        length = _take(entries, "count", lambda each, _: self.path(self.indices, each))
        limit = _take(entries, "limit", _number)
        align = _take(entries, "align", _number)
        claim = _take(entries, "claims", _claim)
        body = _take(entries, "body", self.jump)
        for key, value in entries.items():
            raise _error(value, f"starts has no {key!r}")
        if length is None or limit is None or body is None:
            raise _error(node, "starts needs 'count', 'limit' and 'body'")
        if run is not None and level is None:
            align = 1 if align is None else align
            return BeginRun(
                length=length, limit=limit, run=run, align=align, claim=claim, body=body
            )
        if level is None or run is not None:
            raise _error(node, "starts has one of 'run' and 'loop'")
        if align is not None:
            raise _error(node, "a loop that starts has no 'align'")
        return BeginLoop(length=length, limit=limit, level=level, claim=claim, body=body)

    def path(self, table: dict[str, int], node: yaml.Node) -> int:
        return self.index(table, _text(node, "a path"), node)

    def slices(self, key: str, node: yaml.Node) -> list[Slice]:
        found = RANGE.fullmatch(key)
        if found is None:
            raise _error(node, f"a step has no {key!r}")
        empty_at, first, last = found.groups()
        if empty_at is not None:
            nodes = node.value if isinstance(node, yaml.SequenceNode) else [node]
            return [self.slice(int(empty_at), 0, each) for each in nodes]
        return [self.slice(int(first), int(last or first) - int(first) + 1, node)]

    def slice(self, at: int, size: int, node: yaml.Node) -> Slice:
        text = _text(node, "a byte's meaning")
        if text == "(padding)":
            return Pad(at=at, bytes=size)
        fixed = FIXED.fullmatch(text)
        if fixed is None:
            return self.part(at, size, node)
        data = bytes.fromhex(fixed[1])
        if len(data) != size:
            raise _error(node, f"{len(data)} fixed bytes do not fill a slice of {size}")
        return Fixed(at=at, data=data, check=fixed[2] == "checked")

    def part(self, at: int, size: int, node: yaml.Node) -> Part:
        found = _match(PART, node, "a leaf, padding or fixed bytes")
        path, items, first, final, whole, last, level = found.groups()
        index = self.index(self.indices, path, node)
        if first is not None and int(final or first) - int(first) + 1 != size:
            raise _error(node, f"the bytes of {path!r} are not as many as those of the slice")
        natural = int(items or 1) * self.leaves[index].item_bytes
        if whole is None and natural != size:
            raise _error(node, f"{path!r} has {natural} bytes, not {size}")
        end: ArrayEnd | LoopEnd | None = None
        if last is not None:
            end = ArrayEnd() if level is None else LoopEnd(level=int(level))
        return Part(
            at=at,
            bytes=size,
            leaf=index,
            first=int(first or 0),
            size=natural if whole is None else int(whole),
            end=end,
        )
