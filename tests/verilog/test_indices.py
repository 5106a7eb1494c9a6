"""Yosys must not take an element of an array for a bit of the array."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from firm_hdl.bench.netlist import top_module
from firm_hdl.bench.tools import Tool, find_yosys
from firm_hdl.jobs import ProgramMissingError
from firm_hdl.rtlil import without_indices
from firm_hdl.verilog import convert
from tests.depth import by_depth
from tests.tools import need


def test_elements_of_arrays_get_names_of_their_own() -> None:
    before = (
        "wire width 8 \\a.d\nwire width 2 \\a.d[1]\nwire \\A.D_1\nwire \\m[0][2].x\n"
        "connect \\a.d[1] \\a.d [3:2]\nconnect \\m[0][2].x \\a.d[1] [0]\n"
    )
    assert without_indices(before) == (
        "wire width 8 \\a.d\nwire width 2 \\a.d_1_2\nwire \\A.D_1\nwire \\m_0_2.x\n"
        "connect \\a.d_1_2 \\a.d [3:2]\nconnect \\m_0_2.x \\a.d_1_2 [0]\n"
    )


def test_two_elements_never_get_one_name() -> None:
    before = "wire \\a[0][1]\nwire \\a_0[1]\nwire \\A_0_1\n"
    assert without_indices(before) == "wire \\a_0_1_2\nwire \\a_0_1_3\nwire \\A_0_1\n"


# Two registers: bit 1 of `a`, and an element `a[1]`. Each has a port.
TWO = r"""
attribute \top 1
module \t
  wire width 1 input 0 \clk
  wire width 2 input 1 \x
  wire width 2 output 2 \y
  wire width 1 output 3 \z
  wire width 2 \a
  wire width 1 \a[1]
  wire width 1 \all
  wire width 1 \any
  cell $reduce_and $1
    parameter \A_SIGNED 0
    parameter \A_WIDTH 2
    parameter \Y_WIDTH 1
    connect \A \x
    connect \Y \all
  end
  cell $reduce_or $2
    parameter \A_SIGNED 0
    parameter \A_WIDTH 2
    parameter \Y_WIDTH 1
    connect \A \x
    connect \Y \any
  end
  cell $dff $3
    parameter \CLK_POLARITY 1
    parameter \WIDTH 2
    connect \CLK \clk
    connect \D { \all \x [0] }
    connect \Q \a
  end
  cell $dff $4
    parameter \CLK_POLARITY 1
    parameter \WIDTH 1
    connect \CLK \clk
    connect \D \any
    connect \Q \a[1]
  end
  connect \y \a
  connect \z \a[1]
end
"""


@pytest.fixture
def yosys() -> Tool:
    try:
        return find_yosys()
    except ProgramMissingError as error:
        need(str(error), None)
        raise


@pytest.mark.parametrize("device", by_depth(["ecp5"], ["ecp5", "ice40"]))
def test_yosys_keeps_bits_and_elements_apart(yosys: Tool, tmp_path: Path, device: str) -> None:
    (tmp_path / "t.v").write_text(convert(TWO, name="top"))
    script = f"read_verilog t.v; synth_{device} -top top -json t.json"
    yosys.run(tmp_path, "-q", "-p", script)
    ports = top_module(json.loads((tmp_path / "t.json").read_text()))["ports"]
    assert ports["z"]["bits"][0] not in ports["y"]["bits"]
