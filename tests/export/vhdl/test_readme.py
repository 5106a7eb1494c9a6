# amaranth: UnusedElaboratable=no
"""VHDL of README and documentation, completed to designs: they act on good packets only."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from firm_hdl import load_message
from firm_hdl.cases.stimuli import stimuli
from firm_hdl.export.vhdl.bench import PARTS
from tests.examples.test_examples import load
from tests.export.vhdl.test_layer import analyse, plan_of, vhdl_of, write

ROOT = Path(__file__).parents[3]
PIECES = [
    piece
    for page in ("docs/howto/vhdl.md", "README.md")
    for piece in re.findall(r"^```vhdl\n(.*?)^```$", (ROOT / page).read_text(), re.M | re.S)
]
# Behind the writer are lines that firm-hdl wrote.
RECORD, STREAMS, WRITER, *_, SHORT = PIECES
# The README has the statements alone.
BLOCKS = [RECORD, STREAMS, "...\n".join([*RECORD.split("...\n")[:2], SHORT])]
EXAMPLES = ROOT / "examples"
SAFE = r" and status = STATUS_OK;"

DESIGN = """\
library ieee;
use ieee.std_logic_1164.all;
{uses}
entity design is
  port (
    aclk, aresetn, tlast, tvalid : in std_logic;
    tdata        : in  std_logic_vector(63 downto 0);
    tkeep        : in  std_logic_vector(7 downto 0);
    tready       : out std_logic;
    status       : out std_logic_vector(7 downto 0);
    status_valid : out std_logic;
    speed        : out std_logic_vector(63 downto 0) := (others => '0')
  );
end entity;
architecture rtl of design is
{signals}
begin
{statements}
end architecture;
"""
WRITES = """\
library ieee;
use ieee.std_logic_1164.all;
use work.geometry_msgs_msg_twist_cdr_8_pkg.all;
entity writes is
  port (
    aclk, aresetn, tready, msg_valid : in std_logic;
    msg : in twist_value_t;
    msg_ready, tlast, tuser, tvalid : out std_logic;
    tdata : out std_logic_vector(63 downto 0);
    tkeep : out std_logic_vector(7 downto 0)
  );
end entity;
architecture rtl of writes is
begin
{statements}
end architecture;
"""
INSTANCE = """\
  dut : entity work.design
    port map (
      aclk => aclk, aresetn => aresetn, tdata => tdata, tkeep => tkeep, tlast => tlast,
      tvalid => tvalid, tready => tready, status => open, status_valid => open, speed => speed
    );
"""


@pytest.fixture(scope="module")
def converters():
    message = load_message("geometry_msgs/msg/Twist", distro="lyrical")
    # The same VHDL as for other tests of this type, so that it is made once.
    made, _ = vhdl_of(message, packets=stimuli(message, plan_of(message)))
    return made


def bench() -> str:
    """Return the bench of the motor example, adapted to the wider bus of these designs."""
    text = (EXAMPLES / "vhdl_motor" / "motor_tb.vhd").read_text()
    for old, new in (("(31 downto", "(63 downto"), ("(3 downto", "(7 downto"), ("=> 4,", "=> 8,")):
        assert old in text
        text = text.replace(old, new)
    text, count = re.subn(r"  dut : .*?;\n", INSTANCE, text, flags=re.DOTALL)
    assert count == 1
    return text


def run(ghdl: str, converters, folder: Path, block: str) -> tuple[int, str]:
    uses, signals, statements = block.split("...\n")
    text = DESIGN.format(uses=uses, signals=signals, statements=statements)
    parts = {name: PARTS[name] for name in ("firm_hdl_bench_pkg.vhd", "firm_hdl_axis_source.vhd")}
    write(folder, {**converters.files, **parts, "design.vhd": text, "motor_tb.vhd": bench()})
    files = [*converters.manifest["files"], *parts, "design.vhd", "motor_tb.vhd"]
    analyse(ghdl, folder, files)
    load(EXAMPLES / "vhdl_motor" / "twists.py").main(folder)
    done = subprocess.run(
        [ghdl, "--elab-run", "--std=08", "motor_tb", "--ieee-asserts=disable-at-0"],
        cwd=folder, capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    return done.returncode, done.stdout + done.stderr


@pytest.mark.parametrize("block", BLOCKS, ids=["record", "streams", "README"])
def test_code_of_the_pages_acts_on_good_packets_only(ghdl, converters, tmp_path, block):
    status, output = run(ghdl, converters, tmp_path, block)
    assert status == 0 and "PASS 8 packets, 4 speeds" in output, output


def test_a_serializer_is_used_as_the_page_says(ghdl, converters, tmp_path):
    write(tmp_path, {**converters.files, "writes.vhd": WRITES.format(statements=WRITER)})
    analyse(ghdl, tmp_path, [*converters.manifest["files"], "writes.vhd"])


def test_code_that_ignores_the_status_fails(ghdl, converters, tmp_path):
    naive, count = re.subn(SAFE, ";", BLOCKS[0])
    assert count == 1
    status, output = run(ghdl, converters, tmp_path, naive)
    assert status != 0 and "FAIL after" in output, output
