"""Random definitions on both wires and all bus widths: the checks of acceptance, in hardware."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from firm_hdl.cases.effort import work_of
from firm_hdl.cases.oracle import RosbagsOracle
from firm_hdl.plan import build_plan
from firm_hdl.verify.results.records import Test
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.system import Trial
from firm_hdl.verify.ts3.acceptance import accept_message
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.strategies import BUS_WIDTHS, definitions
from tests.verify.judged import NAN_KEY, TIME_KEY, assert_passed

MOST_WORK = by_depth(300, 5_000)
"""Limit on beats times leaves of the smallest packet; larger examples may take minutes."""

MOST_WIDE_WORK = by_depth(400, 64 * MOST_WORK)
"""Limit on the same times the bytes of the bus: 20 leaves on 64 bytes take 18 s to elaborate."""

MOST_CASES = by_depth(4, 8)


@pytest.mark.thorough
@pytest.mark.parametrize("wire", ["ros1", "cdr"])
# Shrinking would simulate for many minutes; the failure message has the command to repeat it.
@settings(
    max_examples=by_depth(2, 40),
    deadline=None,
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
    suppress_health_check=list(HealthCheck),
)
@given(
    definition=definitions(),
    bus_bytes=st.sampled_from(BUS_WIDTHS),
    seed=st.integers(0, 1 << 16),
)
def test_random_types_pass(wire, definition, bus_bytes, seed):
    message = definition.message
    layout = lay_out(message, wire)
    work = work_of(build_plan(layout, bus_bytes=bus_bytes), layout.least_bytes)
    assume(work <= MOST_WORK and work * bus_bytes <= MOST_WIDE_WORK)
    options = CaseOptions(bus_bytes=bus_bytes, wire=wire, seed=seed, most_cases=MOST_CASES)
    trial = Trial.of(Test(system="ts3", distro="", type=message.name))
    oracle = RosbagsOracle(definition.store(), message.dialect)
    accept_message(message, oracle, definition.rosbags_name, options, trial)
    assert set(trial.known) <= {NAN_KEY, TIME_KEY}
    assert_passed(trial, trial.known)
