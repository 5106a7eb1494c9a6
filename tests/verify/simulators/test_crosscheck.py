# amaranth: UnusedElaboratable=no
"""Exported VHDL in GHDL equals the Python simulation in each cycle; a changed line is found."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

import firm_hdl.verify.simulators.programs as programs
from firm_hdl.export.top import Top
from firm_hdl.verify.results.records import Record
from firm_hdl.verify.simulators.trace import read_row
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.vhdl.convert import Vhdl, convert
from tests.verify.judged import accept, assert_passed
from tests.verify.samples import SAMPLE

HEADER = "std_msgs/msg/Header"


def accepted(distro: str, name: str, bus_bytes: int = 8, **options) -> Record:
    chosen = {"most_cases": 3, "simulator": "ghdl", **options}
    return accept(distro, name, CaseOptions(bus_bytes=bus_bytes, **chosen))


# Other tests of a folder with VHDL have loops over strings, those below have bounds; here are no
# bytes.
QUICK = ("bond/Constants",)


@pytest.mark.parametrize(
    ("distro", "name", "bus_bytes"),
    [
        pytest.param(*each, marks=[] if each[1] in QUICK else pytest.mark.thorough)
        for each in SAMPLE
    ],
)
def test_vhdl_equals_the_simulation_in_each_cycle(ghdl, distro, name, bus_bytes):
    result = accepted(distro, name, bus_bytes)
    assert_passed(result)
    assert result.cycles > 4 * result.cases


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

    monkeypatch.setattr(programs, "convert_to_vhdl", converted)


@pytest.mark.parametrize(
    ("file", "pattern", "text", "output"),
    [
        # A condition, an operator, a limit that costs nothing but cycles; what registers hold
        # initially, and after a reset.
        (
            "deserializer_flat_core_sequencer.vhd",
            r"(?<=if )header_error = '1'",
            "header_error = '0'",
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
@pytest.mark.sampled(9)
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
    counts, seen = [], []

    def converted(top, **options):
        vhdl = made_once(top, **options)
        for file, before in vhdl.files.items():
            vhdl.files[file], count = undefined_at_first(before)
            counts.append(count)
        return vhdl

    def replayed(self, trace, tops, folder):
        seen.append((trace, replay(self, trace, tops, folder)))
        return seen[-1][1]

    replay = programs.Ghdl.replay
    monkeypatch.setattr(programs, "convert_to_vhdl", converted)
    monkeypatch.setattr(programs.Ghdl, "replay", replayed)
    result = accepted(distro, name, bus_bytes)
    assert sum(counts) > 30
    # Ports differ, but the transfers are the same.
    (difference,) = result.failures
    assert re.fullmatch(r"GHDL: hardware, cycle 0: \w+_data of the .* is 'X+' .*", difference)
    ((trace, rows),) = seen
    assert offered(trace, rows) == offered(trace, trace.expected) != []


def offered(trace, rows):
    """Return what each stream offers in each cycle in which its `valid` is not low."""
    names = {pin.number: (pin.device, pin.port.name) for pin in trace.outputs}
    now, found = {}, []
    for number, row in enumerate(rows):
        now.update((names[pin], bits) for pin, bits in read_row(row))
        for (device, name), bits in now.items():
            base, is_valid, _ = name.partition("valid")
            if is_valid and bits != "0":
                parts = {n: b for (d, n), b in now.items() if d == device and n.startswith(base)}
                if base == "m_axis_t":
                    # Bytes that are not kept have no meaning.
                    count = 8 * parts["m_axis_tkeep"].count("1")
                    parts["m_axis_tdata"] = parts["m_axis_tdata"][-count:] if count else ""
                found.append((number, device, parts))
    return found


@pytest.mark.thorough
def test_vhdl_that_ghdl_refuses_is_a_failure(ghdl, monkeypatch):
    change_line(monkeypatch, "_serializer_flat.vhd", "architecture rtl", "architecture of")
    result = accepted("lyrical", HEADER)
    assert len(result.failures) == 1
    assert re.match(r"GHDL: std_msgs_msg_header_cdr_8_serializer_flat\.vhd:\d+", result.failures[0])
