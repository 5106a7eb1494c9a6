"""``python -m tests.mutation``: inject faults one at a time, and report what notices them."""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from threading import Lock

from tests.mutation.explained import read_explanations
from tests.mutation.judge import BrokenTreeError, Judge
from tests.mutation.mutants import Mutant
from tests.mutation.report import markdown
from tests.mutation.results import Record, append, read
from tests.mutation.targets import TARGETS, all_mutants, sample
from tests.mutation.workshop import Workshop, copy_tree

ROOT = Path(__file__).parents[2]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    options = _parser().parse_args(arguments)
    root = Path(options.root).resolve()
    mutants = all_mutants(root, options.target or list(TARGETS))
    chosen = sample(root, mutants, options.count, options.seed)
    out = Path(options.out)
    known = read(out)
    todo = [mutant for mutant in chosen if _is_due(known.get(mutant.key), options)]
    print(f"{len(mutants)} faults, {len(chosen)} chosen, {len(todo)} to run", file=sys.stderr)
    if options.list:
        for mutant in chosen:
            print(f"{mutant.key} {mutant.path}:{mutant.line} {mutant.change.rule}")
        return 0
    try:
        _run(root, todo, options, out)
    except BrokenTreeError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    known = read(out)
    if options.confirm and not _confirm(root, known.values(), options.nice):
        return 1
    records = [known[mutant.key] for mutant in chosen if mutant.key in known]
    text = markdown(records, read_explanations())
    print(text)
    if options.report:
        Path(options.report).write_text(text)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    add = parser.add_argument
    add("--count", type=int, default=240, help="faults to inject (default %(default)s)")
    add("--seed", type=int, default=0, help="chooses them (default %(default)s)")
    add("--target", action="append", choices=list(TARGETS), help="only this one; repeatable")
    add("--first", action="store_true", help="stop at the first system that notices a fault")
    add("--no-rest", action="store_true", help="run no tests beside those of the test systems")
    add("--depth", type=int, help="run only so many stages of each system, fast ones first")
    add("--trust", type=int, metavar="SECONDS", help="tests pass without a fault, in less time")
    add("--retry", action="store_true", help="run again what was not killed")
    add("--jobs", type=int, default=1, help="faults at the same time, each in its own copy")
    add("--nice", type=int, default=0, help="niceness of tests")
    add("--out", default="build/mutation.jsonl", help="results; what is there is not run again")
    add("--report", help="write the table and the survivors to this file")
    add("--confirm", action="store_true", help="check that tests that noticed pass without a fault")
    add("--list", action="store_true", help="list the faults, and run nothing")
    add("--root", default=str(ROOT), help=argparse.SUPPRESS)
    return parser


def _is_due(record: Record | None, options: argparse.Namespace) -> bool:
    if record is None:
        return True
    if record.status == "open":
        return bool(options.retry or not options.no_rest)
    return bool(options.retry and record.status == "survived")


def _run(root: Path, todo: list[Mutant], options: argparse.Namespace, out: Path) -> None:
    """Run mutants, each in the first copy that is free."""
    if not todo:
        return
    judge = Judge(
        first=options.first,
        with_rest=not options.no_rest,
        depth=options.depth,
        trusted_cpu_seconds=options.trust,
    )
    lock = Lock()
    with tempfile.TemporaryDirectory(prefix="firm-hdl-mutation-") as folder:
        free: Queue[Workshop] = Queue()
        shops = [Path(folder) / str(number) for number in range(options.jobs)]
        for shop in shops:
            copy_tree(root, shop)
            free.put(Workshop(shop, options.nice))

        def one(mutant: Mutant) -> None:
            workshop = free.get()
            try:
                record = judge.judge(workshop, mutant)
            finally:
                free.put(workshop)
            with lock:
                append(out, record)
                _show(record)

        pool = ThreadPoolExecutor(options.jobs)
        try:
            for done in [pool.submit(one, mutant) for mutant in todo]:
                done.result()
        finally:
            pool.shutdown(cancel_futures=True)
            while not free.empty():
                free.get().__exit__()


def _confirm(root: Path, records: Iterable[Record], nice: int) -> bool:
    """Run the tests that noticed faults without one; tell whether all pass."""
    tests = {run.by for each in records for run in each.runs.values() if "::" in run.by}
    if not tests:
        return True
    with tempfile.TemporaryDirectory(prefix="firm-hdl-mutation-") as folder:
        copy_tree(root, Path(folder) / "0")
        with Workshop(Path(folder) / "0", nice) as workshop:
            run = workshop.run(sorted(tests), 3600)
    if run.status != "passed":
        print(f"error: fails without a fault, too: {run.by}", file=sys.stderr)
    else:
        print(f"{len(tests)} tests that noticed faults pass without one", file=sys.stderr)
    return run.status == "passed"


def _show(record: Record) -> None:
    by = next((f"{name}: {record.runs[name].by}" for name in record.killers), "")
    where = f"{record.path}:{record.line}"
    print(f"{record.status:8} {where}, {record.rule} {by}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
