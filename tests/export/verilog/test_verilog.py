"""The Verilog text: complete, without lint warnings, and correct in other simulators."""

from __future__ import annotations

import random
import re
import subprocess
from pathlib import Path

import pytest

import firm_hdl
from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.export.top import DIRECTIONS, Top, ports_of
from firm_hdl.plan import Plan, build_plan, encode
from firm_hdl.sim import to_transfers
from firm_hdl.verilog import convert
from firm_hdl.wire import lay_out
from tests.depth import by_depth

# Amaranth's Verilog relies on implicit extension of operands, names every bit of a structure, has a
# module per component in one file, and writes one-hot choices as `casez`.
WAIVED = ["WIDTH", "UNUSEDSIGNAL", "CASEOVERLAP", "DECLFILENAME"]


def verilog_of(type_: str, direction: str, bus_bytes: int = 8, distro: str = "lyrical") -> str:
    converter = Deserializer if direction == "deserializer" else Serializer
    top = Top(converter(load_message(type_, distro=distro), bus_bytes=bus_bytes))
    return convert(top, name=direction, header="One line.\n\nAnother.\n")


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize(
    ("type_", "distro"),
    [
        (by_depth("std_msgs/msg/MultiArrayLayout", "sensor_msgs/msg/PointCloud2"), "lyrical"),
        ("std_msgs/Empty", "noetic"),
    ],
)
@pytest.mark.sampled(2)
def test_every_port_is_there_with_its_width(type_, distro, direction):
    text = verilog_of(type_, direction, distro=distro)
    module = text[: text.index("endmodule")]
    declared = {
        name: (way, int(high or 0) + 1)
        for way, high, name in re.findall(r"^  (in|out)put (?:\[(\d+):0\] )?(\w+);", module, re.M)
    }
    plan = build_plan(lay_out(load_message(type_, distro=distro)))
    assert declared == {
        port.name: (port.direction, port.width) for port in ports_of(plan, direction)
    }


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.sampled(2)
def test_text_does_not_depend_on_the_machine(direction):
    # A plan of one step has signals without bits.
    text = verilog_of("std_msgs/msg/Empty", direction)
    assert text.startswith("// One line.\n//\n// Another.\n\nmodule ")
    assert "src =" not in text
    assert str(Path(firm_hdl.__file__).parent) not in text
    assert "[-1:0]" not in text


@pytest.mark.usefixtures("verilator")
@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize(
    "type_",
    # test_hygiene.py lints the files of larger types.
    ["std_msgs/msg/Empty", *by_depth([], ["sensor_msgs/msg/JointState"])],
)
@pytest.mark.sampled(2)
def test_verilator_finds_nothing(type_, direction, tmp_path):
    (tmp_path / "top.v").write_text(verilog_of(type_, direction))
    waivers = [f"-Wno-{name}" for name in WAIVED]
    command = ["verilator", "--lint-only", "-Wall", *waivers, "top.v"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def bench_of(plan: Plan, packets: list[bytes]) -> str:
    """Return a bench that sends packets through both converters and prints the output packets."""
    bus = plan.bus_bytes
    leaves = [port for port in ports_of(plan, "deserializer") if port.leaf is not None]
    wires = "".join(f"  wire [{port.width - 1}:0] {port.name};\n" for port in leaves)
    links = "".join(f", .{port.name}({port.name})" for port in leaves)
    sends, noise = "", random.Random(bus)
    for packet in packets:
        for at in range(0, len(packet), bus):
            part = packet[at : at + bus]
            data = int.from_bytes(part + noise.randbytes(bus - len(part)), "little")
            last = int(at + bus >= len(packet))
            sends += f"    send({8 * bus}'h{data:x}, {(1 << len(part)) - 1}, {last});\n"
    return f"""
module bench;
  reg clk = 0, rstn = 0, iv = 0, il = 0;
  reg [{8 * bus - 1}:0] id = 0;
  reg [{bus - 1}:0] ik = 0;
  wire ir, ov, ol, ou, rv, tv;
  wire [{8 * bus - 1}:0] od;
  wire [{bus - 1}:0] ok;
  wire [7:0] rs, ts;
{wires}
  deserializer rx(.aclk(clk), .aresetn(rstn), .s_axis_tdata(id), .s_axis_tkeep(ik),
    .s_axis_tlast(il), .s_axis_tvalid(iv), .s_axis_tready(ir), .m_axis_status_tdata(rs),
    .m_axis_status_tvalid(rv), .m_axis_status_tready(1'b1){links});
  serializer tx(.aclk(clk), .aresetn(rstn), .m_axis_tdata(od), .m_axis_tkeep(ok),
    .m_axis_tlast(ol), .m_axis_tuser(ou), .m_axis_tvalid(ov), .m_axis_tready(1'b1),
    .m_axis_status_tdata(ts), .m_axis_status_tvalid(tv), .m_axis_status_tready(1'b1){links});
  always #5 clk = !clk;
  task send(input [{8 * bus - 1}:0] data, input [{bus - 1}:0] keep, input last); begin
    id = data; ik = keep; il = last; iv = 1;
    #1; while (!ir) @(negedge clk) #1;
    @(negedge clk) iv = 0;
  end endtask
  always @(posedge clk) begin
    if (ov) $display("beat %h %b %b %b", od, ok, ol, ou);
    if (rv) $display("rx %d", rs);
    if (tv) $display("tx %d", ts);
  end
  initial begin
    @(negedge clk); @(negedge clk) rstn = 1;
{sends}
    repeat (200) @(negedge clk);
    $finish;
  end
endmodule
"""


@pytest.mark.usefixtures("iverilog")
@pytest.mark.parametrize("bus_bytes", by_depth([8], [1, 8]))
@pytest.mark.thorough
def test_packets_come_back_in_iverilog(bus_bytes, tmp_path):
    type_ = "sensor_msgs/msg/JointState"
    message = load_message(type_)
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    packets = []
    for k in range(4):
        value = {
            "header": {"stamp": {"sec": -1, "nanosec": 5}, "frame_id": "é" * k},
            "name": ["", "elbow", "x" * 9][:k],
            "position": [0.5] * k,
            "velocity": [],
            "effort": [-1.0, 1e300][:k],
        }
        packets.append(encode(plan, to_transfers(plan, message, value))[0])
    texts = [verilog_of(type_, direction, bus_bytes) for direction in DIRECTIONS]
    (tmp_path / "all.v").write_text("".join([*texts, bench_of(plan, packets)]))
    compile_ = ["iverilog", "-g2005", "-s", "bench", "-o", "bench", "all.v"]
    subprocess.run(compile_, cwd=tmp_path, check=True)
    command = ["vvp", "-n", "bench"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    came, current, statuses = [], b"", []
    for line in done.stdout.splitlines():
        kind, *words = line.split()
        if kind == "beat":
            count = words[1].count("1")
            current += bytes.fromhex(words[0])[::-1][:count]
            if words[2] == "1":
                came.append(current)
                current = b""
            assert words[3] == "0"
        elif kind in ("rx", "tx"):
            statuses.append(int(words[0]))
    assert came == packets
    assert statuses == [0] * 8
