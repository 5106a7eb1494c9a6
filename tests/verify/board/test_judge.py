"""What a board is judged by: room, oracles, counters that end or begin again, damaged packets."""

from __future__ import annotations

import pytest

from firm_hdl.node import read_description_text
from firm_hdl.verify.board.description import loop_text
from firm_hdl.verify.results.verdict import Failed, Passed
from tests.frontend.workspace import make_files
from tests.verify.board.fakes import BOTH, STRING, LoopNode, described, verdicts

ONE = described(STRING)
BOOL = BOTH[0]
MOST = (1 << 32) - 1


def test_without_damage_only_good_packets_are_sent():
    node = LoopNode(ONE)
    assert verdicts(node, broken=False) == {STRING: Passed(7)}
    assert node.heard == 7


class LosesOneBehindDamage(LoopNode):
    """The last good packet of all does not come back."""

    def answers(self, packet):
        if self.heard < 7 + 2 * 6:
            yield packet
        self.last = packet


def test_a_packet_that_is_lost_behind_damaged_ones_is_named_by_its_bytes():
    node = LosesOneBehindDamage(ONE)
    failures = verdicts(node, silent_seconds=0.3)[STRING].failures
    (text,) = (each for each in failures if "did not come back" in each)
    assert text.startswith("board, damaged packets: 1 of ") and text.endswith(node.last.hex())


def test_a_type_of_ones_own_is_judged_by_its_own_definition(tmp_path):
    """It has the name of a type of the distribution."""
    source = make_files(tmp_path, {"std_msgs/msg/Bool.msg": "uint64 number\n"})
    node = LoopNode(described(BOOL, paths=[str(source)]))
    seen = []
    node.answers = lambda packet: seen.append(len(packet)) or [packet]
    assert isinstance(verdicts(node, broken=False)[BOOL], Passed)
    assert set(seen) == {4 + 8}


class Wraps(LoopNode):
    """Its counters have 32 bits: those of bytes begin again, and all others end."""

    def count(self, topic, name, by=1):
        super().count(topic, name, by)
        if name == "bytes_low":
            self.counters[topic, name] %= MOST + 1
        else:
            self.counters[topic, name] = min(MOST, self.counters[topic, name])


@pytest.mark.parametrize(("name", "value"), [("bytes_low", MOST - 30), ("passed", MOST - 2)])
def test_counters_of_32_bits_may_be_full(name, value):
    node = Wraps(ONE)
    for came, back in ONE.loops():
        node.counters[came.id, name] = node.counters[back.id, name] = value
    assert verdicts(node) == {STRING: Passed(7)}


class CountsLost(LoopNode):
    """Its link says that it lost a message, and a packet is missing."""

    def answers(self, packet):
        if self.heard != 3:
            yield packet
        else:
            self.count(0, "full")


def test_what_the_link_of_the_board_lost_is_told_with_the_failure():
    failures = verdicts(CountsLost(ONE), silent_seconds=0.3)[STRING].failures
    assert "board: messages and frames: 1 full on the way to it" in failures


class StragglesLater(LoopNode):
    """A packet of the first type comes once more when the second is opened."""

    def take(self, frame):
        frames = super().take(frame)
        topic = frame[2]
        if topic and topic != self.first and not self.is_late:
            self.is_late = True
            return [*self.send(self.loops[topic], b"\0\1\0\0\7"), *frames]
        return frames


def test_a_packet_that_nobody_asked_for_fails_its_type():
    node = StragglesLater(described(*BOTH))
    node.first, node.is_late = next(iter(node.loops)), False
    first, second = verdicts(node).values()
    assert isinstance(first, Passed) and isinstance(second, Failed)


class DropsAndCounts(LoopNode):
    """Its gate drops a good packet, and counts that."""

    def status(self, message):
        return "TRUNCATED" if self.heard == 3 else super().status(message)


def test_a_packet_that_is_missing_does_not_hide_how_it_was_counted():
    failures = verdicts(DropsAndCounts(ONE), silent_seconds=0.3, broken=False)[STRING].failures
    assert "board: 1 of 7 packets did not come back" in failures[0]
    name = "/loopback/in/std_msgs/String"
    assert f"board: 'truncated' of {name} counts 1 instead of 0" in failures


def test_a_damaged_packet_is_cut_to_the_room_of_the_node():
    """What is larger is dropped for its size, which would hide its damage."""
    text = loop_text([STRING], "lyrical").replace("String}", "String, memory_bytes: 16}")
    node = LoopNode(read_description_text(text))
    sizes, status = [], node.status
    node.status = lambda message: sizes.append(len(message.packet)) or status(message)
    for seed in range(3):
        assert isinstance(verdicts(node, most_cases=20, seed=seed)[STRING], Passed)
    assert max(sizes) == 16
