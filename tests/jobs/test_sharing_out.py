"""How tasks are shared out, with pools and clusters that do exactly what a test tells them."""

from __future__ import annotations

from concurrent.futures import BrokenExecutor, CancelledError, Future
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from firm_hdl.jobs import executors
from firm_hdl.jobs.executors import ExecutorError, check_executor, run_each

LOST = r"^the executor was lost; results so far are kept$"
TWICE = "the process that ran it died, also when it was repeated"


class DeadError(Exception):
    """What a cluster says of a task whose worker died."""


class Pool:
    """An executor that does each task when it is given, or dies of it.

    Parameters
    ----------
    dies_of : dict
        Arguments to what the result is instead.
    breaks_at : int
        How many tasks it takes before it is broken.
    """

    def __init__(self, dies_of=(), breaks_at=None):
        self.dies_of, self.breaks_at = dict(dies_of), breaks_at
        self.given, self.said = [], []

    def submit(self, work, *arguments):
        if len(self.given) == self.breaks_at:
            raise BrokenExecutor
        self.given.append(arguments)
        future = Future()
        error = self.dies_of.get(arguments)
        if error is Future:  # Nobody ever works on it.
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
        self.said.append(f"shutdown {wait}")


@pytest.fixture
def cluster(monkeypatch):
    """A cluster of 3 threads that notes what it is told; `pools` is what it hands out."""
    told = SimpleNamespace(
        pools=[], opened=[], closed=0, threads={"a": 2, "b": 1}, busy={"a": ()}, client=None
    )

    class Client:
        def __init__(self, address, **options):
            told.client = address, options

        def __enter__(self):
            return self

        def __exit__(self, *_):
            told.closed += 1

        @contextmanager
        def get_executor(self, **options):
            told.opened.append(options)
            yield told.pools.pop(0) if told.pools else Pool()

        def nthreads(self):
            return told.threads

        def processing(self):
            if isinstance(told.busy, Exception):
                raise told.busy
            return told.busy

    fake = SimpleNamespace(Client=Client, KilledWorker=DeadError)
    monkeypatch.setattr(executors.importlib, "import_module", {"distributed": fake}.__getitem__)
    told.run = lambda tasks, **how: run_each(square, tasks, executor="dask://here:1", **how)
    return told


def square(number):
    if number < 0:
        raise ValueError(number)
    return number * number


def tasks(*numbers):
    return [(f"task {number}", (number,)) for number in numbers]


def test_a_cluster_is_called_by_its_address_and_left_at_the_end(cluster):
    assert dict(cluster.run(tasks(2, 3))) == {"task 2": 4, "task 3": 9}
    # What a task costs is measured: a result that the cluster remembers costs nothing.
    assert cluster.opened == [{"pure": False}]
    options = {"timeout": executors.CONNECT_SECONDS, "set_as_default": False}
    assert cluster.client == ("tcp://here:1", options)
    assert cluster.closed == 1


@pytest.mark.parametrize(
    ("jobs", "threads", "most"),
    [(None, {"a": 2, "b": 1}, 6), (None, {}, 2), (4, {"a": 2}, 4), (1, {"a": 2}, 1)],
)
def test_so_many_tasks_are_under_way_and_no_more(cluster, jobs, threads, most):
    pool = Pool()
    cluster.pools, cluster.threads = [pool], threads
    results = cluster.run(tasks(*range(20)), jobs=jobs)
    next(results)
    assert len(pool.given) == most
    assert len(list(results)) == 19
    assert sorted(pool.given) == [(number,) for number in range(20)]


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
    assert isinstance(found["task 3"], ExecutorError) and str(found.pop("task 3")) == TWICE
    assert found == {"task 1": 1, "task 2": 4, "task 4": 16, "task 5": 25}
    # While somebody is suspected, nobody gets more to do.
    assert dying.given == [(1,), (2,), (3,)]


def test_a_pool_that_breaks_takes_no_more_and_another_one_goes_on(cluster):
    cluster.pools = [Pool(breaks_at=2)]
    found = list(cluster.run(tasks(1, 2, 3, 4)))
    assert sorted(found) == [("task 1", 1), ("task 2", 4), ("task 3", 9), ("task 4", 16)]
    assert len(cluster.opened) == 2


def test_a_task_whose_own_pool_takes_nothing_is_blamed(cluster):
    cluster.pools = [Pool({(1,): DeadError()}), Pool(breaks_at=0)]
    assert [(key, str(error)) for key, error in cluster.run(tasks(1))] == [("task 1", TWICE)]


def test_pools_that_take_nothing_at_all_end_the_run(cluster):
    cluster.pools = [Pool(breaks_at=0)]
    with pytest.raises(ExecutorError, match=r"^processes die before they get a task$"):
        list(cluster.run(tasks(1, 2)))


def test_cancelled_tasks_end_the_run(cluster):
    pool = Pool({(2,): CancelledError()})
    cluster.pools = [pool]
    with pytest.raises(ExecutorError, match=LOST):
        list(cluster.run(tasks(1, 2)))
    # And whoever is left is not waited for.
    assert pool.said == ["shutdown False"] and cluster.closed == 1


def test_a_run_that_ends_well_stops_nobody(cluster):
    pool = Pool()
    cluster.pools = [pool]
    assert len(list(cluster.run(tasks(1, 2)))) == 2
    assert pool.said == []


@pytest.mark.parametrize("busy", [{"a": (), "b": ()}, {}, OSError("lost")])
def test_idle_clusters_are_given_up(cluster, monkeypatch, busy):
    monkeypatch.setattr(executors, "CHECK_SECONDS", 0.01)
    monkeypatch.setattr(executors, "MAX_IDLE_SECONDS", 0.02)
    cluster.pools, cluster.busy = [Pool({(2,): Future})], busy
    said = r"^no process has worked on a test for 0\.02 s; the results so far are kept$"
    with pytest.raises(ExecutorError, match=said):
        list(cluster.run(tasks(1, 2)))


def test_clusters_that_are_busy_are_waited_for(cluster, monkeypatch):
    """And what idled before it was busy again does not count."""
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
def test_names_of_executors_stay_what_they_are(name):
    assert check_executor(name) == name


def test_unknown_executors_start_nothing(monkeypatch):
    monkeypatch.setattr(executors, "worker_pool", None)
    with pytest.raises(ExecutorError, match=r"not 'threads'$"):
        next(run_each(square, tasks(1), executor="threads", jobs=1))


@pytest.mark.parametrize(("jobs", "workers"), [(3, 3), (None, 5)])
def test_pools_here_have_as_many_processes_as_asked_for(monkeypatch, jobs, workers):
    pool, opened = Pool({(2,): BrokenExecutor()}), []

    @contextmanager
    def opening(number):
        opened.append(number)
        yield pool if len(opened) == 1 else Pool()

    monkeypatch.setattr(executors, "worker_pool", opening)
    monkeypatch.setattr(executors.multiprocessing, "cpu_count", lambda: 5)
    results = run_each(square, tasks(*range(20)), jobs=jobs)
    next(results)
    # Two for each: none is idle, and few are in doubt if one dies.
    assert len(pool.given) == 2 * workers
    assert len(list(results)) == 19
    # One more for the suspect, and the rest.
    assert opened == [workers, 1, workers]


def test_pools_here_are_always_waited_for(monkeypatch):
    monkeypatch.setattr(executors, "CHECK_SECONDS", 0.001)
    monkeypatch.setattr(executors, "MAX_IDLE_SECONDS", 0.002)
    future, waits = Future(), []

    def wait(running, **how):
        waits.append(how["timeout"])
        if len(waits) == 10:
            future.set_result(4)
        return {each for each in running if each.done()}, None

    monkeypatch.setattr(executors, "wait", wait)

    class Slow(Pool):
        def submit(self, *_):
            return future

    monkeypatch.setattr(executors, "worker_pool", lambda _: _opened(Slow()))
    assert list(run_each(square, tasks(2), jobs=2)) == [("task 2", 4)]
    assert waits == [0.001] * 10


@contextmanager
def _opened(pool):
    yield pool
