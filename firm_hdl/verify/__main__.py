"""``python -m firm_hdl.verify``: acceptance of the embedded types of all distributions."""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Sequence

from tqdm import tqdm

from firm_hdl.verify.acceptance import Options, Result
from firm_hdl.verify.oracle import DISTRO_STORES
from firm_hdl.verify.runner import Task, collect_tasks, run_tasks

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return 0 if all types pass, 1 if not, 2 if it was called wrongly."""
    given = _parser().parse_args(arguments)
    try:
        tasks = collect_tasks(given.distro or (), given.types)
    except ValueError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    failures = 0
    began = time.perf_counter()
    for bus_bytes in given.bus_bytes or [8]:
        options = Options(
            bus_bytes=bus_bytes,
            wire=given.wire,
            seed=given.seed,
            stalled=given.stalls,
            broken=given.broken,
            most_cases=given.cases,
        )
        failures += _run(tasks, options, given.jobs)
    print(f"{time.perf_counter() - began:.0f} s, {failures} failures")
    return 1 if failures else 0


def _run(tasks: Sequence[Task], options: Options, jobs: int | None) -> int:
    """Run all tasks with one set of options; return the number of types that failed."""
    passed: Counter[str] = Counter()
    total: Counter[str] = Counter()
    results: list[Result] = []
    bar = tqdm(total=len(tasks), unit="type", desc=f"{options.bus_bytes}-byte bus", disable=None)
    with bar:
        for task, result in run_tasks(tasks, options, jobs):
            results.append(result)
            total.update(task.same)
            if not result.failures:
                passed.update(task.same)
            else:
                tqdm.write(_describe(task, result))
            bar.update()
    for distro in DISTRO_STORES:
        if distro in total:
            print(f"{distro:8} {passed[distro]:4} of {total[distro]:4} types pass", end="")
            print(f" ({options.bus_bytes}-byte bus)")
    seconds = sorted(result.seconds for result in results)
    if seconds:
        cycles = sum(result.simulated_cycles for result in results)
        print(
            f"{len(results)} different types, {sum(r.packets for r in results)} packets, "
            f"{cycles} cycles; seconds per type: median {seconds[len(seconds) // 2]:.2f}, "
            f"most {seconds[-1]:.1f}, {sum(seconds):.0f} in total"
        )
        slowest = sorted(results, key=lambda result: -result.seconds)[:5]
        print("slowest:", ", ".join(f"{each.name} {each.seconds:.1f} s" for each in slowest))
    return sum(bool(result.failures) for result in results)


def _describe(task: Task, result: Result) -> str:
    lines = [f"FAIL {task.name} ({', '.join(task.same)})"]
    lines += [f"    {_clip(failure)}" for failure in result.failures[:8]]
    if len(result.failures) > 8:
        lines.append(f"    and {len(result.failures) - 8} more")
    return "\n".join([*lines, f"    again: {result.command}"])


def _clip(text: str, most: int = 600) -> str:
    return text if len(text) <= most else f"{text[:most]}... ({len(text)} characters)"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m firm_hdl.verify", description=__doc__)
    parser.add_argument("types", nargs="*", metavar="TYPE", help="types to run; default: all")
    parser.add_argument(
        "--distro", action="append", choices=list(DISTRO_STORES), help="repeatable; default: all"
    )
    parser.add_argument(
        "--bus-bytes",
        type=int,
        action="append",
        choices=[1, 2, 4, 8, 16, 32, 64],
        help="repeatable; default: 8",
    )
    parser.add_argument("--wire", choices=["ros1", "cdr"], help="default: the distribution's own")
    parser.add_argument("--jobs", type=int, help="processes; default: one per processor")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--cases", type=int, help="most cases per type; default: all")
    parser.add_argument(
        "--no-stalls", dest="stalls", action="store_false", help="do not run with stalls"
    )
    parser.add_argument(
        "--no-broken", dest="broken", action="store_false", help="do not run broken packets"
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
