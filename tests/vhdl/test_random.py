# amaranth: UnusedElaboratable=no
"""Random designs: VHDL in GHDL against `amaranth.sim`, step by step.

``FIRM_HDL_DESIGNS=500`` runs more designs, ``FIRM_HDL_DESIGNS=1000:1500`` runs other designs.
"""

from __future__ import annotations

import os
import re
from dataclasses import replace
from pathlib import Path

import pytest

from firm_hdl.vhdl.convert import Vhdl, convert
from tests.vhdl.ghdl import Steps, difference, expected, simulate, synthesize, vectors
from tests.vhdl.random_designs import RandomDesign

STEPS = 100


def _seeds() -> range:
    first, _, last = os.environ.get("FIRM_HDL_DESIGNS", "0:30").rpartition(":")
    return range(int(first or 0), int(last))


def _design_and_vhdl(seed: int) -> tuple[RandomDesign, Vhdl, Steps, Steps]:
    """Return a design, its VHDL, input vectors, and the outputs in Amaranth's simulator."""
    written, simulated = RandomDesign(seed), RandomDesign(seed)
    vhdl = convert(written, name="dut", ports=written.ports)
    inputs = {signal.name: signal for signal in simulated.inputs}
    outputs = {signal.name: signal for signal in simulated.outputs}
    widths = {name: len(signal) for name, signal in inputs.items()}
    clocks = [clock.name for clock in simulated.clocks]
    steps = vectors(widths, clocks, steps=STEPS, seed=seed)
    return simulated, vhdl, steps, expected(simulated, inputs, outputs, steps)


def _run(design: RandomDesign, vhdl: Vhdl, steps: Steps, folder: Path) -> Steps:
    inputs = {signal.name: len(signal) for signal in design.inputs}
    outputs = {signal.name: len(signal) for signal in design.outputs}
    return simulate(vhdl, steps, inputs, outputs, folder)


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("seed", _seeds())
@pytest.mark.sampled(30)
def test_vhdl_behaves_as_in_amaranth(seed: int, tmp_path: Path) -> None:
    design, vhdl, steps, want = _design_and_vhdl(seed)
    assert difference(want, _run(design, vhdl, steps, tmp_path)) is None


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("seed", [1, 36])
@pytest.mark.sampled(2)
def test_no_latches_are_synthesized(seed: int, tmp_path: Path) -> None:
    # GHDL 2.0 itself fails for constants of more than 32 bits in products, and for some memories.
    _, vhdl, _, _ = _design_and_vhdl(seed)
    assert "latch" not in synthesize(vhdl, tmp_path).lower()


@pytest.mark.usefixtures("ghdl")
@pytest.mark.parametrize("seed", [3, 4, 5])
@pytest.mark.sampled(3)
def test_a_changed_operator_is_noticed(seed: int, tmp_path: Path) -> None:
    """Must-fail twin of the test above: most changed operators must cause a difference."""
    design, vhdl, steps, want = _design_and_vhdl(seed)
    noticed = tried = 0
    for index, twin in enumerate(_changed_operators(vhdl)):
        folder = tmp_path / str(index)
        folder.mkdir()
        tried += 1
        noticed += difference(want, _run(design, twin, steps, folder)) is not None
        if noticed:
            return
    pytest.fail(f"none of {tried} changed operators was noticed")


def _changed_operators(vhdl: Vhdl) -> list[Vhdl]:
    """Yield the VHDL with one operator of the outermost architecture changed."""
    name = f"{vhdl.top}.vhd"
    head, body = vhdl.files[name].split("\nbegin\n", 1)
    twins = []
    for match in re.finditer(r" (and|or|xor|\+|-|<|>=) ", body):
        other = {"and": "or", "or": "and", "xor": "or", "+": "-", "-": "+", "<": ">=", ">=": "<"}
        changed = body[: match.start(1)] + other[match[1]] + body[match.end(1) :]
        # The changed text must still be legal VHDL.
        if match[1] in ("+", "-", "<", ">="):
            twins.append(replace(vhdl, files={**vhdl.files, name: f"{head}\nbegin\n{changed}"}))
    return twins[:8]
