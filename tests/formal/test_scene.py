"""What a scene, its sources and its claims mean, cycle by cycle, in Amaranth's simulator."""

from __future__ import annotations

from amaranth.hdl import Signal, Value
from amaranth.lib import stream

from firm_hdl.formal.streams import (
    packet_rules,
    packet_source,
    progress,
    rules,
    sink,
    source,
    starts_of,
)
from firm_hdl.gateware.signatures import packet_layout
from tests.formal.play import play


def bits(text: str, **more: str) -> list[dict[str, int]]:
    """Return steps with an input of one digit for each cycle, and others alike."""
    rows = {"a": text, **more}
    return [{name: int(row[cycle], 16) for name, row in rows.items()} for cycle in range(len(text))]


def test_a_rigid_value_is_that_of_the_first_cycle():
    def build(scene):
        scene.value = scene.rigid(4, "value")

    steps = [{"value_choice": value} for value in (9, 3, 0, 15)]
    assert play(build, steps, "value")[1] == [(9,)] * 4


def test_the_value_before_is_0_in_the_first_cycle():
    def build(scene):
        scene.before = scene.was(scene.free(4, "a"), "a")

    assert play(build, bits("5903"), "before")[1] == [(0,), (5,), (9,), (0,)]


def test_a_claim_is_broken_while_its_condition_does_not_hold():
    def build(scene):
        a = scene.free(2, "a")
        # A condition of several bits holds unless it is 0.
        scene.claim("any", a)
        # Claims of one name are one claim: either may be broken.
        scene.claim("both", a != 1)
        scene.claim("both", a != 3)

    assert play(build, bits("01230"))[0] == {"any": [0, 4], "both": [1, 3]}


def test_nothing_is_broken_from_the_cycle_on_in_which_an_assumption_fails():
    def build(scene):
        a = scene.free(4, "a")
        scene.claim("low", a[0] == 0)
        scene.assume(a[1] == 0)
        scene.assume(a[2] == 0)

    assert play(build, bits("0110"))[0] == {"low": [1, 2]}
    for failed in ("1", "2", "4", "3", "5"):
        # The assumption fails in cycle 2, alone or with the claim, and holds again later.
        expected = [1, 2, 3] if failed == "1" else [1]
        assert play(build, bits(f"01{failed}1"))[0] == {"low": expected}


def test_progress_is_broken_by_one_cycle_more():
    def build(scene):
        progress(scene, "moves", scene.free(1, "a"), 2)

    # Two cycles in a row are allowed, again and again; a third one shows in the cycle after it.
    assert play(build, bits("110110"))[0] == {"moves": []}
    assert play(build, bits("0111010"))[0] == {"moves": [4]}
    assert play(build, bits("111110"))[0] == {"moves": [3, 4, 5]}


def test_a_source_keeps_what_it_offered_until_it_is_taken():
    def build(scene):
        port = stream.Signature(4).create()
        source(scene, port, "i")
        sink(scene, port, "o")
        scene.valid, scene.payload = port.valid, port.payload

    offers, payloads, readies = "0100110", "7599386", "0001010"
    steps = [
        {"i_valid": int(offer), "i_payload": int(payload), "o_ready": int(ready)}
        for offer, payload, ready in zip(offers, payloads, readies, strict=True)
    ]
    values = play(build, steps, "valid", "payload")[1]
    assert [valid for valid, _ in values] == [0, 1, 1, 1, 1, 1, 0]
    # 5 is taken in cycle 3, and 3 in cycle 5.
    assert [payload for valid, payload in values if valid] == [5, 5, 5, 3, 3]


def packets(any_count: bool):
    def build(scene):
        port = stream.Signature(packet_layout(4)).create()
        beside = Signal(4, name="topic")
        packet_source(scene, port, "i", any_count=any_count, beside=[beside])
        sink(scene, port, "o")
        scene.last, scene.count, scene.topic = port.payload.last, port.payload.count, beside
        scene.starts = starts_of(scene.m, port, "o")

    return build


def choice(count: int, last: int, **more: int) -> dict[str, int]:
    """Return a choice of a packet source: 4 lanes of data, `count` in 3 bits, and `last`."""
    return {"i_choice": count << 32 | last << 35, "i_valid": 1, "o_ready": 1, **more}


def test_a_packet_source_offers_every_packet_that_is_legal_and_no_other():
    choices = [(0, 1), (2, 0), (0, 1), (4, 1), (7, 0), (1, 0), (3, 1), (6, 1), (1, 1)]
    steps = [choice(count, last) for count, last in choices]
    values = play(packets(False), steps, "count", "last", "starts")[1]
    # Beats are full but the last one; only a packet of one beat may have no bytes.
    assert values == [
        *((0, 1, 1), (4, 0, 1), (1, 1, 0), (4, 1, 1), (4, 0, 1), (4, 0, 0), (3, 1, 0)),
        *((4, 1, 1), (1, 1, 1)),
    ]
    # Where any count is allowed, this is not so in the last beat.
    values = play(packets(True), steps, "count")[1]
    assert values == [(0,), (2,), (1,), (4,), (7,), (1,), (3,), (4,), (1,)]


def test_what_is_beside_a_packet_is_as_stable_as_the_packet():
    steps = [
        choice(1, 1, i_topic_choice=5, o_ready=0),
        choice(2, 0, i_topic_choice=6, o_ready=0),
        choice(2, 0, i_topic_choice=7),
        choice(2, 1, i_topic_choice=9),
    ]
    values = play(packets(False), steps, "count", "last", "topic", "starts")[1]
    assert values == [(1, 1, 5, 1), (1, 1, 5, 1), (1, 1, 5, 1), (2, 1, 9, 1)]


def offered(scene):
    """Offer what the inputs say, without any rule."""
    port = stream.Signature(packet_layout(4)).create()
    beside = scene.free(2, "beside")
    scene.m.d.comb += [
        port.valid.eq(scene.free(1, "valid")),
        port.ready.eq(scene.free(1, "ready")),
        Value.cast(port.payload).eq(scene.free(36, "payload")),
    ]
    rules(scene, port, "o", beside)
    packet_rules(scene, port, "o")


def offer(count: int, last: int, *, data: int = 0, **more: int) -> dict[str, int]:
    return {"valid": 1, "payload": data | count << 32 | last << 35, **more}


def test_the_rules_of_streams():
    good = offer(4, 0, data=7)
    broken = play(offered, [good, good, {**good, "ready": 1}, {}, good, {}, {}])[0]
    assert broken == {"valid stays": [5], "payload stays": [5], "count": []}
    others = [offer(4, 0, data=1 << 31 | 7), offer(4, 0, data=7, beside=2), offer(4, 1, data=7)]
    for other in others:
        assert play(offered, [good, other])[0]["payload stays"] == [1]
        assert play(offered, [{**good, "ready": 1}, other])[0]["payload stays"] == []


def test_the_rules_of_packets():
    def legal(*before: dict[str, int]) -> list[tuple[int, int]]:
        """Return the counts, and whether the beat is the last one, that break no claim."""
        every = [(count, last) for last in (0, 1) for count in range(6)]
        # None of these beats is taken.
        broken = play(offered, [*before, *(offer(*each) for each in every)])[0]["count"]
        return [each for cycle, each in enumerate(every, len(before)) if cycle not in broken]

    first = [(4, 0), (0, 1), (1, 1), (2, 1), (3, 1), (4, 1)]
    assert legal() == first
    # Only a packet of one beat may have no bytes.
    assert legal(offer(4, 0, ready=1)) == [each for each in first if each != (0, 1)]
    # The packet begins anew behind a last beat, and has not begun before its first beat is taken.
    assert legal(offer(2, 1, ready=1)) == legal(offer(4, 0)) == first
    assert play(offered, [{**offer(1, 0), "valid": 0}])[0]["count"] == []
