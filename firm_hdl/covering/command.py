"""``firm-hdl cover``: choose or check a few types that have every feature of all."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path

from firm_hdl.arguments import add_options
from firm_hdl.covering.choose import FAMILIES, all_features, choose, cost
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.files import read_file, write_file
from firm_hdl.frontend import Library, all_names, load_all, open_library
from firm_hdl.model import Message
from firm_hdl.plan.shape import shape
from firm_hdl.terminal import stage

__all__ = ["add_cover", "read_chosen", "run_cover"]

_HEAD = """\
# Types that together have every feature that any of {where} has; bus of {bus_bytes} bytes.
# Written by `firm-hdl cover`; `firm-hdl cover --check FILE` compares it with today's features.
"""


def add_cover(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl cover``, besides the origins of definitions."""
    parser.add_argument(
        "types",
        nargs="*",
        metavar="TYPE",
        help="types to choose from; default: all; with --path, all in those folders",
    )
    do = parser.add_mutually_exclusive_group()
    do.add_argument("--out", metavar="FILE", help="write the names of the chosen types to a file")
    do.add_argument(
        "--check", metavar="FILE", help="choose nothing; list the features that FILE's types lack"
    )
    add_options(parser)
    parser.set_defaults(run=run_cover)


def read_chosen(path: str | Path) -> list[str]:
    """Read the names of types from a file that ``--out`` wrote.

    Raises `UserError` if the file names no types or is not UTF-8 text.
    """
    try:
        lines = read_file(path, 1 << 24).decode("utf-8").splitlines()
    except UnicodeDecodeError:
        raise UserError(f"'{path}' is not UTF-8 text") from None
    wanted = (line.strip() for line in lines if not line.startswith("#"))
    # A name that is there twice is one type.
    names = list(dict.fromkeys(name for name in wanted if name))
    if not names:
        raise UserError(f"'{path}' names no types")
    return names


def run_cover(given: argparse.Namespace) -> int:
    """Run ``firm-hdl cover``; return 1 if the checked types lack a feature."""
    library = open_library(given.distro, given.path, given.bag, depends=given.depends)
    kept = None if given.check is None else read_chosen(given.check)
    if given.types:
        messages = load_all(library, given.types)
    else:
        messages = _usable(
            library, all_names(given.distro, given.path, given.bag, depends=given.depends)
        )
    types: dict[str, frozenset[str]] = {}
    costs, shapes = {}, set()
    for number, message in enumerate(messages):
        stage("cover: features of types", number, len(messages))
        try:
            plan = plan_of(message, given.wire, given.bus_bytes, given.max_message_bytes)
        except BuildError as error:
            if given.types:
                raise
            print(f"left out: {error}", file=sys.stderr)
            continue
        types[message.name] = all_features(library, message, plan)
        costs[message.name] = cost(plan)
        shapes.add(shape(plan))
    if not types:
        raise UserError("there are no types to choose from")
    if kept is not None:
        return _check(types, kept, given.check)
    chosen = choose(types, costs)
    for each in chosen:
        print(f"{each.name}: {', '.join(each.adds)}")
    names = [each.name for each in chosen]
    if given.out is not None:
        where = "the folders" if given.path else "the recordings" if given.bag else library.distro
        head = _HEAD.format(where=where, bus_bytes=given.bus_bytes)
        text = head + "".join(f"{name}\n" for name in sorted(names))
        write_file(given.out, text)
    print(f"{_share(types, names)}; {len(shapes)} different circuits", file=sys.stderr)
    return 0


def _usable(library: Library, names: Iterable[str]) -> list[Message]:
    """Return the messages of types; print errors of types that are left out."""
    found = []
    for name in names:
        try:
            found += load_all(library, [name])
        except DefinitionError as error:
            for problem in error.diagnostics:
                print(f"left out: {name}: {problem.message}", file=sys.stderr)
    return found


def _check(types: Mapping[str, frozenset[str]], kept: list[str], path: str) -> int:
    if unknown := [name for name in kept if name not in types]:
        names = ", ".join(unknown)
        raise UserError(f"'{path}' names types that are not among the given ones: {names}")
    missing = _union(types.values()) - _union(types[name] for name in kept)
    for feature in sorted(missing):
        # Name the type with the fewest features: it shows the missing feature best.
        having = [name for name in types if feature in types[name]]
        least = min(having, key=lambda name: (len(types[name]), name))
        print(f"missing: {feature} (in {least})")
    print(_share(types, kept), file=sys.stderr)
    return 1 if missing else 0


def _share(types: Mapping[str, frozenset[str]], names: list[str]) -> str:
    """Describe how many features of all types the named types have, by family."""
    all_of = Counter(feature.partition(":")[0] for feature in _union(types.values()))
    some_of = Counter(
        feature.partition(":")[0] for feature in _union(types[name] for name in names)
    )
    families = ", ".join(
        f"{family} {some_of[family]} of {all_of[family]}" for family in FAMILIES if all_of[family]
    )
    have, all_ = some_of.total(), all_of.total()
    # Rounded down, so that 100 % means all of them.
    share = 100 * have // all_ if all_ else 100
    return f"{len(names)} of {len(types)} types have {share} % of the {all_} features ({families})"


def _union(sets: Iterable[frozenset[str]]) -> frozenset[str]:
    return frozenset().union(*sets)
