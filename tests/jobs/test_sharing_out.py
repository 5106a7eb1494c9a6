"""Distribution of tasks to workers, with fake pools that a test controls."""

from __future__ import annotations

from concurrent.futures import BrokenExecutor, Future
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from firm_hdl.jobs import executors
from firm_hdl.jobs.executors import ExecutorError, run_each

DIED_TWICE = "the process that ran it died, also when it was repeated"


class Pool:
    """An executor that runs each task when it is submitted, or fails it.

    * `dies_of`: error of the task by its arguments.
    * `breaks_at`: number of tasks that the pool accepts before it is broken.
    """

    def __init__(self, dies_of=(), breaks_at=None):
        self.dies_of, self.breaks_at, self.given = dict(dies_of), breaks_at, []

    def submit(self, work, *arguments):
        if len(self.given) == self.breaks_at:
            raise BrokenExecutor
        self.given.append(arguments)
        future = Future()
        if (error := self.dies_of.get(arguments)) is not None:
            future.set_exception(error)
            return future
        try:
            future.set_result(work(*arguments))
        except Exception as caught:
            future.set_exception(caught)
        return future


@pytest.fixture
def pools(monkeypatch):
    """The pools that the run gets, one after the other, and `opened`: their numbers of workers."""
    found = SimpleNamespace(next=[], opened=[])

    @contextmanager
    def open_pool(workers):
        found.opened.append(workers)
        yield found.next.pop(0) if found.next else Pool()

    monkeypatch.setattr(executors, "worker_pool", open_pool)
    monkeypatch.setattr(executors.multiprocessing, "cpu_count", lambda: 5)
    return found


def square(number):
    if number < 0:
        raise ValueError(number)
    return number * number


def tasks(*numbers):
    return [(f"task {number}", (number,)) for number in numbers]


@pytest.mark.parametrize(("jobs", "most"), [(None, 10), (3, 6), (1, 0)])
def test_number_of_submitted_tasks_is_limited(pools, jobs, most):
    pool = Pool()
    pools.next = [pool]
    results = run_each(square, tasks(*range(20)), jobs=jobs)
    next(results)
    # Two tasks for each process: none is idle, and few are suspects if one dies.
    assert len(pool.given) == most
    assert len(list(results)) == 19
    assert pools.opened == ([] if jobs == 1 else [jobs or 5])


def test_tasks_that_end_together_have_their_results_in_order(pools):
    assert [key for key, _ in run_each(square, tasks(*range(40)), jobs=20)] == [
        f"task {number}" for number in range(40)
    ]


def test_tasks_of_a_dead_worker_run_again_each_alone(pools):
    dying = Pool({(2,): BrokenExecutor(), (3,): BrokenExecutor()})
    alone = [Pool(), Pool({(3,): BrokenExecutor()})]
    pools.next = [dying, *alone]
    found = dict(run_each(square, tasks(1, 2, 3, 4, 5, 6, 7), jobs=2))
    assert [pool.given for pool in alone] == [[(2,)], [(3,)]]
    assert isinstance(found["task 3"], ExecutorError) and str(found.pop("task 3")) == DIED_TWICE
    assert found == {f"task {number}": number * number for number in (1, 2, 4, 5, 6, 7)}
    # No new task is submitted while a task is suspected of killing its worker.
    assert dying.given == [(1,), (2,), (3,), (4,)]
    assert pools.opened == [2, 1, 1, 2]


def test_broken_pool_is_replaced(pools):
    pools.next = [Pool(breaks_at=2)]
    found = list(run_each(square, tasks(1, 2, 3, 4), jobs=2))
    assert sorted(found) == [("task 1", 1), ("task 2", 4), ("task 3", 9), ("task 4", 16)]
    assert len(pools.opened) == 2


def test_a_task_whose_own_pool_takes_nothing_is_blamed(pools):
    pools.next = [Pool({(1,): BrokenExecutor()}), Pool(breaks_at=0)]
    found = run_each(square, tasks(1), jobs=2)
    assert [(key, str(error)) for key, error in found] == [("task 1", DIED_TWICE)]


def test_pools_that_take_nothing_at_all_end_the_run(pools):
    pools.next = [Pool(breaks_at=0)]
    with pytest.raises(ExecutorError, match=r"^processes die before they get a task$"):
        list(run_each(square, tasks(1, 2), jobs=2))


def test_results_of_this_process_come_one_by_one():
    done = []

    def work(number):
        done.append(number)
        return square(number)

    results = run_each(work, tasks(2, -1, 3), jobs=1)
    assert (next(results), done) == (("task 2", 4), [2])
    assert isinstance(next(results)[1], ValueError)
    assert list(results) == [("task 3", 9)]
