"""Scenes of deserializers, played with packets by hand: each part of a claim tells of a bug."""

from __future__ import annotations

import pytest

from firm_hdl.formal.blocks import all_studies
from firm_hdl.formal.blocks.converters import BOOL, JOY, JOY_CDR, TIME_CDR
from firm_hdl.formal.bugs import Bug, seeded
from firm_hdl.gateware.mover import _MoverLogic as _Move
from firm_hdl.gateware.parse.judge import Judge
from firm_hdl.gateware.parse.sequencer import _SequencerLogic as _Sequence
from firm_hdl.sim.payloads import packet_beats
from tests.formal.play import play_each

STUDIES = {study.name: study for study in all_studies()}
FLAG, WORDS = "deserializer-bool-noetic-1", "deserializer-joyfeedback-noetic-1"
JOYS, TIMES = "deserializer-joyfeedback-lyrical-4", "deserializer-time-lyrical-8"
KINDS = {FLAG: BOOL, WORDS: JOY, JOYS: JOY_CDR, TIMES: TIME_CDR}
BODY = bytes(range(0xA1, 0xAD))
CDR = b"\0\1\0\0"
# Without a header: packets that are right, too short or too long. In CDR, 3 bytes more are right.
PACKETS = {
    FLAG: [b"", b"\0", b"\2", BODY[:2]],
    WORDS: [BODY[:size] for size in (0, 1, 2, 3, 5, 6, 7)],
}
# The last 2 bytes of a header may have any value.
IN_CDR = [
    *(b"\0", b"\1\1", CDR[:2], CDR, b"\0\1\xff\xff" + BODY[:8]),
    *(header + BODY[:8] for header in (b"\1\1\0\0", b"\0\0\0\0", b"\0\3\0\0")),
    *(CDR + BODY[:size] for size in (1, 7, 8, 9, 11, 12)),
]
PACKETS |= {JOYS: IN_CDR, TIMES: IN_CDR}


def broken(name, cases, *, apart=1, held=()):
    """Send packets to a deserializer, from a reset on for each case.

    Parameters
    ----------
    cases : iterable of (bytes, int, int)
        A packet, which is sent twice; the leaf that is compared, or the number of leaves for the
        status; a byte of the leaf.
    apart : int
        Cycles from a beat to the next one.
    held : collection of int
        Leaves that are never taken.

    Returns
    -------
    list of set of str
        The claims that each case breaks.
    """
    bus = int(name.rsplit("-", 1)[1])
    ready = {f"o{n}_ready": int(n not in held) for n in range(len(KINDS[name].fields) + 1)}
    runs = []
    for packet, which, part in cases:
        given = ready | {"which_choice": which, "part_choice": part, "mark": 1}
        runs.append([])
        for beat in [*packet_beats(packet, bus)] * 2:
            runs[-1] += [given | {"i_choice": beat, "i_valid": 1}, *[given] * (apart - 1)]
        runs[-1] += [given] * 16
    return play_each(STUDIES[name].build, runs)


def all_cases(name):
    """Return all packets with the status, and with the last byte of a leaf, of each one in turn."""
    fields = KINDS[name].fields
    cases = []
    for number, packet in enumerate(PACKETS[name]):
        leaf = number % len(fields)
        cases += [(packet, len(fields), 0), (packet, leaf, fields[leaf][1] - 1)]
    return cases


@pytest.mark.parametrize("name", KINDS)
def test_no_packet_breaks_a_claim_about_a_right_block(name):
    assert set().union(*broken(name, all_cases(name))) == set()


def status(bit):
    return Bug(_Move._report, "eq(status)", f"eq(status.as_value() ^ {bit})")


def value(change):
    return Bug(_Move._put, "cast(target).eq(value)", f"cast(target).eq(value ^ {change})")


# Bytes of a packet that are not good are not 0; a packet is taken to be cut before it ends.
_ANY = Bug(_Move._put, "self.m.If(good)", "self.m.If(1)")
_CUT = Bug(Judge._find, "cut.eq(self.ended & ~state.present)", "cut.eq(~state.present)")
# A packet that is too long is judged before it ends.
_EARLY = Bug(_Sequence._decide, "state.ends_message & c.ended)", "state.ends_message)")
_TAKEN = "with m.If(port.ready)"
# A leaf, or a status, is transferred twice; a step writes its second leaf before its first one.
_TWICE = Bug(_Move.__init__, _TAKEN, "with m.If(port.ready & (port is mover.status))")
_AGAIN = Bug(_Move.__init__, _TAKEN, "with m.If(port.ready & (port is not mover.status))")
_PASSES = Bug(_Move._schedule, "[each.blocked for each in writers[: writer.slot]]", "[]")
# The first leaf is not offered.
_LACKS = Bug(_Move.__init__, "m.If(writer.go)", "m.If(writer.go & (writer.leaf != 0))")
# A bug, a packet with its leaf and byte, and the claim that is broken.
PARTS = [
    *((JOYS, status(bit), (CDR + BODY[:8], 3, 0), "statuses", {}) for bit in (1, 2, 4)),
    (WORDS, _EARLY, (BODY[:10], 3, 0), "statuses", {"apart": 3}),
    (WORDS, _TWICE, (BODY[:6], 0, 0), "one each", {}),
    (WORDS, _AGAIN, (BODY[:6], 0, 0), "one each", {}),
    (WORDS, value(0x80), (BODY[:6], 1, 0), "values", {}),
    (JOYS, value(1 << 31), (CDR + BODY[:8], 2, 3), "values", {}),
    (WORDS, _ANY, (BODY[:5], 2, 0), "values", {}),
    (WORDS, _CUT, (BODY[:6], 2, 0), "values", {"apart": 3}),
    (JOYS, _PASSES, (CDR + BODY[:8], 0, 0), "wire order", {"held": [0]}),
    (WORDS, _LACKS, (BODY[:6], 0, 0), "wire order", {"held": [0, 1, 2]}),
]


@pytest.mark.parametrize(("name", "bug", "case", "claim", "options"), PARTS)
def test_a_bug_that_one_part_of_a_claim_finds_breaks_the_claim(name, bug, case, claim, options):
    with seeded([bug]):
        (found,) = broken(name, [case], **options)
    assert claim in found
