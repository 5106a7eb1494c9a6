"""Scenes in Amaranth's simulator: right blocks keep every claim, and each part of a claim tells.

A proof takes minutes, a run some milliseconds. A claim that is too strong shows as soon as a run
reaches what it forbids. A claim that is too weak misses a bug that only one part of it can find;
the twins of the proofs have one bug for each claim.
"""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Const

from firm_hdl.formal.blocks import all_studies
from firm_hdl.formal.bugs import Bug, seeded
from firm_hdl.gateware.collect.collector import _CollectorLogic as _Collect
from firm_hdl.gateware.mover import _MoverLogic as _Move
from firm_hdl.gateware.packer import _PackerLogic as _Pack
from firm_hdl.gateware.packets.gate import _Verdicts
from firm_hdl.gateware.packets.tail_drop import TailDrop
from firm_hdl.gateware.parse.claims import Claims
from firm_hdl.gateware.parse.packet_judge import PacketJudge
from firm_hdl.gateware.record import RecordReader, RecordWriter
from tests.formal.play import play, play_each

STUDIES = {study.name: study for study in all_studies()}
CYCLES = 40
# What a scene assumes of the choices that hold for a whole run, and of lengths.
ASSUMED = {"which_choice": 0, "part_choice": 0, "step_choice": 0, "count": 25}
ASSUMED |= {"chosen_choice": 0, "other_choice": 1}


def run(name, **fixed):
    """Play a scene with random inputs; those of `fixed` are the same in all cycles.

    Returns
    -------
    broken : dict of str to list of int
        As `play` returns it.
    """
    source = random.Random(name)
    fixed = ASSUMED | fixed

    def value(signal, bits):
        if signal in fixed:
            return fixed[signal]
        if signal.endswith(("valid", "ready")):
            return int(source.random() < 0.8)
        if signal.endswith("mark"):
            return int(source.random() < 0.1)
        if signal.endswith("choice") and bits > 8:
            # The highest bit is that of the last beat of a packet.
            return source.getrandbits(bits - 1) | (source.random() < 0.25) << bits - 1
        return source.getrandbits(bits)

    def steps(widths):
        return [{each: value(each, bits) for each, bits in widths.items()} for _ in range(CYCLES)]

    def build(scene):
        STUDIES[name].build(scene)
        scene.claim("is allowed", Const(0, 1))

    broken = play(build, steps)[0]
    # Nothing that the scene assumes has failed.
    assert broken.pop("is allowed") == list(range(CYCLES))
    return broken


@pytest.mark.parametrize("name", STUDIES)
def test_no_run_of_a_right_block_breaks_a_claim(name):
    assert run(name) == {claim.name: [] for claim in STUDIES[name].claims}


BOOL = "serializer-bool-noetic-1"
_DROP, _JUDGE = TailDrop.elaborate, _Collect._judge
PARTS = [
    # What is sent with a packet, not only the block's own number.
    ("tail-drop", "dropped", _DROP, "any_dropped.eq(self.dropped.any())", "any_dropped.eq(0)"),
    ("tail-drop", "dropped", _DROP, "any_dropped.eq(self.dropped.any())", "any_dropped.eq(1)"),
    ("tail-drop", "dropped", _DROP, "dropped.eq(self.dropped),", "dropped.eq(0),"),
    ("tail-drop", "room", _DROP, "ready.eq(1)", "ready.eq(~abort_pending)"),
    ("tail-drop", "order", _DROP, "beat.eq(beat)", "beat.eq(~beat.as_value())"),
    ("tail-drop", "order", _DROP, "(came & ~drops_rest)", "~drops_rest"),
    ("tail-drop", "drops", _DROP, "eq(refused & beat.last)", "eq(0)"),
    # A status that is wrong, and a packet that is marked as wrong.
    (BOOL, "statuses", _JUDGE, "payload.eq(found)", "payload.eq(Status.ITEMS)"),
    (BOOL, "statuses", _Pack._send, "eq(is_last & read.data.error)", "eq(1)"),
]


_JOINED = "Value.cast(self.record.payload).eq(Cat(parts[bit] for bit in sorted(parts)))"
_LANES = "_values(leaf).eq(vector[self._record.bits_of(places)])"
# Bits of each leaf of a record, at its ends; the last lane has no value in the
# second transfer of an array.
PARTS += [
    (
        "record-reader",
        "order",
        RecordReader.elaborate,
        _JOINED,
        _JOINED.removesuffix(")") + f" ^ {1 << bit})",
    )
    for bit in (7, 8, 31, 47)
]
PARTS += [
    (
        "record-writer",
        "order",
        RecordWriter._offer,
        _LANES,
        f"{_LANES.removesuffix(')')} ^ ({1 << bit} if {chosen} else 0))",
    )
    for bit, chosen in (
        (7, "len(_values(leaf)) == 8"),
        (15, "len(transfers) == 1 and len(_values(leaf)) == 16"),
        (0, "len(transfers) == 2 and number == 1"),
        (15, "len(transfers) == 2 and number == 0"),
    )
]
PARTS += [
    ("record-writer", "order", RecordWriter._offer, "for number in ends).any()", f"for {ends}")
    for ends in ("number in ends).all() | 1", "number in ends).any() & 0")
]

_DATA = "Value.cast(payload.data).eq(beat)"
# A bit of each byte of the header; padding has two of the lanes, too.
PARTS += [
    (
        "serializer-joyfeedback-lyrical-4",
        "layout",
        _Pack._send,
        _DATA,
        f"{_DATA.removesuffix(')')} ^ {1 << bit})",
    )
    for bit in (0, 15, 16, 31)
]


@pytest.mark.parametrize(("name", "claim", "function", "old", "new"), PARTS)
def test_a_bug_that_one_part_of_a_claim_finds_breaks_the_claim(name, claim, function, old, new):
    with seeded([Bug(function, old, new)]):
        assert run(name)[claim]


def test_a_status_without_a_message_breaks_a_claim():
    with seeded([Bug(_JUDGE, "m.If(state.complete & state.ends)", "m.If(1)")]):
        # Nothing comes, and nothing is taken.
        assert run(BOOL, leaf0_valid=0, status_ready=0)["statuses"]


@pytest.mark.parametrize("name", ["gate-bool", "gate-drop"])
def test_a_status_before_any_packet_breaks_a_claim(name):
    # None is taken. So there is one too many, and never two.
    given = [{}] * 8
    assert not any(play(STUDIES[name].build, given)[0].values())
    with seeded([Bug(_Verdicts.give_statuses, "is_due.eq(leaves)", "is_due.eq(1)")]):
        assert play(STUDIES[name].build, given)[0]["one status"]


@pytest.mark.parametrize("name", [name for name in STUDIES if name.startswith("deserializer-")])
def test_a_wrong_status_of_a_deserializer_breaks_a_claim(name):
    # Behind the streams of the leaves is that of the status; the first packet is followed.
    leaves = {"bool": 1, "joyfeedback": 3, "time": 2}[name.split("-")[1]]
    assert run(name, which_choice=leaves, mark=1) == {
        claim.name: [] for claim in STUDIES[name].claims
    }
    other = "Value.cast(port.payload).eq(~Value.cast(status))"
    with seeded([Bug(_Move._report, "port.payload.eq(status)", other)]):
        assert run(name, which_choice=leaves, mark=1)["statuses"]


@pytest.mark.parametrize(
    ("name", "leaf", "part"),
    # A byte in the second lane, and one in the last lane of a beat.
    [("serializer-joyfeedback-noetic-2", 1, 0), ("serializer-joyfeedback-lyrical-4", 2, 3)],
)
def test_a_wrong_byte_in_any_lane_breaks_a_claim(name, leaf, part):
    given = {"which_choice": leaf, "part_choice": part, "mark": 1}
    assert run(name, **given) == {claim.name: [] for claim in STUDIES[name].claims}
    with seeded([Bug(_Pack._send, "payload.data).eq(beat)", "payload.data).eq(~beat)")]):
        assert run(name, **given)["values"]


# A text of 3 bytes is the longest one of a parser for messages of 7 bytes.
JUDGED = {
    "parser-bool": [b"", b"\1", b"\1\1", b"\1\0\0"],
    "parser-string": [
        *(b"\3\0\0\0ttt", b"\3\0\0\0tt", b"\3\0\0\0tttt", b"\4\0\0\0tttt"),
        *(b"\0\0\0\0", b"\0\0\0", b"\0\0\0\1"),
    ],
}
_OTHER_STATUS = Bug(
    PacketJudge._judge,
    "Mux(state.fails, self.code, Status.OK)",
    "Mux(state.fails, Status.OK, Status.STRING)",
)


def judge(name, packets):
    """Send packets of a byte per beat through a parser; return the claims that each breaks."""
    given, runs = {"status_ready": 1, "status_mark": 1}, []
    for packet in packets:
        # A packet without bytes is a beat, too.
        beats = [value | 1 << 8 for value in packet] or [0]
        beats[-1] |= 1 << 9
        sent = [{"i_choice": beat, "i_valid": 1} for beat in beats]
        # A parser takes a beat at least in every other cycle.
        steps = [each for beat in sent for each in (beat, {})] + [{}] * 14
        runs.append([{**each, **given} for each in steps])
    return play_each(STUDIES[name].build, runs)


@pytest.mark.parametrize("name", JUDGED)
def test_a_parser_and_its_scene_judge_each_packet_alike(name):
    packets = JUDGED[name]
    assert judge(name, packets) == [set()] * len(packets)
    with seeded([_OTHER_STATUS]):
        assert judge(name, packets[:2]) == [{"statuses"}] * 2


def lengths(first, second):
    """Execute the length that renews the budget, and then one of what the budget has left."""
    given = {"issue": 1, "counted": 1}
    # The number of a step is chosen in its first cycle, and its length comes a cycle later.
    steps = [given, {**given, "step_choice": 1, "count": first}, {"count": second}]
    return steps + [{}] * 8


# A budget of 688 bytes, and elements of 12 bytes; one of 658 bytes, elements of 16 bytes, and
# each length claims 14 bytes less. So the first length leaves 256 bytes.
BUDGETS = {"claims-noetic": (36, 256), "claims-lyrical": (26, 270)}


@pytest.mark.parametrize("name", BUDGETS)
def test_a_length_fails_if_it_claims_a_byte_more_than_is_left(name):
    first, most = BUDGETS[name]
    for count, other in ((most, 1), (most + 1, 0)):
        steps = lengths(first, count)
        assert not any(play(STUDIES[name].build, steps)[0].values())
        # A block of the other opinion is wrong.
        with seeded([Bug(Claims.__init__, "eq(subtracts & left[-1])", f"eq(subtracts & {other})")]):
            broken = play(STUDIES[name].build, steps)[0]
        assert broken["fails"]


def alone(count):
    """Execute one length."""
    return [{"issue": 1, "counted": 1}, {"count": count}, *[{}] * 8]


_PENDING = "starts | loads | multiplies | exceeds"
_REFUSED = "eq(self.fails | (state.refused & ~state.issue))"
# A length that nobody has started fails; `pending` lacks a cycle, or has one too many; the refusal
# of a length that has not failed, none of one that has, and one that does not wait.
CYCLES_OF = [
    ("fails", "exceeds.eq(subtracts & left[-1])", "exceeds.eq(1)"),
    *(
        ("pending", _PENDING, _PENDING.replace(f"{name} | ", ""))
        for name in ("starts", "loads", "multiplies")
    ),
    ("pending", _PENDING, _PENDING.replace("exceeds", "subtracts")),
    ("refused", _REFUSED, "eq(1)"),
    ("refused", _REFUSED, "eq(state.refused & ~state.issue)"),
    ("refused", _REFUSED, "eq(self.fails)"),
]


@pytest.mark.parametrize(("claim", "old", "new"), CYCLES_OF)
@pytest.mark.parametrize("name", BUDGETS)
def test_each_cycle_of_a_signal_counts(name, claim, old, new):
    first, most = BUDGETS[name]
    with seeded([Bug(Claims.__init__, old, new)]):
        runs = {"fails": [{}] * 8, "pending": alone(first), "refused": lengths(first, most + 1)}
        assert play(STUDIES[name].build, runs[claim])[0][claim]
