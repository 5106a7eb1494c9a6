# amaranth: UnusedElaboratable=no
"""The user's layer in VHDL: records with the message's own names, made legal where necessary."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from firm_hdl import load_message
from firm_hdl.cases.stimuli import stimuli
from firm_hdl.export.backend import Converters, Output
from firm_hdl.export.options import Options, Ports
from firm_hdl.export.top import Direction
from firm_hdl.export.vhdl.backend import to_vhdl
from firm_hdl.export.vhdl.layer import UserLayer, user_layer
from firm_hdl.export.vhdl.wrapper import Core
from firm_hdl.model import Message
from firm_hdl.plan import Plan, build_plan
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.export.conftest import EVERYTHING, hollow_converters

NASTY = """\
# Keywords, doubles, outer underscores, case.
uint8 ERROR=1
uint8 INHERIT=3
uint8 range=2
int64 LEAST=-9223372036854775808
uint64 MOST=18446744073709551615
float32 THIRD=0.333333
float64 TINY=1e-300
bool YES=True
string QUOTE=say "hö" # all of it
float32 range
float32 RANGE
uint16[3] entity
string type
int8[] a__b
int8 a_b
int8 a_
Inner[] float64_stream_t
Inner rdy
float64[] aclk
Empty nothing
uint8 uint8_stream_t
uint8 after_uint8_stream_t
bool view
# More.
bool signal
bool[] label
string[] std_logic
time time
Inner[2] msg
byte data
char valid
int64 ready
uint64[] last
uint8 unsigned
uint8 string_stream_t
string after_string_stream_t
bool inherit
"""
MORE = "# More.\n"
INNER = "uint32 process\nuint32 Process\nfloat64[2] units\n"


# All warnings of GHDL 2.0 for VHDL-2008.
WARNINGS = [
    f"--warn-{name}"
    for name in (
        "analyze-assert attribute binding body default-binding delayed-checks delta-cycle "
        "directive hide library nested-comment others parenthesis port port-bounds pragma pure "
        "reserved runtime-error shared specs static universal unused useless vital-generic"
    ).split()
]


def plan_of(message: Message, bus_bytes: int = 8) -> Plan:
    return build_plan(lay_out(message), bus_bytes=bus_bytes)


def vhdl_of(
    message: Message,
    bus_bytes: int = 8,
    packets: Iterable[bytes] = (),
    ports: Ports = "records",
    hollow: bool = False,
) -> tuple[Output, Plan]:
    """Return a type's VHDL; that of a hollow one has all but the insides of the converters."""
    with pytest.MonkeyPatch.context() as patch:
        if hollow:
            hollow_converters(patch)
        made = _vhdl(message, texts_of(message), bus_bytes, tuple(packets), ports, hollow)
    return made, plan_of(message, bus_bytes)


def texts_of(message: Message) -> tuple[object, ...]:
    """Return the texts of a message and its parts: equal messages may have other comments."""
    return (message.text, *map(texts_of, message.children))


@cache
def _vhdl(
    message: Message,
    texts: tuple[object, ...],
    bus_bytes: int,
    packets: tuple[bytes, ...],
    ports: Ports,
    hollow: bool,
) -> Output:
    """Write the VHDL once for all tests of a type: making circuits takes seconds."""
    plan = plan_of(message, bus_bytes)
    made = Converters(
        message=message,
        plan=plan,
        name=f"{message.name}_{plan.wire}_{bus_bytes}",
        options=Options(bus_bytes=bus_bytes, ports=ports, extras=EVERYTHING),
        stimuli=packets,
    )
    return to_vhdl(replace(made, circuits=_circuits(message, bus_bytes, hollow)))


@cache
def _circuits(message: Message, bus_bytes: int, hollow: bool) -> dict[Direction, str]:
    """Make the circuits, which are the same with records and with flat ports."""
    plan = plan_of(message, bus_bytes)
    name = f"{message.name}_{plan.wire}_{bus_bytes}"
    options = Options(bus_bytes=bus_bytes)
    return Converters(message=message, plan=plan, name=name, options=options).make_circuits()


def write(folder: Path, files: dict[str, str]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text)


def analyse(ghdl: str, folder: Path, files: Iterable[str]) -> None:
    """Analyse files in GHDL, which must print nothing."""
    done = subprocess.run(
        [ghdl, "-a", "--std=08", "--warn-error", *WARNINGS, *files],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


@cache
def nasty(*, is_short: bool = False) -> Message:
    """Return a message with nasty names: of all fields, or of so many that circuits are quick."""
    with TemporaryDirectory() as source:
        folder = Path(source) / "nasty_msgs" / "msg"
        folder.mkdir(parents=True)
        text = NASTY.partition(MORE)[0] if is_short else NASTY
        (folder / "Signal.msg").write_text(text)
        (folder / "Inner.msg").write_text(INNER)
        (folder / "Empty.msg").write_text("")
        return load_message("nasty_msgs/Signal", distro="noetic", paths=[source])


def layer(message: Message, bus_bytes: int = 8) -> UserLayer:
    plan = build_plan(lay_out(message), bus_bytes=bus_bytes)
    cores: dict[Direction, Core] = {
        "deserializer": Core(entity="rx_flat", names={}),
        "serializer": Core(entity="tx_flat", names={}),
    }
    return user_layer(message, plan, name="t", cores=cores)


def own_package(made: UserLayer) -> str:
    return made.packages[f"{made.package}.vhd"]


def test_package_reads_like_the_definition():
    made = layer(load_message("sensor_msgs/msg/Range", distro="lyrical"))
    text = own_package(made)
    assert "  type range_t is record\n" in text
    time = "work.builtin_interfaces_msg_time_cdr_8_pkg.time_ready_t"
    header = made.packages["std_msgs_msg_header_cdr_8_pkg.vhd"]
    assert f"  type header_ready_t is record\n    stamp    : {time};\n" in header
    assert "    range_field    : float32_stream_t;  -- range: float32" in text
    assert '  constant INFRARED   : unsigned(7 downto 0) := x"01";  -- uint8 1\n' in text


def test_idle_offers_nothing_and_all_ready_takes_everything():
    made = layer(load_message("sensor_msgs/msg/JointState", distro="lyrical"))
    constant = re.compile(r"constant \w+_(IDLE|ALL_READY) +: \w+ := \((.*?)\);", re.DOTALL)
    found = [each for text in made.packages.values() for each in constant.findall(text)]
    assert {kind for kind, values in found} == {"IDLE", "ALL_READY"} and len(found) > 20
    for kind, values in found:
        assert ("'1'" if kind == "IDLE" else "'0'") not in values


def test_types_are_shared_and_no_two_names_meet():
    made = layer(nasty())
    text = "".join(made.packages.values())
    assert text.count("  type inner_t is record\n") == 1
    nodes = list(made.tree.root.walk())
    for node in nodes:
        names = [child.name.lower() for child in node.children]
        assert len(set(names)) == len(names)
    paths = [node.access.lower() for node in made.tree.root.leaves()]
    assert len(set(paths)) == len(paths)
    for text in made.packages.values():
        types = [row.split()[1].lower() for row in text.splitlines() if row.startswith("  type ")]
        assert len(set(types)) == len(types)


# On a bus of one byte, test_wide.py analyses strings.
@pytest.mark.parametrize("bus_bytes", by_depth([8], [1, 8]))
def test_nasty_names_are_analysed_without_warnings(ghdl, tmp_path, bus_bytes):
    # All names are in packages, in ports and in benches.
    packets = stimuli(nasty(), plan_of(nasty(), bus_bytes))
    made, _ = vhdl_of(nasty(), bus_bytes, packets, hollow=by_depth(True, False))
    write(tmp_path / "vhdl", made.files)
    analyse(ghdl, tmp_path / "vhdl", [*made.manifest["files"], *made.manifest["bench"]["files"]])


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
  signal msg    : twist_t;
  signal rdy    : twist_ready_t;
begin
  aclk <= not aclk after 5 ns when now < 1 us;

  dut : geometry_msgs_msg_twist_cdr_8_deserializer
    port map (
      aclk => aclk, aresetn => aresetn, s_axis_tdata => tdata, s_axis_tkeep => tkeep,
      s_axis_tlast => tlast, s_axis_tvalid => tvalid, s_axis_tready => tready, msg => msg,
      rdy => rdy, m_axis_status_tdata => status, m_axis_status_tvalid => status_valid,
      m_axis_status_tready => '1'
    );

  -- All at once, but for linear.x.
  rdy.linear.y <= '1';
  rdy.linear.z <= '1';
  rdy.angular <= (others => '1');

  process
    -- 1.0 and five zeros, after the encapsulation header.
    type words_t is array (natural range <>) of std_logic_vector(63 downto 0);
    constant WORDS : words_t(0 to 6) := (
      x"00000000_00000100", x"00000000_3ff00000", others => (others => '0'));
  begin
    rdy.linear.x <= '0';
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
    wait until rising_edge(aclk) and msg.linear.x.valid = '1';
    assert msg.linear.x.data = x"3ff0000000000000" report "not 1.0" severity failure;
    rdy.linear.x <= '1';
    wait until rising_edge(aclk) and status_valid = '1';
    assert status = STATUS_OK report status_name(status) severity failure;
    report "USER DONE";
    wait;
  end process;
end architecture;
"""


def test_users_own_design_reads_a_twist(ghdl, tmp_path):
    message = load_message("geometry_msgs/msg/Twist", distro="lyrical")
    made, _ = vhdl_of(message, packets=stimuli(message, plan_of(message)))
    write(tmp_path, {**made.files, "user.vhd": USERS_OWN})
    analyse(ghdl, tmp_path, [*made.manifest["files"], "user.vhd"])
    command = [ghdl, "--elab-run", "--std=08", "user", "--ieee-asserts=disable-at-0"]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "USER DONE" in done.stdout + done.stderr
