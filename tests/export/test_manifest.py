"""Entries of the manifest: all of them, also for definitions with equal names."""

from __future__ import annotations

import json

import pytest

from firm_hdl.export import verilog
from firm_hdl.export.backend import Converters
from firm_hdl.export.manifest import converter_sections, to_json
from firm_hdl.export.options import Options
from firm_hdl.export.top import DIRECTIONS, leaf_names, ports_of
from firm_hdl.model import PRIMITIVES, Constant, Field, Message, String
from firm_hdl.plan import build_plan
from firm_hdl.rtlil import netlist_of
from firm_hdl.timing import timing
from firm_hdl.wire import lay_out
from tests.export.conftest import EVERYTHING
from tests.frontend.workspace import library

EMPTY = "attribute \\top 1\nmodule \\top\nend\n"

TEXTS = {
    # Every level has a field `x` and a field `item`, each with its own comment.
    "p/T": "\n# of T.x\nint8 x  # [m]\n\n# of T.a\nPart a\n# of T.b\nq/Part[] b\n# of T.item\n"
    "string[] item  # [s]\nfloat32[2] list  # [kg]\nint8 plain\n",
    "p/Part": "\n# of p.x\nint16 x  # [mm]\nfloat32 item  # [A]\nInner[2] inner\n",
    "p/Inner": "\n# of Inner.x\nbool x\nint8[] length  # [V]\nint8[] items\n",
    "q/Part": "\n# of q.x\nint32 x  # [cm]\nfloat32 item\nuint8[3] inner  # [B]\n",
}


def manifest_of(message: Message, **options):
    """Return a plan, and the sections on its converters."""
    plan = build_plan(lay_out(message), **{"bus_bytes": 8, **options})
    made = Converters(
        message=message,
        plan=plan,
        name="f",
        options=Options(extras=EVERYTHING),
        circuits=dict.fromkeys(DIRECTIONS, netlist_of(EMPTY)),
    )
    sections = converter_sections(message, plan, timing(plan))
    return plan, {**sections, **verilog.write(made).manifest}


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


# Timing.
