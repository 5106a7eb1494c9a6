"""``python -m lab.formal``: run proofs, with a line for each as it ends."""

from __future__ import annotations

import argparse
import fnmatch
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from firm_hdl.arguments import positive
from firm_hdl.equivalence.tools import find_tools
from firm_hdl.jobs import ProgramMissingError, ToolError, run_each
from firm_hdl.terminal import printable_streams
from lab.formal.catalog import Proof
from lab.formal.run import TIMEOUT, all_proofs, prove, refute
from lab.formal.solve import Answer
from lab.formal.table import replace_table, table

__all__ = ["main"]


@printable_streams()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return 0 if all is proved, or each bug is found."""
    given = _parser().parse_args(arguments)
    proofs = _chosen(given.names)
    if not proofs:
        print(f"error: no proof is called {' or '.join(given.names)}", file=sys.stderr)
        return 1
    if given.write is not None and (given.names or given.only_twins):
        print(
            "error: --write needs all proofs, because it replaces the whole table", file=sys.stderr
        )
        return 1
    if given.list:
        for key, proof in proofs.items():
            print(f"{key:34} {proof.claim.method} {proof.claim.reach:9} {proof.study.block}")
        return 0
    try:
        find_tools(ghdl=False)
    except (ProgramMissingError, ToolError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    wanted = []
    if not given.only_twins:
        wanted.append((prove, "proved"))
    if given.twins or given.only_twins:
        wanted.append((refute, "broken"))
    good = True
    for work, result in wanted:
        answers = _run(work, proofs, given.jobs, float(given.timeout))
        good &= all(key in answers and answers[key].result == result for key in proofs)
        if work is prove and given.write is not None:
            replace_table(given.write, table(proofs, answers))
    return 0 if good else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m lab.formal",
        description="Prove claims about building blocks and converters for all inputs.",
    )
    parser.add_argument("names", nargs="*", help="such as 'slice/*'; default: all")
    parser.add_argument("--list", action="store_true", help="list the proofs")
    parser.add_argument(
        "--twins",
        action="store_true",
        help="then put a bug into each block; its claim must find it",
    )
    parser.add_argument("--only-twins", action="store_true", help="the same, without the proofs")
    parser.add_argument("--jobs", type=positive, default=2, help="processes; default: %(default)s")
    parser.add_argument(
        "--timeout",
        type=positive,
        default=int(TIMEOUT),
        metavar="SECONDS",
        help="time limit of each proof; default: %(default)s",
    )
    parser.add_argument(
        "--write",
        type=Path,
        metavar="PAGE",
        help="replace the table of a page, lab/notes/formal.md",
    )
    return parser


def _chosen(names: Sequence[str]) -> dict[str, Proof]:
    return {
        key: proof
        for key, proof in all_proofs().items()
        if not names or any(fnmatch.fnmatch(key, name) for name in names)
    }


def _run(
    work: Callable[[str, float], Answer],
    proofs: Mapping[str, Proof],
    jobs: int,
    timeout: float,
) -> dict[str, Answer]:
    """Run proofs or twins, and print a line as each ends."""
    answers = {}
    tasks = [(key, (key, timeout)) for key in proofs]
    for key, answer in run_each(work, tasks, jobs=jobs):
        proof, what = proofs[key], "twin" if work is refute else "proof"
        if isinstance(answer, Exception):
            print(f"failed     {what}  {key}: {answer!r}", flush=True)
            continue
        answers[key] = answer
        found = f"{answer.cycles} cycles" if answer.result == "broken" else proof.claim.reach
        method = "BMC" if work is refute else proof.claim.method
        print(
            f"{answer.result:10} {what}  {key:34} {method}  {found:10} {answer.seconds:6.1f} s",
            flush=True,
        )
        if answer.inputs and (work is prove or answer.result == "undecided"):
            print(f"  {answer.inputs.strip()}", flush=True)
    return answers
