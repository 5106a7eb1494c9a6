"""Converters and a node with registers, in Icarus Verilog with cocotbext-axi's master."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import asdict, replace
from importlib.util import find_spec
from pathlib import Path

import pytest

from firm_hdl.export.backend import Converters
from firm_hdl.export.registers import register_circuits, register_maps, write
from firm_hdl.frontend import Library
from firm_hdl.garbage import search_put_off
from firm_hdl.node import Node, read_description_text
from firm_hdl.node.register_map import register_map
from firm_hdl.node.top import NodeTop, node_ports
from firm_hdl.plan import build_plan
from firm_hdl.verilog import convert
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.tools import need

DEFINITION = """\
uint8 a
float64 b
string name
bool c
int16 d
uint8[3] e
float32[2] f
int64 g
"""

NODE = """\
node: mirror
distro: jazzy
bus_bytes: 4
registers: axi4lite
accelerator: firm_hdl.node.loop:Loop
subscribe:
  came: {type: std_msgs/msg/UInt8}
publish:
  goes: {type: std_msgs/msg/UInt8}
"""

RUN = """\
import sys
from cocotb_tools.runner import get_results, get_runner
folder, bench, *sources = sys.argv[1:]
sys.path[:0] = [bench]
runner = get_runner("icarus")
runner.build(sources=sources, hdl_toplevel="bench", build_dir=folder, timescale=("1ns", "1ps"))
results = runner.test(hdl_toplevel="bench", test_module="cocotb_registers", test_dir=folder)
tests, failed = get_results(results)
print(f"{tests} tests, {failed} failed")
"""


def bench_of(sections) -> str:
    """Write a module with all designs, and their ports behind a prefix."""
    outer, inner = [], []
    for side, section in sections.items():
        ports = section["ports"]
        for port in ports:
            way, high = f"{port['direction']}put", port["width"] - 1
            outer.append(
                f"{way} [{high}:0] {side}_{port['name']}"
                if high
                else f"{way} {side}_{port['name']}"
            )
        joined = ", ".join(f".{port['name']}({side}_{port['name']})" for port in ports)
        inner.append(f"{section['module']} {side} ({joined});")
    return f"module bench ({', '.join(outer)});\n" + "\n".join(inner) + "\nendmodule\n"


@pytest.mark.usefixtures("iverilog")
def test_registers_behave_under_random_transfers(tmp_path):
    found = find_spec("cocotb_tools") and find_spec("cocotbext") and find_spec("cocotbext.axi")
    need("cocotbext-axi", "here" if found else None)
    definition = tmp_path / "test_msgs" / "msg" / "Mixed.msg"
    definition.parent.mkdir(parents=True)
    definition.write_text(DEFINITION)
    (definition.parents[1] / "package.xml").write_text("<package><name>test_msgs</name></package>")
    message = Library("jazzy", paths=[tmp_path]).message("test_msgs/msg/Mixed")
    plan = build_plan(lay_out(message, "cdr"), bus_bytes=4)
    converters = Converters(
        message=message, plan=plan, name="mixed", registers=register_maps(message, plan)
    )
    output = write(replace(converters, register_circuits=register_circuits(converters)))
    way = {"rx": "deserializer", "tx": "serializer"}
    sections = {side: output.manifest["registers"][each] for side, each in way.items()}
    work = tmp_path / "work"
    work.mkdir()
    description = read_description_text(NODE)
    node = Node(description)
    sections["node"] = {
        "module": "mirror",
        "verilog": "mirror.v",
        "ports": [asdict(port) for port in node_ports(node)],
    }
    with search_put_off():
        output.files["mirror.v"] = convert(NodeTop(node), name="mirror")
    (work / "bench.v").write_text(bench_of(sections))
    for each in sections.values():
        (work / each["verilog"]).write_text(output.files[each["verilog"]])
    sources = [work / "bench.v", *(work / each["verilog"] for each in sections.values())]
    low, high = (
        each["fields"][0]["reset"]
        for each in sections["tx"]["registers"]
        if each["name"].startswith("fingerprint")
    )
    done = subprocess.run(
        [sys.executable, "-c", RUN, str(work), str(Path(__file__).parent), *map(str, sources)],
        cwd=work,
        env={
            **os.environ,
            # A line for each transfer takes as long as the transfer.
            "COCOTB_LOG_LEVEL": "WARNING",
            "ROUNDS": str(by_depth(100, 100_000)),
            "DEFINITION": str(definition),
            "FINGERPRINT": str(high << 32 | low),
            "NODE": json.dumps([asdict(each) for each in register_map(description).registers]),
        },
        capture_output=True,
        text=True,
        timeout=3000,
        check=False,
    )
    assert "5 tests, 0 failed" in done.stdout, done.stdout + done.stderr
