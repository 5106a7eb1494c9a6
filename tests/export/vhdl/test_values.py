# amaranth: UnusedElaboratable=no
"""Records of values and vectors in VHDL: what is converted, in GHDL, whatever its range."""

from __future__ import annotations

import random
import subprocess

import pytest

from firm_hdl.model import Message
from tests.export.vhdl.test_layer import layer, write
from tests.frontend.workspace import library

POINT = "uint16 x\nint8 y\nbool[3] f\nbool g\n"
BITS = 16 + 8 + 3 + 1
BENCH = """\
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.p_msg_point_cdr_8_pkg.all;
entity t is end entity;
architecture a of t is
begin
  process
    -- Points 1 to 4 as vectors: the first one is in the lowest bits.
    variable bits : std_logic_vector(0 to {top}) := "{bits}";
    variable up   : point_values_t(7 to 10) := ({points});
    variable down : point_values_t(3 downto 0) := ({points});
  begin
    assert POINT_VALUE_BITS = {size} report "size" severity failure;
    assert to_slv(up) = bits and to_slv(down) = bits report "to_slv" severity failure;
    assert to_point_values(bits) = up report "to_point_values" severity failure;
    assert to_point_values(bits)(0) = up(7) and to_point_values(bits)(3) = up(10)
      report "range" severity failure;
    -- Parts of both.
    assert to_slv(up(8 to 9)) = bits({size} * 1 to {size} * 3 - 1)
      report "to_slv of a part" severity failure;
    assert to_point_values(bits({size} * 1 to {size} * 3 - 1)) = up(8 to 9)
      report "to_point_values of a part" severity failure;
    assert to_slv(up(8 to 7)) = "" and to_point_values("") = up(8 to 7)
      report "nothing" severity failure;
    for k in 0 to 3 loop
      assert to_slv(up(10 - k)) = bits({size} * k to {size} * (k + 1) - 1)
        report "to_slv of one" severity failure;
      assert to_point_value(bits({size} * k to {size} * (k + 1) - 1)) = up(10 - k)
        report "to_point_value" severity failure;
    end loop;
    report "ALL";
    wait;
  end process;
end architecture;
"""


@pytest.fixture
def point(tmp_path) -> Message:
    return library(tmp_path / "src", {"p/Point": POINT}).message("p/Point")


def bench() -> str:
    noise = random.Random(4)
    points, texts = [], []
    for _ in range(4):
        x, y, flags, g = (noise.getrandbits(bits) for bits in (16, 8, 3, 1))
        vector = "".join(f"'{flags >> k & 1}', " for k in range(3)).rstrip(", ")
        points.append(f'(x"{x:04x}", x"{y:02x}", ({vector}), \'{g}\')')
        # The first field is in the lowest bits, and so on the right.
        texts.append(f"{g:b}{flags:03b}{y:08b}{x:016b}")
    bits = "".join(reversed(texts))
    return BENCH.format(size=BITS, top=4 * BITS - 1, bits=bits, points=", ".join(points))


def test_values_and_vectors_are_the_same_in_any_range(ghdl, tmp_path, point):
    packages = layer(point).packages
    names = [name for name in packages if "components" not in name]
    write(tmp_path, {**packages, "t.vhd": bench()})
    done = subprocess.run(
        f"{ghdl} -a --std=08 {' '.join(names)} t.vhd && {ghdl} --elab-run --std=08 t",
        shell=True, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert "ALL" in done.stdout + done.stderr
