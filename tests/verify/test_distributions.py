"""Every type of every distribution, a few cases each; `make verify` runs them all."""

from __future__ import annotations

import pytest

from firm_hdl.verify import Options, accept, collect_tasks

TASKS = list(collect_tasks((), ()))
WIDTHS = (8, 4)
OTHER_WIDTHS = (1, 2, 16, 32, 64)


@pytest.mark.parametrize("index", range(len(TASKS)), ids=[task.name for task in TASKS])
def test_every_type_passes(index):
    task = TASKS[index]
    options = Options(bus_bytes=WIDTHS[index % len(WIDTHS)], most_cases=3, broken=False)
    result = accept(task.same[-1], task.name, options)
    assert not result.failures


@pytest.mark.parametrize("index", range(0, len(TASKS), 9), ids=lambda index: TASKS[index].name)
def test_a_sample_passes_on_other_buses(index):
    task = TASKS[index]
    width = OTHER_WIDTHS[index // 9 % len(OTHER_WIDTHS)]
    result = accept(task.same[-1], task.name, Options(bus_bytes=width, most_cases=3))
    assert not result.failures
