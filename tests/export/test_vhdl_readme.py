"""The README's pieces of VHDL are a design that compiles, once what they leave out is there."""

# amaranth: UnusedElaboratable=no

from __future__ import annotations

import re
from pathlib import Path

import pytest

from firm_hdl import load_message
from tests.export.test_vhdl_types import analyse, vhdl_of, write

README = Path(__file__).parents[2] / "README.md"
BLOCKS = re.findall(r"^```vhdl\n(.*?)^```$", README.read_text(), re.MULTILINE | re.DOTALL)

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
    speed        : out std_logic_vector(63 downto 0)
  );
end entity;
architecture rtl of design is
{signals}
begin
{statements}
end architecture;
"""


@pytest.mark.parametrize("number", range(2))
def test_pieces_compile(ghdl, tmp_path, number):
    assert len(BLOCKS) == 2
    uses, signals, statements = BLOCKS[number].split("...\n")
    text = DESIGN.format(uses=uses, signals=signals, statements=statements)
    made, _ = vhdl_of(load_message("geometry_msgs/msg/Twist", distro="lyrical"))
    write(tmp_path, {**made.files, "design.vhd": text})
    analyse(ghdl, tmp_path, [*made.manifest["files"], "design.vhd"])
