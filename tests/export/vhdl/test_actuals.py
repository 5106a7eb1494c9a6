"""What each kind of port of a core is connected to, and the streams that a bus has for it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl.export.primitives import PRIMITIVE_BYTES
from firm_hdl.export.records import shared_records
from firm_hdl.export.systemverilog.types import bus_package as sv_bus_package
from firm_hdl.export.systemverilog.wrapper import wrapper as sv_wrapper
from firm_hdl.export.top import Direction
from firm_hdl.export.tree import tree_of
from firm_hdl.export.vhdl.bus import bus_package
from firm_hdl.export.vhdl.values import values_of
from firm_hdl.export.vhdl.wrapper import Core, record_wrapper, stream_wrapper
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.frontend.workspace import library

KINDS = {
    "p/T": "bool b\nfloat32 f\nint16 i\nuint8 u\nbool[2] bits\nint8[2] bytes\nfloat64[] many\n"
}


def wrapped(folder: Path, direction: Direction, bus_bytes: int) -> tuple[dict[str, str], set[str]]:
    """Return the actual of each port of the core, and the assignments beside it."""
    message = library(folder, KINDS).message("p/T")
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    core = Core(entity="inner", names={"aclk": "aclk_port"})
    text = stream_wrapper(plan, tree_of(message, plan), direction, entity="outer", core=core)
    body = text.partition("\nbegin\n")[2]
    assert "core : entity work.inner\n" in body
    return (
        dict(re.findall(r"^ +(\w+) +=> ([^,\n]+)", body, re.MULTILINE)),
        set(re.findall(r"^  (\S+ <= \S+);$", body, re.MULTILINE)),
    )


@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_values_are_converted_by_their_type_and_direction(tmp_path: Path, bus_bytes: int) -> None:
    read, from_core = wrapped(tmp_path / "r", "deserializer", bus_bytes)
    written, to_core = wrapped(tmp_path / "w", "serializer", bus_bytes)
    one = bus_bytes == 1
    for actuals in (read, written):
        assert actuals["aclk_port"] == "aclk" and "aclk" not in actuals
        # Bits and floats have the type of the core's port. A vector of one bit has not.
        assert actuals["b_data"] == "msg.b.data" and actuals["f_data"] == "msg.f.data"
        assert actuals["bits_items_data"] == (
            "msg.bits.items.data(0)" if one else "bits_items_data"
        )
        assert actuals["bits_items_last"] == "msg.bits.items.last"
        assert actuals["bits_items_valid"] == "msg.bits.items.valid"
        assert actuals["many_length_ready"] == "rdy.many.length"
        for name in ("i", "u", "bytes_items", "many_length", "many_items"):
            assert actuals[f"{name}_data"] == f"{name}_data"
    assert read["s_axis_tkeep"] == ("s_axis_tkeep(0)" if one else "s_axis_tkeep")
    assert written["m_axis_tkeep"] == ("m_axis_tkeep(0)" if one else "m_axis_tkeep")
    bits = set() if one else {"msg.bits.items.data <= to_bool_items(bits_items_data)"}
    assert from_core == bits | {
        "msg.i.data <= signed(i_data)",
        "msg.u.data <= unsigned(u_data)",
        "msg.bytes.items.data <= to_int8_items(bytes_items_data)",
        "msg.many.length.data <= unsigned(many_length_data)",
        "msg.many.items.data <= to_float64_items(many_items_data)",
    }
    bits = set() if one else {"bits_items_data <= to_slv(msg.bits.items.data)"}
    assert to_core == bits | {
        "i_data <= std_logic_vector(msg.i.data)",
        "u_data <= std_logic_vector(msg.u.data)",
        "bytes_items_data <= to_slv(msg.bytes.items.data)",
        "many_length_data <= std_logic_vector(msg.many.length.data)",
        "many_items_data <= to_slv(msg.many.items.data)",
    }


def test_structs_need_no_conversion(tmp_path: Path) -> None:
    message = library(tmp_path, KINDS).message("p/T")
    plan = build_plan(lay_out(message), bus_bytes=4)
    tree = tree_of(message, plan)
    for direction, beats in (("deserializer", "s_axis"), ("serializer", "m_axis")):
        text = sv_wrapper(plan, tree, direction, name="outer", core="inner")
        actuals = dict(re.findall(r"\.(\w+) +\(([^)]+)\)", text))
        assert actuals["aclk"] == "aclk" and actuals["i_data"] == "msg.i.data"
        assert actuals["bits_items_last"] == "msg.bits.items.last"
        assert actuals["many_length_ready"] == "rdy.many.length"
        assert actuals[f"{beats}_tkeep"] == f"{beats}.tkeep"
        assert actuals[f"{beats}_tready"] == f"{beats}_tready"
        assert actuals["m_axis_status_tdata"] == "status"
        assert actuals["m_axis_status_tvalid"] == "m_axis_status.tvalid"


@pytest.mark.parametrize(("text", "actual"), [("bool b", "msg_data(0)"), ("int8 b", "msg_data")])
def test_a_record_of_one_bit_is_a_vector_outside_of_the_core(
    tmp_path: Path, text: str, actual: str
) -> None:
    message = library(tmp_path, {"p/T": text}).message("p/T")
    plan = build_plan(lay_out(message), bus_bytes=4)
    values = values_of(tree_of(message, plan), plan)[message.name]
    core = Core(entity="inner", names={})
    read, written = (
        record_wrapper(plan, values, way, entity="outer", core=core)
        for way in ("deserializer", "serializer")
    )
    for wrapper in (read, written):
        assert re.search(rf" msg_data +=> {re.escape(actual)},\n", wrapper)
    assert "  msg <= to_t_value(msg_data);\n" in read
    assert "  msg_data <= to_slv(msg);\n" in written


@pytest.mark.parametrize(("name", "is_long"), [("T", False), (f"{'Long' * 9}Name", True)])
def test_the_meaning_of_a_port_moves_above_it_where_the_line_is_too_long(
    tmp_path: Path, name: str, is_long: bool
) -> None:
    message = library(tmp_path, {f"p/{name}": "int8 x\n"}).message(f"p/{name}")
    plan = build_plan(lay_out(message), bus_bytes=4)
    core = Core(entity="inner", names={})
    text = stream_wrapper(plan, tree_of(message, plan), "serializer", entity="outer", core=core)
    ports = text.partition("  port (\n")[2].partition("\n  );\n")[0].splitlines()
    assert max(map(len, ports)) <= 100
    at = next(n for n, line in enumerate(ports) if line.startswith("    msg "))
    meaning = f"-- Data and valid of p/msg/{name}."
    if is_long:
        assert ports[at - 1] == f"    {meaning}" and "--" not in ports[at]
    else:
        assert ports[at].endswith(f"  {meaning}")


LANES = {
    1: dict.fromkeys(PRIMITIVE_BYTES, 1),
    4: {name: max(1, 4 // size) for name, size in PRIMITIVE_BYTES.items()},
    64: {name: 64 // size for name, size in PRIMITIVE_BYTES.items()},
}


@pytest.mark.parametrize("bus_bytes", LANES)
def test_a_beat_has_as_many_items_as_fit_and_at_least_one(bus_bytes: int) -> None:
    vhdl, verilog = bus_package(bus_bytes), sv_bus_package(bus_bytes)
    for text, pattern in (
        (vhdl, r"data  : (\w+)_items_t\(0 to (\d+)\);"),
        (verilog, r"(\w+)_data_t \[(\d+):0\] data;"),
    ):
        found = {name: int(most) + 1 for name, most in re.findall(pattern, text)}
        assert found == LANES[bus_bytes]
    assert LANES[4]["float64"] == 1 and LANES[64]["uint16"] == 32
    assert f"logic [{8 * bus_bytes - 1}:0] tdata;" in verilog
    assert re.search(rf"logic \[{bus_bytes - 1}:0\] +tkeep;", verilog)
    # An item of several bits needs two levels of zeros.
    for name, zeros in (("BOOL", "(others => '0')"), ("INT8", "(others => (others => '0'))")):
        start = vhdl.partition(f"constant {name}_ITEMS_STREAM_IDLE")[2].splitlines()[1]
        assert start.strip().startswith(f"data => {zeros}, ")


def test_sequences_have_a_length_and_arrays_have_none() -> None:
    found = {each.stem: [(m.name, m.stem) for m in each.members] for each in shared_records()}
    length = ("length", "uint32_stream")
    assert found["string_stream"] == [length, ("items", "uint8_items_stream")]
    assert found["wstring_stream"] == [length, ("items", "uint32_items_stream")]
    assert found["int16_sequence_stream"] == [length, ("items", "int16_items_stream")]
    assert found["int16_array_stream"] == [("items", "int16_items_stream")]
    assert found["wstring_sequence_stream"] == [length, ("item", "wstring_stream")]
    assert found["string_array_stream"] == [("item", "string_stream")]
    # Two texts; a sequence and an array of each primitive and of each text.
    assert len(found) == 2 + 2 * (len(PRIMITIVE_BYTES) + 2)


def test_idle_structs_offer_nothing_and_ready_ones_take_all() -> None:
    text = sv_bus_package(4)
    for name in ("STRING_STREAM", "UINT8_SEQUENCE_STREAM", "WSTRING_ARRAY_STREAM"):
        assert f"localparam {name.lower()}_t {name}_IDLE = '0;" in text
        assert f"localparam {name.lower()}_ready_t {name}_ALL_READY = '1;" in text


def test_only_messages_of_fixed_size_have_a_record_of_values(tmp_path: Path) -> None:
    texts = {
        "p/T": "Fixed a\nFixed[2] b\nText c\n",
        "p/Fixed": "bool x\nint8[3] y",
        "p/Text": "string x",
    }
    message = library(tmp_path, texts).message("p/T")
    plan = build_plan(lay_out(message), bus_bytes=4)
    found = values_of(tree_of(message, plan), plan)
    assert {name: each.bits for name, each in found.items()} == {"p/msg/Fixed": 25}
