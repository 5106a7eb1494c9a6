"""Acceptance: correct converters pass, and each check has a must-fail twin."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring

import firm_hdl.cases.damage as damage
import firm_hdl.verify.ts3.acceptance as acceptance
import firm_hdl.verify.ts3.circuit as circuit
from firm_hdl.cases.damage import DAMAGES, broken_packets
from firm_hdl.cases.make import Case
from firm_hdl.frontend import load_message
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.signatures import Status
from firm_hdl.plan import build_plan, decode
from firm_hdl.verify import Options, accept, collect_tasks, run_tasks
from firm_hdl.verify.__main__ import main
from firm_hdl.verify.results.verdict import Passed
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.verify.judged import NAN_KEY, TIME_KEY, assert_passed

HEADER = "std_msgs/msg/Header"


# Wider buses have more cases, and thus values that libraries encode differently.
KNOWN = {("sensor_msgs/Joy", 16): (NAN_KEY, TIME_KEY)}


TYPES = [
    ("humble", HEADER),
    ("humble", "std_msgs/msg/Empty"),
    ("humble", "geometry_msgs/msg/Twist"),
    ("lyrical", "diagnostic_msgs/msg/DiagnosticArray"),
    ("noetic", "std_msgs/Header"),
    ("noetic", "std_msgs/Empty"),
    ("noetic", "sensor_msgs/Joy"),
]
# No bytes, numbers alone, and strings on each wire.
QUICK = [(*TYPES[0], 8), (*TYPES[2], 16), (*TYPES[4], 16), (*TYPES[5], 8)]


@pytest.mark.parametrize(
    ("distro", "name", "bus_bytes"),
    by_depth(QUICK, [(*each, bus_bytes) for each in TYPES for bus_bytes in (8, 16)]),
)
def test_types_pass(distro, name, bus_bytes):
    result = accept(distro, name, Options(bus_bytes=bus_bytes))
    known = KNOWN.get((name, bus_bytes), ())
    assert assert_passed(result, known) >= 2 * result.cases > 0
    assert result.packets > 2 * result.cases and result.cycles >= result.beats


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
    given = Options(most_cases=4, references=(), **options)
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
    result = accept("humble", HEADER, Options(most_cases=by_depth(5, None)))
    assert any(output in failure for failure in result.failures), result.failures


RUNS = ("hardware: ", "hardware, Stalls(", "hardware, broken packets, Stalls(")


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
    result = accept("humble", "std_msgs/msg/UInt8", Options(most_cases=2))
    assert len(runs) == len(RUNS)
    where = RUNS[number]
    assert all(failure.startswith(where) for failure in result.failures)
    for what in ("packet ", "leaf data", "status: ", "sent_status of packet ", "packet_error is "):
        assert sum(f": {what}" in failure for failure in result.failures) == 1, what
    assert len(result.failures) == 5


def test_broken_packets_are_of_every_kind():
    # With a small limit, few packets with a large length are decoded item by item.
    plan = build_plan(lay_out(load_message("std_msgs/msg/Header")), max_message_bytes=1 << 12)
    packet = bytes.fromhex("00010000 01000000 02000000 05000000 61626364 00")
    cases = [Case(what="", value=None, packet=packet, transfers={})] * len(DAMAGES)
    found = {}
    for seed in range(40):
        for each in broken_packets(plan, cases, random.Random(seed)):
            found[each] = decode(plan, each).status
    assert set(found.values()) == {
        "OK",
        "TRUNCATED",
        "TRAILING",
        "LENGTH",
        "ENCAPSULATION",
        "STRING",
    }
    sizes = {len(each) - len(packet) for each in found}
    # One byte, a whole beat or more, added or removed; and changes that keep the size.
    assert {-1, 0, 3, 4} <= sizes and min(sizes) < -8 and max(sizes) > 11
    changed = [each for each in found if len(each) == len(packet)]
    assert {sum(a != b for a, b in zip(each, packet, strict=True)) for each in changed} > {
        0,
        1,
        2,
        6,
    }


def test_all_kinds_of_damage_take_turns(monkeypatch):
    plan = build_plan(lay_out(load_message("std_msgs/msg/Bool")))
    kinds = [lambda *_, kind=kind: bytes([kind]) for kind in range(5)]
    monkeypatch.setattr(damage, "DAMAGES", tuple(kinds))
    cases = [Case(what="", value=None, packet=bytes(5), transfers={})] * 15
    found = b"".join(broken_packets(plan, cases, random.Random(1)))
    assert sorted(found[:5]) == [*range(5)] and found == found[:5] * 3


def test_fault_in_the_golden_model_is_found(monkeypatch):
    original = acceptance.decode

    def decode(plan, packet):
        decoded = original(plan, packet)
        return replace(decoded, transfers=decoded.transfers[:-1])

    monkeypatch.setattr(acceptance, "decode", decode)
    result = accept("humble", HEADER, Options(broken=False, stalled=False))
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
    result = accept("humble", "std_msgs/msg/UInt8", Options(simulated=False))
    for failure in result.failures:
        assert failure.startswith("golden model, case ") and f": {output}" in failure
    # One wrong answer hides no other one.
    assert len({failure.partition(": ")[0] for failure in result.failures}) == result.cases > 1


def test_unknown_types_fail_and_say_how_to_repeat():
    result = accept("humble", "no_msgs/msg/Such", Options(bus_bytes=4, seed=3, stalled=False))
    assert len(result.failures) == 1
    assert result.command == (
        "firm-hdl verify --distro humble --bus-bytes 4 --seed 3 --no-stalls no_msgs/msg/Such"
    )


def test_same_types_are_run_once():
    tasks = collect_tasks(["humble", "jazzy"], ["sensor_msgs/Imu", "sensor_msgs/msg/Range"])
    assert sorted((task.name, task.distro, task.same) for task in tasks) == [
        ("sensor_msgs/msg/Imu", "jazzy", ("humble", "jazzy")),
        ("sensor_msgs/msg/Range", "humble", ("humble",)),
        ("sensor_msgs/msg/Range", "jazzy", ("jazzy",)),
    ]


def test_unknown_names_are_refused():
    with pytest.raises(ValueError, match=r"^No distribution has no_msgs/msg/Such$"):
        collect_tasks(["humble"], ["no_msgs/Such"])


def test_processes_give_the_results_of_one():
    tasks = collect_tasks(["humble"], [HEADER, "std_msgs/Bool"])
    options = Options(most_cases=2)
    one = {task.name: result.simulated_cycles for task, result in run_tasks(tasks, options, 1)}
    two = {task.name: result.simulated_cycles for task, result in run_tasks(tasks, options, 2)}
    assert one == two and len(one) == 2


def test_command_reports_and_exits(capsys, monkeypatch):
    arguments = ["--distro", "humble", "--jobs", "1", "--cases", "2", "std_msgs/Bool"]
    assert main(arguments) == 0
    assert "humble      1 of    1 types pass (8-byte bus)" in capsys.readouterr().out
    monkeypatch.setattr(circuit, "Serializer", lambda *a, **o: MarksPackets(Serializer(*a, **o)))
    assert main(arguments) == 1
    output = capsys.readouterr().out
    assert "FAIL std_msgs/msg/Bool (humble)" in output
    assert "again: firm-hdl verify --distro humble --bus-bytes 8 --seed 0" in output
    assert main(["--distro", "humble", "no_msgs/Such"]) == 1
    assert capsys.readouterr().err == "error: No distribution has no_msgs/msg/Such\n"
