"""Definitions with small mistakes, given to ROS's own readers: do they and firm-hdl agree on each?

``python -m lab.definitions --distro noetic --path my_ws/src -n 1000`` changes real definitions by
rules, which drop, double and swap characters and words, and change types, names, values and lines.
A change depends only on its number and on the definitions to choose from: ``--seed S -n 1`` makes
that of the number S again. A changed definition has a name of its own in the package, because
readers keep what they have read: `Pose` becomes `Pose0`, `Pose1` and so on.
"""

from __future__ import annotations

import argparse
import difflib
import random
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from copy import copy
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import ClassVar

from firm_hdl.errors import Source
from firm_hdl.frontend import DISTROS, Library
from firm_hdl.frontend.names import Kind
from firm_hdl.frontend.sources import Definition, PackagePlace
from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.ts1.judge import judge, read
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.universe import DefinitionCase, Universe, write_definitions

__all__ = ["main", "mutate", "mutation"]

_MOST_CHARACTERS = 20_000
_SIGNS = [*"=#\"'\\/<>[](){}:;,.-+_@ \t~é\x0b", *"<= [] [3] [<=2] ---".split(), "  ", " = "]
_NUMBERS = (
    "0 1 2 -1 +1 010 0x10 0b1 1_000 127 128 255 256 -129 65536 4294967295 4294967296 1.5 .5 5. 1e3 "
    "1e400 inf nan true False TRUE \"x\" 'y' [1] [1,2] [] [1,]"
).split()
_TYPES = (
    "bool byte char int8 uint8 int16 uint32 int64 uint64 float32 float64 string wstring string<=4 "
    "wstring<=2 time duration Header std_msgs/Header std_msgs/String Nothing no_package/Nothing "
    "int string[] uint8[3] int32[<=4]"
).split()
_NAMES = "x a_b a__b a_ _a A aB Ab A_B range a1 1a é message".split()

# `ros2` knows installed packages only, and rosbags is not meant to find mistakes.
_READERS = [name for name in ORACLES if name not in ("rosbags", "ros2")]

_Rule = Callable[[random.Random, str], str]


def mutation(cases: Sequence[DefinitionCase], number: int) -> tuple[str, DefinitionCase]:
    """Make a mutation; return the text before it, too.

    Parameters
    ----------
    cases : sequence of DefinitionCase
        The definitions to choose from.
    number : int
        The number of the mutation.
    """
    generator = random.Random(f"ts1 {number}")
    small = [case for case in cases if len(case.text) <= _MOST_CHARACTERS] or list(cases)
    while True:
        case = generator.choice(small)
        name, before = f"{case.name}{number}", case.text
        if case.language == "idl":
            # The file of a type has its name.
            before = re.sub(rf"\b{case.name}(?=\b|_)", name, before)
        text = mutate(before, generator)
        if text != before or not before:
            return before, replace(case, name=name, text=text, source="")


def mutate(text: str, generator: random.Random) -> str:
    """Apply one rule, sometimes two."""
    for _ in range(generator.choice((1, 1, 1, 1, 2))):
        text = generator.choice(_RULES)(generator, text)
    return text


def _place(generator: random.Random, text: str) -> int:
    """Choose a place, but seldom inside a comment, where hardly any change is a mistake."""
    place = 0
    for _ in range(4):
        place = generator.randrange(len(text) + 1)
        if "#" not in text[text.rfind("\n", 0, place) + 1 : place]:
            break
    return place


def _span(generator: random.Random, text: str, pattern: str) -> tuple[int, int] | None:
    found = [match.span() for match in re.finditer(pattern, text)]
    outside = [
        (start, end)
        for start, end in found
        if "#" not in text[text.rfind("\n", 0, start) + 1 : start]
    ]
    return generator.choice(outside or found) if found else None


def _at(change: Callable[[random.Random, str, int], str]) -> _Rule:
    """Return a rule that changes a text at a place."""
    return lambda generator, text: change(generator, text, _place(generator, text))


def _put(pattern: str, words: Sequence[str]) -> _Rule:
    """Return a rule that replaces what a pattern finds in a text by a word."""

    def put(generator: random.Random, text: str) -> str:
        span = _span(generator, text, pattern)
        return text if span is None else text[: span[0]] + generator.choice(words) + text[span[1] :]

    return put


def _change_case(generator: random.Random, text: str) -> str:
    span = _span(generator, text, r"[A-Za-z]")
    return text if span is None else text[: span[0]] + text[span[0]].swapcase() + text[span[1] :]


def _add_value(generator: random.Random, text: str) -> str:
    span = _span(generator, text, r"(?m)(?<=\w)$")
    if span is None:
        return text
    value = generator.choice((" ", "=", " = ")) + generator.choice(_NUMBERS)
    return text[: span[0]] + value + text[span[0] :]


def _lines(generator: random.Random, text: str) -> str:
    """Drop, repeat, swap, indent, join or end lines."""
    lines = text.split("\n")
    at = generator.randrange(len(lines))
    match generator.randrange(7):
        case 0:
            del lines[at]
        case 1:
            lines.insert(at, lines[at])
        case 2:
            lines.insert(generator.randrange(len(lines)), lines.pop(at))
        case 3:
            lines[at] = generator.choice((" ", "\t", "  ")) + lines[at]
        case 4:
            lines[at] += generator.choice((" ", "\t", "\r", " # x", "#x", " [m]"))
        case 5:
            lines[at : at + 2] = [generator.choice(("", " ")).join(lines[at : at + 2])]
        case _:
            return text.replace("\n", generator.choice(("\r\n", "\r", "\n\n")))
    return "\n".join(lines)


def _tokens(generator: random.Random, text: str) -> str:
    """Drop, repeat or swap words."""
    lines = text.split("\n")
    at = generator.randrange(len(lines))
    words = lines[at].split(" ")
    which = generator.randrange(len(words))
    match generator.randrange(3):
        case 0:
            del words[which]
        case 1:
            words.insert(which, words[which])
        case _:
            words.insert(generator.randrange(len(words)), words.pop(which))
    lines[at] = " ".join(words)
    return "\n".join(lines)


_insert_sign = _at(lambda generator, text, at: text[:at] + generator.choice(_SIGNS) + text[at:])
_change_value = _put(r"(?<==)[^\n#]*|(?<=[<=\[])\d+", _NUMBERS)

_RULES: tuple[_Rule, ...] = (
    # Drop, double or swap characters.
    _at(lambda _, text, at: text[:at] + text[at + 1 :]),
    _at(lambda _, text, at: text[:at] + text[at : at + 1] + text[at:]),
    _at(lambda _, text, at: text[:at] + text[at : at + 2][::-1] + text[at + 2 :]),
    _insert_sign,
    _insert_sign,
    _put(r"\d", "0123456789"),
    _change_case,
    _change_value,
    _change_value,
    _put(r"(?m)^[^\s#]+", _TYPES),
    _put(r"(?<= )[A-Za-z_]\w*", _NAMES),
    _add_value,
    _add_value,
    _lines,
    _tokens,
)


class _Added:
    """An origin that has only the text of one case."""

    packages: ClassVar[Mapping[str, PackagePlace]] = {}

    def __init__(self, case: DefinitionCase) -> None:
        self._case = case
        self._key = case.package, case.kind, case.name

    def names(self) -> Iterable[tuple[str, Kind, str]]:
        return [self._key]

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        if (package, kind, name) != self._key:
            return None
        source = Source(name=self._case.file, text=self._case.text)
        return Definition(source=source, language=self._case.language)


def _with(universe: Universe, case: DefinitionCase) -> Universe:
    """Add a case to the folder of a universe; return the universe with it for our reader."""
    folder = Path(universe.folder, case.package, case.kind)
    if folder.is_symlink():
        # The folder is the user's.
        own = folder.resolve()
        folder.unlink()
        folder.mkdir()
        for each in own.iterdir():
            (folder / each.name).symlink_to(each)
    (folder / case.file).write_bytes(case.text.encode("utf-8", "surrogateescape"))
    found = copy(universe)
    found.library = Library(universe.distro, origins=[_Added(case), *universe.origins])
    return found


def _changes(before: str, text: str) -> list[str]:
    """Return the lines that a change has removed (``-``) and added (``+``)."""
    lines = list(difflib.unified_diff(before.splitlines(), text.splitlines(), lineterm="", n=0))
    return [repr(line)[1:-1] for line in lines[2:] if not line.startswith("@@")]


def main(arguments: Sequence[str] | None = None) -> int:
    """Judge changed definitions; the exit status is 1 if a reader and firm-hdl differ."""
    parser = argparse.ArgumentParser(prog="lab.definitions", description=__doc__.split("\n")[0])
    parser.add_argument("types", nargs="*", help="definitions to change; default: all")
    parser.add_argument("--distro", choices=list(DISTROS), default="lyrical")
    parser.add_argument("--path", action="append", default=[])
    parser.add_argument("--oracle", action="append", choices=_READERS)
    parser.add_argument("-n", type=int, default=1000, help="number of changed definitions")
    parser.add_argument("--seed", type=int, default=0, help="number of the first one")
    given = parser.parse_args(arguments)
    counts: Counter[str] = Counter()
    with ExitStack() as stack:
        folder = stack.enter_context(TemporaryDirectory(prefix="firm-hdl-lab-"))
        universe = Universe(given.distro, given.path, folder)
        write_definitions(universe)
        originals = universe.select(given.types)
        oracles = [ORACLES[name](universe) for name in given.oracle or _READERS]
        for oracle in oracles:
            stack.callback(oracle.close)
        usable = [each for each in oracles if each.missing() is None]
        for number in range(given.seed, given.seed + given.n):
            before, case = mutation(originals, number)
            changed = _with(universe, case)
            ours = read(changed, case)
            for oracle in usable:
                if (found := judge(changed, oracle, case, ours)) is None:
                    continue
                counts[f"{found.verdict.name} by {oracle.name}"] += 1
                counts[f"refused by both, {oracle.name}"] += found.is_refused
                if isinstance(found.verdict, Failed):
                    lines = [*_changes(before, case.text), *found.verdict.failures]
                    print(f"--seed {number}: {case.full_name}, {oracle.name}", *lines, sep="\n    ")
    for what, count in sorted(counts.items()):
        print(f"{count:7} {what}")
    return 1 if any(what.startswith(Failed.name) for what in counts) else 0


if __name__ == "__main__":
    sys.exit(main())
