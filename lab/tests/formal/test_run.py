"""Proofs, and their twins with a bug: a fast subset of `make -C lab formal`."""

from __future__ import annotations

import pytest
from amaranth.hdl import Fragment

from lab.formal.blocks import all_studies
from lab.formal.bugs import seeded
from lab.formal.command import main
from lab.formal.run import all_proofs, prove, refute
from lab.formal.scene import Scene
from tests.depth import by_depth

FAST = ("arbiter/turns", "router/counters", "claims-noetic/pending")
# About 2 s each.
LONGER = (
    *("gate-bool/statuses", "serializer-joyfeedback-noetic-2/wire-order", "slice/order"),
    *("slice/valid-stays", "arbiter/whole-packets", "router/order", "crossing/nothing-extra"),
    *("fifo-wait-1/one-outcome", "width-1-4/count", "gate-bool/input-moves"),
    *("gate-bool/output-moves", "parser-string/one-status", "tail-drop/room"),
    *(
        "record-reader/order",
        "record-writer/one-each",
        "gate-drop/output-moves",
        "axi-lite/answers",
    ),
)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("key", [*FAST, *by_depth((), LONGER)])
def test_claim_holds(key):
    assert prove(key).result == "proved"


@pytest.mark.sampled(3)
@pytest.mark.parametrize("key", FAST)
def test_twin_is_found(key):
    answer = refute(key)
    assert answer.result == "broken"
    assert answer.cycles > 0 and answer.inputs


@pytest.mark.thorough
@pytest.mark.parametrize("key", all_proofs())
def test_every_twin_is_found(key):
    assert refute(key).result == "broken"


def test_every_bug_is_about_today_s_text():
    for proof in all_proofs().values():
        with seeded([proof.claim.bug]):
            pass


@pytest.mark.thorough
@pytest.mark.parametrize("study", all_studies(), ids=lambda study: study.name)
def test_scenes_have_the_claims_that_are_listed(study):
    scene = Scene(study.build)
    assert {claim.name for claim in study.claims} == set(scene.claims)
    # What is never elaborated is a warning.
    Fragment.get(scene, None)


@pytest.mark.thorough
def test_command_says_what_it_found(capsys):
    assert main(["arbiter/turns", "--jobs", "1", "--only-twins"]) == 0
    assert "broken" in capsys.readouterr().out
    assert main(["no-such-block/*"]) == 1
    assert "no proof is called no-such-block/*" in capsys.readouterr().err
