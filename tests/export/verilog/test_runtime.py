"""Yosys inside this process: what it prints, and its errors."""

from __future__ import annotations

import re

import pytest
import wasmtime

from firm_hdl.export.verilog import runtime
from firm_hdl.export.verilog.runtime import YosysError, run_yosys

# Each mux of `proc` gets a number that Yosys counts up as long as it runs.
CHOICE = r"""
read_rtlil <<rtlil
module \m
  wire width 1 input 0 \a
  wire width 1 output 1 \b
  process $p
    assign \b 1'0
    switch \a
      case 1'1
        assign \b 1'1
    end
  end
end
rtlil
proc -norom
write_rtlil
"""


def numbers(text: str) -> set[str]:
    return set(re.findall(r"\$procmux\$\d+", text))


def test_a_run_does_not_depend_on_those_before():
    first = run_yosys(CHOICE)
    assert numbers(first)
    assert run_yosys(CHOICE) == first
    # One run counts on.
    both = run_yosys(CHOICE + CHOICE.replace(r"\m", r"\n"))
    assert numbers(both) > numbers(first)


def test_mistakes_in_a_script_are_errors():
    with pytest.raises(YosysError, match=r"^ERROR: No such command: no_command"):
        run_yosys("no_command")


def test_failures_of_the_runtime_are_errors(monkeypatch):
    def fails(*_):
        raise wasmtime.WasmtimeError("mmap failed to reserve memory")

    monkeypatch.setattr(runtime, "_run", fails)
    with pytest.raises(YosysError, match=r"^mmap failed to reserve memory$"):
        run_yosys("write_rtlil")
