"""A tracker finds each unit that is lost, repeated, changed or out of order, and no other."""

from __future__ import annotations

import pytest
from amaranth.hdl import Value
from amaranth.lib import stream

from firm_hdl.formal.tracking import BeatTracker, Tracker
from firm_hdl.gateware.signatures import packet_layout
from tests.formal.play import play

MOST = 6


def follow(scene):
    """Beats of two bytes go in and out as the inputs say; there is no block between them."""
    ports = {}
    for name in ("in", "out"):
        port = ports[name] = stream.Signature(packet_layout(2)).create()
        scene.m.d.comb += Value.cast(port.payload).eq(scene.free(19, f"{name}_beat"))
    decides, keeps = scene.free(1, "decides"), scene.free(1, "keeps")
    moves = {name: scene.free(1, name) for name in ports}
    scene.bytes = Tracker(scene, "unit", MOST)
    scene.bytes.enter(moves["in"], ports["in"].payload, decides=decides, keeps=keeps)
    scene.bytes.leave(moves["out"], ports["out"].payload)
    scene.place, scene.is_end = scene.bytes.place, scene.bytes.is_end
    scene.inside, scene.hits = scene.bytes.inside, scene.bytes.hits


def beat(data: str, last: int = 0) -> int:
    """Return a beat of up to two bytes, as text in the order of the wire."""
    return int.from_bytes(data.encode(), "little") | len(data) << 16 | last << 18


def comes(data: str, last: int = 0, *, mark: int | None = None, **more: int) -> dict[str, int]:
    """Return a beat that enters and is kept; the unit of the lane `mark` is the chosen one."""
    chosen = {} if mark is None else {"unit_mark": 1, "unit_lane": mark}
    return {"in": 1, "in_beat": beat(data, last), "decides": 1, "keeps": 1, **chosen, **more}


def goes(data: str, last: int = 0) -> dict[str, int]:
    return {"out": 1, "out_beat": beat(data, last)}


# Units: a b c end d end.
CAME = [("ab", 0), ("c", 1), ("d", 1)]
UNITS = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)]


def came(unit: tuple[int, int]) -> list[dict[str, int]]:
    """Let all beats enter, and choose the unit of a beat and a lane."""
    return [
        comes(*each, mark=unit[1] if unit[0] == number else None)
        for number, each in enumerate(CAME)
    ]


@pytest.mark.parametrize("unit", UNITS)
def test_what_leaves_as_it_came_breaks_nothing(unit):
    # Once in the same beats, once with other beats of the same bytes; then another packet.
    for gone in (CAME, [("a", 0), ("bc", 1), ("d", 1)]):
        steps = [*came(unit), *(goes(*each) for each in gone), comes("e", 1), goes("e", 1)]
        broken, values = play(follow, steps, "hits", "inside")
        assert broken == {"order": [], "nothing extra": []}
        assert sum(hits for hits, _ in values) == 1
        assert [inside for _, inside in values] == [0, 2, 4, 6, *values_after(gone), 0, 2]


def values_after(gone: list[tuple[str, int]]) -> list[int]:
    """Return the numbers of units inside, as each beat leaves."""
    left = 6
    found = []
    for data, last in gone[:-1]:
        left -= len(data) + last
        found.append(left)
    return found


@pytest.mark.parametrize(
    ("gone", "unit"),
    [
        ([("ax", 0)], (0, 1)),
        ([("xb", 0)], (0, 0)),
        ([("b", 0)], (0, 0)),
        ([("ab", 0), ("x", 1)], (1, 0)),
        # An end in the place of a byte, and a byte in the place of an end.
        ([("a", 1)], (0, 1)),
        ([("ab", 0), ("cd", 1)], (1, 1)),
        ([("ab", 0), ("c", 0), ("d", 0)], (1, 1)),
        # The packets in the wrong order, and the second one twice.
        ([("d", 1)], (0, 0)),
        ([("ab", 0), ("c", 1), ("c", 1)], (2, 0)),
    ],
)
def test_another_unit_in_the_place_of_the_chosen_one_is_out_of_order(gone, unit):
    broken = play(follow, [*came(unit), *(goes(*each) for each in gone)])[0]
    assert broken["order"] == [len(CAME) + len(gone) - 1]


@pytest.mark.parametrize(("first", "lane"), [(("a", 0), 1), (("a", 1), 2), (("", 1), 1)])
def test_a_lane_behind_the_units_of_a_beat_chooses_none(first, lane):
    # So the mark of the next beat still chooses.
    steps = [comes(*first, mark=lane), comes("c", 1, mark=0), goes(*first), goes("c", 1)]
    broken, values = play(follow, steps, "hits")
    assert broken == {"order": [], "nothing extra": []}
    assert values == [(0,), (0,), (0,), (1,)]


def test_a_unit_more_than_came_is_extra():
    gone = [*CAME, ("e", 0)]
    broken = play(follow, [*came((0, 0)), *(goes(*each) for each in gone)])[0]
    assert broken == {"order": [], "nothing extra": [6]}


def test_units_that_stay_inside_are_found_by_their_number():
    steps = [*came((0, 0)), comes(""), {}]
    assert play(follow, steps)[0]["nothing extra"] == []
    # One unit more than a block holds.
    assert play(follow, [*came((0, 0)), comes("e"), {}])[0]["nothing extra"] == [4]


def test_what_is_not_kept_does_not_leave():
    undecided = {"decides": 0, "keeps": 0}
    lost = [comes("ab", mark=1, **undecided), comes("c", 1, keeps=0)]
    kept = [comes("de", **undecided), comes("f", 1)]
    gone = [goes("de"), goes("f", 1)]
    broken, values = play(follow, [*lost, *kept, *gone], "inside", "hits")
    assert broken == {"order": [], "nothing extra": []}
    assert values == [(0, 0)] * 4 + [(4, 0), (2, 0)]
    assert play(follow, [*lost, goes("ab")])[0]["nothing extra"] == [2]


@pytest.mark.parametrize("lane", [0, 1])
def test_a_unit_is_found_behind_others_while_those_leave(lane):
    """A packet is decided while the one before it leaves."""
    undecided = {"decides": 0, "keeps": 0}
    start = [
        comes("ab", 1),
        comes("cd", mark=lane, **undecided),
        {**comes("e", 1), **goes("ab", 1)},
    ]
    good = [*start, goes("cd"), goes("e", 1)]
    broken, values = play(follow, good, "hits", "place", "is_end")
    assert broken == {"order": [], "nothing extra": []}
    assert [each[0] for each in values] == [0, 0, 0, 1, 0]
    assert values[-1][1:] == (lane, 0)
    wrong = goes("xd" if lane == 0 else "cx")
    assert play(follow, [*start, wrong])[0]["order"] == [3]


def test_the_place_of_an_end_is_the_size_of_its_packet():
    undecided = {"decides": 0, "keeps": 0}
    steps = [comes("z", 1), comes("ab", **undecided), comes("c", 1, mark=1), {}]
    assert play(follow, steps, "place", "is_end")[1][-1] == (3, 1)


def follow_beats(scene):
    tracker = BeatTracker(scene, "beat", 3)
    tracker.enter(scene.free(1, "in"), scene.free(4, "came"))
    tracker.leave(scene.free(1, "out"), scene.free(4, "gone"))


@pytest.mark.parametrize("bit", range(4))
def test_every_bit_of_a_beat_is_compared(bit):
    steps = [
        {"in": 1, "came": 0b0110, "beat_which_choice": bit},
        {"in": 1, "came": 0b1010, "beat_mark": 1},
        {"out": 1, "gone": 0b0110},
        {"out": 1, "gone": 0b1010},
    ]
    assert play(follow_beats, steps)[0] == {"order": [], "nothing extra": []}
    steps[-1]["gone"] ^= 1 << bit
    assert play(follow_beats, steps)[0] == {"order": [3], "nothing extra": []}
    steps[-1]["gone"] = 0b1010 ^ (0b1111 ^ 1 << bit)
    assert play(follow_beats, steps)[0]["order"] == []
