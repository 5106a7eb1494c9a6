"""Instance templates: legal Verilog modules after copying, with every port named."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.export.build import build
from firm_hdl.export.options import Options
from firm_hdl.export.top import DIRECTIONS, ports_of
from firm_hdl.export.verilog import module_name
from firm_hdl.export.verilog.template import instance, template
from firm_hdl.model import Message
from tests.export.conftest import EVERYTHING
from tests.export.systemverilog.hdl import plan_of, stub
from tests.export.systemverilog.test_structs import hard
from tests.export.test_packaging import run
from tests.export.vhdl.test_layer import nasty
from tests.frontend.workspace import library

CONNECTION = re.compile(r"\.(\w+)\(([^()]*)\)")


def template_of(message: Message, direction: str, bus_bytes: int = 8) -> str:
    plan = plan_of(message, bus_bytes)
    text = instance(message, plan, direction, module=direction)
    return template(direction, text, header="One line.\n")


def wrapped(text: str) -> str:
    return f"module around (input aclk, input aresetn);\n{text}endmodule\n"


def compiled(iverilog: str, folder: Path, text: str, language: str) -> tuple[int, str]:
    (folder / "around.v").write_text(text)
    command = [iverilog, f"-g{language}", "-Wall", "-t", "null", "-s", "around"]
    return run([*command, "around.v", "stubs.v"], folder)


def write_stub(message: Message, direction: str, bus_bytes: int, folder: Path) -> None:
    (folder / "stubs.v").write_text(stub(plan_of(message, bus_bytes), direction, direction))


def messages(tmp_path: Path) -> list[Message]:
    return [
        hard(tmp_path).message("p/msg/Outer"),
        nasty(),
        load_message("std_msgs/Empty", distro="noetic"),
        load_message("sensor_msgs/msg/CameraInfo"),
    ]


@pytest.mark.parametrize("bus_bytes", [1, 8])
@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.sampled(2)
def test_icarus_takes_templates_in_both_languages(iverilog, tmp_path, direction, bus_bytes):
    for message in messages(tmp_path):
        write_stub(message, direction, bus_bytes, tmp_path)
        text = wrapped(template_of(message, direction, bus_bytes))
        for language in ("2005", "2012"):
            assert compiled(iverilog, tmp_path, text, language) == (0, "")
        connected = dict(CONNECTION.findall(text))
        ports = ports_of(plan_of(message, bus_bytes), direction)
        assert [*connected] == [port.name for port in ports]
        # A name of no port, and an undeclared net.
        port = ports[-2].name
        for wrong in (text.replace(f".{port}(", ".nobody("), re.sub(r"wire .*;\n", "", text)):
            assert compiled(iverilog, tmp_path, wrong, "2005") != (0, "")


def test_fields_are_tied_off(tmp_path):
    text = "int8 x\nstring s\nuint8[8] one\nuint8[9] two\nbool[] list\nInner[2] inner\n"
    message = library(tmp_path, {"p/T": text, "p/Inner": "float64 y"}).message("p/T")
    taken = dict(CONNECTION.findall(template_of(message, "deserializer")))
    for name, value in taken.items():
        if not name.startswith(("s_axis", "m_axis", "a")):
            assert value == ("1'b1" if name.endswith("_ready") else ""), name
    offered = dict(CONNECTION.findall(template_of(message, "serializer")))
    assert offered["x_data"] == "8'd0" and offered["s_length_data"] == "32'd0"
    valid = {name: value for name, value in offered.items() if re.search("_valid$|_last$", name)}
    assert {name: value for name, value in valid.items() if "axis" not in name} == {
        "x_valid": "1'b1",
        "s_length_valid": "1'b1",
        # The sequence has no items.
        "s_items_last": "1'b0",
        "s_items_valid": "1'b0",
        "one_items_last": "1'b1",
        "one_items_valid": "1'b1",
        # The array has two transfers, so `last` is not constant.
        "two_items_last": "1'b0",
        "two_items_valid": "1'b0",
        "list_length_valid": "1'b1",
        "list_items_last": "1'b0",
        "list_items_valid": "1'b0",
        "inner_item_y_valid": "1'b1",
    }
    assert "two.items: 8 x uint8; 2 transfers" in template_of(message, "serializer")
    for ports in (taken, offered):
        assert ports["m_axis_status_tready"] == "1'b1"
    empty = template_of(load_message("std_msgs/Empty", distro="noetic"), "serializer")
    assert ".trigger_data(1'd1), .trigger_valid(1'b1), .trigger_ready()" in empty


BENCH = """\
module bench;
  reg aclk = 0, aresetn = 0;
  wire [31:0] mine = 32'h01020304;
{template}
  always #5 aclk = !aclk;
  assign m_axis_tready = 1;
  always @(posedge aclk) if (m_axis_tvalid) $display("%h %b %b %b", m_axis_tdata, m_axis_tkeep,
    m_axis_tlast, m_axis_tuser);
  initial begin
    @(negedge aclk) @(negedge aclk) aresetn = 1;
    repeat (20) @(negedge aclk);
    $finish;
  end
endmodule
"""


@pytest.mark.usefixtures("iverilog")
def test_changing_one_line_sends_one_field(tmp_path):
    (built,) = build(["std_msgs/msg/Header"], tmp_path, options=Options(extras=EVERYTHING))
    module = module_name(built.folder.name, "serializer")
    text = (built.folder / f"{module}.veo").read_text()
    before = ".stamp_sec_data(32'd0), .stamp_sec_valid(1'b1), .stamp_sec_ready()"
    assert text.count(before) == 1
    text = text.replace(before, ".stamp_sec_data(mine), .stamp_sec_valid(1'b1), .stamp_sec_ready()")
    (tmp_path / "bench.v").write_text(BENCH.format(template=text))
    files = ["bench.v", str(built.folder / f"{module}.v")]
    assert run(["iverilog", "-g2005", "-s", "bench", "-o", "bench", *files], tmp_path) == (0, "")
    status, output = run(["vvp", "-n", "bench"], tmp_path)
    beats = [line for line in output.splitlines() if re.match("[0-9a-f]{16} ", line)]
    # Encapsulation and seconds; nanoseconds and a length of 1; the NUL.
    assert status == 0 and beats[:3] == [
        "0102030400000100 11111111 0 0",
        "0000000100000000 11111111 0 0",
        "0000000000000000 00000001 1 0",
    ]
