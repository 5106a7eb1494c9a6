"""Proofs, and their twins with a bug: a fast subset of `make formal`."""

from __future__ import annotations

import pytest
from amaranth.hdl import Const, Fragment, Signal
from amaranth.lib.memory import Memory

from firm_hdl.formal import run
from firm_hdl.formal.blocks import all_studies
from firm_hdl.formal.bugs import Bug, seeded
from firm_hdl.formal.catalog import Claim, Study
from firm_hdl.formal.command import main
from firm_hdl.formal.run import all_proofs, prove, refute
from firm_hdl.formal.scene import Scene
from firm_hdl.gateware.packets.slice import StreamSlice
from tests.depth import by_depth

# Their proofs take 2 s each, their twins less than 1 s.
LONG = ("slice/order", "crossing/nothing-extra")
FAST = [
    *("arbiter/turns", "router/counters", "claims-noetic/pending"),
    *("gate-bool/statuses", "serializer-joyfeedback-noetic-2/wire-order"),
    # About 2 s each. tests/formal/test_liveness.py breaks what moves, in short runs.
    *by_depth(
        (),
        (
            *("slice/valid-stays", "arbiter/whole-packets", "router/order"),
            *("fifo-wait-1/one-outcome", "width-1-4/count", "gate-bool/input-moves"),
            *("gate-bool/output-moves", "parser-string/one-status", "tail-drop/room"),
            *("record-reader/order", "record-writer/one-each", "gate-drop/output-moves"),
        ),
    ),
]


@pytest.mark.parametrize("key", [*FAST, *by_depth((), LONG)])
def test_claim_holds(key):
    assert prove(key).result == "proved"


@pytest.mark.parametrize("key", [*FAST, *LONG])
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


@pytest.mark.parametrize("study", all_studies(), ids=lambda study: study.name)
def test_scenes_have_the_claims_that_are_listed(study):
    scene = Scene(study.build)
    assert {claim.name for claim in study.claims} == set(scene.claims)
    # What is never elaborated is a warning.
    Fragment.get(scene, None)


def test_every_proof_of_bounded_depth_says_its_depth():
    for proof in all_proofs().values():
        assert proof.claim.reach == "unbounded" or int(proof.claim.reach) > 0


def counting(scene):
    """A counter that reaches 5 after 5 cycles in which `go` is high."""
    go, value = scene.free(1, "go"), Signal(4)
    with scene.m.If(go):
        scene.m.d.sync += value.eq(value + 1)
    scene.claim("less than five", value < 5)


NO_BUG = Bug(StreamSlice.elaborate, "ready.eq(1)", "ready.eq(1)")


@pytest.mark.parametrize(
    "method, depth, result",
    [("PDR", 0, "broken"), ("BMC", 5, "proved"), ("BMC", 6, "broken")],
)
def test_answers_count_cycles(monkeypatch, method, depth, result):
    study = Study("count", "", counting, (Claim("less than five", NO_BUG, method, depth),))
    proofs = {"count": run.Proof(study, study.claims[0])}
    monkeypatch.setattr(run, "all_proofs", lambda: proofs)
    answer = prove("count")
    assert answer.result == result
    if result == "broken":
        assert answer.cycles == 6
        assert answer.inputs.split()[0] == "go@0"


@pytest.mark.parametrize(
    ("listed", "differs"),
    [(["less than five"], "more"), (["less than five", "more", "most"], "most")],
)
def test_a_study_lists_all_claims_of_its_scene_and_no_others(monkeypatch, listed, differs):
    scenes = []

    def build(scene):
        scenes.append(scene)
        counting(scene)
        scene.claim("more", Const(1))

    study = Study("count", "", build, tuple(Claim(name, NO_BUG, "BMC", 1) for name in listed))
    monkeypatch.setattr(run, "all_proofs", lambda: {"count": run.Proof(study, study.claims[0])})
    for work in (prove, refute):
        with pytest.raises(ValueError, match=rf"^count: claims differ: {{'{differs}'}}$"):
            work("count")
    for scene in scenes:
        Fragment.get(scene, None)


def test_a_claim_is_found_by_its_name_among_those_of_the_scene(monkeypatch):
    names = ["less than five", "more"]

    def build(scene):
        counting(scene)
        scene.claim("more", Const(1))

    # A study may list them in another order.
    study = Study("count", "", build, tuple(Claim(name, NO_BUG, "BMC", 1) for name in names[::-1]))
    proofs = {each.name: run.Proof(study, each) for each in study.claims}
    monkeypatch.setattr(run, "all_proofs", lambda: proofs)
    monkeypatch.setattr(run, "find_tools", lambda *, ghdl: None)
    monkeypatch.setattr(run, "write_aiger", lambda scene, *given: Fragment.get(scene, None))
    monkeypatch.setattr(run, "decide", lambda aiger, output, tools, **how: output)
    assert [prove(name) for name in names] == [0, 1]


def wrong_at_once(scene):
    """A claim that an input breaks in the first cycle only."""
    scene.claim("low", ~(scene.free(1, "go") & scene.first))


@pytest.mark.parametrize("method", ["PDR", "BMC"])
def test_a_counterexample_may_have_one_cycle(monkeypatch, method):
    study = Study("wrong", "", wrong_at_once, (Claim("low", NO_BUG, method, 3),))
    monkeypatch.setattr(run, "all_proofs", lambda: {"wrong": run.Proof(study, study.claims[0])})
    answer = prove("wrong")
    assert (answer.result, answer.cycles, answer.inputs) == ("broken", 1, "go@0")


def beyond_a_memory(scene):
    """Read a place that a memory of three words does not have; a claim says what is there."""
    memory = Memory(shape=1, depth=3, init=[])
    scene.m.submodules.memory = memory
    read, write = memory.read_port(domain="comb"), memory.write_port()
    at = scene.free(2, "at")
    scene.m.d.comb += [read.addr.eq(at), write.addr.eq(at), write.en.eq(1)]
    scene.claim("low", (at != 3) | ~read.data)
    scene.claim("high", (at != 3) | read.data)


@pytest.mark.parametrize("claim", ["low", "high"])
def test_what_is_undefined_may_be_anything(monkeypatch, claim):
    claims = tuple(Claim(name, NO_BUG, "BMC", 2) for name in ("low", "high"))
    study = Study("memory", "", beyond_a_memory, claims)
    proofs = {each.name: run.Proof(study, each) for each in claims}
    monkeypatch.setattr(run, "all_proofs", lambda: proofs)
    assert prove(claim).result == "broken"


def kept_by_a_reset(is_configured):
    """Claims that a register without a reset, and a word of a memory, are 0 in the first cycle."""

    def build(scene):
        scene.is_configured = is_configured
        register, memory = Signal(reset_less=True), Memory(shape=1, depth=2, init=[0, 0])
        scene.m.submodules.memory = memory
        read, write = memory.read_port(domain="comb"), memory.write_port()
        scene.m.d.comb += [read.addr.eq(0), write.addr.eq(1), write.en.eq(1)]
        scene.m.d.sync += register.eq(scene.free(1, "go"))
        scene.claim("register", ~scene.first | ~register)
        scene.claim("word", ~scene.first | ~read.data)

    return build


@pytest.mark.parametrize(
    ("claim", "is_configured", "result"),
    [("register", False, "broken"), ("register", True, "proved"), ("word", False, "broken")],
)
def test_a_reset_changes_no_memory_and_no_register_without_a_reset(
    monkeypatch, claim, is_configured, result
):
    claims = tuple(Claim(name, NO_BUG, "BMC", 2) for name in ("register", "word"))
    study = Study("kept", "", kept_by_a_reset(is_configured), claims)
    proofs = {each.name: run.Proof(study, each) for each in claims}
    monkeypatch.setattr(run, "all_proofs", lambda: proofs)
    assert prove(claim).result == result


def test_bug_goes_away_again():
    code = StreamSlice.elaborate.__code__
    with seeded([Bug(StreamSlice.elaborate, "ready.eq(1)", "ready.eq(0)")]):
        assert StreamSlice.elaborate.__code__ is not code
    assert StreamSlice.elaborate.__code__ is code


def test_bug_that_is_nowhere_is_refused():
    with (
        pytest.raises(
            ValueError, match=r"^StreamSlice.elaborate: no such text -> yes: .* 0 times$"
        ),
        seeded([Bug(StreamSlice.elaborate, "no such text", "yes")]),
    ):
        pass


def twice(value: int) -> int:
    if value:
        return value + 1
    return value - 1


def closed(value: int):
    def inner() -> int:
        return value + 1

    return inner


def test_bug_in_a_text_that_occurs_twice_or_needs_its_surroundings_is_refused():
    with (
        pytest.raises(ValueError, match="occurs 2 times"),
        seeded([Bug(twice, "return value", "return 2")]),
    ):
        pass
    with (
        pytest.raises(ValueError, match="cannot be compiled alone"),
        seeded([Bug(closed(1), "value + 1", "value + 2")]),
    ):
        pass
    assert (twice(3), twice(0)) == (4, -1)


def test_command_says_what_it_found(capsys):
    assert main(["slice/order", "--jobs", "1", "--timeout", "1", "--only-twins"]) == 0
    assert "broken" in capsys.readouterr().out
    assert main(["no-such-block/*"]) == 1
    assert "no proof is called no-such-block/*" in capsys.readouterr().err
