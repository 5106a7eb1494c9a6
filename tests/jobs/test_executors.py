"""Executors: results do not depend on where tasks run, and a dead worker loses its task only."""

from __future__ import annotations

import contextlib
import os
import signal
import time
from pathlib import Path

import pytest

from firm_hdl.jobs import executors
from firm_hdl.jobs.executors import ExecutorError, check_executor, run_each
from firm_hdl.verify.systems.options import Options
from firm_hdl.verify.systems.system import run_tests
from firm_hdl.verify.systems.tasks import collect_tasks
from firm_hdl.verify.ts3.acceptance import accepted
from firm_hdl.verify.ts3.task import test_of
from tests.verify.judged import assert_passed, without_times

TASKS = [(f"task {number}", (number,)) for number in range(30)]
SQUARES = {f"task {number}": number * number for number in range(30)}


def square(number: int) -> int:
    return number * number


def square_or_fail(number: int) -> int:
    if number == 7:
        raise RuntimeError("seven")
    return number * number


def square_or_die(number: int) -> int:
    if number in (5, 20):
        os.kill(os.getpid(), signal.SIGKILL)
    return number * number


def slow_square(number: int) -> int:
    time.sleep(0.1)
    return number * number


def noted_square(number: int, folder: str) -> int:
    Path(folder, str(number)).touch()
    return slow_square(number)


@pytest.mark.parametrize("jobs", [1, 2, None])
def test_processes_give_the_results_of_one(jobs):
    assert dict(run_each(square, TASKS, jobs=jobs)) == SQUARES


@pytest.mark.parametrize("jobs", [1, 2])
def test_exceptions_are_results(jobs):
    found = dict(run_each(square_or_fail, TASKS, jobs=jobs))
    failed = found.pop("task 7")
    assert isinstance(failed, RuntimeError) and str(failed) == "seven"
    assert found == {key: value for key, value in SQUARES.items() if key != "task 7"}


def test_dead_process_is_the_error_of_its_task_alone():
    found = dict(run_each(square_or_die, TASKS, jobs=2))
    for key in ("task 5", "task 20"):
        assert str(found.pop(key)) == "the process that ran it died, also when it was repeated"
    assert found == {k: v for k, v in SQUARES.items() if k not in ("task 5", "task 20")}


def test_nothing_goes_on_after_a_run_was_closed(tmp_path):
    run = run_each(noted_square, [(key, (*task, str(tmp_path))) for key, task in TASKS], jobs=2)
    next(run)
    run.close()
    done = len(list(tmp_path.iterdir()))
    assert done < len(TASKS) // 2
    time.sleep(0.3)
    assert len(list(tmp_path.iterdir())) == done


@pytest.mark.parametrize(
    "name", ["threads", "host:8786", "dask://", "dask://host", "dask://:1", "dask://h:x"]
)
def test_unknown_executors_are_refused(name):
    with pytest.raises(ExecutorError, match=r"^executor must be 'processes' or 'dask://HOST:PORT'"):
        check_executor(name)


def test_dask_that_is_not_installed_is_an_error(monkeypatch):
    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr(executors.importlib, "import_module", missing)
    with pytest.raises(ExecutorError, match=r"^Dask is not installed: .*firm-hdl\[distributed\]"):
        list(run_each(square, TASKS, executor="dask://127.0.0.1:1"))


@pytest.fixture(scope="module")
def cluster():
    """Return a Dask cluster of two workers on this machine, and its name as an executor.

    A cluster takes seconds to start. It replaces a worker that was killed. The last test closes it.
    """
    distributed = pytest.importorskip("distributed")
    local_cluster = distributed.LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        host="127.0.0.1",
        # Any free port; `None` takes 8787, which may be in use.
        dashboard_address="127.0.0.1:0",
        worker_dashboard_address=None,
        silence_logs=50,
    )
    try:
        yield local_cluster, local_cluster.scheduler_address.replace("tcp://", "dask://")
    finally:
        with contextlib.suppress(Exception):
            local_cluster.close()


# Dask leaves sockets and loops to the garbage collector.
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::DeprecationWarning")
@pytest.mark.thorough
class TestDask:
    """The Dask executor, on a cluster of this machine."""

    def test_results_are_those_of_processes(self, cluster):
        _, executor = cluster
        assert dict(run_each(square, TASKS, executor=executor)) == SQUARES
        found = dict(run_each(square_or_fail, TASKS, executor=executor))
        assert isinstance(found["task 7"], RuntimeError) and len(found) == len(TASKS)

    @pytest.mark.thorough
    def test_verified_types_have_the_records_of_processes(self, cluster):
        _, executor = cluster
        options = Options(most_cases=3)
        tasks = collect_tasks(["humble"], ["std_msgs/Bool", "std_msgs/String", "std_msgs/Header"])
        here, there = (
            {
                test.type: without_times(record)
                for share in run_tests(
                    accepted,
                    options,
                    [test_of(task, options) for task in tasks],
                    lambda test: test.type,
                    lambda record: (),
                    executor=where,
                    jobs=2,
                )
                for test, record, _ in share
            }
            for where in ("processes", executor)
        )
        assert here == there and all(assert_passed(record) for record in here.values())

    def test_lost_worker_loses_nothing(self, cluster):
        local_cluster, executor = cluster
        found = {}
        for key, result in run_each(slow_square, TASKS, executor=executor):
            found[key] = result
            if len(found) == 5:
                os.kill(local_cluster.workers[0].pid, signal.SIGKILL)
        assert found == SQUARES

    @pytest.mark.thorough
    def test_lost_cluster_is_an_error_that_keeps_earlier_results(self, cluster, monkeypatch):
        local_cluster, executor = cluster
        monkeypatch.setattr(executors, "CHECK_SECONDS", 0.5)
        monkeypatch.setattr(executors, "MAX_IDLE_SECONDS", 2)
        found = []
        with pytest.raises(ExecutorError, match=r"results so far are kept"):
            for key, _ in run_each(slow_square, TASKS, executor=executor):
                found.append(key)
                if len(found) == 5:
                    local_cluster.close()
        assert 5 <= len(found) < len(TASKS)

    def test_scheduler_that_is_not_there_is_an_error(self, monkeypatch):
        pytest.importorskip("distributed")
        monkeypatch.setattr(executors, "CONNECT_SECONDS", 1)
        with pytest.raises(ExecutorError, match=r"^no Dask scheduler at 127\.0\.0\.1:1: "):
            list(run_each(square, TASKS, executor="dask://127.0.0.1:1"))
