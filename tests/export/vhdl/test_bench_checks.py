"""Each check of the generated benches reports its fault."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from firm_hdl.export.vhdl.bench import PARTS, packets_text
from tests.export.vhdl.test_bench import write_folder
from tests.tools import run_script

# The bench plays beats, one per line (data, keep, last, user in binary), and records the source.
PLAYER = """\
library ieee;
use ieee.std_logic_1164.all;
use std.textio.all;

entity player is
  generic (beats : string; expected : string);
end entity;

architecture sim of player is
  signal aclk, aresetn : std_logic := '0';
  signal over : boolean := false;
  signal i_data, o_data : std_logic_vector(31 downto 0);
  signal i_keep, o_keep : std_logic_vector(3 downto 0);
  signal i_last, i_user, i_valid, i_ready, o_last, o_valid : std_logic := '0';
begin
  aclk <= not aclk after 5 ns when not over;
  aresetn <= '1' after 30 ns;

  sink : entity work.firm_hdl_axis_sink
    generic map (
      bus_bytes => 4, expected => expected, results => "results.txt", seed => 1, stalls => 40
    )
    port map (
      aclk => aclk, aresetn => aresetn, tdata => i_data, tkeep => i_keep, tlast => i_last,
      tuser => i_user, tvalid => i_valid, tready => i_ready
    );

  source : entity work.firm_hdl_axis_source
    generic map (bus_bytes => 4, stimuli => expected, seed => 1, stalls => 40)
    port map (
      aclk => aclk, aresetn => aresetn, tdata => o_data, tkeep => o_keep, tlast => o_last,
      tvalid => o_valid, tready => '1'
    );

  process (aclk)
    file sent : text open write_mode is "sent.txt";
    variable row : line;
  begin
    if rising_edge(aclk) and o_valid = '1' then
      write(row, to_string(o_data) & ' ' & to_string(o_keep) & ' ' & to_string(o_last));
      writeline(sent, row);
    end if;
  end process;

  process
    file played : text;
    variable row : line;
    variable data : std_ulogic_vector(31 downto 0);
    variable keep : std_ulogic_vector(3 downto 0);
    variable last, user : std_ulogic;
  begin
    file_open(played, beats, read_mode);
    wait until aresetn = '1';
    while not endfile(played) loop
      readline(played, row);
      read(row, data);
      read(row, keep);
      read(row, last);
      read(row, user);
      (i_data, i_keep, i_last, i_user) <= std_logic_vector'(data & keep & last & user);
      i_valid <= '1';
      wait until rising_edge(aclk) and i_ready = '1';
      i_valid <= '0';
    end loop;
    wait for 2 us;
    over <= true;
    wait;
  end process;
end architecture;
"""


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    folder = tmp_path_factory.mktemp("parts")
    for name, text in {**PARTS, "player.vhd": PLAYER}.items():
        (folder / name).write_text(text)
    return folder


def play(ghdl: str, folder: Path, beats: list[str], packets: list[bytes]) -> str:
    """Play beats to the sink, which expects packets; return the output."""
    if not (folder / "work-obj08.cf").exists():
        subprocess.run([ghdl, "-a", "--std=08", *PARTS, "player.vhd"], cwd=folder, check=True)
    (folder / "beats.txt").write_text("".join(f"{beat}\n" for beat in beats))
    (folder / "expected.txt").write_text(packets_text(packets))
    command = [ghdl, "--elab-run", "--std=08", "player", "--ieee-asserts=disable-at-0"]
    files = ["-gbeats=beats.txt", "-gexpected=expected.txt"]
    done = subprocess.run(
        [*command, *files], cwd=folder, capture_output=True, text=True, timeout=60, check=False
    )
    assert bool(done.returncode) == ("FAIL" in done.stdout + done.stderr)
    return done.stdout + done.stderr


def beat(data: bytes, *, keep: str = "", last: int = 1, user: int = 0) -> str:
    """Return a beat; bytes that are not kept are undefined."""
    bits = "".join(f"{byte:08b}" for byte in reversed(data))
    keep = keep or "1" * len(data)
    return f"{bits:U>32} {keep:0>4} {last} {user}"


WHOLE = beat(b"abcd", last=0)


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("beats", "output"),
    [
        ([WHOLE, beat(b"e")], ""),
        # A changed bit, an undefined bit, one byte more or fewer, and a packet of twice the beats.
        ([WHOLE, beat(b"d")], "FAIL packet 0: byte 4 is 64 instead of 65"),
        ([WHOLE, beat(b"e").replace("01100101", "0110010X")], "FAIL packet 0: byte 4 is 0110010X"),
        ([WHOLE, beat(b"ef")], "FAIL packet 0: byte 5 is 01100110, and 5 are expected"),
        ([beat(b"abcd")], "FAIL packet 0 has 4 bytes instead of 5"),
        ([WHOLE, WHOLE, beat(b"e")], "FAIL packet 0: byte 4 is 61 instead of 65"),
        # Surplus packets, even without bytes.
        ([WHOLE, beat(b"e"), beat(b"e")], "FAIL packet 1: no such packet is expected"),
        ([WHOLE, beat(b"e"), beat(b"", keep="0000")], "FAIL packet 1: no such packet is expected"),
        # Lanes.
        (
            [beat(b"abc", last=0), beat(b"de")],
            "FAIL packet 0: tkeep is 0111 with tlast 0, after 0",
        ),
        ([WHOLE, beat(b"", keep="0000", last=0), beat(b"e")], "FAIL packet 0: tkeep is 0000 with"),
        ([WHOLE, beat(b"ee", keep="0010")], "FAIL packet 0: tkeep is 0010 with tlast 1, after 4"),
        ([WHOLE, beat(b"e", keep="1001")], "FAIL packet 0: tkeep is 1001 with tlast 1, after 4"),
        ([WHOLE, beat(b"e", keep="000X")], "FAIL packet 0: tkeep is 000X with tlast 1, after 4"),
        ([WHOLE, beat(b"e", last=0)], "FAIL packet 0: tkeep is 0001 with tlast 0, after 4"),
        # `tuser` marks.
        ([WHOLE, beat(b"e", user=1)], "FAIL packet 0 is marked by tuser"),
        ([WHOLE.removesuffix("0") + "1", beat(b"e")], "FAIL packet 0: tuser is 1 with tlast 0"),
        ([WHOLE, beat(b"e").removesuffix("0") + "X"], "FAIL packet 0 is marked by tuser"),
    ],
)
def test_sink(ghdl, parts, beats, output):
    found = play(ghdl, parts, beats, [b"abcde"])
    assert output in found if output else not found
    if not output:
        assert (parts / "results.txt").read_text() == b"abcde".hex() + "\n"


def test_sink_wants_the_last_beat_of_a_full_packet_to_be_its_end(ghdl, parts):
    found = play(ghdl, parts, [WHOLE, beat(b"", keep="0000")], [b"abcd"])
    assert "FAIL packet 0: tkeep is 0000 with tlast 1, after 4 bytes" in found
    assert play(ghdl, parts, [beat(b"", keep="0000")], [b""]) == ""


def test_source_fills_lanes_that_are_not_kept_with_noise(ghdl, parts):
    play(ghdl, parts, [], [b"x"] * 30 + [b"abcd", b"abcdef", b""])
    rows = [row.split() for row in (parts / "sent.txt").read_text().splitlines()]
    assert {row[0][-8:] for row in rows[:30]} == {"01111000"}
    for lane in range(3):
        assert len({row[0][8 * lane : 8 * lane + 8] for row in rows[:30]}) > 15
    assert [tuple(row[1:]) for row in rows[29:]] == [
        ("0001", "1"),
        ("1111", "1"),
        ("1111", "0"),
        ("0011", "1"),
        ("0000", "1"),
    ]


STATUS = r"m_axis_status_tdata <= .*;"
VALID = r"(status_valid +=> )m_axis_status_tvalid"


@pytest.mark.parametrize(
    ("side", "changes", "output"),
    [
        ("deserializer", {STATUS: 'm_axis_status_tdata <= x"02";'}, "FAIL packet 0: the deserial"),
        ("serializer", {STATUS: 'm_axis_status_tdata <= x"06";'}, "FAIL packet 0: the serializer"),
        # A surplus status, a surplus leaf, and a missing one.
        ("deserializer", {VALID: r"\1open", STATUS: "m_axis_status_tvalid <= '1';"}, "FAIL "),
        ("serializer", {VALID: r"\1open", STATUS: "m_axis_status_tvalid <= '1';"}, "FAIL "),
        ("serializer", {VALID: r"\1open", STATUS: "m_axis_status_tvalid <= '0';"}, "FAIL no beat"),
        (
            "deserializer",
            {r"(message_data_valid +=> )data_valid": r"\1open", STATUS: "data_valid <= '1';"},
            "FAIL ",
        ),
    ],
)
@pytest.mark.sampled(6)
def test_bench(ghdl, tmp_path, side, changes, output):
    write_folder(tmp_path, "std_msgs/msg/UInt8", "lyrical", 8)
    (file,) = tmp_path.glob(f"*_8_{side}_flat.vhd")
    text = file.read_text()
    for pattern, to in changes.items():
        text, count = re.subn(pattern, to, text, count=1)
        assert count == 1
    # The changed text drives these outputs, so the wrapper's own assignments are removed.
    text = re.sub(
        r"^  status_valid <= .*|^  message_data_valid <= .*", "", text, flags=re.MULTILINE
    )
    file.write_text(text)
    status, found = run_script(tmp_path / "run_ghdl.sh", "-gpatience=1000", GHDL=ghdl)
    assert status != 0 and output in found and "PASS" not in found, found


def test_bench_without_packets_fails(ghdl, tmp_path):
    write_folder(tmp_path, "std_msgs/msg/UInt8", "lyrical", 8)
    (tmp_path / "stimuli.txt").write_text("# nothing\n")
    status, found = run_script(tmp_path / "run_ghdl.sh", GHDL=ghdl)
    assert status != 0 and "FAIL there are no packets" in found


def test_bench_reports_leftover_transfers(ghdl, tmp_path):
    write_folder(tmp_path, "builtin_interfaces/msg/Time", "lyrical", 8)
    (tmp_path / "stimuli.txt").write_text(packets_text([b"\0\1\0\0" + bytes(8)] * 3))
    (file,) = tmp_path.glob("*_8_deserializer_flat.vhd")
    # There is always one more of the second leaf; the serializer takes it only with the first.
    text = file.read_text()
    for pattern, to in {
        r"(message_nanosec_valid +=> )nanosec_valid": r"\1open",
        r"(  nanosec_data <= )": r"  nanosec_valid <= '1';\n\1",
    }.items():
        text, count = re.subn(pattern, to, text, count=1)
        assert count == 1
    file.write_text(text)
    status, found = run_script(tmp_path / "run_ghdl.sh", GHDL=ghdl)
    assert status != 0 and "FAIL unexpected transfers after the last packet" in found, found
    assert "PASS" not in found, found
