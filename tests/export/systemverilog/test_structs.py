"""The user's layer in SystemVerilog: structs with the message's own names, and no lint warnings."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.export.systemverilog.package import constants_of
from firm_hdl.export.systemverilog.types import WORDS
from firm_hdl.export.tree import tree_of
from firm_hdl.frontend import Library
from firm_hdl.names import identifiers as names
from firm_hdl.names.keywords import KEYWORDS
from tests.export.systemverilog.hdl import Design, plan_of, slang
from tests.export.test_every_keyword import SPOT, write_packages
from tests.export.vhdl.test_layer import nasty
from tests.frontend.workspace import library

COVERING = Path(__file__).parents[2] / "verify" / "covering"
HARD = {
    "p/msg/Outer.msg": "Middle[] rows\nMiddle[3] fixed\nstring<=5 name\nwstring<=7[<=3] wide\n"
    "bool[70] flags\nInner[<=4] few\nstd_msgs/Header header\nEmpty nothing\nPacketStatus x\n",
    "p/msg/Middle.msg": "Inner[] inner\nfloat64[] list\nwstring text\n",
    "p/msg/Inner.msg": "byte b\nchar c\nint8[3] three\nstring[2] two\n",
    "p/msg/Empty.msg": "",
    # Names that the packages of all messages declare.
    "p/msg/PacketStatus.msg": "uint8 BYTE=1\nint8 STATUS_OK=1\nint8 PACKET_BEAT_IDLE=2\nint8 x\n",
    "p/srv/Ask.srv": "Inner[] always_comb\n---\nint8 logic\n",
    "p/action/Go.action": "Inner go\n---\nstring priority\n---\nuint64 final\n",
}


def covering(distro: str) -> list[str]:
    lines = (COVERING / f"{distro}.txt").read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def hard(tmp_path: Path) -> Library:
    for name, text in HARD.items():
        path = tmp_path / "src" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    (tmp_path / "src" / "p" / "package.xml").write_text(
        "<package format='3'><name>p</name><version>1.0.0</version></package>"
    )
    return Library("lyrical", [tmp_path / "src"])


@pytest.fixture
def design(tmp_path) -> Design:
    (tmp_path / "sv").mkdir()
    return Design(tmp_path / "sv")


def sources(design: Design) -> list[str]:
    """Return all files except the module that only Verilator needs."""
    return [name for name in design.write() if name != "all.sv"]


def clean(design: Design, verilator: str) -> None:
    assert design.lint(verilator) == ""
    assert slang(sources(design), design.folder) == ""


@pytest.mark.parametrize("bus_bytes", [1, 8, 64])
@pytest.mark.sampled(3)
def test_linters_find_nothing_in_hard_types(design, verilator, tmp_path, bus_bytes):
    given = hard(tmp_path)
    messages = [
        each
        for name in ("p/msg/Outer", "p/srv/Ask", "p/action/Go")
        for each in given.interface(name).messages
    ]
    for message in (*messages, nasty(), load_message("std_msgs/msg/Empty")):
        design.add(message, bus_bytes)
    design.add(load_message("std_msgs/Empty", distro="noetic"), bus_bytes)
    clean(design, verilator)


@pytest.mark.thorough
def test_linters_find_nothing_in_the_covering_types(design, verilator):
    for distro in ("lyrical", "noetic"):
        given = Library(distro)
        for name in covering(distro):
            for message in given.interface(name).messages:
                design.add(message)
    assert len(design.instances) > 100
    clean(design, verilator)


def test_wrong_member_is_seen_by_both_linters(design, verilator):
    design.add(load_message("geometry_msgs/msg/Twist"))
    clean(design, verilator)
    name = "geometry_msgs_msg_Twist_cdr_8_deserializer_sv.sv"
    design.texts[name] = design.texts[name].replace("msg.linear.y.data", "msg.linear.x.data")
    assert "linear" in design.lint(verilator)
    assert "linear" in slang(sources(design), design.folder)


# Names.


@pytest.mark.thorough
def test_fields_take_every_word(design, verilator, tmp_path):
    folder = write_packages(tmp_path / "ws", sorted(KEYWORDS))
    design.add(Library("noetic", [folder]).message("all_words/Fields"))
    clean(design, verilator)


@pytest.mark.thorough
def test_messages_and_packages_take_every_word(design, tmp_path):
    folder = write_packages(tmp_path / "ws", sorted(KEYWORDS))
    design.add(Library("noetic", [folder]).message("all_words/Types"))
    assert len(design.texts) > 600
    assert slang(sources(design), design.folder) == ""


def test_keyword_as_a_name_is_refused(design, verilator, tmp_path, monkeypatch):
    folder = write_packages(tmp_path / "ws", ["priority"])
    monkeypatch.setattr(names, "KEYWORDS", frozenset())
    design.add(Library("noetic", [folder]).message("all_words/Fields"))
    assert "priority" in design.lint(verilator)
    assert "expected" in slang(sources(design), design.folder)


def test_manifest_maps_fields_and_constants_to_their_names(design, tmp_path):
    folder = write_packages(tmp_path / "ws", SPOT)
    section = design.add(Library("noetic", [folder]).message("all_words/Fields"))
    text = design.texts[f"{section['package']}.sv"]
    assert section["leaves"]["final"] == "final_field"
    for path, access in section["leaves"].items():
        assert re.search(rf"uint8_stream_t +{access};  // {path}\b|{access};  // uint8", text), path
    section = design.add(load_message("sensor_msgs/msg/NavSatStatus"))
    entries = {each["constant"]: each for each in section["constants"]}
    assert entries["STATUS_NO_FIX"]["name"] == "STATUS_NO_FIX"
    assert section["modules"]["serializer"] == "sensor_msgs_msg_NavSatStatus_cdr_8_serializer_sv"


def test_names_of_all_packages_are_hidden_by_no_message(tmp_path):
    message = hard(tmp_path).message("p/msg/PacketStatus")
    plan = plan_of(message)
    (package,) = tree_of(message, plan, WORDS).packages
    assert package.base == "packet_status_2"
    assert tree_of(message, plan).packages[0].base == "packet_status"
    names = {each.constant.name: each.name for each in constants_of(package, plan)}
    assert names == {
        "BYTE": "BYTE_field",
        "STATUS_OK": "STATUS_OK_CONSTANT",
        "PACKET_BEAT_IDLE": "PACKET_BEAT_IDLE_CONSTANT",
    }


# A user's design.

DESIGN = """\
module users (input logic aclk, aresetn, mine);
  import {scan}_pkg::*;
  import {cloud}_pkg::*;
  firm_hdl_bus_8_sv_pkg::packet_beat_t beats, out, none;
  firm_hdl_sv_pkg::packet_status_stream_t rx_status, tx_status;
  logic beats_ready;

  laser_scan_t scan;
  laser_scan_ready_t scan_rdy;
  point_cloud2_t cloud;
  point_cloud2_ready_t cloud_rdy;

  // One line per field.
  always_comb begin
    scan_rdy = LASER_SCAN_ALL_READY;
    scan_rdy.angle_min = mine;
    scan_rdy.header = cloud_rdy.header;
  end
  always_comb begin
    cloud = POINT_CLOUD2_IDLE;
    cloud.header = scan.header;
    cloud.height = '{{data: 32'd1, valid: 1'b1}};
  end
  assign none = firm_hdl_bus_8_sv_pkg::PACKET_BEAT_IDLE;

  {scan_rx} rx (.aclk, .aresetn, .s_axis(none), .s_axis_tready(beats_ready), .msg(scan),
    .rdy(scan_rdy), .m_axis_status(rx_status), .m_axis_status_tready(1'b1));
  {cloud_tx} tx (.aclk, .aresetn, .m_axis(out), .m_axis_tready(1'b1), .msg(cloud),
    .rdy(cloud_rdy), .m_axis_status(tx_status), .m_axis_status_tready(1'b1));
  assign beats = rx_status.tdata == firm_hdl_sv_pkg::STATUS_OK ? out : none;
endmodule
"""


def test_header_of_one_type_goes_to_another_and_a_field_is_a_line(design, verilator):
    scan = design.add(load_message("sensor_msgs/msg/LaserScan"))
    cloud = design.add(load_message("sensor_msgs/msg/PointCloud2"))
    design.texts["users.sv"] = text = DESIGN.format(
        scan=scan["package"].removesuffix("_pkg"),
        cloud=cloud["package"].removesuffix("_pkg"),
        scan_rx=scan["modules"]["deserializer"],
        cloud_tx=cloud["modules"]["serializer"],
    )
    design.instances.append("  users users ();\n")
    assert slang(sources(design), design.folder) == ""
    # Verilator warns of signals that this design does not use.
    assert not re.search("%Error(?!: Exiting due to .* warning)", design.lint(verilator))
    design.texts["users.sv"] = text.replace("= scan.header;", "= scan.ranges;")
    output = slang(sources(design), design.folder)
    assert "conversion from 'float32_sequence_stream_t' to 'header_t'" in output


# Constants.

# `D` contains comments, pragmas and macros of other languages.
CONSTANTS = """\
int8 A=-3  # [m]
uint64 E=18446744073709551615
int64 F=-9223372036854775808
bool C=true
float32 B=0.1
float64 G=1e300
string D='hö "x" // -- `y` \\'
"""
LONG = "a" * 199 + "z"

CHECK = """\
module check;
  import p_msg_t_cdr_8_sv_pkg::*;
  if (A !== -8'sd3 || A >= 0) $error("A");
  if (E !== 64'd18446744073709551615 || F !== 64'sh8000000000000000 || F >= 0) $error("E or F");
  if (C !== 1'b1 || B_BITS !== 32'h3dcccccd || G != 1.0e300) $error("B, C or G");
  if (G_BITS !== 64'h7e37e43c8800759c) $error("G_BITS");
  if (D !== {bits}'h{image}) $error("D");
  if ($bits(L) != 1600 || L[7:0] !== "z" || L[1599:1592] !== "a") $error("L");
endmodule
"""


def test_constants_have_their_values(design, verilator, tmp_path):
    texts = {"p/T": f"{CONSTANTS}string L={LONG}\nint8 x"}
    message = library(tmp_path, texts).message("p/T")
    section = design.add(message)
    text = design.texts[f"{section['package']}.sv"]
    assert "localparam logic signed [7:0] A = 8'shfd;  // int8 -3 [m]" in text
    (value,) = [each.value for each in message.constants if each.name == "D"]
    data = value if isinstance(value, bytes) else value.encode()
    check = CHECK.format(bits=8 * len(data), image=data.hex())
    design.instances.append("  check check ();\n")
    for wrong in (None, "-8'sd3", "3dcccccd", "1600", data.hex()):
        design.texts["check.sv"] = check.replace(wrong, "7") if wrong else check
        for output in (slang(sources(design), design.folder), design.lint(verilator)):
            assert ("rror" in output) is bool(wrong), (wrong, output)
