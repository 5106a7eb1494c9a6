"""The claim about values follows the bytes of every leaf, the last one included."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.formal import run
from firm_hdl.formal.bugs import Bug
from firm_hdl.formal.run import all_proofs, refute
from firm_hdl.gateware.collect.fill import Filler
from firm_hdl.gateware.mover import _MoverLogic

SPOILED = {
    "serializer-joyfeedback-noetic-2": Bug(
        Filler._wire_bits, "return _item_bits(payload)", "return _item_bits(payload) ^ (leaf == {})"
    ),
    "deserializer-joyfeedback-noetic-1": Bug(
        _MoverLogic._write, "(payload, value, good", "(payload, value ^ (writer.leaf == {}), good"
    ),
}


@pytest.mark.parametrize(
    "leaf", [*(pytest.param(k, marks=pytest.mark.thorough) for k in (0, 1)), 2]
)
@pytest.mark.parametrize(
    "study",
    [
        "deserializer-joyfeedback-noetic-1",
        pytest.param("serializer-joyfeedback-noetic-2", marks=pytest.mark.thorough),
    ],
)
def test_a_wrong_bit_of_any_leaf_is_found(study: str, leaf: int, monkeypatch) -> None:
    key = f"{study}/values"
    proof, bug = all_proofs()[key], SPOILED[study]
    bug = replace(bug, new=bug.new.format(leaf))
    changed = replace(proof, claim=replace(proof.claim, bug=bug))
    monkeypatch.setattr(run, "all_proofs", lambda: {key: changed})
    assert refute(key).result == "broken"
