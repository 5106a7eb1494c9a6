"""The VHDL of the page "Floats and fixed point", in GHDL."""

from __future__ import annotations

import math
import re
import struct
import subprocess

from tests.examples.test_examples import DOCS

BENCH = """\
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
entity bench is
end entity;
architecture sim of bench is
{function}
begin
  process begin
{checks}
    report "all are right";
    wait;
  end process;
end architecture;
"""
VALUES = (0.0, -0.0, 1.0, -1.0, 0.3, -2.75, 2**-20, 2**-21, 5e-324, 524_287.5, -524_287.0)
TOO_LARGE = (524_288.0, -1e300, math.inf, -math.inf)


def test_vhdl_makes_fixed_numbers_of_floats(ghdl, tmp_path):
    page = (DOCS / "howto" / "floats.md").read_text(encoding="utf-8")
    (function,) = re.findall(r"^```vhdl\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    expected = {value: math.trunc(value * 2**20) for value in VALUES}
    expected |= {value: int(math.copysign(2**39 - 1, value)) for value in TOO_LARGE}
    expected[math.nan] = 0
    checks = [
        f'    assert from_float64(x"{struct.pack(">d", value).hex()}") = '
        f'signed\'(x"{fixed & (1 << 40) - 1:010x}") report "{value}" severity failure;'
        for value, fixed in expected.items()
    ]
    text = BENCH.format(function=function, checks="\n".join(checks))
    (tmp_path / "bench.vhd").write_text(text)
    for action in (["-a", "--std=08", "bench.vhd"], ["--elab-run", "--std=08", "bench"]):
        done = subprocess.run(
            [ghdl, *action], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
    assert "all are right" in done.stdout
