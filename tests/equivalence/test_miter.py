"""Miters of two small circuits, made by hand: every kind of difference is found."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.equivalence.circuit import Cell, Circuit, Flop, ProofError
from firm_hdl.equivalence.miter import Claim, make_miter

NAND = {"A_SIGNED": 0, "B_SIGNED": 0, "A_WIDTH": 1, "B_WIDTH": 1, "Y_WIDTH": 1}


def circuit(first: int, **changes: object) -> Circuit:
    """An output that is a register of two bits, which takes input AND enable.

    Parameters
    ----------
    first : int
        The number of its first net.
    """
    clk, i, en, q0, q1, d = range(first, first + 6)
    flop = Flop(data=d, clock=clk, rising=True, init="0")
    known = {
        "inputs": {"clk": (clk,), "i": (i,), "en": (en,)},
        "outputs": {"o": (q0, q1)},
        "signals": {("inner", "r"): (q0, q1)},
        "cells": [
            Cell(kind="$and", parameters=NAND, inputs={"A": (i,), "B": (en,)}, outputs={"Y": (d,)})
        ],
        "flops": {q0: flop, q1: replace(flop, data=q0, init="1")},
    }
    return Circuit(**{**known, **changes})  # type: ignore[arg-type]


AMARANTH = circuit(2)
SAME = {"ports": {}, "signals": {("inner", "r"): ("inner_1", "r")}}


def vhdl(**changes: object) -> Circuit:
    result = circuit(2, **changes)
    return replace(result, signals={("inner_1", "r"): result.signals["inner", "r"]})


def miter(other: Circuit, ours: Circuit = AMARANTH, **options: object):
    return make_miter(ours, other, **{**SAME, **options})  # type: ignore[arg-type]


def flops(**changes: object) -> dict[int, Flop]:
    """Return both registers with the same changes."""
    return {net: replace(flop, **changes) for net, flop in AMARANTH.flops.items()}


def open_claims(result) -> list[str]:
    return [claim.what for claim in result.claims]


def test_the_same_circuit_leaves_its_next_states_to_be_proved() -> None:
    result = miter(vhdl())
    assert (result.differences, result.unmatched, result.registers) == ((), (), 2)
    # Outputs are shared registers; each side computes the next states with a gate.
    assert open_claims(result) == ["next state of inner.r"]
    (claim,) = result.claims
    assert claim.amaranth != claim.vhdl and len(claim.amaranth) == len(claim.vhdl) == 2
    assert {name: len(bits) for name, bits in result.inputs.items()} == {
        "input clk": 1, "input i": 1, "input en": 1, "register inner.r": 2
    }  # fmt: skip
    # Both gates read the same nets.
    one, other = result.cells
    assert dict(one.inputs) == dict(other.inputs) == {"A": (3,), "B": (4,)}
    assert one.outputs != other.outputs


RESET = {"reset": 3, "reset_level": True, "reset_value": "0"}


@pytest.mark.parametrize(
    ("ours", "theirs", "difference"),
    [
        ({}, {"init": "1"}, "inner.r starts with another value"),
        ({}, {"init": "x"}, "inner.r starts with another value"),
        ({}, {"rising": False}, "inner.r changes at the other edge of its clock"),
        ({"rising": False}, {}, "inner.r changes at the other edge of its clock"),
        (RESET, {}, "inner.r has an asynchronous reset on one side only"),
        ({}, RESET, "inner.r has an asynchronous reset on one side only"),
        (RESET, {**RESET, "reset_value": "1"}, "inner.r has another asynchronous reset"),
        (RESET, {**RESET, "reset_level": False}, "inner.r has another asynchronous reset"),
    ],
)
def test_registers_with_other_properties_differ_without_a_proof(
    ours: dict, theirs: dict, difference: str
) -> None:
    result = miter(vhdl(flops=flops(**theirs)), replace(AMARANTH, flops=flops(**ours)))
    assert difference in result.differences
    assert {*result.differences} == {difference}


def test_one_bit_of_a_register_that_starts_otherwise_differs() -> None:
    for net in AMARANTH.flops:
        for init in "01":
            changed = {**AMARANTH.flops, net: replace(AMARANTH.flops[net], init=init)}
            result = miter(vhdl(flops=changed))
            is_same = init == AMARANTH.flops[net].init
            assert result.differences == (() if is_same else ("inner.r starts with another value",))


def test_register_without_an_initial_value_may_have_one_in_the_vhdl() -> None:
    assert (
        miter(vhdl(flops=flops(init="1")), replace(AMARANTH, flops=flops(init="x"))).differences
        == ()
    )


@pytest.mark.parametrize(
    ("changes", "claim"),
    [
        ({"clock": 3}, "clock of inner.r"),
        ({"data": 4}, "next state of inner.r"),
        ({**RESET, "reset": 4}, "reset of inner.r"),
    ],
)
def test_inputs_of_registers_are_to_be_proved(changes: dict, claim: str) -> None:
    ours = flops(**RESET) if "reset" in changes else AMARANTH.flops
    same = miter(vhdl(flops=dict(ours)), replace(AMARANTH, flops=ours))
    result = miter(vhdl(flops={n: replace(f, **changes) for n, f in ours.items()}),
                 replace(AMARANTH, flops=ours))  # fmt: skip
    assert result.differences == ()
    assert claim in open_claims(result)
    assert open_claims(same) == ["next state of inner.r"]


def test_outputs_are_to_be_proved() -> None:
    q0, q1 = AMARANTH.outputs["o"]
    result = miter(vhdl(outputs={"o": (q1, q0)}))
    assert "output o" in open_claims(result) and result.differences == ()
    for constant in "01":
        assert "output o" in open_claims(miter(vhdl(outputs={"o": (q0, constant)})))


@pytest.mark.parametrize("side", ["amaranth", "vhdl"])
@pytest.mark.parametrize("what", ["inputs", "outputs"])
def test_ports_that_one_side_has_alone_differ(side: str, what: str) -> None:
    more = {**getattr(AMARANTH, what), "more": (99,) if what == "inputs" else (5,)}
    ours, theirs = AMARANTH, vhdl()
    if side == "amaranth":
        ours = replace(ours, **{what: more})
    else:
        theirs = replace(theirs, **{what: more})
    assert miter(theirs, ours).differences == (f"only one side has the {what[:-1]} more",)


@pytest.mark.parametrize("what", ["inputs", "outputs"])
def test_ports_of_another_width_differ(what: str) -> None:
    name = {"inputs": "i", "outputs": "o"}[what]
    ports = dict(getattr(AMARANTH, what))
    ports[name] = (*ports[name], 99 if what == "inputs" else 5)
    result = miter(vhdl(**{what: ports}))
    assert f"the {what[:-1]} {name} has two widths" in result.differences


def test_circuits_without_outputs_and_registers_are_not_equal() -> None:
    empty = circuit(2, outputs={}, signals={}, cells=[], flops={})
    with pytest.raises(ProofError, match="there is nothing to prove"):
        make_miter(empty, empty, ports={}, signals={})
    # What differs all the same is reported.
    other = replace(empty, inputs={"clk": (2,)})
    assert make_miter(empty, other, ports={}, signals={}).differences


def test_ports_are_matched_by_the_names_that_the_back_end_gave() -> None:
    renamed = vhdl(inputs={"clk": (2,), "i_field": (3,), "en": (4,)})
    result = miter(renamed, ports={"i": "I_field"})
    assert result.differences == () and open_claims(result) == ["next state of inner.r"]
    assert len(miter(renamed).differences) == 2
    # Swapped names are a difference, too.
    swapped = miter(vhdl(), ports={"i": "en", "en": "i"})
    assert swapped.differences == () and open_claims(swapped) == ["next state of inner.r"]
    one, other = swapped.cells
    assert dict(one.inputs) != dict(other.inputs)


def test_a_register_may_be_the_constant_that_it_keeps() -> None:
    q0, q1 = AMARANTH.outputs["o"]
    bits = (q0, "1")
    other = circuit(2, outputs={"o": bits}, flops={q0: AMARANTH.flops[q0]})
    other = replace(other, signals={("inner_1", "r"): bits})
    result = miter(other)
    # It must be proved to keep its value: its next state has to be that constant.
    assert result.differences == ()
    claims: dict[str, Claim] = {claim.what: claim for claim in result.claims}
    assert claims["next state of inner.r"].vhdl[1] == "1"
    wrong = replace(other, signals={("inner_1", "r"): (q0, "0")})
    assert miter(wrong).differences == ("inner.r starts with another value",)
    with_reset = replace(AMARANTH, flops={**AMARANTH.flops, q1: replace(
        AMARANTH.flops[q1], reset=3, reset_value="0")})  # fmt: skip
    assert miter(other, with_reset).differences == ("inner.r has another asynchronous reset",)
    # A reset to that constant, or no initial value at all, changes nothing.
    for changes in ({"reset": 3, "reset_value": "1"}, {"init": "x"}):
        kept = {**AMARANTH.flops, q1: replace(AMARANTH.flops[q1], **changes)}
        assert miter(other, replace(AMARANTH, flops=kept)).differences == ()


def test_a_wire_in_place_of_a_register_differs() -> None:
    q0, q1 = AMARANTH.outputs["o"]
    wires = Cell(kind="$pos", parameters={}, inputs={"A": (3,)}, outputs={"Y": (q1,)})
    other = circuit(2, cells=[*AMARANTH.cells, wires], flops={q0: AMARANTH.flops[q0]})
    result = miter(replace(other, signals={("inner_1", "r"): (q0, q1)}))
    assert result.differences == ("inner.r is not a register in the VHDL",)


@pytest.mark.parametrize(
    "signals",
    [{}, {("inner", "r"): ("inner_1", "s")}, {("inner", "r"): ("inner", "r")}],
)
def test_registers_without_a_partner_may_hold_anything(signals: dict) -> None:
    result = miter(vhdl(), signals=signals)
    assert result.differences == () and result.registers == 0
    assert result.unmatched == (
        "register inner.r of the Amaranth alone", "register inner_1.r of the VHDL alone"
    )  # fmt: skip
    # So the outputs are not equal: they are these registers.
    assert open_claims(result) == ["output o"]
    (claim,) = result.claims
    free = {bit for name, bits in result.inputs.items() if "alone" in name for bit in bits}
    assert {*claim.amaranth, *claim.vhdl} == free and len(free) == 4


def test_a_register_of_two_names_is_one_register() -> None:
    both = {("inner", "r"): ("inner_1", "r"), ("inner", "again"): ("inner_1", "again")}
    nets = AMARANTH.outputs["o"]
    ours = replace(AMARANTH, signals=dict.fromkeys(both, nets))
    theirs = replace(vhdl(), signals=dict.fromkeys(both.values(), nets))
    result = miter(theirs, ours, signals=both)
    assert (result.differences, result.unmatched, result.registers) == ((), (), 2)
    assert open_claims(result) == ["next state of inner.r", "next state of inner.again"]
    free = [bit for bits in result.inputs.values() for bit in bits]
    assert len(free) == len({*free}) == 5


@pytest.mark.parametrize("short", ["amaranth", "vhdl"])
def test_a_register_of_another_width_is_no_partner(short: str) -> None:
    q0, _ = AMARANTH.outputs["o"]
    ours, theirs = AMARANTH, vhdl()
    if short == "amaranth":
        ours = replace(ours, signals={("inner", "r"): (q0,)})
    else:
        theirs = replace(theirs, signals={("inner_1", "r"): (q0,)})
    side = {"amaranth": "Amaranth", "vhdl": "VHDL"}[short]
    result = miter(theirs, ours)
    assert result.differences == () and result.registers == 0
    # The other bit of the narrow one has no name.
    assert {*result.unmatched} == {
        "register inner.r of the Amaranth alone",
        "register inner_1.r of the VHDL alone",
        f"registers without a name of the {side} alone",
    }
    assert open_claims(result) == ["output o"]


def test_undriven_nets_are_free() -> None:
    loose = Cell(kind="$and", parameters=NAND, inputs={"A": (77,), "B": (4,)}, outputs={"Y": (7,)})
    result = miter(vhdl(cells=[loose]))
    assert len(result.inputs["anything"]) == 1 and result.differences == ()
    assert open_claims(result) == ["next state of inner.r"]
    # Nets that only an output has, on either side.
    bits = (AMARANTH.outputs["o"][0], 88)
    for sides in ((vhdl(outputs={"o": bits}), AMARANTH), (vhdl(), circuit(2, outputs={"o": bits}))):
        result = miter(*sides)
        (claim,) = [each for each in result.claims if each.what == "output o"]
        (free,) = result.inputs["anything"]
        assert [claim.amaranth[1], claim.vhdl[1]].count(free) == 1


def test_two_drivers_are_refused() -> None:
    with pytest.raises(ProofError, match="has two drivers"):
        circuit(2, cells=[*AMARANTH.cells, *AMARANTH.cells])
    with pytest.raises(ProofError, match="has two drivers"):
        circuit(2, inputs={**AMARANTH.inputs, "x": (7,)})


def test_the_netlist_asks_about_every_claim() -> None:
    result = miter(vhdl(outputs={"o": tuple(reversed(AMARANTH.outputs["o"]))}))
    assert len(result.claims) == 2
    module = result.netlist(values=True)["modules"]["miter"]
    differs = module["ports"]["differs"]["bits"]
    assert len(differs) == 2
    for number, claim in enumerate(result.claims):
        cell = module["cells"][f"claim{number}"]
        assert cell["type"] == "$ne"
        assert cell["connections"]["A"] == list(claim.amaranth)
        assert cell["connections"]["B"] == list(claim.vhdl)
        assert cell["connections"]["Y"] == [differs[number]]
        assert module["ports"][f"amaranth{number}"]["bits"] == list(claim.amaranth)
        assert module["ports"][f"vhdl{number}"]["bits"] == list(claim.vhdl)
    assert len({*differs}) == 2 and not {*differs} & {
        b for c in result.cells for b in c.outputs["Y"]
    }
    inputs = [p["bits"] for n, p in module["ports"].items() if n.startswith("in")]
    assert inputs == [list(bits) for bits in result.inputs.values()]
