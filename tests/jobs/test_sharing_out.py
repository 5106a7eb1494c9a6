"""Distribution of tasks to workers, with fake pools and clusters that a test controls."""

from __future__ import annotations

from concurrent.futures import BrokenExecutor, CancelledError, Future
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from firm_hdl.jobs import executors
from firm_hdl.jobs.executors import ExecutorError, check_executor, run_each

LOST = r"^the executor was lost; results so far are kept$"
DIED_TWICE = "the process that ran it died, also when it was repeated"


class DeadError(Exception):
    """The error of a cluster for a task whose worker died."""


class Pool:
    """An executor that runs each task when it is submitted, or fails it.

    Parameters
    ----------
    dies_of : dict
        Error of the task by its arguments; `Future` for a task that never ends.
    breaks_at : int
        Number of tasks that the pool accepts before it is broken.
    """

    def __init__(self, dies_of=(), breaks_at=None):
        self.dies_of, self.breaks_at = dict(dies_of), breaks_at
        self.given, self.shutdowns = [], []

    def submit(self, work, *arguments):
        if len(self.given) == self.breaks_at:
            raise BrokenExecutor
        self.given.append(arguments)
        future = Future()
        error = self.dies_of.get(arguments)
        if error is Future:  # The task never runs.
            return future
        if error is not None:
            future.set_exception(error)
            return future
        try:
            future.set_result(work(*arguments))
        except Exception as caught:
            future.set_exception(caught)
        return future

    def shutdown(self, *, wait):
        self.shutdowns.append(f"shutdown {wait}")


@pytest.fixture
def cluster(monkeypatch):
    """A cluster of 3 threads that records calls; `pools` has the executors that it gives."""
    fake_cluster = SimpleNamespace(
        pools=[], opened=[], closed=0, threads={"a": 2, "b": 1}, busy={"a": ()}, client=None
    )

    class Client:
        def __init__(self, address, **options):
            fake_cluster.client = address, options

        def __enter__(self):
            return self

        def __exit__(self, *_):
            fake_cluster.closed += 1

        @contextmanager
        def get_executor(self, **options):
            fake_cluster.opened.append(options)
            yield fake_cluster.pools.pop(0) if fake_cluster.pools else Pool()

        def nthreads(self):
            return fake_cluster.threads

        def processing(self):
            if isinstance(fake_cluster.busy, Exception):
                raise fake_cluster.busy
            return fake_cluster.busy

    fake = SimpleNamespace(Client=Client, KilledWorker=DeadError)
    monkeypatch.setattr(executors.importlib, "import_module", {"distributed": fake}.__getitem__)
    fake_cluster.run = lambda tasks, **how: run_each(square, tasks, executor="dask://here:1", **how)
    return fake_cluster


def square(number):
    if number < 0:
        raise ValueError(number)
    return number * number


def tasks(*numbers):
    return [(f"task {number}", (number,)) for number in numbers]


def test_cluster_is_connected_by_its_address_and_closed_at_the_end(cluster):
    assert dict(cluster.run(tasks(2, 3))) == {"task 2": 4, "task 3": 9}
    # The cost of a task is measured: a result from the cluster's cache costs nothing.
    assert cluster.opened == [{"pure": False}]
    options = {"timeout": executors.CONNECT_SECONDS, "set_as_default": False}
    assert cluster.client == ("tcp://here:1", options)
    assert cluster.closed == 1


@pytest.mark.parametrize(
    ("jobs", "threads", "most"),
    [(None, {"a": 2, "b": 1}, 6), (None, {}, 2), (4, {"a": 2}, 4), (1, {"a": 2}, 1)],
)
def test_number_of_submitted_tasks_is_limited(cluster, jobs, threads, most):
    pool = Pool()
    cluster.pools, cluster.threads = [pool], threads
    results = cluster.run(tasks(*range(20)), jobs=jobs)
    next(results)
    assert len(pool.given) == most
    assert len(list(results)) == 19
    assert sorted(pool.given) == [(number,) for number in range(20)]


def test_tasks_that_end_together_have_their_results_in_order(cluster):
    assert [key for key, _ in cluster.run(tasks(*range(40)), jobs=40)] == [
        f"task {number}" for number in range(40)
    ]


def test_errors_of_tasks_are_results(cluster):
    found = dict(cluster.run(tasks(2, -3, 4)))
    assert isinstance(found["task -3"], ValueError)
    assert (found["task 2"], found["task 4"]) == (4, 16)


def test_tasks_of_a_dead_worker_run_again_each_alone(cluster):
    dying = Pool({(2,): DeadError(), (3,): DeadError()})
    alone = [Pool(), Pool({(3,): DeadError()})]
    cluster.pools = [dying, *alone]
    found = dict(cluster.run(tasks(1, 2, 3, 4, 5), jobs=3))
    assert [pool.given for pool in alone] == [[(2,)], [(3,)]]
    assert isinstance(found["task 3"], ExecutorError) and str(found.pop("task 3")) == DIED_TWICE
    assert found == {"task 1": 1, "task 2": 4, "task 4": 16, "task 5": 25}
    # No new task is submitted while a task is suspected of killing its worker.
    assert dying.given == [(1,), (2,), (3,)]


def test_broken_pool_is_replaced(cluster):
    cluster.pools = [Pool(breaks_at=2)]
    found = list(cluster.run(tasks(1, 2, 3, 4)))
    assert sorted(found) == [("task 1", 1), ("task 2", 4), ("task 3", 9), ("task 4", 16)]
    assert len(cluster.opened) == 2


def test_a_task_whose_own_pool_takes_nothing_is_blamed(cluster):
    cluster.pools = [Pool({(1,): DeadError()}), Pool(breaks_at=0)]
    assert [(key, str(error)) for key, error in cluster.run(tasks(1))] == [("task 1", DIED_TWICE)]


def test_pools_that_take_nothing_at_all_end_the_run(cluster):
    cluster.pools = [Pool(breaks_at=0)]
    with pytest.raises(ExecutorError, match=r"^processes die before they get a task$"):
        list(cluster.run(tasks(1, 2)))


def test_cancelled_tasks_end_the_run(cluster):
    pool = Pool({(2,): CancelledError()})
    cluster.pools = [pool]
    with pytest.raises(ExecutorError, match=LOST):
        list(cluster.run(tasks(1, 2)))
    # The run does not wait for the remaining tasks.
    assert pool.shutdowns == ["shutdown False"] and cluster.closed == 1


@pytest.mark.parametrize("busy", [{"a": (), "b": ()}, {}, OSError("lost")])
def test_idle_clusters_are_given_up(cluster, monkeypatch, busy):
    monkeypatch.setattr(executors, "CHECK_SECONDS", 0.01)
    monkeypatch.setattr(executors, "MAX_IDLE_SECONDS", 0.02)
    cluster.pools, cluster.busy = [Pool({(2,): Future})], busy
    message = r"^no process has worked on a test for 0\.02 s; the results so far are kept$"
    with pytest.raises(ExecutorError, match=message):
        list(cluster.run(tasks(1, 2)))


def test_clusters_that_are_busy_are_waited_for(cluster, monkeypatch):
    """Idle time before the cluster was busy again does not count."""
    monkeypatch.setattr(executors, "CHECK_SECONDS", 0.001)
    monkeypatch.setattr(executors, "MAX_IDLE_SECONDS", 0.002)
    pool, asked = Pool({(2,): Future}), []
    submit = pool.submit
    late = []

    def submitted(work, *arguments):
        future = submit(work, *arguments)
        if arguments == (2,):
            late.append(future)
        return future

    class Busy(dict):
        def values(self):
            asked.append(None)
            if len(asked) == 12:
                late[0].set_result("late")
            return [()] if len(asked) % 2 else [(), ("task",)]

    pool.submit, cluster.pools, cluster.busy = submitted, [pool], Busy()
    assert dict(cluster.run(tasks(1, 2))) == {"task 1": 1, "task 2": "late"}
    assert len(asked) == 12


@pytest.mark.parametrize("error", [OSError("no route"), ValueError("no route")])
def test_schedulers_that_do_not_answer_are_named(cluster, monkeypatch, error):
    def refuse(*_, **__):
        raise error

    fake = SimpleNamespace(Client=refuse)
    monkeypatch.setattr(executors.importlib, "import_module", lambda _: fake)
    with pytest.raises(ExecutorError, match=r"^no Dask scheduler at here:1: no route$"):
        list(cluster.run(tasks(1)))


def test_results_of_this_process_come_one_by_one():
    done = []

    def work(number):
        done.append(number)
        return square(number)

    results = run_each(work, tasks(2, -1, 3), jobs=1)
    assert (next(results), done) == (("task 2", 4), [2])
    assert isinstance(next(results)[1], ValueError)
    assert list(results) == [("task 3", 9)]


@pytest.mark.parametrize("name", ["processes", "dask://host:8786", "dask://[::1]:1"])
def test_names_of_executors_are_returned_unchanged(name):
    assert check_executor(name) == name


def test_unknown_executors_start_nothing(monkeypatch):
    monkeypatch.setattr(executors, "worker_pool", None)
    with pytest.raises(ExecutorError, match=r"not 'threads'$"):
        next(run_each(square, tasks(1), executor="threads", jobs=1))


@pytest.mark.parametrize(("jobs", "workers"), [(3, 3), (None, 5)])
def test_local_pools_have_the_requested_number_of_processes(monkeypatch, jobs, workers):
    pool, opened = Pool({(2,): BrokenExecutor()}), []

    @contextmanager
    def open_pool(number):
        opened.append(number)
        yield pool if len(opened) == 1 else Pool()

    monkeypatch.setattr(executors, "worker_pool", open_pool)
    monkeypatch.setattr(executors.multiprocessing, "cpu_count", lambda: 5)
    results = run_each(square, tasks(*range(20)), jobs=jobs)
    next(results)
    # Two tasks for each process: none is idle, and few are suspects if one dies.
    assert len(pool.given) == 2 * workers
    assert len(list(results)) == 19
    # A pool of one process for the suspect, then a pool for the rest.
    assert opened == [workers, 1, workers]
