# amaranth: UnusedElaboratable=no
"""Messages from a seed, and their cycles."""

from __future__ import annotations

from itertools import islice

import pytest

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.bench import cycles
from firm_hdl.bench.cycles import Stated, count_cycles, values
from firm_hdl.model import Array, Field, Message, Sequence, String
from firm_hdl.model.types import PRIMITIVES
from tests.strategies import make


def test_values_have_the_stated_lengths_and_repeat() -> None:
    message = make(
        "ros2", {"s": "string", "short": "string<=2", "q": "uint8[]", "few": "int16[<=4]"}
    )
    stated = Stated(count=4, characters=(4, 10), elements=(3, 8), seed=5)
    drawn = list(islice(values(message, stated), 200))
    assert {len(value["s"]) for value in drawn} == set(range(4, 11))
    assert {len(value["short"]) for value in drawn} == {2}
    assert {len(value["q"]) for value in drawn} == set(range(3, 9))
    assert {len(value["few"]) for value in drawn} == {3, 4}
    assert drawn == list(islice(values(message, stated), 200))
    fields = (
        Field(name="s", type=String(bound=0)),
        Field(name="q", type=Sequence(element=PRIMITIVES["ros2"]["int8"], bound=0)),
    )
    nothing = Message(name="p/msg/Nothing", dialect="ros2", fields=fields)
    assert list(islice(values(nothing, stated), 9)) == [{"s": "", "q": []}] * 9
    assert drawn != list(islice(values(message, Stated(seed=6)), 200))


def test_each_type_and_each_seed_have_values_of_their_own() -> None:
    fields = (Field(name="n", type=PRIMITIVES["ros2"]["uint64"]),)
    messages = [Message(name=f"p/msg/{name}", dialect="ros2", fields=fields) for name in "AB"]
    drawn = [
        next(values(message, Stated(seed=seed)))["n"] for message in messages for seed in (0, 1)
    ]
    assert len(set(drawn)) == 4


def test_values_are_of_all_kinds() -> None:
    primitives = PRIMITIVES["ros2"]
    inner = Message(
        name="p/msg/In", dialect="ros2", fields=(Field(name="x", type=primitives["float32"]),)
    )
    outer = Message(
        name="p/msg/Out",
        dialect="ros2",
        fields=(
            Field(name="b", type=primitives["bool"]),
            Field(name="i", type=primitives["int8"]),
            Field(name="a", type=Array(element=inner, count=2)),
            Field(name="w", type=Sequence(element=String(wide=True))),
        ),
    )
    drawn = list(islice(values(outer), 100))
    assert {value["b"] for value in drawn} == {True, False}
    assert max(value["i"] for value in drawn) > 60 and min(v["i"] for v in drawn) >= 0
    assert all([set(each) for each in value["a"]] == [{"x"}] * 2 for value in drawn)
    assert all(3 <= len(value["w"]) <= 8 for value in drawn)


@pytest.mark.parametrize("component", [Deserializer, Serializer])
def test_a_fixed_size_takes_a_cycle_per_beat(component: type) -> None:
    message = load_message("geometry_msgs/msg/Twist")
    found = count_cycles(component(message), message)
    assert (found.bytes, found.beats, found.cycles) == (16 * 52, 16 * 7, 16 * 7)
    assert found.per_beat == 1 and found.bits_per_cycle == pytest.approx(59.43, abs=0.01)


@pytest.mark.parametrize("component", [Deserializer, Serializer])
def test_messages_end_with_their_status_and_not_with_their_last_leaf(component: type) -> None:
    # The last beat may have the terminating NUL alone, and no leaf.
    message = load_message("std_msgs/msg/String")
    found = count_cycles(component(message, bus_bytes=2), message)
    assert found.beats == found.cycles


def test_large_messages_are_fewer(monkeypatch: pytest.MonkeyPatch) -> None:
    message = load_message("geometry_msgs/msg/Twist")
    monkeypatch.setattr(cycles, "MOST_BEATS", 15)
    found = count_cycles(Deserializer(message), message)
    assert (found.messages.count, found.beats, found.cycles) == (3, 21, 21)
    monkeypatch.setattr(cycles, "MOST_BEATS", 1)
    assert count_cycles(Deserializer(message), message).messages.count == 1


@pytest.mark.parametrize(("component", "latency"), [(Deserializer, 5), (Serializer, 4)])
def test_latency_is_that_of_the_first_message(component: type, latency: int) -> None:
    message = load_message("std_msgs/msg/Bool")
    found = count_cycles(component(message), message, Stated(count=6))
    assert (found.latency, found.cycles, found.beats, found.bytes) == (latency, 6, 6, 30)
