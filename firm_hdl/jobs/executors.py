"""Run tasks in processes of this machine.

Each task is one call of a function with arguments that can be pickled. Results come back in any
order, and every task gives a result or an error. If a process dies, each task that was running is
repeated in a process of its own. A task fails only if that process dies, too.
"""

from __future__ import annotations

import multiprocessing
from collections import deque
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from typing import Any, TypeVar

from firm_hdl.errors import UserError
from firm_hdl.jobs.processes import worker_pool

__all__ = ["ExecutorError", "run_each"]

K = TypeVar("K")
R = TypeVar("R")

# Number of submitted tasks per worker. With two, no worker waits for its next task. With more, more
# tasks would be repeated when a worker dies.
TASKS_PER_WORKER = 2


class ExecutorError(UserError):
    """The process of a task died, or no process can be had; the message says which."""


def run_each(
    work: Callable[..., R],
    tasks: Sequence[tuple[K, tuple[Any, ...]]],
    *,
    jobs: int | None = None,
) -> Generator[tuple[K, R | Exception], None, None]:
    """Call a function for each task, and yield results as they come.

    * `jobs`: number of processes (`None`: one per processor); 1 runs everything in this process.

    Yields each key with the result of `work`, or with the exception that it raised, or with an
    `ExecutorError` if its process died.

    Raises `ExecutorError` if processes die before they get a task.
    """
    if jobs == 1:
        for key, arguments in tasks:
            yield key, _called(work, arguments)
        return
    jobs = jobs or multiprocessing.cpu_count()
    remaining = deque(tasks)
    while remaining:
        before = len(remaining)
        with worker_pool(jobs) as pool:
            suspects = yield from _distribute(pool, TASKS_PER_WORKER * jobs, work, remaining)
        for key, arguments in suspects:
            # One of the suspects ended the worker. Alone in a process, it cannot end other tasks.
            with worker_pool(1) as pool:
                again = deque([(key, arguments)])
                dead = yield from _distribute(pool, 1, work, again)
            if dead or again:
                yield key, ExecutorError("the process that ran it died, also when it was repeated")
        if len(remaining) == before:
            raise ExecutorError("processes die before they get a task")


def _called(work: Callable[..., R], arguments: tuple[Any, ...]) -> R | Exception:
    try:
        return work(*arguments)
    except Exception as error:
        return error


def _distribute(
    pool: Executor,
    window: int,
    work: Callable[..., R],
    remaining: deque[tuple[K, tuple[Any, ...]]],
) -> Generator[tuple[K, R | Exception], None, list[tuple[K, tuple[Any, ...]]]]:
    """Submit tasks, at most `window` at once, until none remains or until a worker has died.

    Returns the tasks that were running when the worker died.
    """
    running: dict[Future[R], tuple[K, tuple[Any, ...]]] = {}
    suspects: list[tuple[K, tuple[Any, ...]]] = []
    while True:
        while remaining and not suspects and len(running) < window:
            try:
                future = pool.submit(work, *remaining[0][1])
            except BrokenExecutor:
                break
            running[future] = remaining.popleft()
        if not running:
            return suspects
        finished, _ = wait(running, return_when=FIRST_COMPLETED)
        # Keep the order of the tasks; the set of finished futures is unordered.
        for future in [each for each in running if each in finished]:
            key, arguments = running.pop(future)
            try:
                result: R | Exception = future.result()
            except BrokenExecutor:
                suspects.append((key, arguments))
                continue
            except Exception as error:
                result = error
            yield key, result
