"""What a board is judged by: room, oracles, counters that end or begin again, damaged packets."""

from __future__ import annotations

import pytest

from firm_hdl.node import read_description_text
from firm_hdl.verify.board import judge
from firm_hdl.verify.board.description import loop_text
from firm_hdl.verify.board.system import Boards
from firm_hdl.verify.board.talk import room_for
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from tests.frontend.workspace import make_files
from tests.node.bridge.fakes import FakeBoard
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


@pytest.mark.parametrize("way", ["in", "out"])
def test_cases_need_room_in_both_directions(way, capsys):
    """The memory of one direction is smaller than that of the other."""
    text = loop_text([STRING], "lyrical")
    line = next(each for each in text.splitlines() if f"/loopback/{way}/" in each)
    text = text.replace(line, line.replace("String}", "String, memory_bytes: 16}"))
    node = LoopNode(read_description_text(text))
    (loop,) = node.description.loops()
    assert room_for(node.description, loop) == 16
    sizes = []
    node.answers = lambda packet: sizes.append(len(packet)) or [packet]
    assert isinstance(verdicts(node, most_cases=20)[STRING], Passed)
    assert max(sizes) <= 16
    assert "cases are larger than the 16 bytes that the node takes" in capsys.readouterr().out


def test_a_limit_of_messages_counts_as_their_room(capsys):
    text = loop_text([STRING], "lyrical").replace("String}", "String, max_message_bytes: 20}")
    node = LoopNode(read_description_text(text))
    assert isinstance(verdicts(node, most_cases=20)[STRING], Passed)
    assert "larger than the 20 bytes that the node takes" in capsys.readouterr().out


def test_a_type_of_ones_own_is_judged_by_its_own_definition(tmp_path):
    """It has the name of a type of the distribution."""
    source = make_files(tmp_path, {"std_msgs/msg/Bool.msg": "uint64 number\n"})
    node = LoopNode(described(BOOL, paths=[str(source)]))
    seen = []
    node.answers = lambda packet: seen.append(len(packet)) or [packet]
    assert isinstance(verdicts(node, broken=False)[BOOL], Passed)
    assert set(seen) == {4 + 8}


def test_a_type_that_no_library_can_confirm_is_not_sent(monkeypatch):
    def unable(message, wire, cases, options, result, oracle):
        result.obstacle = NotJudged("nobody can")

    monkeypatch.setattr(judge, "confirm_cases", unable)
    node = LoopNode(ONE)
    assert verdicts(node) == {STRING: NotJudged("nobody can")}
    assert node.heard == 0


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


class TalksAhead(LoopNode):
    """While the first type is tested, it sends a packet of the second."""

    def take(self, frame):
        frames = super().take(frame)
        if self.heard == 3:
            self.heard += 1
            return [*frames, *self.send(list(self.loops.values())[1], b"\0\1\0\0\7")]
        return frames


def test_what_came_before_a_type_does_not_count_for_it():
    found = verdicts(TalksAhead(described(*BOTH)), broken=False)
    assert [type(each) for each in found.values()] == [Passed, Passed]


def test_a_case_may_be_as_long_as_the_limit():
    text = loop_text([BOOL], "lyrical").replace("Bool}", "Bool, max_message_bytes: 5}")
    assert verdicts(LoopNode(read_description_text(text))) == {BOOL: Passed(5)}


class DropsAndCounts(LoopNode):
    """Its gate drops a good packet, and counts that."""

    def status(self, message):
        return "TRUNCATED" if self.heard == 3 else super().status(message)


def test_a_packet_that_is_missing_does_not_hide_how_it_was_counted():
    failures = verdicts(DropsAndCounts(ONE), silent_seconds=0.3, broken=False)[STRING].failures
    assert "board: 1 of 7 packets did not come back" in failures[0]
    name = "/loopback/in/std_msgs/String"
    assert f"board: 'truncated' of {name} counts 1 instead of 0" in failures


@pytest.mark.parametrize(
    ("given", "key"),
    [
        ({}, ""),
        ({"node": "n.yaml"}, "node=n.yaml,"),
        ({"most_cases": 7}, "cases=7,"),
        ({"broken": False}, "no-broken,"),
        ({"references": ("a", "b")}, "references=a+b,"),
        ({"references": ()}, "references=,"),
        ({"paths": ("x", "y")}, "path=x,path=y,"),
        (
            {"node": "n", "most_cases": 1, "broken": False, "references": ("a",), "paths": ("x",)},
            "node=n,cases=1,no-broken,references=a,path=x,",
        ),
    ],
)
def test_a_test_is_known_by_all_that_determines_it(given, key):
    request = Request(board="b", seed=3, **given)
    (test,) = Boards(ONE, request, FakeBoard(LoopNode(ONE))).tests
    assert f"{test.options}," == f"board=b,seed=3,{key}"
    assert (test.system, test.distro, test.type) == ("board", "lyrical", STRING)
    assert (test.wire, test.bus_bytes, test.same) == ("cdr", 8, ("lyrical",))


class DropsAndFlips(LoopNode):
    """It drops the third packet, and the fifth comes back with another byte."""

    def answers(self, packet):
        if self.heard != 3:
            yield packet[:-1] + bytes([packet[-1] ^ (self.heard == 5)])


def test_packets_are_only_called_missing_if_all_others_are_right():
    failures = verdicts(DropsAndFlips(ONE), silent_seconds=0.3, broken=False)[STRING].failures
    assert failures[0].startswith("board: packet 2 of 7 differs at byte ")
    assert "did not come back" not in failures[0]


@pytest.mark.parametrize(
    ("got", "wanted", "missing"),
    [
        ("abc", "abc", []),
        ("ac", "abc", [1]),
        ("", "ab", [0, 1]),
        ("b", "ab", [0]),
        # Packets that are equal: the last one of them is missing.
        ("aa", "aaa", [2]),
        # More than expected, another one, and another order.
        ("abcd", "abc", []),
        ("ax", "abc", []),
        ("abx", "abcd", []),
        ("cb", "abc", []),
    ],
)
def test_which_packets_are_missing(got, wanted, missing):
    found = judge._missing(*([letter.encode() for letter in text] for text in (got, wanted)))
    assert found == missing


def test_many_missing_packets_are_counted_and_four_are_named():
    run = judge._Run(
        where="here",
        packets=[b"%d" % n for n in range(9)],
        names=[f"n{n}" for n in range(9)],
        statuses=["OK"] * 9,
        # The first one has no answer, so it is not missing.
        answers=[None, *(b"%d" % n for n in range(1, 9))],
    )
    (text,) = judge._differences(run, [b"1", b"3"])
    assert text == "here: 6 of 8 packets did not come back: n2; n4; n5; n6 and 2 more"
    (text,) = judge._differences(run, [b"%d" % n for n in (1, 2, 5, 7)])
    assert text == "here: 4 of 8 packets did not come back: n3; n4; n6; n8"


def test_a_damaged_packet_is_cut_to_the_room_of_the_node():
    """What is larger is dropped for its size, which would hide its damage."""
    text = loop_text([STRING], "lyrical").replace("String}", "String, memory_bytes: 16}")
    node = LoopNode(read_description_text(text))
    sizes, status = [], node.status
    node.status = lambda message: sizes.append(len(message.packet)) or status(message)
    for seed in range(3):
        assert isinstance(verdicts(node, most_cases=20, seed=seed)[STRING], Passed)
    assert max(sizes) == 16


def test_one_case_for_each_kind_of_damage_is_damaged_and_the_seed_decides_how(monkeypatch):
    original, asked = judge.broken_packets, []

    def broken_packets(plan, sample, rng):
        asked.append(([case.what for case in sample], rng.getstate()[1][:3]))
        return original(plan, sample, rng)

    monkeypatch.setattr(judge, "broken_packets", broken_packets)
    monkeypatch.setattr(judge, "DAMAGES", [None] * 4)
    both = described(*BOTH)
    for seed, names in ((1, [STRING]), (1, [STRING]), (2, [STRING]), (1, [BOOL])):
        verdicts(LoopNode(both), names=names, node="n.yaml", seed=seed, most_cases=13)
    cases = [len(names) for names, _ in asked]
    # Every third of 13 cases, and each of five.
    assert cases == [5, 5, 5, 5]
    assert [name.split()[1] for name in asked[0][0]] == ["0", "3", "6", "9", "12"]
    states = [state for _, state in asked]
    assert states[0] == states[1] and len(set(states)) == 3
