"""The functions of `float_fixed_pkg`, in GHDL."""

from __future__ import annotations

import math
import struct
import subprocess

from tests.examples.test_examples import ROOT

PACKAGE = ROOT / "examples" / "nodes" / "wheels_vhdl" / "float_fixed_pkg.vhd"
BENCH = """\
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.float_fixed_pkg.all;
entity bench is
end entity;
architecture sim of bench is
begin
  process begin
{checks}
    report "all are right";
    wait;
  end process;
end architecture;
"""
VALUES = (
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.3,
    -2.75,
    2**-16,
    2**-17,
    5e-324,
    32_767.5,
    -32_767.0,
    32_767.9,
)
TOO_LARGE = (32_768.0, 1e300, math.inf, -32_768.0, -1e300, -math.inf)


def test_vhdl_makes_fixed_numbers_of_floats_and_back(ghdl, tmp_path):
    expected = {value: math.trunc(value * 2**16) for value in VALUES}
    expected |= {value: 2**31 - 1 if value > 0 else -(2**31) for value in TOO_LARGE}
    expected[math.nan] = 0
    checks = []
    for value, fixed in expected.items():
        text = f'signed\'(x"{fixed & 0xFFFF_FFFF:08x}")'
        for call, want in (
            (f'to_fixed(x"{struct.pack(">d", value).hex()}")', text),
            (f"to_float({text})", f'x"{struct.pack(">d", fixed / 2**16).hex()}"'),
        ):
            checks.append(f'    assert {call} = {want} report "{value}" severity failure;')
    (tmp_path / "bench.vhd").write_text(BENCH.format(checks="\n".join(checks)))
    for action in (
        ["-a", "--std=08", str(PACKAGE), "bench.vhd"],
        ["--elab-run", "--std=08", "bench", "--ieee-asserts=disable-at-0"],
    ):
        done = subprocess.run(
            [ghdl, *action], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
    assert "all are right" in done.stdout
