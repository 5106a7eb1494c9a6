"""Twins: faults in the exported Verilog, and in what the decoder knows, are found."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from lab.fuzz.circuits import circuits_of
from lab.fuzz.table import table_of
from lab.fuzz.types import message_of
from lab.tests.fuzz.faults import FAULTS
from lab.tests.fuzz.samples import STRING, found, need_tools, run


@pytest.fixture(autouse=True)
def tools() -> None:
    need_tools()


@pytest.mark.thorough
@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_fault_in_the_circuit_is_found(fault):
    outcome = run(STRING, fault.circuit, alter=fault.alter)
    failure = found(outcome)
    assert re.search(fault.rule, failure.rule), failure
    assert failure.circuit == fault.circuit
    assert failure.packet is not None and failure.cycle is not None


@pytest.mark.thorough
def test_each_fault_changes_the_verilog_of_today():
    """The longer test of each fault is thorough, so renamed signals would be noticed late."""
    message = message_of(STRING)
    options = {"wire": message.wire, "bus_bytes": 4, "max_message_bytes": 300}
    texts = {}

    def kept(module, text):
        return texts.setdefault(module, text)

    circuits_of(message, table_of(message, **options), max_message_bytes=300, alter=kept)
    assert set(texts) == {"deserializer", "serializer", "gate_wait", "gate_drop"}
    for fault in FAULTS:
        assert fault.alter(fault.module, texts[fault.module]) != texts[fault.module]


# The table of a string: "run LENGTH ITEMS BYTES BOOL NUL COUNT BOUND LIMIT".
RUN = "run 0 1 1 0 1 0 0 299"
WRONG_TABLES = {
    "a limit that is too small": "run 0 1 1 0 1 0 0 298",
    "a limit that is too large": "run 0 1 1 0 1 0 0 300",
    "no terminator": "run 0 1 1 0 0 0 0 299",
    "bools": "run 0 1 1 1 1 0 0 299",
    "items of two bytes": "run 0 1 2 0 1 0 0 299",
}


@pytest.mark.thorough
@pytest.mark.parametrize("line", WRONG_TABLES.values(), ids=WRONG_TABLES)
def test_a_fault_in_the_decoders_table_is_found(line):
    def alter(table):
        assert table.lines == (RUN,)
        return replace(table, lines=(line,))

    # Cuts, lengths and items all differ; which is first depends on the packets.
    assert found(run(STRING, "deserializer", alter_table=alter)).rule


@pytest.mark.thorough
def test_a_decoder_that_does_not_sum_what_lengths_claim_is_found():
    def alter(table):
        return replace(table, claim_bytes=1 << 40)

    name = "diagnostic_msgs/msg/DiagnosticArray"
    assert not run(name, "deserializer", bus_bytes=8).failures
    assert "length" in found(run(name, "deserializer", bus_bytes=8, alter_table=alter)).rule


@pytest.mark.thorough
def test_a_failure_is_repeated_by_its_packet_alone():
    fault = FAULTS[3]
    failure = found(run(STRING, fault.circuit, alter=fault.alter))
    again = found(run(STRING, fault.circuit, alter=fault.alter, packets=1, first=failure.packet))
    assert again == failure
