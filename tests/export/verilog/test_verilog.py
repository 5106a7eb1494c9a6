"""The Verilog text is complete."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import firm_hdl
from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.export.top import DIRECTIONS, Top, ports_of
from firm_hdl.plan import build_plan
from firm_hdl.verilog import convert
from firm_hdl.wire import lay_out
from tests.depth import by_depth

PORT = r"^  (in|out)put wire +(?:\[(\d+):0\])? *(\w+),?(?:  //.*)?$"


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
@pytest.mark.sampled(4)
def test_every_port_is_there_with_its_width(type_, distro, direction):
    text = verilog_of(type_, direction, distro=distro)
    module = text[text.index(f"module {direction} (") :]
    declared = {
        name: (way, int(high or 0) + 1) for way, high, name in re.findall(PORT, module, re.M)
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
    assert text.startswith("// One line.\n//\n// Another.\n\n// Buffer: ")
    assert "src =" not in text
    assert str(Path(firm_hdl.__file__).parent) not in text
    assert "[-1:0]" not in text
