"""Golden plans: accepted plans that are kept in files and compared by meaning (TS2).

A folder has a plan in YAML for each chosen type, below the name of its distribution:
``lyrical/sensor_msgs_msg_Imu_cdr_8.yaml``. The file itself names its type, wire and bus.
``firm-hdl golden`` checks the plans, accepts their changes, and adds new ones. Checking never
writes. Accepted changes are reviewed in version control.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from firm_hdl.arguments import add_options
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.files import read_file, write_file
from firm_hdl.frontend import DISTROS, Library, load_all, open_library
from firm_hdl.model import Message
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import Plan, check, to_yaml
from firm_hdl.plan.compare import Change, Head, compare, head_of
from firm_hdl.verify.results.verdict import Failed, Passed, Verdict
from firm_hdl.wire import lay_out

__all__ = [
    "Checked",
    "Golden",
    "add",
    "add_golden",
    "check_golden",
    "read_golden",
    "run_golden",
    "summarise",
    "write_golden",
]


_MOST_BYTES = 1 << 23
"""The largest size of a file with a golden plan: 50,000 steps. Reading takes up to 200 times it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Golden:
    """One golden plan."""

    path: Path
    distro: str  # Name of the folder that the file is in.
    plan: Head  # What the plan in the file is of.
    text: str  # The text of the file.


@dataclass(frozen=True, slots=True, kw_only=True)
class Checked:
    """The result of checking a golden plan."""

    golden: Golden
    text: str  # Today's plan in YAML; empty if there is none.
    changes: tuple[Change, ...]  # Changes from the golden plan to today's.
    # Why there is no plan today, or which invariants today's plan breaks.
    problems: tuple[str, ...]

    @property
    def verdict(self) -> Verdict:
        """Passed if there are neither problems nor changes."""
        wrong = (*self.problems, *map(str, self.changes))
        return Failed(wrong) if wrong else Passed(1)


def read_golden(folder: str | os.PathLike[str]) -> list[Golden]:
    """Read all golden plans of a folder, sorted by path.

    Raises `UserError` if a file is not a plan, or its folder is not named like a distribution.
    """
    found = []
    for path in sorted(Path(folder).glob("*/*.yaml")):
        distro = path.parent.name
        if distro not in DISTROS:
            raise UserError(f"'{path}' is not below a distribution's name: {', '.join(DISTROS)}")
        data = read_file(path, _MOST_BYTES)
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError:
            raise UserError(f"'{path}' is not UTF-8 text") from None
        try:
            plan = head_of(text)
        except ValueError as error:
            raise UserError(f"'{path}': {error}") from None
        found.append(Golden(path=path, distro=distro, plan=plan, text=text))
    return found


def check_golden(
    goldens: Iterable[Golden],
    paths: Sequence[str | os.PathLike[str]] = (),
    bags: Sequence[str | os.PathLike[str]] = (),
    *,
    depends: Sequence[str | os.PathLike[str]] = (),
) -> list[Checked]:
    """Plan each type again, compare the plans, and check the invariants of each new plan.

    * `paths`, `bags`, `depends`: as for `open_library`, which is called for the distribution of
      each golden plan.
    """
    libraries: dict[str, Library] = {}
    results = []
    for golden in goldens:
        if golden.distro not in libraries:
            libraries[golden.distro] = open_library(golden.distro, paths, bags, depends=depends)
        results.append(_check(golden, libraries[golden.distro]))
    return results


def _check(golden: Golden, library: Library) -> Checked:
    given = golden.plan
    try:
        message = library.message(given.message)
        plan = plan_of(message, given.wire, given.bus_bytes, given.max_message_bytes)
    except (DefinitionError, BuildError) as error:
        return Checked(golden=golden, text="", changes=(), problems=(str(error),))
    text = to_yaml(plan)
    return Checked(
        golden=golden,
        text=text,
        changes=tuple(compare(golden.text, text)),
        problems=tuple(check(plan, lay_out(message, plan.wire))),
    )


def add(folder: str | os.PathLike[str], distro: str, message: Message, plan: Plan) -> Path:
    """Write a plan into a folder of golden plans, and return its file."""
    name = f"{identifier(message.name)}_{plan.wire}_{plan.bus_bytes}.yaml"
    path = Path(folder) / distro / name
    write_golden(path, to_yaml(plan))
    return path


def write_golden(path: Path, text: str) -> None:
    """Write a golden plan; raise a `UserError` where that would follow a link in the folder.

    The user named the folder, not the files in it, which may come from others.
    """
    for each in (path.parent, path):
        if each.is_symlink():
            raise UserError(f"'{each}' is a link; golden plans are not written through links")
    write_file(path, text)


def summarise(results: Iterable[Checked]) -> dict[str, list[str]]:
    """Group changes by their kind, so that one cause in many types shows as one kind.

    Returns the names of the types that each kind of change touches, the most frequent kind first.
    """
    touched: dict[str, dict[str, None]] = defaultdict(dict)
    for result in results:
        for change in result.changes:
            touched[change.kind].setdefault(result.golden.plan.message)
    kinds = sorted(touched, key=lambda kind: (-len(touched[kind]), kind))
    return {kind: list(touched[kind]) for kind in kinds}


def add_golden(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl golden``, besides the origins of definitions."""
    parser.add_argument(
        "do",
        choices=["check", "accept", "add"],
        help="compare all plans of the folder with the current ones; write those that changed; or "
        "add types",
    )
    parser.add_argument("folder", metavar="DIR", help="folder of golden plans")
    parser.add_argument("types", nargs="*", metavar="TYPE", help="all of the folder, if none")
    add_options(parser)
    parser.set_defaults(run=run_golden)


def run_golden(given: argparse.Namespace) -> int:
    """Run ``firm-hdl golden``; return 0 if no difference is left."""
    if given.do == "add":
        return _add_types(given)
    goldens = read_golden(given.folder)
    wanted = set(given.types)
    if unknown := wanted - {golden.plan.message for golden in goldens}:
        raise UserError(f"'{given.folder}' has no plan of {', '.join(sorted(unknown))}")
    if not goldens:
        raise UserError(f"'{given.folder}' has no golden plans")
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


def _add_types(given: argparse.Namespace) -> int:
    if not given.types:
        raise UserError("name the types to add")
    library = open_library(given.distro, given.path, given.bag, depends=given.depends)
    for message in load_all(library, given.types):
        plan = plan_of(message, given.wire, given.bus_bytes, given.max_message_bytes)
        print(f"added {add(given.folder, library.distro, message, plan)}")
    return 0
