"""The test system ``board``: a right node passes, and every fault is found."""

from __future__ import annotations

import re

import pytest

from firm_hdl.errors import UserError
from firm_hdl.node import read_description_text
from firm_hdl.node.messages import MessageSender
from firm_hdl.verify.board.description import chosen_loops, loop_text
from firm_hdl.verify.board.system import Boards
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from tests.node.bridge.fakes import FakeBoard
from tests.verify.board.fakes import BOTH, STRING, LoopNode, described, verdicts

ONE = described(STRING)


def test_a_right_node_passes_and_its_packets_are_counted():
    node = LoopNode(described(*BOTH))
    found = verdicts(node)
    assert set(found) == set(BOTH)
    # A truth value has five cases, a string six, one of them also without its NUL.
    assert [each.cases for each in found.values() if isinstance(each, Passed)] == [5, 7]
    # And as many damaged packets, each with a good one behind it.
    assert node.heard == 5 + 7 + 2 * 5 + 2 * 6


def test_named_types_of_a_node_are_tested_alone():
    node = LoopNode(described(*BOTH))
    assert set(verdicts(node, names=[STRING], node="n.yaml")) == {STRING}
    assert chosen_loops(node.description, ["std_msgs/String"]) == node.description.loops()[1:]
    with pytest.raises(UserError, match=r"the node of the board has no loop of std_msgs/Char"):
        verdicts(node, names=["std_msgs/msg/Char"], node="n.yaml")


class FlipsAByte(LoopNode):
    """The last byte of one packet is another one."""

    def answers(self, packet):
        yield packet[:-1] + bytes([packet[-1] ^ 1]) if self.heard == 3 else packet


class Loses(LoopNode):
    """One packet does not come back; its counters say that it did."""

    def answers(self, packet):
        yield packet

    def send(self, topic, packet, tag=0):
        return [] if topic and self.heard == 3 else super().send(topic, packet, tag)


class Swaps(LoopNode):
    """Two packets come back in the other order."""

    def answers(self, packet):
        if self.heard == 3:
            self.kept = packet
            return
        yield packet
        if self.heard == 4:
            yield self.kept


class Doubles(LoopNode):
    """One packet comes back twice."""

    def answers(self, packet):
        yield packet
        if self.heard == 7:
            yield packet


class Straggles(LoopNode):
    """A packet comes once more, when all have come and the counters are read."""

    def control(self, message):
        late = self.send(self.last[0], self.last[1]) if self.heard == 7 else []
        self.heard += self.heard == 7
        return late + super().control(message)

    def send(self, topic, packet, tag=0):
        if topic:
            self.last = topic, packet
        return super().send(topic, packet, tag)


class Pads(LoopNode):
    """A packet has bytes behind it, which a receiver would ignore."""

    def answers(self, packet):
        yield packet + bytes(self.heard == 3)


class PassesAll(LoopNode):
    """Its gate drops nothing."""

    def status(self, message):
        return "OK"


class Refuses(LoopNode):
    """Its gate drops a good packet."""

    def status(self, message):
        return "TRUNCATED" if self.heard == 3 else super().status(message)


class Miscounts(LoopNode):
    """It drops the right packets, and counts them at the wrong place."""

    def count(self, topic, name, by=1):
        super().count(topic, "trailing" if name == "truncated" else name, by)


class CountsTooManyBytes(LoopNode):
    """It counts a byte that was not there."""

    def count(self, topic, name, by=1):
        super().count(topic, name, by + (name == "bytes_low" and self.heard == 3))


class CountsTooManyBytesBack(LoopNode):
    """It counts a byte that it did not send."""

    def count(self, topic, name, by=1):
        is_back = topic in self.loops.values()
        super().count(topic, name, by + (is_back and name == "bytes_low" and self.heard == 3))


class LosesAndSwaps(LoopNode):
    """One packet does not come back, and two others come in the other order."""

    def answers(self, packet):
        if self.heard == 3:
            self.kept = packet
        elif self.heard != 2:
            yield packet
        if self.heard == 4:
            yield self.kept


class Restarts(LoopNode):
    """It starts again after some packets."""

    def take(self, frame):
        if self.heard == 3:
            self.__init__(self.description)
        return super().take(frame)


class FallsSilent(LoopNode):
    """It says nothing after some packets."""

    def take(self, frame):
        return [] if self.heard >= 3 else super().take(frame)


class Mute(LoopNode):
    """It never says anything."""

    def take(self, frame):
        return []


class Other(LoopNode):
    """It has another description."""

    def __init__(self, description):
        super().__init__(described(STRING, "std_msgs/msg/Char"))


class RefusesToRead(LoopNode):
    """It has no counters."""

    def response(self, packet):
        return bytes([1, 2 * (packet[4] >= 16), 0, 0]) + super().response(packet)[4:]


class CutsResponses(LoopNode):
    """Its responses lack a byte."""

    def response(self, packet):
        return super().response(packet)[:-1]


class Babbles(LoopNode):
    """It sends what no node sends."""

    def take(self, frame):
        return [b"good morning, this is no frame", b""]


FAULTS = {
    FlipsAByte: r"board: packet 2 of 7 differs at byte \d+: .* \(case 2 of std_msgs/msg/String",
    Loses: r"board: 1 of 7 packets did not come back: case 2 of std_msgs/msg/String, seed 0",
    Swaps: r"board: packet 2 of 7 differs at byte",
    Doubles: r"board: 8 packets instead of 7",
    Straggles: r"board: 8 packets instead of 7",
    Pads: r"board: packet 2 of 7 differs at byte",
    PassesAll: r"damaged packets: '\w+' of /loopback/in/std_msgs/String counts 0 instead of",
    Refuses: r"board: 1 of 7 packets did not come back",
    Miscounts: r"damaged packets: 'truncated' of /loopback/in/std_msgs/String counts 0 instead of",
    CountsTooManyBytes: r"board: /loopback/in/std_msgs/String counts \d+ bytes instead of \d+",
    CountsTooManyBytesBack: r"board: /loopback/out/std_msgs/String counts \d+ bytes instead of",
    LosesAndSwaps: r"board: packet 1 of 7 differs at byte",
    Restarts: r"fake: the board has started again during the test",
    FallsSilent: r"fake: the board does not answer for 0\.2 s",
    Mute: r"^fake: the board does not answer for 0\.2 s$",
    Other: r"fake: the board's fingerprint is \w{16}, and that of the description is \w{16}",
    RefusesToRead: r"fake: the board refuses to read register \d+",
    CutsResponses: r"fake: the board does not answer for 0\.2 s$",
    Babbles: r"fake: the board does not answer for 0\.2 s \(frames: \d+ malformed\)",
}


@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_of_a_board_is_found(fault, capsys):
    verdict = verdicts(fault(ONE), ONE, silent_seconds=0.2)[STRING]
    assert isinstance(verdict, Failed)
    assert any(re.search(FAULTS[fault], text) for text in verdict.failures), verdict.failures
    printed = capsys.readouterr().out
    assert f"FAIL {STRING} (lyrical)\n    {verdict.failures[0]}"[:400] in printed
    assert "firm-hdl verify --board fake --silent-seconds 0.2 --distro lyrical" in printed


class DropsTheFirstLoop(LoopNode):
    """Nothing comes back from the first of its loops."""

    def send(self, topic, packet, tag=0):
        first = next(iter(self.loops.values()))
        return [] if topic == first else super().send(topic, packet, tag)


def test_each_of_several_loops_of_a_type_has_its_own_record():
    """Otherwise, the record of the last one would hide those of the others."""
    topics = [f"  /{way}{n}: {{type: {BOTH[0]}}}\n" for way in ("in", "out") for n in (1, 2)]
    text = "node: n\nlink: udp\nsubscribe:\n{}{}publish:\n{}{}".format(*topics)
    description = read_description_text(text)
    request = Request(board="fake", node="n.yaml", most_cases=4, references=(), silent_seconds=0.2)
    board = FakeBoard(DropsTheFirstLoop(description))
    board.repeat_seconds = 0.05
    with Boards(description, request, board) as system:
        records = system.run(None)
    assert [record.verdict.name for record in records] == ["failed", "passed"]
    assert ["topic=/in1" in record.test.key for record in records] == [True, False]


def test_a_board_that_is_gone_fails_what_is_left_at_once():
    node = Mute(described(*BOTH))
    found = list(verdicts(node, silent_seconds=0.2).values())
    assert all(isinstance(each, Failed) for each in found) and found[0] == found[1]


def test_the_types_behind_one_that_fails_are_tested():
    node = FallsSilent(described(*BOTH))

    def take(frame, silent=node.take):
        # It wakes up when it is opened again.
        node.heard = 0 if frame[1] & 2 else node.heard
        return silent(frame)

    node.take = take
    found = verdicts(node, silent_seconds=0.2)
    assert [type(each) for each in found.values()] == [Failed, Failed]
    assert "does not answer" in found[STRING].failures[0]


def test_a_board_that_wakes_up_when_it_is_opened_again_passes_the_next_type():
    node = LoopNode(described(*BOTH))
    asleep, take = [], node.take

    def sleepy(frame):
        # Messages with the flag of a start come only from a host that begins anew.
        if node.heard == 3 and not asleep:
            asleep.append(True)
        if asleep == [True] and frame[1] & 2:
            asleep.append(False)
            node.sender = MessageSender(272)
        return [] if asleep == [True] else take(frame)

    node.take = sleepy
    found = verdicts(node, silent_seconds=0.2)
    assert [type(each) for each in found.values()] == [Failed, Passed]


@pytest.mark.parametrize(
    ("kind", "opened", "silent"),
    [
        (LoopNode, 1, 60.0),
        # A wrong packet is no reason to begin anew; silence is, for the next type.
        (FlipsAByte, 1, 60.0),
        (FallsSilent, 2, 0.2),
        # A board that does not answer from the start is not asked about the next type.
        (Mute, 1, 0.2),
    ],
)
def test_a_board_is_opened_once_as_long_as_it_answers(kind, opened, silent):
    description = described(*BOTH)
    board = FakeBoard(kind(description))
    request = Request(board="fake", most_cases=4, references=(), silent_seconds=silent)
    with Boards(description, request, board) as system:
        assert len(system.run(None)) == 2
    assert board.opened == opened


def test_requests_that_are_lost_are_repeated_and_noted(capsys):
    """A way that loses requests for counters loses no message; the verdict stays."""
    count = iter(range(10**6))
    found = verdicts(
        LoopNode(ONE),
        loses=lambda frame: frame[2] == 0 and next(count) % 50 == 5,
    )
    assert isinstance(found[STRING], Passed)
    assert (
        f"note: {STRING} (lyrical): the link lost requests of control: " in capsys.readouterr().out
    )


def test_a_way_that_loses_a_message_fails_and_says_where():
    count = iter(range(10**6))
    found = verdicts(
        LoopNode(ONE), loses=lambda frame: frame[2] == 2 and next(count) == 3, silent_seconds=1.0
    )
    assert found[STRING].failures == (
        "board: 1 of 7 packets did not come back: case 3 of std_msgs/msg/String, seed 0: special "
        "values",
        "board: messages and frames: 1 lost on the way back",
    )


def test_cases_that_have_no_room_are_left_out_and_named(capsys):
    text = loop_text([STRING], "lyrical").replace("String}", "String, memory_bytes: 16}")
    node = LoopNode(read_description_text(text))
    # Eight cases, and one of them without its NUL.
    assert verdicts(node, most_cases=20) == {STRING: Passed(9)}
    note = "5 of 13 cases are larger than the 16 bytes that the node takes, and were left out"
    assert note in capsys.readouterr().out


def test_what_nothing_can_judge_is_no_pass(tmp_path):
    (tmp_path / "w_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "w_msgs" / "msg" / "Wide.msg").write_text("wstring text\n")
    node = LoopNode(described("w_msgs/msg/Wide", paths=[str(tmp_path)]))
    assert verdicts(node) == {
        "w_msgs/msg/Wide": NotJudged("rosbags has no wstring, which w_msgs/msg/Wide.text is")
    }
    assert node.heard == 0
