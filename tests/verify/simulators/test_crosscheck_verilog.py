"""Exported Verilog equals the Python simulation in each cycle; a changed line is found."""

from __future__ import annotations

import re

import pytest

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.export.build import build
from firm_hdl.export.options import Options as BuildOptions
from firm_hdl.export.top import Top
from firm_hdl.jobs.programs import ProgramMissingError
from firm_hdl.verify.results.records import Record
from firm_hdl.verify.simulators import programs
from firm_hdl.verify.simulators.programs import Icarus, TextSimulator, Verilator
from firm_hdl.verify.simulators.trace import Trace
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verilog import convert
from tests.depth import by_depth
from tests.verify.judged import accept, assert_passed

HEADER = "std_msgs/msg/Header"
BOOL = "std_msgs/msg/Bool"
NAMES = {Icarus: "iverilog", Verilator: "verilator"}


def accepted(
    simulator: TextSimulator, distro: str, name: str, bus_bytes: int = 8, **more
) -> Record:
    chosen = {"most_cases": 3, "simulator": NAMES[type(simulator)], **more}
    return accept(distro, name, CaseOptions(bus_bytes=bus_bytes, **chosen))


WIDE = ("lyrical", "service_msgs/msg/ServiceEventInfo", 16)


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("of_verilog", "sample"),
    [
        # Ports of all widths, some of more than 64 bits.
        ("iverilog", WIDE),
        # A bus of one byte; no bytes at all, and a leaf that is only a trigger.
        ("iverilog", ("noetic", by_depth("std_msgs/String", "std_msgs/Header"), 1)),
        pytest.param("iverilog", ("noetic", "bond/Constants", 8), marks=pytest.mark.thorough),
    ],
    indirect=["of_verilog"],
)
def test_verilog_equals_the_simulation_in_each_cycle(of_verilog, sample):
    result = accepted(of_verilog, *sample)
    assert_passed(result)
    assert result.cycles > 4 * result.cases


@pytest.mark.parametrize("of_verilog", ["iverilog"], indirect=True)
def test_text_is_that_of_build(of_verilog, tmp_path):
    message = load_message(BOOL, distro="lyrical")
    cores = [Deserializer(message), Serializer(message)]
    of_verilog.replay(Trace(cores, BOOL), [Top(core) for core in cores], tmp_path)
    files = [path.name for path in tmp_path.glob("*.v") if path.name != "replay.v"]
    (built,) = build([BOOL], tmp_path / "out", options=BuildOptions(ports="flat"))
    for file in files:
        text = (built.folder / file).read_text()
        without_header = re.sub(r"\A(//.*\n)+\n", "", text)
        assert without_header == (tmp_path / file).read_text() != text
    assert len(files) == 2


_made: dict[str, str] = {}


def change_line(monkeypatch, file: str, pattern: str, text: str) -> None:
    """A function that changes the first line with `pattern` in one Verilog file."""

    def changed(top, *, name, **options):
        # The name says type, bus and direction: the text before the change is made once.
        before = _made.get(name) or convert(top, name=name, **options)
        _made[name] = before
        if not name.endswith(f"{file}_verilog"):
            return before
        after, count = re.subn(pattern, text, before, count=1)
        assert count == 1 and after != before
        assert after.count("\n") == before.count("\n")
        return after

    monkeypatch.setattr(programs, "convert_to_verilog", changed)


INITIAL = r"(?<=reg \[31:0\] message_stamp_sec_payload_q) = 32'd0"
STATUS = r"(?<=assign m_axis_status_tdata = )\{.*\}"

CHANGES = {
    # A condition, an operator, a limit that costs nothing but cycles.
    "condition": (
        "_deserializer",
        r"(?<=assign header_error = )(step_\w+)",
        r"~\1",
        "instead of",
    ),
    "operator": ("_serializer", r"(?<=assign total = at )\+", "-", "of the serializer is"),
    "limit": (
        "_deserializer",
        r"(?<=used )== 4'd7",
        ">= 4'd3",
        "s_axis_tready of the deserializer",
    ),
    # What registers hold initially, and after a reset.
    "initial value": (
        "_deserializer",
        INITIAL,
        " = 32'd1",
        "hardware, cycle 0: stamp_sec_data of the deserializer is 0x1 instead of 0x0",
    ),
    "no initial value": (
        "_deserializer",
        INITIAL,
        "",
        f"hardware, cycle 0: stamp_sec_data of the deserializer is '{'X' * 32}' instead of 0x0",
    ),
    "no reset": (
        "_deserializer",
        # The position of the next beat. Leaves that a port shows are not reset, and what else it
        # shows is 0 at the end of a run.
        r"(?<=      at <= )4'd0",
        "at",
        "hardware, nothing taken, cycle 6: stamp_sec_data of the deserializer is",
    ),
    # An output that has no meaning while `valid` is low.
    "payload": (
        "_deserializer",
        r"(?<=reg \[64:0\] message_frame_id_items_payload_q = 65')d0",
        "h0ffffffffffffffff",
        "cycle 0: frame_id_items_data of the deserializer is 0xffffffffffffffff instead of 0x0",
    ),
    # Undefined and undriven values are differences, too.
    "constant": ("_serializer", STATUS, "{5'h10, status_payload}", "is 0x80 instead of 0x0"),
    "undefined": ("_serializer", STATUS, "8'hxx", "m_axis_status_tdata of the serializer is 'XXXX"),
    "undefined bytes": (
        "_serializer",
        r"(?<=assign m_axis_tdata = ).*;",
        "64'hx;",
        "hardware, cycle 0: m_axis_tdata of the serializer is 'XXXX",
    ),
}
# Changes to undefined values, which Verilator does not have.
UNDEFINED = ("no initial value", "undefined")


@pytest.mark.parametrize(
    ("of_verilog", "change"),
    [
        *(("iverilog", each) for each in CHANGES),
        *(("verilator", each) for each in UNDEFINED[:: by_depth(2, 1)]),
    ],
    indirect=["of_verilog"],
)
@pytest.mark.sampled(14)
def test_a_changed_line_is_found(of_verilog, monkeypatch, change):
    *where, output = CHANGES[change]
    change_line(monkeypatch, *where)
    result = accepted(of_verilog, "lyrical", HEADER)
    assert any(output in failure for failure in result.failures), result.failures
    # Only the Verilog is reported as faulty.
    assert all(failure.startswith(of_verilog.title) for failure in result.failures)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("of_verilog", ["iverilog", "verilator"], indirect=True)
def test_verilog_that_is_refused_is_a_failure(of_verilog, monkeypatch):
    change_line(monkeypatch, "_serializer", "endmodule", "endmodul")
    (failure,) = accepted(of_verilog, "lyrical", BOOL, 1).failures
    assert failure.startswith(f"{of_verilog.title}: ")
    assert re.search(r"std_msgs_msg_Bool_cdr_1_serializer_verilog\.v:\d+", failure)


@pytest.mark.parametrize(
    ("kind", "variable", "output"),
    [
        (
            Icarus,
            "IVERILOG",
            r"Icarus Verilog is not installed \(Debian, Ubuntu: apt install iverilog\)",
        ),
        (
            Verilator,
            "VERILATOR",
            r".* needs Verilator: Verilator is not installed \(Debian, Ubuntu: apt install .*",
        ),
    ],
)
def test_error_for_a_missing_simulator_explains_the_installation(
    monkeypatch, tmp_path, kind, variable, output
):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv(variable, raising=False)
    with pytest.raises(ProgramMissingError, match=f"^{output}$"):
        kind()
    monkeypatch.setenv(variable, "nowhere")
    output = f"{kind.title} is 'nowhere' in the environment, but there is no such command"
    with pytest.raises(ProgramMissingError, match=output):
        kind()


def test_missing_companions_are_named(monkeypatch, tmp_path):
    for name in ("iverilog", "verilator"):
        (tmp_path / name).write_text("#!/bin/sh\n")
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    for variable in ("IVERILOG", "VERILATOR", "CXX"):
        monkeypatch.delenv(variable, raising=False)
    with pytest.raises(ProgramMissingError, match=r"^Icarus Verilog has no command vvp beside"):
        Icarus()
    with pytest.raises(ProgramMissingError, match=r"needs a C\+\+ compiler.*apt install g\+\+"):
        Verilator()
    monkeypatch.setenv("CXX", "nowhere -O0")
    with pytest.raises(ProgramMissingError, match=r"^CXX is 'nowhere' in the environment"):
        Verilator()
