"""Tasks in processes: results do not depend on their number, and a dead one loses its task only."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import pytest

from firm_hdl.jobs.executors import run_each

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
