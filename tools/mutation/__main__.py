"""``python -m tools.mutation``: inject faults one at a time, and report what notices them."""

from __future__ import annotations

import argparse
import signal
import sys
import tempfile
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from random import randrange
from threading import Lock

from tools.mutation.explained import read_explanations
from tools.mutation.given import GivenFaultError, read_faults
from tools.mutation.judge import Judge
from tools.mutation.map.store import BrokenTreeError, read_map, tree_digest
from tools.mutation.mutants import Mutant
from tools.mutation.report import markdown
from tools.mutation.results import Record, append, read
from tools.mutation.systems import test_files
from tools.mutation.targets import TARGETS, all_mutants, sample
from tools.mutation.workshop import Workshop, copy_tree

ROOT = Path(__file__).parents[2]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    options = _parser().parse_args(arguments)
    root = Path(options.root).resolve()
    files = test_files(root, options.tests or ())
    if not files:
        print("error: no tests there", file=sys.stderr)
        return 1
    try:
        chosen, origin = _chosen(root, options)
    except GivenFaultError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    out = Path(options.out)
    known = read(out)
    tree = tree_digest(root, test_files(root))
    todo = [mutant for mutant in chosen if _is_due(known.get(mutant.key), tree, options)]
    print(f"{len(chosen)} chosen, {len(todo)} to run", file=sys.stderr)
    if options.list:
        for mutant in chosen:
            print(f"{mutant.key} {mutant.path}:{mutant.line} {mutant.change.rule}")
        return 0
    try:
        _run(root, todo, files, options)
    except BrokenTreeError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    known = read(out)
    if options.confirm and not _confirm(root, known.values(), options.nice):
        return 1
    records = [known[mutant.key] for mutant in chosen if mutant.key in known]
    text = f"{markdown(records, read_explanations(), tree)}\n{origin}.\n"
    print(text)
    if options.report:
        Path(options.report).write_text(text)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tools.mutation", description=__doc__)
    add = parser.add_argument
    add("--count", type=int, default=200, help="faults to inject (default %(default)s)")
    add("--seed", type=int, help="chooses them; without it, others each time")
    add("--target", action="append", choices=list(TARGETS), help="only this one; repeatable")
    add("--faults", metavar="FILE", help="faults written by hand, instead of a sample")
    add("--rule", action="append", help="only what this one makes; repeatable")
    add("--first", action="store_true", help="stop at the first test that notices a fault")
    add("--tests", action="append", metavar="PATH", help="only tests below this; repeatable")
    add(
        "--each",
        type=float,
        metavar="SECONDS",
        help="measure fewer sets of parameters of each test",
    )
    add("--fresh", action="store_true", help="measure again what ran on an older program")
    add("--most", type=float, metavar="SECONDS", help="leave faults open that need longer tests")
    add("--least", type=float, default=30, metavar="SECONDS", help="what any run of tests may take")
    add("--retry", action="store_true", help="run again what was not killed")
    add("--keep", action="store_true", help="run nothing again only because files have changed")
    add("--jobs", type=int, default=1, help="faults at the same time, each in its own copy")
    add("--nice", type=int, default=0, help="niceness of tests")
    add("--map", default="build/mutation/map", help="which tests run which lines")
    add("--out", default="build/mutation/results.jsonl", help="what is there is not run again")
    add("--report", help="write the table and the survivors to this file")
    add("--confirm", action="store_true", help="check that tests that noticed pass without a fault")
    add("--list", action="store_true", help="list the faults, and run nothing")
    add("--root", default=str(ROOT), help=argparse.SUPPRESS)
    return parser


def _chosen(root: Path, options: argparse.Namespace) -> tuple[list[Mutant], str]:
    """Return the mutants to be judged, and where they come from."""
    if options.faults:
        return read_faults(root, Path(options.faults)), f"Faults of {options.faults}"
    mutants = all_mutants(root, options.target or list(TARGETS))
    if options.rule:
        mutants = [mutant for mutant in mutants if mutant.change.rule in options.rule]
    seed = randrange(10**6) if options.seed is None else options.seed
    # With the same seed, an interrupted run can be continued.
    print(f"--seed {seed}\nout of {len(mutants)} faults", file=sys.stderr)
    return sample(root, mutants, options.count, seed), f"Seed {seed}"


def _is_due(record: Record | None, tree: str, options: argparse.Namespace) -> bool:
    if record is None or record.status == "error":
        return True
    if record.tree != tree and not options.keep:
        return True
    if record.status == "open" and not (options.tests or options.most):
        return True
    return bool(options.retry and record.status not in ("killed", "unloaded"))


def _run(root: Path, todo: list[Mutant], files: list[str], options: argparse.Namespace) -> None:
    """Run mutants, each in the first free copy of the repository."""
    if not todo:
        return
    lock = Lock()
    with tempfile.TemporaryDirectory(prefix="firm-hdl-mutation-") as folder:
        free: Queue[Workshop] = Queue()
        shops: list[Workshop] = []
        for number in range(options.jobs):
            shop = Path(folder) / str(number)
            copy_tree(root, shop)
            shops.append(Workshop(shop, options.nice))
            free.put(shops[-1])
        pool = ThreadPoolExecutor(options.jobs)
        try:
            found = read_map(
                root,
                Path(options.map),
                files,
                each=options.each,
                complete=not options.tests,
                fresh=options.fresh,
                workshops=free,
                say=lambda text: print(text, file=sys.stderr, flush=True),
            )
            judge = Judge(
                found,
                first=options.first,
                least_cpu_seconds=options.least,
                most_cpu_seconds=options.most,
            )

            def one(mutant: Mutant) -> None:
                workshop = free.get()
                try:
                    record = judge.judge(workshop, mutant)
                finally:
                    free.put(workshop)
                with lock:
                    append(Path(options.out), record)
                    _show(record)

            for done in [pool.submit(one, mutant) for mutant in todo]:
                done.result()
        finally:
            # End the tests that still run after an error or Ctrl-C.
            for each in shops:
                each.__exit__()
            pool.shutdown(cancel_futures=True)


def _confirm(root: Path, records: Iterable[Record], nice: int) -> bool:
    """Run the tests that noticed faults, now without a fault; return whether all pass."""
    tests = {run.by for each in records for run in each.runs.values() if "::" in run.by}
    if not tests:
        return True
    with tempfile.TemporaryDirectory(prefix="firm-hdl-mutation-") as folder:
        copy_tree(root, Path(folder) / "0")
        with Workshop(Path(folder) / "0", nice) as workshop:
            run = workshop.run(sorted(tests), 3600, seconds=7200)
    if run.status != "passed":
        print(f"error: fails without a fault, too: {run.by}", file=sys.stderr)
    else:
        print(f"{len(tests)} tests that noticed faults pass without one", file=sys.stderr)
    return run.status == "passed"


def _show(record: Record) -> None:
    by = next((f"{name}: {record.runs[name].by}" for name in record.killers), "")
    seconds = max((run.cpu_seconds for run in record.runs.values()), default=0)
    where = f"{record.path}:{record.line}, {record.rule}, {record.tests} tests, {seconds} s"
    print(f"{record.status:8} {where} {by}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    # On SIGTERM, as on Ctrl-C, end tests and remove copies.
    signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))
    sys.exit(main())
