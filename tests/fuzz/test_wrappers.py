"""The wrappers of circuits: every port of a converter is connected, at the place of the harness."""

from __future__ import annotations

import gc
import re

import pytest

from firm_hdl.fuzz.circuits import circuits_of
from firm_hdl.fuzz.table import table_of
from tests.strategies import make

FIELDS = {"a": "uint16", "s": "string", "f": "bool"}
LEAVES = ("a", "s_length", "s_items", "f")


@pytest.fixture
def made(monkeypatch):
    """A function that makes circuits for a bus, without their Verilog."""
    modules = []

    def convert(design, *, name):
        modules.append(name)
        return f"module {name}\n"

    monkeypatch.setattr("firm_hdl.fuzz.circuits.convert", convert)
    message = make("ros1", FIELDS)

    def of(bus_bytes, *names):
        most = {"max_message_bytes": 300}
        table = table_of(message, wire="ros1", bus_bytes=bus_bytes, **most)
        return circuits_of(message, table, names=names, **most), modules

    yield of
    # What nothing elaborated warns when it is collected.
    gc.collect()


def read(text):
    """Return what is declared, the connections of each instance, and what is assigned."""
    declared = {
        name: (int(high) + 1 if high else 1)
        for high, name in re.findall(r"(?:input|output|wire) (?:\[(\d+):0\] )?(\w+)", text)
    }
    instances = {
        (module, name): dict(re.findall(r"^ +\.(\w+)\((.*)\),?$", ports, re.M))
        for module, name, ports in re.findall(r"^  (\w+) (\w+)\(\n(.*?)\n  \);", text, re.M | re.S)
    }
    return declared, instances, dict(re.findall(r"assign (\S+) = (.*);", text))


def given(bus_bytes):
    """Return the connections of an input of packets."""
    return {
        "aclk": "clk",
        "aresetn": "control[2]",
        "s_axis_tvalid": "control[0]",
        "s_axis_tlast": "control[1]",
        "s_axis_tdata": f"data[{8 * bus_bytes - 1}:0]",
        "s_axis_tkeep": f"keep[{bus_bytes - 1}:0]",
        "s_axis_tready": "accept[0]",
    }


def status(wire, number):
    return {
        "m_axis_status_tvalid": f"valid[{number}]",
        "m_axis_status_tready": f"ready[{number}]",
        "m_axis_status_tdata": wire,
    }


# Items of 8 bits; bits of the inputs, in whole words.
@pytest.mark.parametrize(("bus_bytes", "data", "keep"), [(2, 32, 32), (8, 64, 32), (64, 512, 64)])
def test_each_leaf_of_a_deserializer_is_an_output(made, bus_bytes, data, keep):
    (circuit,), modules = made(bus_bytes, "deserializer")
    assert modules == ["deserializer"]
    assert set(circuit.files) == {"deserializer.v", "fuzz_deserializer.v"}
    declared, instances, assigned = read(circuit.files["fuzz_deserializer.v"])
    connected = given(bus_bytes) | status("status_code", 4)
    for number, leaf in enumerate(LEAVES):
        connected[f"{leaf}_valid"] = f"valid[{number}]"
        connected[f"{leaf}_ready"] = f"ready[{number}]"
        connected[f"{leaf}_data"] = f"leaf_{number}_data"
    connected["s_items_last"] = "leaf_2_last"
    assert instances == {("deserializer", "dut"): connected}
    items = 8 * bus_bytes
    ports = {"control": 32, "data": data, "keep": keep, "ready": 32, "valid": 32}
    assert {name: declared[name] for name in ports} == ports
    widths = {"leaf_0_data": 16, "leaf_1_data": 32, "leaf_2_data": items, "leaf_3_data": 1}
    assert {name: declared[name] for name in widths} == widths
    # A word of flags, and whole words of data.
    words = [1, 1, -(-items // 32), 1, 1]
    flags = ["32'd0", "32'd0", "leaf_2_last", "32'd0", "32'd0"]
    values = [*(f"leaf_{number}_data" for number in range(4)), "status_code"]
    for number, (count, flag, value) in enumerate(zip(words, flags, values, strict=True)):
        assert declared[f"out_{number}"] == 32 * (1 + count) == 32 * circuit.outputs[number].words
        assert assigned.pop(f"out_{number}[31:0]") == flag
        assert assigned.pop(f"out_{number}[{32 * count + 31}:32]") == value
    assert assigned == {"accept[31:1]": "0", "valid[31:5]": "0"}
    names = ["a", "s.length", "s.items", "f", "status"]
    assert [each.name for each in circuit.outputs] == names
    assert (circuit.name, circuit.kind, circuit.counters) == ("deserializer", "Deserializer", 0)


@pytest.mark.parametrize("bus_bytes", [2, 8])
def test_the_leaves_of_a_loop_go_into_a_serializer(made, bus_bytes):
    (circuit, again), modules = made(bus_bytes, "loop", "deserializer")
    # Each converter is exported once for all circuits.
    assert modules == ["deserializer", "serializer"]
    assert again.files["deserializer.v"] == circuit.files["deserializer.v"]
    declared, instances, assigned = read(circuit.files["fuzz_loop.v"])
    assert list(instances) == [("deserializer", "reader"), ("serializer", "writer")]
    reader, writer = instances.values()
    ends = {"valid": 1, "ready": 1}
    widths = {"a": 16, "s_length": 32, "s_items": 8 * bus_bytes, "f": 1}
    shared = {f"{leaf}_{end}": width for leaf in LEAVES for end, width in ends.items()}
    shared |= {f"{leaf}_data": width for leaf, width in widths.items()} | {"s_items_last": 1}
    inner = {port: reader.pop(port) for port in shared}
    assert inner == {port: writer.pop(port) for port in shared}
    assert len(set(inner.values())) == len(inner)
    assert {port: declared[wire] for port, wire in inner.items()} == shared
    assert reader == given(bus_bytes) | status("status_code", 1)
    assert writer == status("written_code", 2) | {
        "aclk": "clk",
        "aresetn": "control[2]",
        "m_axis_tvalid": "valid[0]",
        "m_axis_tready": "ready[0]",
        "m_axis_tdata": "out_data",
        "m_axis_tkeep": "out_keep",
        "m_axis_tlast": "out_flags[0]",
        "m_axis_tuser": "out_flags[1]",
    }
    words = -(-8 * bus_bytes // 32)
    assert assigned == {
        "accept[31:1]": "0",
        "valid[31:3]": "0",
        "out_0[31:0]": "out_flags",
        f"out_0[{32 * words + 31}:32]": "out_data",
        f"out_0[{32 * words + 63}:{32 * words + 32}]": "out_keep",
        "out_1[31:0]": "32'd0",
        "out_1[63:32]": "status_code",
        "out_2[31:0]": "32'd0",
        "out_2[63:32]": "written_code",
    }
    assert (declared["out_data"], declared["out_keep"]) == (8 * bus_bytes, bus_bytes)
    names = ["packets_out", "deserializer's status", "serializer's status"]
    assert [each.name for each in circuit.outputs] == names
    assert (circuit.name, circuit.kind, circuit.drops) == ("loop", "Loop", False)
