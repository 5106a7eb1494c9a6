"""Acceptance of many types at once, on all processors.

Types that are the same in several distributions are run once and counted for each.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass

from firm_hdl.verify.acceptance import Options, Result, accept
from firm_hdl.verify.oracle import DISTRO_STORES, distro_oracle

__all__ = ["Task", "collect_tasks", "run_tasks"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """One run.

    Attributes
    ----------
    distro, name : str
        Of the type that is run.
    same : tuple of str
        All distributions that have the type just so, `distro` included.
    """

    distro: str
    name: str
    same: tuple[str, ...]


def collect_tasks(distros: Iterable[str] = (), names: Sequence[str] = ()) -> list[Task]:
    """List what to run, the largest types first.

    Parameters
    ----------
    distros : iterable of str
        None: all of them.
    names : sequence of str
        Types as ``package/Type`` or ``package/msg/Type``; none: all types.

    Raises
    ------
    ValueError
        If no distribution has a type of a name.
    """
    wanted = {_full(name) for name in names}
    found: dict[tuple[str, str], list[str]] = defaultdict(list)
    weights: dict[tuple[str, str], int] = {}
    for distro in list(distros) or DISTRO_STORES:
        oracle = distro_oracle(distro)
        for name in oracle.names():
            if not wanted or name in wanted:
                structure = repr(oracle.structure(name))
                found[name, structure].append(distro)
                weights[name, structure] = len(structure)
    if missing := wanted - {name for name, _ in found}:
        raise ValueError(f"No distribution has {', '.join(sorted(missing))}")
    # The largest first, so that no processor is left with one at the end.
    keys = sorted(found, key=lambda key: (-weights[key], key))
    return [Task(distro=found[k][-1], name=k[0], same=tuple(found[k])) for k in keys]


def run_tasks(
    tasks: Sequence[Task], options: Options, jobs: int | None = None
) -> Iterator[tuple[Task, Result]]:
    """Run tasks in `jobs` processes (`None`: one per processor), and yield results as they come."""
    if jobs == 1:
        for task in tasks:
            yield task, accept(task.distro, task.name, options)
        return
    with ProcessPoolExecutor(jobs) as pool:
        futures = {pool.submit(accept, t.distro, t.name, options): t for t in tasks}
        for future in as_completed(futures):
            task = futures[future]
            try:
                result = future.result()
            except Exception as error:  # A process that died takes its type with it, not the rest.
                result = Result(distro=task.distro, name=task.name)
                result.failures.append(f"{type(error).__name__}: {error}")
                result.command = options.command(task.distro, task.name)
            yield task, result


def _full(name: str) -> str:
    package, _, base = name.rpartition("/")
    return f"{package.removesuffix('/msg')}/msg/{base}"
