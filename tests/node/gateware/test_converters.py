# amaranth: UnusedElaboratable=no
"""The converters of a node alone: services in order, and messages that a serializer finds wrong."""

from __future__ import annotations

import struct

import pytest
from amaranth.hdl import Cat

from firm_hdl.frontend import Library
from firm_hdl.node import read_description_text
from firm_hdl.node.gateware.converters import NodeConverters
from firm_hdl.sim import Stalls
from tests.frontend.workspace import make_files
from tests.gateware.packets.bench import PacketBench, beats, with_side

COUNT = 12
TAGS = [0x8000_0001 + 3 * number for number in range(COUNT)]
ASKED = [0xA000 + number for number in range(COUNT)]
ANSWERS = [0x5A00 + number for number in range(COUNT)]


def packets(values):
    return [struct.pack("<H", value) for value in values]


class ServiceBench:
    """The converters of one service. A packet of it has two beats, and its message one field."""

    def __init__(self, folder, most):
        make_files(folder, {"own/srv/Set.srv": "uint16 on\n---\nuint16 ok\n"})
        text = f"node: n\nbus_bytes: 1\nserve: {{/a: {{type: own/Set, packets: {most}}}}}\n"
        library = Library("noetic", [folder])
        part = NodeConverters(read_description_text(text, library=library))
        asked, answered = part.packets.serve.a.request, part.packets.serve.a.response
        message = part.serve.a
        aborts = answered.abort & answered.packets.payload.last
        self.bench = PacketBench(
            part,
            {"asked": with_side(asked.packets, asked.tag), "ok": message.response.ok},
            {"answered": (answered.packets, 1, Cat(answered.tag, aborts))},
            others={"on": message.request.on},
        )

    def run(self, stalls):
        """Send all requests and all answers; check that each answer has the tag of its request."""
        sources = {"asked": list(beats(packets(ASKED), 1, TAGS)), "ok": ANSWERS}
        seen = self.bench.run(sources, {"answered": COUNT}, stalls=stalls, deadline=500)
        assert seen.others["on"] == ASKED and seen.packets["answered"] == packets(ANSWERS)
        assert seen.sides["answered"] == [{tag} for tag in TAGS]
        return seen


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    return ServiceBench(tmp_path_factory.mktemp("own"), 2)


def test_as_many_requests_are_under_way_as_packets_says_and_four_more(bench):
    seen = bench.run({"ok": Stalls.bits("0" * 120 + "1" * 1000)})
    before = seen.times["answered"][0]
    assert sum(cycle < before for cycle in seen.times["on"]) == 2 + 4
    # Of the next one, not even the first beat is taken.
    assert sum(cycle < before for cycle in seen.times["asked"]) == 2 * (2 + 4)


def test_an_answer_has_the_tag_of_its_request_whatever_stalls(bench):
    for seed in range(2):
        bench.run(Stalls(0.4, max_cycles=6, seed=seed))


def test_an_answer_that_is_given_early_waits_for_its_request(bench):
    seen = bench.run({"asked": Stalls.bits("0" * 60 + "1" * 1000)})
    assert seen.times["ok"][0] < 60 <= seen.times["asked"][0] < seen.times["answered"][0]


def test_a_length_over_the_limit_of_its_topic_aborts_its_packet_alone():
    """A String of ROS 1 has 4 bytes besides its text, so 12 bytes have room for a text of 8."""
    text = "node: n\nbus_bytes: 1\npublish: {/a: {type: std_msgs/String, max_message_bytes: 12}}\n"
    part = NodeConverters(read_description_text(text, library=Library("noetic")))
    sent, out = part.publish.a.data, part.packets.publish.a
    bench = PacketBench(
        part,
        {"length": sent.length, "items": sent.items},
        {"out": (out.packets, 1, Cat(out.tag, out.abort & out.packets.payload.last))},
    )
    texts = [b"abc", b"123456789", b"", b"12345678"]
    items = [byte | (at == len(t)) << 8 for t in texts for at, byte in enumerate(t, 1)]
    seen = bench.run({"length": [len(t) for t in texts], "items": items}, {"out": 4})
    assert seen.packets["out"] == [struct.pack("<I", len(t)) + t for t in texts]
    assert [1 << 32 in sides for sides in seen.sides["out"]] == [False, True, False, False]
