"""Every type of every distribution, with a few cases each; in `make test`, one type in twelve.

There, other tests plan all types of two distributions, such as `test_covering`.
"""

from __future__ import annotations

import pytest

from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.tasks import collect_tasks
from tests.depth import THOROUGH, by_depth
from tests.verify.judged import accept, assert_passed

TASKS = list(collect_tasks((), ()))
WIDTHS = (8, 4)
OTHER_WIDTHS = (1, 2, 16, 32, 64)
LARGEST = 60
"""Number of largest types; each has so many leaves that its test takes as long as many others."""
SAMPLE = range(by_depth(LARGEST, 0), len(TASKS), by_depth(72, 9))
SIMULATED = by_depth(24, 1)
"""One in this many of the other types is simulated. For the rest, only the plan is judged."""


@pytest.mark.parametrize("index", range(len(TASKS)), ids=[task.name for task in TASKS])
@pytest.mark.sampled(45)
def test_every_type_passes(index):
    task = TASKS[index]
    options = CaseOptions(
        bus_bytes=WIDTHS[index // SIMULATED % len(WIDTHS)],
        most_cases=1 if index < LARGEST and not THOROUGH else 3,
        stalled=THOROUGH or index % (2 * SIMULATED) == 0,
        broken=False,
        simulated=THOROUGH or (index >= LARGEST and index % SIMULATED == 0),
    )
    result = accept(task.same[-1], task.name, options)
    assert_passed(result)


@pytest.mark.parametrize("index", SAMPLE, ids=lambda index: TASKS[index].name)
@pytest.mark.thorough
def test_a_sample_passes_on_other_buses(index):
    task = TASKS[index]
    width = OTHER_WIDTHS[SAMPLE.index(index) % len(OTHER_WIDTHS)]
    result = accept(task.same[-1], task.name, CaseOptions(bus_bytes=width, most_cases=3))
    assert_passed(result)
