"""The Verilog in a cocotb bench, with Icarus Verilog and cocotbext-axi."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.export.build import build
from firm_hdl.export.options import Options
from tests.depth import by_depth
from tests.tools import need

LOOPBACK = """\
module loopback (
  input aclk, aresetn,
  input [63:0] s_axis_tdata, input [7:0] s_axis_tkeep, input s_axis_tlast, s_axis_tvalid,
  output s_axis_tready,
  output [63:0] m_axis_tdata, output [7:0] m_axis_tkeep, output m_axis_tlast, m_axis_tuser,
  output m_axis_tvalid, input m_axis_tready,
  output [7:0] m_axis_status_tdata, output m_axis_status_tvalid, input m_axis_status_tready
);
{wires}
  {rx} rx (.aclk(aclk), .aresetn(aresetn), .s_axis_tdata(s_axis_tdata),
    .s_axis_tkeep(s_axis_tkeep), .s_axis_tlast(s_axis_tlast), .s_axis_tvalid(s_axis_tvalid),
    .s_axis_tready(s_axis_tready), .m_axis_status_tdata(m_axis_status_tdata),
    .m_axis_status_tvalid(m_axis_status_tvalid), .m_axis_status_tready(m_axis_status_tready),
    {joined});
  {tx} tx (.aclk(aclk), .aresetn(aresetn), .m_axis_tdata(m_axis_tdata),
    .m_axis_tkeep(m_axis_tkeep), .m_axis_tlast(m_axis_tlast), .m_axis_tuser(m_axis_tuser),
    .m_axis_tvalid(m_axis_tvalid), .m_axis_tready(m_axis_tready), .m_axis_status_tready(1'b1),
    {joined});
endmodule
"""

RUN = """\
import sys
from cocotb_tools.runner import get_results, get_runner
folder, bench, packets, *sources = sys.argv[1:]
sys.path.insert(0, bench)
runner = get_runner("icarus")
runner.build(sources=sources, hdl_toplevel="loopback", build_dir=folder,
    timescale=("1ns", "1ps"))
results = runner.test(
    hdl_toplevel="loopback", test_module="cocotb_loopback", test_dir=folder,
    extra_env={"PACKETS": packets},
)
tests, failed = get_results(results)
print(f"{tests} tests, {failed} failed")
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    found = find_spec("cocotb_tools") and find_spec("cocotbext") and find_spec("cocotbext.axi")
    need("cocotbext-axi", "here" if found else None)
    name = by_depth("std_msgs/msg/Header", "sensor_msgs/msg/LaserScan")
    options = Options(ports=by_depth("flat", "records"))
    out = tmp_path_factory.mktemp("built")
    (built,) = build([name], out, stimuli=stimuli, options=options)
    return built.folder


def run_bench(folder: Path, work: Path, text: str) -> str:
    """Run the bench with `text` as the deserializer; return the output."""
    manifest = json.loads((folder / "manifest.json").read_text())
    rx, tx = (manifest["converters"][way] for way in ("deserializer", "serializer"))
    ports = [port for port in rx["ports"] if port.get("leaf") is not None]
    (work / "loopback.v").write_text(
        LOOPBACK.format(
            rx=rx["module"],
            tx=tx["module"],
            wires="".join(f"  wire [{p['width'] - 1}:0] {p['name']};\n" for p in ports),
            joined=", ".join(f".{p['name']}({p['name']})" for p in ports),
        )
    )
    (work / "rx.v").write_text(text)
    command = [
        *(sys.executable, "-c", RUN, str(work), str(Path(__file__).parent)),
        str(folder / "vhdl" / "stimuli.txt"),
        *(str(work / "loopback.v"), str(work / "rx.v"), str(folder / tx["verilog"])),
    ]
    done = subprocess.run(
        command, cwd=work, capture_output=True, text=True, timeout=300, check=False
    )
    return done.stdout + done.stderr


@pytest.mark.usefixtures("iverilog")
def test_packets_come_back_through_cocotb(folder, tmp_path):
    manifest = json.loads((folder / "manifest.json").read_text())
    text = (folder / manifest["converters"]["deserializer"]["verilog"]).read_text()
    output = run_bench(folder, tmp_path, text)
    assert "1 tests, 0 failed" in output, output
    assert "packets came back" in output


@pytest.mark.usefixtures("iverilog")
@pytest.mark.thorough
def test_process_that_waits_for_its_first_change_fails(folder, tmp_path):
    manifest = json.loads((folder / "manifest.json").read_text())
    text = (folder / manifest["converters"]["deserializer"]["verilog"]).read_text()
    # Yosys writes such processes. Their initial output is defined in Verilog only.
    waiting = r"reg [7:0] waits; always @* waits = \2; assign \1 = waits;"
    changed, count = re.subn(r"assign (m_axis_status_tdata) = (.*);", waiting, text)
    assert count == 1
    output = run_bench(folder, tmp_path, changed)
    assert "0 failed" not in output, output
    assert "Failed 1 of 1 tests" in output


# What the bench has to put where it does not count, in beats that are taken.
NOISE = {
    "bytes in lanes that are not kept": "s_axis_tlast && |(s_axis_tdata & ~{kept})",
    "tkeep in beats that are not the last": "!s_axis_tlast && !(&s_axis_tkeep)",
}


@pytest.mark.parametrize("noise", NOISE)
@pytest.mark.usefixtures("iverilog")
@pytest.mark.thorough
def test_deserializer_that_does_not_ignore_noise_fails(folder, tmp_path, noise):
    manifest = json.loads((folder / "manifest.json").read_text())
    text = (folder / manifest["converters"]["deserializer"]["verilog"]).read_text()
    kept = ", ".join(f"{{8{{s_axis_tkeep[{lane}]}}}}" for lane in reversed(range(8)))
    seen = NOISE[noise].replace("{kept}", f"{{{kept}}}")
    sees = f"""reg noisy = 0;
    always @(posedge aclk) if (s_axis_tvalid && s_axis_tready && {seen}) noisy <= 1;
    assign \\1 = \\2 | noisy;"""
    changed, count = re.subn(r"assign (m_axis_status_tdata) = (.*);", sees, text)
    assert count == 1
    output = run_bench(folder, tmp_path, changed)
    assert "Failed 1 of 1 tests" in output, output
