"""Run proofs and twins, each in a process of its own."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from functools import cache
from pathlib import Path

from firm_hdl.equivalence.tools import find_tools
from firm_hdl.jobs import ToolError
from lab.formal.blocks import all_studies
from lab.formal.bugs import seeded
from lab.formal.catalog import Proof
from lab.formal.netlist import write_aiger
from lab.formal.scene import Scene
from lab.formal.solve import Answer, decide

__all__ = ["all_proofs", "prove", "refute"]

TIMEOUT = 900.0
"""Seconds for each proof."""


@cache
def all_proofs() -> dict[str, Proof]:
    """Return all proofs by their keys."""
    proofs = [Proof(study, claim) for study in all_studies() for claim in study.claims]
    return {proof.key: proof for proof in proofs}


def prove(key: str, timeout: float = TIMEOUT) -> Answer:
    """Prove a claim."""
    proof = all_proofs()[key]
    claim = proof.claim
    if claim.method == "induction":
        return _induction(proof, timeout)
    return _decide(proof, timeout, method=claim.method, depth=claim.depth)


def refute(key: str, timeout: float = TIMEOUT) -> Answer:
    """Look for a counterexample to the same claim, with its bug in the block."""
    proof = all_proofs()[key]
    claim = proof.claim
    depth = claim.depth if claim.method == "BMC" else claim.found_within
    with seeded([claim.bug]):
        return _decide(proof, timeout, method="BMC", depth=depth)


def _induction(proof: Proof, timeout: float) -> Answer:
    """Prove that a claim holds in the first cycle, and in each one after one in which it holds."""
    start = _decide(proof, timeout, method="BMC", depth=1)
    if start.result != "proved":
        return start
    step = _decide(proof, timeout, is_step=True, method="BMC", depth=2)
    # A state that breaks it may be one that no run has.
    if step.result == "broken":
        step = replace(step, result="undecided")
    return replace(step, seconds=start.seconds + step.seconds)


def _decide(proof: Proof, timeout: float, *, is_step: bool = False, **how: object) -> Answer:
    scene = Scene(proof.study.build, is_step=is_step)
    named = {claim.name for claim in proof.study.claims}
    if named != set(scene.claims):
        raise ValueError(f"{proof.study.name}: claims differ: {named ^ set(scene.claims)}")
    output = list(scene.claims).index(proof.claim.name)
    tools = find_tools(ghdl=False)
    with tempfile.TemporaryDirectory(prefix="firm-hdl-formal-") as folder:
        try:
            aiger = write_aiger(scene, Path(folder), tools)
            return decide(aiger, output, tools, timeout=timeout, **how)  # type: ignore[arg-type]
        except ToolError as error:
            return Answer(result="undecided", inputs=str(error))
