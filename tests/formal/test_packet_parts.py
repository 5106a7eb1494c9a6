"""Scenes of packet parts in Amaranth's simulator: each part of a claim tells.

As in `test_played.py`, each bug is one that the other parts of the claim do not find.
"""

from __future__ import annotations

import pytest

from firm_hdl.formal.bugs import Bug, seeded
from firm_hdl.gateware.packets.arbiter import PacketArbiter
from firm_hdl.gateware.packets.crossing import PacketCrossing
from firm_hdl.gateware.packets.fifo import PacketFifo
from firm_hdl.gateware.packets.reader import PacketReader
from firm_hdl.gateware.packets.router import PacketRouter
from firm_hdl.gateware.packets.slice import StreamSlice
from tests.formal.play import play
from tests.formal.test_played import STUDIES, run

_FIFO, _ROUTE, _CROSS = PacketFifo.elaborate, PacketRouter.elaborate, PacketCrossing.elaborate
_SIZE, _OUTCOME = "self.size.eq(reader.size)", "self.outcome.eq(writer.outcome)"
_SOURCE = "self.source.eq(out.o.payload.source)"
_OUT = "out.eq(Mux(ready, incoming, second))"


def outcome(before, after):
    """Return the text of a FIFO that gives one outcome as another."""
    is_before = f"(writer.outcome == Outcome.{before})"
    other = f"{is_before} * (Outcome.{before}.value ^ Outcome.{after}.value)"
    return f"Value.cast(self.outcome).eq(Value.cast(writer.outcome) ^ {other})"


PARTS = [
    # What is beside the payload stays, too.
    (
        "arbiter",
        "payload stays",
        PacketArbiter.elaborate,
        _SOURCE,
        "self.source.eq(Mux(self.packets_out.ready, out.o.payload.source, 0))",
    ),
    # An outcome in place of another one.
    *(
        ("fifo-drop-1", "outcome", _FIFO, _OUTCOME, outcome(*each))
        for each in (
            *(("LARGE", "KEPT"), ("KEPT", "LARGE"), ("ABORTED", "KEPT"), ("ABORTED", "FULL")),
            *(("KEPT", "ABORTED"), ("LARGE", "ABORTED")),
        )
    ),
    # While the link waits, nothing is refused.
    ("fifo-wait-1", "outcome", _FIFO, _OUTCOME, outcome("KEPT", "FULL")),
    # None, and one without a packet.
    ("fifo-wait-1", "one outcome", _FIFO, "ended.eq(writer.ended)", "ended.eq(0)"),
    ("fifo-wait-1", "one outcome", _FIFO, "ended.eq(writer.ended)", "ended.eq(1)"),
    # A counter that does not count, or that counts others.
    *(
        ("fifo-drop-1", "counters", _FIFO, f'"{name}": Outcome.{old}', f'"{name}": Outcome.{new}')
        for name, old, new in (
            ("passed", "KEPT", "FULL"),
            ("aborted", "ABORTED", "KEPT"),
            ("large", "LARGE", "FULL"),
        )
    ),
    ("router", "counters", _ROUTE, '"unknown": ends & ~to.any()', '"unknown": ends'),
    ("router", "counters", _ROUTE, '"routed": ends & to.any()', '"routed": 0'),
]


@pytest.mark.parametrize(("name", "claim", "function", "old", "new"), PARTS)
def test_a_bug_that_one_part_of_a_claim_finds_breaks_the_claim(name, claim, function, old, new):
    with seeded([Bug(function, old, new)]):
        assert run(name)[claim]


# The first unit is followed: a byte of a lane, or a bit of a beat with its count and its end.
FOLLOWED = [
    *(
        ("slice", StreamSlice.elaborate, _OUT, f"{_OUT[:-1]} ^ {1 << bit})", {"unit_lane": lane})
        for bit, lane in ((0, 0), (7, 0), (8, 1), (15, 1))
    ),
    *(
        (
            "crossing",
            _CROSS,
            "eq(fifo.r_data)",
            f"eq(fifo.r_data ^ {1 << bit})",
            {"beat_which_choice": bit},
        )
        for bit in (0, 7, 8, 9)
    ),
]


@pytest.mark.parametrize(("name", "function", "old", "new", "given"), FOLLOWED)
def test_each_bit_of_what_is_followed_counts(name, function, old, new, given):
    given = {"unit_mark": 1, "beat_mark": 1, "write_edge": 1, "read_edge": 1, **given}
    assert not any(run(name, **given).values())
    with seeded([Bug(function, old, new)]):
        assert run(name, **given)["order"]


def sizes(lengths):
    """Send packets of so many beats of one byte through a FIFO, and take each beat late."""
    lasts = [at == length - 1 for length in lengths for at in range(length)]
    beats = [{"i_valid": 1, "i_choice": 1 << 8 | last << 9} for last in lasts]
    steps = [each for beat in beats for each in (beat, *[{}] * 9, *[{"o_ready": 1}] * 2)]
    return [{**each, "beat_mark": 1} for each in steps]


@pytest.mark.parametrize(
    ("lengths", "wrong", "claim"),
    [
        # The first beat is followed, and is the last one of its packet.
        ([1], "1", "size"),
        # The size is that of the whole packet with the beats before the last one, too.
        ([2], "~self.packets_out.payload.last", "size"),
        # The size changes while a beat waits.
        ([1, 2], "self.packets_out.ready", "payload stays"),
    ],
)
def test_the_size_of_a_packet_is_right_with_each_beat(lengths, wrong, claim):
    build, steps = STUDIES["fifo-wait-1"].build, sizes(lengths)
    assert not any(play(build, steps)[0].values())
    with seeded([Bug(_FIFO, _SIZE, f"self.size.eq(reader.size + ({wrong}))")]):
        assert play(build, steps)[0][claim]


def test_a_packet_that_leaves_a_gate_has_all_its_bytes():
    build = STUDIES["gate-drop"].build
    beats = [{"i_valid": 1, "i_choice": 1 << 8 | last << 9} for last in (0, 1)]
    steps = [{**each, "o_ready": 1, "status_ready": 1} for each in (*beats, *[{}] * 40)]
    assert not any(play(build, steps)[0].values())
    word = "packets.payload.eq(self.word"
    with seeded([Bug(PacketReader.elaborate, word, f"{word}.as_value() ^ self.word.last << 8")]):
        # The number of bytes is beside those of the data, and is 0 with the last one.
        assert play(build, steps)[0]["nothing extra"]
