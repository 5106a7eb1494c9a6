# amaranth: UnusedElaboratable=no
"""The record view in VHDL: messages of fixed size pass through both entities in GHDL."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.cases.stimuli import stimuli
from firm_hdl.export.backend import Output
from firm_hdl.export.record_top import RecordTop, why_no_record
from firm_hdl.export.tree import taken_names, tree_of
from firm_hdl.export.vhdl.bench import packets_text
from firm_hdl.export.vhdl.values import values_of
from firm_hdl.model import Message
from firm_hdl.plan import build_plan
from firm_hdl.vhdl.names import PREDEFINED
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.export.vhdl.test_layer import (
    WARNINGS,
    analyse,
    layer,
    own_package,
    plan_of,
    vhdl_of,
    write,
)
from tests.strategies import make
from tests.tools import run_script

ARRAYS = """\
# Keywords, names that meet, and all kinds of arrays.
uint8 RANGE_VALUE_BITS=3
bool range
bool[11] flags
Point[3] corners
Range other
int16[5] signal
Point POINT
byte data
char letter
time when
float32 speed  # [m/s]
Inside value
Inside[2] values
int64 std_logic_vector
"""
POINT = "uint16 x\nint16 y\nuint8[3] label\nEmpty nothing\n"
RANGE = "uint8 bits\nfloat64[2] units\n"
INSIDE = "Point[2] k\n"


def arrays(tmp_path: Path, distro: str) -> Message:
    folder = tmp_path / "src" / "array_msgs" / "msg"
    folder.mkdir(parents=True)
    text = ARRAYS
    if distro != "noetic":
        text = text.replace("time when", "builtin_interfaces/Time when").replace("POINT", "spot")
        text = text.replace("Point spot\n", "Point spot\nbool[2] unsigned\n")
    (folder / "Arrays.msg").write_text(text)
    (folder / "Point.msg").write_text(POINT)
    (folder / "Range.msg").write_text(RANGE)
    (folder / "Inside.msg").write_text(INSIDE)
    (folder / "Empty.msg").write_text("")
    return load_message("array_msgs/Arrays", distro=distro, paths=[tmp_path / "src"])


def hollow_arrays(tmp_path: Path, distro: str) -> Output:
    """Return the VHDL of arrays, in `make test` without the insides of the converters."""
    message = arrays(tmp_path, distro)
    packets = stimuli(message, plan_of(message, 8))
    return vhdl_of(message, 8, packets, hollow=by_depth(True, False))[0]


def with_packets(message: Message, bus_bytes: int = 8) -> tuple[Output, list[bytes]]:
    """Return a type's VHDL and its packets; tests with the same packets share the VHDL."""
    packets = stimuli(message, plan_of(message, bus_bytes))
    return vhdl_of(message, bus_bytes, packets)[0], packets


def write_folder(folder: Path, message: Message, bus_bytes: int) -> tuple[str, list[bytes]]:
    """Write the VHDL folder of a type; return its record bench and its packets."""
    vhdl, packets = with_packets(message, bus_bytes)
    assert packets
    write(folder, vhdl.files)
    [_, bench] = vhdl.manifest["bench"]["entities"]
    assert bench.endswith("_record_tb")
    return bench, packets


def check(ghdl: str, folder: Path, message: Message, bus_bytes: int) -> None:
    bench, packets = write_folder(folder, message, bus_bytes)
    for stalls in (0, 40):
        status, output = run_script(
            folder / "run_ghdl.sh", f"-gstalls={stalls}", GHDL=ghdl, BENCH=bench
        )
        assert status == 0, output
        assert output.startswith(f"PASS {message.name} record, "), output
        assert f": {len(packets)} packets, " in output
    assert (folder / "work" / "results_record.txt").read_text() == packets_text(packets)
    rows = (folder / "work" / "transfers_record.txt").read_text().splitlines()
    assert [row.split()[1] for row in rows] == ["msg"] * len(packets)


@pytest.mark.parametrize(
    ("name", "distro", "bus_bytes"),
    [
        ("geometry_msgs/msg/Twist", "lyrical", 8),
        ("std_msgs/msg/Bool", "lyrical", 1),
        *by_depth(
            [],
            [("shape_msgs/Plane", "noetic", 2), ("geometry_msgs/PoseWithCovariance", "noetic", 8)],
        ),
    ],
)
@pytest.mark.sampled(2)
def test_whole_messages_come_back(ghdl, tmp_path, name, distro, bus_bytes):
    check(ghdl, tmp_path, load_message(name, distro=distro), bus_bytes)


@pytest.mark.parametrize(
    ("distro", "bus_bytes"),
    [
        # CDR aligns what is in the record.
        ("lyrical", 8),
        *by_depth([], [("noetic", 8), ("noetic", 1), ("noetic", 16), ("lyrical", 4)]),
    ],
)
@pytest.mark.thorough
def test_arrays_and_nasty_names_come_back(ghdl, tmp_path, distro, bus_bytes):
    check(ghdl, tmp_path / "vhdl", arrays(tmp_path, distro), bus_bytes)


def test_changed_byte_fails(ghdl, tmp_path):
    bench, packets = write_folder(tmp_path, load_message("geometry_msgs/msg/Twist"), 8)
    changed = [bytearray(packet) for packet in packets]
    changed[2][17] ^= 1
    (tmp_path / "changed.txt").write_text(packets_text(list(map(bytes, changed))))
    status, output = run_script(
        tmp_path / "run_ghdl.sh", f"-gexpected={tmp_path}/changed.txt", GHDL=ghdl, BENCH=bench
    )
    assert status != 0
    assert "FAIL packet 2: byte 17 is " in output


def test_swapped_members_fail(ghdl, tmp_path):
    # Both directions could have the same fault. The user's own design below would find it.
    bench, _ = write_folder(tmp_path, load_message("geometry_msgs/msg/Twist"), 8)
    [package] = tmp_path.glob("*vector3_cdr_8_pkg.vhd")
    text = package.read_text()
    assert "    value.x := all_bits(63 downto 0);\n" in text
    text = text.replace("value.x := all_bits", "value.@ := all_bits")
    text = text.replace("value.y := all_bits", "value.x := all_bits")
    package.write_text(text.replace("value.@ := all_bits", "value.y := all_bits"))
    status, output = run_script(tmp_path / "run_ghdl.sh", GHDL=ghdl, BENCH=bench)
    assert status != 0
    assert "FAIL packet " in output


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
@pytest.mark.sampled(2)
def test_arrays_are_analysed_without_warnings(ghdl, tmp_path, distro):
    vhdl = hollow_arrays(tmp_path, distro)
    write(tmp_path / "vhdl", vhdl.files)
    analyse(ghdl, tmp_path / "vhdl", [*vhdl.manifest["files"], *vhdl.manifest["bench"]["files"]])
    assert "--warn-hide" in WARNINGS


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("uint8[] a\n", "big_msgs/msg/Big has no fixed size"),
        (
            "",
            "Message big_msgs/msg/Big has no field of fixed size for a record; its fields: none",
        ),
        (
            "uint64[1024] a\n",
            "Record of big_msgs/msg/Big is too wide: a has 65536 bits, and Amaranth elaborates at "
            "most 65535",
        ),
        (
            "uint8[8191] a\nbool[7] b\n",
            "Record of big_msgs/msg/Big is too wide: it has 65535 bits, its serializer 65540 input "
            "bits, and Amaranth elaborates at most 65535",
        ),
    ],
)
def test_types_without_a_record_state_the_reason(tmp_path, text, reason):
    folder = tmp_path / "big_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Big.msg").write_text(text)
    message = load_message("big_msgs/msg/Big", paths=[tmp_path])
    plan = build_plan(lay_out(message))
    assert why_no_record(message, plan) == reason
    with pytest.raises(ValueError) as caught:
        RecordTop(message, plan, "deserializer", "core", {})
    assert str(caught.value) == reason
    if "8191" not in text and "1024" not in text:
        vhdl, _ = vhdl_of(message, hollow=True)
        assert vhdl.manifest["record_view"] == {"built": False, "reason": reason}
        assert not [name for name in vhdl.files if "record" in name]


@pytest.mark.parametrize(("bools", "bits"), [(7, 65535), (8, None)])
def test_the_widest_record_of_values_has_65535_bits(bools, bits):
    message = make("ros2", {"a": "uint8[8191]", "b": f"bool[{bools}]"}, "Wide")
    plan = build_plan(lay_out(message))
    found = values_of(tree_of(message, plan), plan)
    assert {name: kind.bits for name, kind in found.items()} == (
        {"p/msg/Wide": bits} if bits else {}
    )


def test_no_constant_hides_what_a_package_declares():
    message = load_message("geometry_msgs/msg/Vector3")
    made = layer(message)
    declared = re.findall(r"^  (?:type|constant|function) (\w+)", own_package(made), re.MULTILINE)
    assert {"VECTOR3_ALL_READY", "to_vector3_value", "to_vector3_values"} <= set(declared)
    taken = taken_names(made.tree.package, build_plan(lay_out(message), bus_bytes=8))
    assert {name.lower() for name in declared} <= taken | PREDEFINED


USERS_OWN = """\
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.firm_hdl_types_pkg.all;
use work.geometry_msgs_msg_twist_cdr_8_pkg.all;
use work.geometry_msgs_msg_twist_cdr_8_components_pkg.all;

entity user is end entity;

architecture sim of user is
  signal aclk, aresetn, tlast, tvalid, tready, status_valid : std_logic := '0';
  signal tdata  : std_logic_vector(63 downto 0) := (others => '0');
  signal tkeep  : std_logic_vector(7 downto 0) := (others => '1');
  signal status : std_logic_vector(7 downto 0);
  signal msg    : twist_value_t;
  signal fifo   : std_logic_vector(TWIST_VALUE_BITS - 1 downto 0);
  signal msg_valid, msg_ready : std_logic := '0';
begin
  aclk <= not aclk after 5 ns when now < 1 us;

  dut : geometry_msgs_msg_twist_cdr_8_deserializer_record
    port map (
      aclk => aclk, aresetn => aresetn, s_axis_tdata => tdata, s_axis_tkeep => tkeep,
      s_axis_tlast => tlast, s_axis_tvalid => tvalid, s_axis_tready => tready, msg => msg,
      msg_valid => msg_valid, msg_ready => msg_ready, m_axis_status_tdata => status,
      m_axis_status_tvalid => status_valid, m_axis_status_tready => '1'
    );

  fifo <= to_slv(msg);

  process
    -- 1.0 in linear.x, 2.0 in angular.z, after the encapsulation header.
    type words_t is array (natural range <>) of std_logic_vector(63 downto 0);
    constant WORDS : words_t(0 to 6) := (
      x"00000000_00000100", x"00000000_3ff00000", x"00000000_00000000", x"00000000_00000000",
      x"00000000_00000000", x"00000000_00000000", x"00000000_40000000");
  begin
    wait until rising_edge(aclk);
    aresetn <= '1';
    for k in WORDS'range loop
      tdata <= WORDS(k);
      tlast <= '1' when k = WORDS'right else '0';
      tkeep <= x"0f" when k = WORDS'right else x"ff";
      tvalid <= '1';
      wait until rising_edge(aclk) and tready = '1';
    end loop;
    tvalid <= '0';
    wait until rising_edge(aclk) and msg_valid = '1';
    assert msg.linear.x = x"3ff0000000000000" report "not 1.0" severity failure;
    assert msg.linear.y = x"0000000000000000" report "not 0.0" severity failure;
    assert msg.angular.z = x"4000000000000000" report "not 2.0" severity failure;
    assert to_twist_value(fifo) = msg report "not the same" severity failure;
    msg_ready <= '1';
    wait until rising_edge(aclk);
    msg_ready <= '0';
    wait until rising_edge(aclk);
    assert msg_valid = '0' report "taken, and still there" severity failure;
    report "USER DONE";
    wait;
  end process;
end architecture;
"""


def test_users_own_design_reads_a_whole_twist(ghdl, tmp_path):
    vhdl, _ = with_packets(load_message("geometry_msgs/msg/Twist", distro="lyrical"))
    write(tmp_path, {**vhdl.files, "user.vhd": USERS_OWN})
    subprocess.run(
        [ghdl, "-a", "--std=08", *vhdl.manifest["files"], "user.vhd"], cwd=tmp_path, check=True
    )
    command = [ghdl, "--elab-run", "--std=08", "user", "--ieee-asserts=disable-at-0"]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "USER DONE" in done.stdout + done.stderr
