"""``firm-hdl golden``: checks golden plans, accepts their changes, and adds new ones."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.frontend import load_all, open_library
from firm_hdl.verify.results.verdict import Passed
from firm_hdl.verify.ts2.golden import (
    Checked,
    add,
    check_golden,
    read_golden,
    summarise,
    write_golden,
)

__all__ = ["add_golden_arguments", "run_golden"]


def add_golden_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl golden``, except those that it shares with other commands."""
    parser.add_argument(
        "do",
        choices=["check", "accept", "add"],
        help="compare all plans of the folder with the current ones; write those that changed; or "
        "add types",
    )
    parser.add_argument("folder", metavar="DIR", help="folder of golden plans")
    parser.add_argument("types", nargs="*", metavar="TYPE", help="all of the folder, if none")


def run_golden(given: argparse.Namespace) -> int:
    """Run ``firm-hdl golden``; return 0 if no difference is left."""
    if given.do == "add":
        return _add(given)
    try:
        goldens = read_golden(given.folder)
    except ValueError as error:
        raise BuildError(str(error)) from None
    wanted = set(given.types)
    if unknown := wanted - {golden.plan.message for golden in goldens}:
        raise BuildError(f"'{given.folder}' has no plan of {', '.join(sorted(unknown))}")
    if not goldens:
        raise BuildError(f"'{given.folder}' has no golden plans")
    chosen = [golden for golden in goldens if not wanted or golden.plan.message in wanted]
    results = check_golden(chosen, given.path, given.bag, depends=given.depends)
    differing = [result for result in results if not isinstance(result.verdict, Passed)]
    for result in differing:
        _print(result)
    kinds = summarise(results)
    if len(differing) > 1:
        for kind, types in kinds.items():
            print(f"{len(types):4} {'type' if len(types) == 1 else 'types'}: {kind}")
    print(f"{len(results)} golden plans, {len(differing)} differ")
    if given.do == "check":
        return 1 if differing else 0
    return _accept(differing)


def _print(result: Checked) -> None:
    print(f"{result.golden.path}: {result.golden.plan.message}")
    for line in result.verdict.details:
        print(f"    {line}")


def _accept(differing: Sequence[Checked]) -> int:
    refused = 0
    for result in differing:
        if result.problems:
            print(f"not accepted: {result.golden.path}", file=sys.stderr)
            refused += 1
        else:
            write_golden(result.golden.path, result.text)
            print(f"accepted {result.golden.path}")
    return 1 if refused else 0


def _add(given: argparse.Namespace) -> int:
    if not given.types:
        raise BuildError("name the types to add")
    library = open_library(given.distro, given.path, given.bag, depends=given.depends)
    for message in load_all(library, given.types):
        plan = plan_of(message, given.wire, given.bus_bytes, given.max_message_bytes)
        print(f"added {add(given.folder, library.distro, message, plan)}")
    return 0
