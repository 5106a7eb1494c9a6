"""Programs for the tests: one type on one bus, with or without a fault."""

from __future__ import annotations

from firm_hdl.jobs.programs import ProgramMissingError
from lab.fuzz import Failure, FuzzTask, Outcome, run_task
from lab.fuzz.build import find_tools
from tests.tools import need

STRING = "std_msgs/msg/String"
EMPTY = "std_msgs/Empty"


def need_tools() -> None:
    """Skip the test without Verilator or a compiler; in CI, fail it."""
    try:
        find_tools()
    except ProgramMissingError as error:
        need(str(error), None)


def run(
    name: str, *circuits, bus_bytes: int = 4, packets: int = 3000, first: int = 0, **more
) -> Outcome:
    """Fuzz circuits of a type."""
    task = FuzzTask(
        type=name,
        bus_bytes=bus_bytes,
        room=300,
        seed=1,
        packets=packets,
        first=first,
        circuits=circuits,
    )
    return run_task(task, **more)


def found(outcome: Outcome) -> Failure:
    """Return the only failure."""
    (failure,) = outcome.failures
    return failure
