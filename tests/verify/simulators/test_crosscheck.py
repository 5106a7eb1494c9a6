# amaranth: UnusedElaboratable=no
"""Exported VHDL in GHDL equals the Python simulation in each cycle; a changed line is found."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

import firm_hdl.verify.simulators.crosscheck as crosscheck
import firm_hdl.verify.simulators.ghdl as exported
import firm_hdl.verify.ts3.circuit as circuit
from firm_hdl import Serializer, load_message
from firm_hdl.export.build import BuildError
from firm_hdl.export.top import Top
from firm_hdl.jobs.processes import ToolError
from firm_hdl.jobs.programs import ProgramMissingError, find_ghdl
from firm_hdl.sim import Harness, RunOptions, Stalls
from firm_hdl.verify import Options, Result, accept
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.verify.simulators import Ghdl, TextSimulator
from firm_hdl.verify.simulators.crosscheck import first_difference
from firm_hdl.verify.simulators.semantics import traffic
from firm_hdl.verify.simulators.trace import Trace
from firm_hdl.vhdl.convert import Vhdl, convert
from tests.depth import by_depth
from tests.verify.judged import assert_passed
from tests.verify.samples import SAMPLE, own_package

HEADER = "std_msgs/msg/Header"


def accepted(distro: str, name: str, bus_bytes: int = 8, **options) -> Result:
    chosen = {"most_cases": 3, "simulator": "ghdl", **options}
    return accept(distro, name, Options(bus_bytes=bus_bytes, **chosen))


# Other tests of a folder with VHDL have loops over strings, those below have bounds; here are no
# bytes, and one lane.
QUICK = ("bond/Constants",)
SMALL = by_depth([("noetic", "std_msgs/String", 1)], [])


@pytest.mark.parametrize(
    ("distro", "name", "bus_bytes"),
    [pytest.param(*each, marks=[] if each[1] in QUICK else pytest.mark.thorough) for each in SAMPLE]
    + SMALL,
)
def test_vhdl_equals_the_simulation_in_each_cycle(ghdl, distro, name, bus_bytes):
    result = accepted(distro, name, bus_bytes)
    assert_passed(result)
    found = result.comparison
    assert found is not None
    # Each of the four runs begins with the state before its first clock edge.
    assert found.cycles == result.simulated_cycles + 4
    assert (found.packets, found.statuses) == (result.packets, 2 * result.packets)
    assert found.transfers >= result.packets


def replay_marked(other: TextSimulator, folder: Path) -> None:
    """Replay a serializer that marks packets, which loopback tests never do."""
    message = load_message("std_msgs/msg/String")

    def make() -> Serializer:
        return Serializer(message, bus_bytes=2, max_message_bytes=99)

    tx = make()
    trace = Trace((tx,), message.name)
    harness = Harness(None, tx, message=message, probes=trace.probes)
    items = {
        "right": [((97, 98), False), ((99, 0), True)],
        "early": [((97, 98), True), ((99, 0), True)],
        "never": [((97, 98), False), ((99, 0), False)],
    }
    order = ["right", "early", "right", "never", "right"]
    trace.start("marked")
    seen = harness.run_messages(
        [{0: [3], 1: items[name]} for name in order],
        RunOptions(
            stalls={"packets_out": Stalls.bits("011"), "status": Stalls.bits("001")},
            observe=trace.observe,
        ),
    )
    assert seen.packet_errors == [name != "right" for name in order]
    rows = [row.rstrip() for row in other.replay(trace, lambda: [Top(make())], folder)]
    assert first_difference(trace, rows) is None
    (run,) = traffic(trace, rows)
    assert (run.packets, run.packet_errors) == (seen.packets, seen.packet_errors)
    assert run.sent_statuses == [f"{status.value:08b}" for status in seen.statuses]


def test_marked_packets_are_marked_in_vhdl(ghdl, tmp_path):
    replay_marked(Ghdl(), tmp_path)


@pytest.mark.parametrize("of_verilog", ["iverilog"], indirect=True)
def test_marked_packets_are_marked_in_verilog(of_verilog, tmp_path):
    replay_marked(of_verilog, tmp_path)


OWN_TYPES = [
    pytest.param("own_msgs/msg/Deep", 8, marks=pytest.mark.thorough),
    ("own_msgs/msg/Runs", 4),
    pytest.param("own_msgs/srv/Ask_Request", 8, marks=pytest.mark.thorough),
    pytest.param("own_msgs/srv/Ask_Response", 8, marks=pytest.mark.thorough),
]


@pytest.mark.parametrize(("name", "bus_bytes"), OWN_TYPES)
def test_user_defined_types_behave_the_same(ghdl, tmp_path, name, bus_bytes):
    paths = (str(own_package(tmp_path)),)
    result = accepted("lyrical", name, bus_bytes, paths=paths)
    assert assert_passed(result) and result.note == ""
    assert result.comparison is not None and result.comparison.packets == result.packets > 0


_made: dict[str, Vhdl] = {}


def made_once(top: Top, *, name: str) -> Vhdl:
    """Convert a circuit once for all changes of its text; its name says type, bus and direction."""
    if name not in _made:
        _made[name] = convert(top, name=name)
    return replace(_made[name], files=dict(_made[name].files))


def change_line(monkeypatch, file: str, pattern: str, text: str) -> None:
    """A function that changes the first line with `pattern` in one VHDL file."""

    def converted(top, **options):
        vhdl = made_once(top, **options)
        for name, before in vhdl.files.items():
            if name.endswith(file):
                after, count = re.subn(pattern, text, before, count=1)
                assert count == 1 and after != before
                assert after.count("\n") == before.count("\n")
                vhdl.files[name] = after
        return vhdl

    monkeypatch.setattr(exported, "convert", converted)


@pytest.mark.parametrize(
    ("file", "pattern", "text", "output"),
    [
        # A condition, an operator, a limit that costs nothing but cycles; what registers hold
        # initially, and after a reset.
        (
            "deserializer_flat_core_sequencer.vhd",
            r"(?<=if )mismatch = '1'",
            "mismatch = '0'",
            "instead of",
        ),
        (
            "serializer_flat_core_packer.vhd",
            r"(?<= total <= at )\+",
            "-",
            "of the serializer is",
        ),
        (
            "deserializer_flat_core_buffer.vhd",
            r"(?<=used )= 7",
            ">= 3",
            "s_axis_tready of the des",
        ),
        (
            "_deserializer_flat_core_mover.vhd",
            r"(message_stamp_sec_payload_q +: .*):= \(others => '0'\)",
            r"\1:= (0 => '1', others => '0')",
            "hardware, cycle 0: stamp_sec_data of the deserializer is 0x1 instead of 0x0",
        ),
        # Only the status output is reset: the other outputs keep their last value.
        (
            "_deserializer_flat_core_mover.vhd",
            r"status_payload_q( +)<= \(others => '0'\);",
            r"status_payload_q\1<= (0 => '1', others => '0');",
            "cycle 0: m_axis_status_tdata of the deserializer is 0x1 instead of 0x0",
        ),
        # An output that has no meaning while `valid` is low.
        (
            "_deserializer_flat.vhd",
            r"(stamp_nanosec_data +<= )(.*);",
            r"\1not \2;",
            "stamp_nanosec_data of the deserializer is 0xffffffff instead of 0x0",
        ),
        # Undefined values are differences, too.
        (
            "_serializer_flat.vhd",
            r"(m_axis_status_tdata +<= ).*;",
            r"\1(others => 'X');",
            "m_axis_status_tdata of the serializer is 'XXXXXXXX' instead of 0x0",
        ),
    ],
)
@pytest.mark.sampled(4)
def test_a_changed_line_is_found(ghdl, monkeypatch, file, pattern, text, output):
    change_line(monkeypatch, file, pattern, text)
    result = accepted("lyrical", HEADER)
    assert any(output in failure for failure in result.failures), result.failures
    # Only the VHDL is reported as faulty.
    assert all(failure.startswith("GHDL") for failure in result.failures)


def undefined_at_first(vhdl: str) -> tuple[str, int]:
    """Make the initial values of memories, and of registers without a reset, undefined."""
    count = 0
    for process in re.findall(r"process \(aclk\)\n.*?end process;", vhdl, re.DOTALL):
        if "rst = '1'" in process:
            continue
        for name in set(re.findall(r"^ +(\w+)(?:\(.*\))? +<=", process, re.MULTILINE)):
            declared = rf"(  signal {name} +: .*:= )(.*);"
            found = re.search(declared, vhdl)
            assert found is not None, name
            vhdl = vhdl.replace(found[0], found[1] + found[2].replace("'0'", "'X'") + ";")
            count += 1
    return vhdl, count


@pytest.mark.parametrize(
    ("distro", "name", "bus_bytes"),
    [
        ("lyrical", HEADER, 8),
        pytest.param("noetic", "std_msgs/Header", 1, marks=pytest.mark.thorough),
        pytest.param("lyrical", "sensor_msgs/msg/Joy", 4, marks=pytest.mark.thorough),
    ],
)
def test_registers_without_reset_are_written_before_they_are_offered(
    ghdl, monkeypatch, distro, name, bus_bytes
):
    counts = []

    def converted(top, **options):
        vhdl = made_once(top, **options)
        for file, before in vhdl.files.items():
            vhdl.files[file], count = undefined_at_first(before)
            counts.append(count)
        return vhdl

    monkeypatch.setattr(exported, "convert", converted)
    result = accepted(distro, name, bus_bytes)
    assert sum(counts) > 30
    # Ports differ, but the transfers are the same.
    (difference,) = result.failures
    assert re.fullmatch(r"GHDL: hardware, cycle 0: \w+_data of the .* is 'X+' .*", difference)


def test_vhdl_that_ghdl_refuses_is_a_failure(ghdl, monkeypatch):
    change_line(monkeypatch, "_serializer_flat.vhd", "architecture rtl", "architecture of")
    result = accepted("lyrical", HEADER)
    assert len(result.failures) == 1
    assert re.match(r"GHDL: std_msgs_msg_header_cdr_8_serializer_flat\.vhd:\d+", result.failures[0])


def test_cycles_that_are_missing_are_found(monkeypatch):
    monkeypatch.setattr(circuit, "simulator", lambda name: ShortSimulator())
    result = accepted("lyrical", "std_msgs/msg/Bool")
    cycles = result.simulated_cycles + 4
    assert result.failures[0] == f"short: {cycles - 9} cycles instead of {cycles}"
    assert "packets differ" in result.failures[1]
    # Those that the other simulator showed.
    assert result.comparison is not None and result.comparison.cycles == cycles - 9


def test_converters_that_are_too_large_to_export_are_not_judged(monkeypatch):
    def refuse(plan):
        raise BuildError("it is too large")

    monkeypatch.setattr(crosscheck, "check_size", refuse)
    monkeypatch.setattr(circuit, "simulator", lambda name: ShortSimulator())
    result = accepted("lyrical", "std_msgs/msg/Bool")
    assert result.verdict == NotJudged("it cannot be exported: it is too large")


class ShortSimulator:
    """Returns the expected rows without the last ones."""

    title = "short"

    def replay(self, trace, tops, folder):
        return trace.expected[:-9]


class FailingSimulator:
    """A simulator that cannot be run."""

    title = "broken"

    def replay(self, trace, tops, folder):
        raise ToolError("out of order")


def test_simulator_that_fails_is_a_failure(monkeypatch):
    monkeypatch.setattr(circuit, "simulator", lambda name: FailingSimulator())
    result = accepted("lyrical", "std_msgs/msg/Bool")
    found = result.comparison
    assert result.failures == ["broken: out of order"] and found is not None
    # It showed nothing that could be counted.
    assert (found.cycles, found.packets, found.transfers, found.statuses) == (0, 0, 0, 0)


def test_the_cycles_of_a_hanging_circuit_are_compared(ghdl, monkeypatch):
    class HangingHarness(circuit.Harness):
        def run_packets(self, packets, options):
            return super().run_packets(packets, replace(options, limit=20))

    monkeypatch.setattr(circuit, "Harness", HangingHarness)
    result = accepted("lyrical", "std_msgs/msg/Bool", 1)
    assert result.failures and all("DeadlineError" in failure for failure in result.failures)
    assert result.comparison is not None and result.comparison.cycles > 60


def test_error_for_missing_ghdl_explains_the_installation(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("GHDL", raising=False)
    with pytest.raises(
        ProgramMissingError,
        match=r"^GHDL is not installed \(Debian, Ubuntu: apt install ghdl-mcode\)$",
    ):
        Ghdl()
    monkeypatch.setenv("GHDL", "ghdl-nowhere")
    with pytest.raises(ProgramMissingError, match=r"^GHDL is 'ghdl-nowhere' in the environment"):
        find_ghdl()
