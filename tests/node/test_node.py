# amaranth: UnusedElaboratable=no
"""Whole nodes: from frames of a host through an accelerator and back."""

from __future__ import annotations

import random
import struct
from functools import cache

import pytest
from amaranth.hdl import DriverConflict, Fragment
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.node import Node, accelerator_signature
from firm_hdl.node.accelerator import conflicts_reported
from firm_hdl.node.control import ControlRequest, ControlResponse, Operation, registers
from firm_hdl.node.messages import NodeMessage
from firm_hdl.sim import Stalls
from tests.depth import by_depth
from tests.gateware.packets.bench import PacketBench, beats
from tests.node.accelerators import Echo, NoComponent, echo_text
from tests.node.samples import read
from tests.node.traffic import frames_of, packets_of, received_by_host


def string(text):
    data = text.encode() + b"\0"
    return b"\0\1\0\0" + struct.pack("<I", len(data)) + data


@cache
def echo_bench(bus):
    """Return a node with an accelerator that answers, in a bench whose runs begin anew."""
    description = read(echo_text(bus_bytes=str(bus)))
    return description, stream_node(description)[1]


def stream_node(description, accelerator=None):
    node = Node(description, accelerator)
    bus = description.bus_bytes
    bench = PacketBench(
        node,
        {"in": node.link.frames_in},
        {"out": (node.link.frames_out, bus, node.link.dest)},
        final={"strings": node.io.strings},
    )
    return node, bench


def texts(count):
    rng = random.Random(count)
    return ["x" * rng.randrange(12) + str(number) for number in range(count)]


@pytest.mark.parametrize("bus", by_depth([8], [1, 2, 8, 16]))
def test_an_accelerator_is_alive_behind_a_link(bus):
    description, bench = echo_bench(bus)
    strings = texts(6)
    requests = packets_of(description.topics[3].store("in").message, 5, most=200)
    set_time = ControlRequest(operation=Operation.SET_TIME, seconds=77, nanoseconds=5)
    sent = [NodeMessage(topic=0, packet=set_time.encode(), tag=9)]
    sent += [NodeMessage(topic=1, packet=string(text)) for text in strings]
    sent += [NodeMessage(topic=4, packet=p, tag=100 + n) for n, p in enumerate(requests)]
    sent.insert(4, NodeMessage(topic=1, packet=string("bad")[:-1]))
    sent.insert(9, NodeMessage(topic=4, packet=requests[0][:-2], tag=99))
    source = list(beats(frames_of(sent), bus))
    for stalls in by_depth([Stalls(0.2, max_cycles=5)], [None, Stalls(0.2, max_cycles=5)]):
        seen = bench.run({"in": source}, {"out": 18}, stalls=stalls, deadline=2000)
        out, counters = received_by_host(seen.packets["out"])
        assert counters.lost == 0 and [{m.topic} for m in out] == seen.sides["out"]
        assert [m.packet for m in out if m.topic == 2] == [string(text) for text in strings]
        stamps = [struct.unpack("<4xiI", m.packet) for m in out if m.topic == 3]
        assert {sec for sec, _ in stamps} == {77} and stamps == sorted(stamps)
        answers = [m for m in out if m.topic == 4]
        assert [m.tag for m in answers] == [100, 101, 102, 103, 104]
        for request, answer in zip(requests, answers, strict=True):
            # Padding may be any; success, one error: the bits of the duration.
            assert answer.packet[:5] == b"\0\1\0\0\1"
            assert answer.packet[8:] == struct.pack("<I", 1) + request[-4:]
        assert bench.state["strings"] == 6


def text_of(packet):
    """Return the string of a packet, or `None` if it is no String. Written down after OMG CDR."""
    if len(packet) < 8 or packet[:2] != b"\0\1":
        return None
    (size,) = struct.unpack("<I", packet[4:8])
    data, rest = packet[8 : 8 + size], packet[8 + size :]
    if len(data) < size or len(rest) > 3 or (size and data[-1]):
        return None
    return data[:-1]


def damaged(frame, rng):
    """Return a frame with a byte changed, added or removed; headers are hit as often as bytes."""
    at = rng.choice((rng.randrange(16), rng.randrange(len(frame))))
    what = rng.randrange(3)
    byte = bytes([frame[at] ^ 1 << rng.randrange(8)]) if what == 0 else rng.randbytes(what - 1)
    return frame[:at] + byte + frame[at + (what != 2) :]


def expected_echo(frames):
    """Return the strings that the frames of a stream carry to the accelerator, in order."""
    for frame in frames:
        if len(frame) < 16 or frame[0] != 0xF1 or not frame[1] & 1 or frame[14:16] != b"\0\0":
            continue
        text = text_of(frame[16:]) if frame[2:4] == b"\1\0" else None
        if text is not None:
            yield b"\0\1\0\0" + struct.pack("<I", len(text) + 1) + text + b"\0"


@pytest.mark.parametrize("seed", range(by_depth(1, 8)))
def test_nothing_gets_behind_the_gates_that_is_not_right(seed):
    rng = random.Random(seed)
    _, bench = echo_bench(8)
    count = by_depth(12, 30)
    good = frames_of(NodeMessage(topic=1, packet=string(text)) for text in texts(count))
    frames = [damaged(frame, rng) if rng.random() < 0.6 else frame for frame in good]
    want = list(expected_echo(frames))
    assert 0 < len(want) < count
    source = list(beats(frames, 8))
    # Control requests that damage made are answered, too, and the clock may be set.
    seen = bench.run({"in": source}, {"in": len(source)}, settle=100, deadline=600)
    out, _ = received_by_host(seen.packets["out"])
    assert [m.packet for m in out if m.topic == 2] == want
    assert bench.state["strings"] == len(want)
    assert not [m for m in out if m.topic == 4]


BACK = """\
node: back
distro: jazzy
bus_bytes: 16
clock_mhz: 62.5
accelerator: firm_hdl.node.loop:Loop
subscribe:
  /came: {type: std_msgs/msg/UInt16}
publish:
  /goes: {type: std_msgs/msg/UInt16}
"""


COUNTED = {
    ("link", "passed"): 8,
    ("link", "malformed"): 1,
    ("node", "unknown"): 1,
    ("node", "control"): 4,
    ("subscribe_came", "passed"): 3,
    ("publish_goes", "bytes_low"): 18,
}
"""What has been counted when the host has read four registers."""


def test_the_clock_and_all_counters_come_out_and_are_read_by_the_host():
    description = read(BACK)
    node = Node(description)
    found = {"sec": node.time.sec, "nanosec": node.time.nanosec}
    for part, name in COUNTED:
        found[part, name] = node.counters[part][name]
    outputs = {"out": (node.link.frames_out, 16, None)}
    bench = PacketBench(node, {"in": node.link.frames_in}, outputs, final=found)
    messages = [NodeMessage(topic=1, packet=b"\0\1\0\0" + bytes([n, 9])) for n in range(3)]
    messages.append(NodeMessage(topic=77, packet=b"abc"))
    # The frequency of the clock, its rate, and two counters of the link.
    numbers = {each.name: each.number for each in registers(description)[:15]}
    asked = [numbers[name] for name in ("clock_hz", "rate", "passed", "malformed")]
    for number in asked:
        request = ControlRequest(operation=Operation.READ, argument=number)
        messages.append(NodeMessage(topic=0, packet=request.encode(), tag=number))
    frames = [b"no frame", *frames_of(messages)]
    # Each request is answered before the next one comes.
    pause = {"in": Stalls.bits("1" + "0" * 15)}
    seen = bench.run({"in": list(beats(frames, 16))}, {"out": 7}, stalls=pause, deadline=500)
    out, _ = received_by_host(seen.packets["out"])
    answers = {m.tag: ControlResponse.decode(m.packet) for m in out if m.topic == 0}
    # The request that reads `passed` is the seventh message.
    assert [answers[number].value for number in asked] == [62_500_000, 16 << 22, 7, 1]
    assert {name: bench.state[name] for name in COUNTED} == COUNTED
    # A cycle has 16 ns, and the run ends soon after the last answer.
    times = [each.nanoseconds for each in answers.values()]
    assert bench.state["sec"] == 0 and times[-1] < bench.state["nanosec"] < times[-1] + 16 * 60


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("nowhere.at_all:X", "cannot import 'nowhere.at_all': No module named 'nowhere'"),
        ("tests.node.accelerators:Eco", "'tests.node.accelerators' has no 'Eco'"),
        ("tests.node.accelerators:NoComponent", "an accelerator is a component of amaranth.lib"),
        ("tests.node.accelerators:Other", "the accelerator has no 'subscribe' with the ports"),
        ("tests.node.accelerators:Exploding", "raised KeyError at .*accelerators.py:"),
    ],
)
def test_an_accelerator_that_cannot_be_used_is_an_error_at_its_name(name, message):
    description = read(echo_text().replace("tests.node.accelerators:Echo", name))
    with pytest.raises(DefinitionError, match=message) as caught:
        Node(description)
    assert str(caught.value).startswith("<description>:3:14: error: ")


def test_a_module_beside_the_description_is_found(tmp_path):
    (tmp_path / "mine_only.py").write_text("from tests.node.accelerators import Echo\n")
    description = read(echo_text().replace("tests.node.accelerators", "mine_only"))
    with pytest.raises(DefinitionError, match="No module named 'mine_only'"):
        Node(description)
    object.__setattr__(description, "folder", str(tmp_path))
    assert type(Node(description).accelerator) is Echo


def test_the_code_of_an_accelerator_that_is_given_raises_its_own_errors():
    """There is no name in the description at which they could be reported."""
    description = read(echo_text().replace("accelerator: tests.node.accelerators:Echo", ""))

    class Raises(_Fits):
        def elaborate(self, platform):
            raise KeyError("mine")

    accelerator = Raises(accelerator_signature(description))
    with pytest.raises(KeyError, match="mine"):
        Fragment.get(Node(description, accelerator), None)
    with pytest.raises(DriverConflict, match="two"), conflicts_reported(description):
        raise DriverConflict("two")


class _Fits(wiring.Component):
    """An accelerator whose signature a test changes."""

    def __init__(self, signature):
        super().__init__(signature)


def test_ports_that_do_not_match_are_named():
    description = read(echo_text())
    members = dict(accelerator_signature(description).members.items())
    without_clock = {name: member for name, member in members.items() if name != "time"}
    Node(description, _Fits(without_clock))
    publish = dict(members["publish"].signature.members.items())
    cases = {
        "has no 'publish.said'": {k: v for k, v in publish.items() if k != "said"},
        "'publish.said' is .* and should be": publish | {"said": publish["stamp"]},
        "no topic for 'publish.more'": publish | {"more": publish["said"]},
    }
    for message, changed in cases.items():
        wrong = members | {"publish": Out(wiring.Signature(changed))}
        with pytest.raises(UserError, match=message):
            Node(description, _Fits(wrong))
    turned = publish | {"said": publish["said"].flip()}
    with pytest.raises(UserError, match=r"'publish\.said' is"):
        Node(description, _Fits(members | {"publish": Out(wiring.Signature(turned))}))
    with pytest.raises(UserError, match="'time' must be In"):
        Node(description, _Fits(members | {"time": In(8)}))
    with pytest.raises(UserError, match="a component of amaranth"):
        Node(description, NoComponent(description))
