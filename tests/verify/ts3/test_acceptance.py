"""Acceptance: correct converters pass, and each check has a must-fail twin."""

from __future__ import annotations

from dataclasses import replace

import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring

import firm_hdl.verify.ts3.acceptance as acceptance
import firm_hdl.verify.ts3.circuit as circuit
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import Status
from firm_hdl.verify.results.verdict import Passed
from firm_hdl.verify.systems.options import CaseOptions
from tests.depth import by_depth
from tests.verify.judged import accept

HEADER = "std_msgs/msg/Header"


@pytest.mark.parametrize(
    ("options", "judged", "sent"),
    [
        # Four packets, once without stalls and once with them; damaged ones have no oracle.
        ({"stalled": False, "broken": False}, 4, 4),
        ({"broken": False}, 8, 8),
        ({"stalled": False}, 4, 12),
        # The golden model counts only in place of a circuit.
        ({"simulated": False}, 4, 0),
    ],
)
def test_each_packet_that_is_compared_counts_once(options, judged, sent):
    given = CaseOptions(most_cases=4, references=(), **options)
    result = accept("lyrical", "std_msgs/msg/Bool", given)
    assert (result.verdict, result.packets) == (Passed(judged), sent)


class Mirror(wiring.Component):
    """A converter with the ports of another one, and faults between them."""

    def __init__(self, inner):
        self.inner, self.plan, self.tree = inner, inner.plan, inner.tree
        super().__init__(inner.signature)

    def elaborate(self, platform):
        m = Module()
        m.submodules.inner = self.inner
        for name, member in self.signature.members.items():
            if member.is_port:
                m.d.comb += getattr(self, name).eq(getattr(self.inner, name))
            elif member.flow == wiring.In:
                wiring.connect(m, wiring.flipped(getattr(self, name)), getattr(self.inner, name))
            else:
                wiring.connect(m, getattr(self.inner, name), wiring.flipped(getattr(self, name)))
        self.fault(m)
        return m

    def fault(self, m):
        """Add the fault to the module."""


class BadByte(Mirror):
    """Inverts a bit that is padding or text in most packets."""

    def fault(self, m):
        bit = self.packets.payload.data[7][0]
        m.d.comb += bit.eq(self.inner.packets.payload.data[7][0] ^ self.packets.payload.last)


class BadLeaf(Mirror):
    """Inverts a bit of an output leaf, and no bit of the packets."""

    def fault(self, m):
        port, inner = self.message.stamp.nanosec, self.inner.message.stamp.nanosec
        m.d.comb += port.payload.eq(inner.payload ^ 1)


class BadStatus(Mirror):
    """Always reports the status OK."""

    def fault(self, m):
        m.d.comb += self.status.payload.eq(0)


class MarksPackets(Mirror):
    """Marks every packet."""

    def fault(self, m):
        m.d.comb += self.packet_error.eq(self.packets.payload.last)


class MarksBeats(Mirror):
    """Marks every beat."""

    def fault(self, m):
        m.d.comb += self.packet_error.eq(1)


class Hangs(Mirror):
    """Accepts eight beats, and then none."""

    def fault(self, m):
        count = Signal(8)
        go = count < 8
        m.d.sync += count.eq(count + (self.packets.valid & self.packets.ready))
        m.d.comb += self.inner.packets.valid.eq(self.packets.valid & go)
        m.d.comb += self.packets.ready.eq(self.inner.packets.ready & go)


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("which", "fault", "output"),
    [
        ("Serializer", BadByte, "hardware: packet "),
        ("Deserializer", BadLeaf, "hardware: leaf stamp.nanosec, transfer 0 of "),
        ("Deserializer", BadStatus, " is OK instead of "),
        ("Serializer", MarksPackets, "hardware: packet_error is [True"),
        ("Serializer", MarksBeats, "hardware: AssertionError: packet_error is high in cycle "),
        pytest.param(*("Deserializer", Hangs, "hardware, Stalls("), marks=pytest.mark.thorough),
        ("Deserializer", Hangs, "hardware: DeadlineError: No transfer in "),
    ],
)
def test_faults_in_hardware_are_found(monkeypatch, which, fault, output):
    original = {"Serializer": Serializer, "Deserializer": Deserializer}[which]
    made = lambda message, **options: fault(original(message, **options))  # noqa: E731
    monkeypatch.setattr(circuit, which, made)
    result = accept("humble", HEADER, CaseOptions(most_cases=by_depth(5, None)))
    assert any(output in failure for failure in result.failures), result.failures


RUNS = ("hardware: ", "hardware, Stalls(", "hardware, broken packets, Stalls(")


@pytest.mark.sampled(3)
@pytest.mark.parametrize("number", range(len(RUNS)))
def test_all_outputs_of_a_run_are_judged(monkeypatch, number):
    """Each output of a run is changed in turn, as little as possible."""
    runs = []

    class ChangedHarness(circuit.Harness):
        def run_packets(self, packets, options):
            seen = super().run_packets(packets, options)
            runs.append(options)
            if len(runs) == number + 1:
                seen.packets[-1] += b"\0"
                seen.transfers[0][-1] ^= 1
                seen.statuses.append(Status.OK)
                seen.sent_statuses[-1] = Status.ITEMS
                seen.packet_errors[-1] = True
            return seen

    monkeypatch.setattr(circuit, "Harness", ChangedHarness)
    result = accept("humble", "std_msgs/msg/UInt8", CaseOptions(most_cases=2))
    assert len(runs) == len(RUNS)
    where = RUNS[number]
    assert all(failure.startswith(where) for failure in result.failures)
    for what in ("packet ", "leaf data", "status: ", "sent_status of packet ", "packet_error is "):
        assert sum(f": {what}" in failure for failure in result.failures) == 1, what
    assert len(result.failures) == 5


def test_fault_in_the_golden_model_is_found(monkeypatch):
    original = acceptance.decode

    def decode(plan, packet):
        decoded = original(plan, packet)
        return replace(decoded, transfers=decoded.transfers[:-1])

    monkeypatch.setattr(acceptance, "decode", decode)
    result = accept("humble", HEADER, CaseOptions(broken=False, stalled=False))
    assert any(f.startswith("golden model, case 0 of") for f in result.failures)
    assert not any(f.startswith("hardware") for f in result.failures)


def refuse(found):
    raise ValueError("it is refused")


@pytest.mark.parametrize(
    ("which", "change", "output"),
    [
        ("encode", refuse, "it is refused"),
        ("decode", lambda found: replace(found, status="TRUNCATED"), "status TRUNCATED"),
        ("encode", lambda found: (found[0], "ITEMS"), "status ITEMS when encoding"),
        ("encode", lambda found: (found[0], "LENGTH"), "status LENGTH when encoding"),
        ("encode", lambda found: (found[0] + b"\0", found[1]), "packet 0 of 1 differs at byte 5: "),
    ],
)
def test_each_answer_of_the_golden_model_is_judged(monkeypatch, which, change, output):
    original = getattr(acceptance, which)
    monkeypatch.setattr(acceptance, which, lambda *given: change(original(*given)))
    result = accept("humble", "std_msgs/msg/UInt8", CaseOptions(simulated=False))
    for failure in result.failures:
        assert failure.startswith("golden model, case ") and f": {output}" in failure
    # One wrong answer hides no other one.
    assert len({failure.partition(": ")[0] for failure in result.failures}) == result.cases > 1


def test_unknown_types_fail_and_say_how_to_repeat():
    result = accept("humble", "no_msgs/msg/Such", CaseOptions(bus_bytes=4, seed=3, stalled=False))
    assert len(result.failures) == 1
    assert result.command == (
        "firm-hdl verify --distro humble --bus-bytes 4 --seed 3 --no-stalls no_msgs/msg/Such"
    )
