"""Acceptance of many types at once, on all processors."""

from __future__ import annotations

from collections.abc import Container, Generator, Sequence
from dataclasses import replace

from firm_hdl.errors import described
from firm_hdl.jobs.executors import PROCESSES, run_each
from firm_hdl.verify.systems.options import Options
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts3.acceptance import accept
from firm_hdl.verify.ts3.replay import replay
from firm_hdl.verify.ts3.result import Result, command_of

__all__ = ["run_tasks"]


def run_tasks(
    tasks: Sequence[TypeUnderTest],
    options: Options,
    jobs: int | None = None,
    *,
    executor: str = PROCESSES,
    golden_only: Container[TypeUnderTest] = (),
) -> Generator[tuple[TypeUnderTest, Result], None, None]:
    """Run tasks in `jobs` processes (`None`: one per processor), and yield results as they come.

    Parameters
    ----------
    executor : str
        See :func:`firm_hdl.jobs.executors.run_each`.
    golden_only : container of Task
        Those whose circuit is not to be simulated.
    """
    without = replace(options, simulated=False)
    work = [
        (task, (task.distro, task.name, without if task in golden_only else options))
        for task in tasks
    ]
    run = replay if options.bags else accept
    for task, result in run_each(run, work, executor=executor, jobs=jobs):
        if isinstance(result, Exception):
            failed = Result(distro=task.distro, name=task.name)
            failed.failures.append(described(result))
            failed.command = command_of(options, task.distro, task.name)
            yield task, failed
        else:
            yield task, result
