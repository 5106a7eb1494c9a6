# amaranth: UnusedElaboratable=no
"""The core of a node: every message goes where it belongs, whole, or is dropped and counted."""

from __future__ import annotations

import random
from types import SimpleNamespace

import pytest
from amaranth.hdl import Cat

from firm_hdl.frontend import open_library
from firm_hdl.node import read_description_text
from firm_hdl.node.control import ControlRequest, ControlResponse, Operation, Result, registers
from firm_hdl.node.gateware import NodeCore
from firm_hdl.node.gateware.core import node_counters_layout
from firm_hdl.node.messages import NodeMessage
from firm_hdl.sim import Stalls
from tests.depth import by_depth
from tests.frontend.workspace import make_files
from tests.gateware.packets.bench import PacketBench, beats
from tests.node.samples import read
from tests.node.traffic import link_beats, link_output, messages_of, packets_of


class CoreBench:
    """A core whose streams are all driven and watched."""

    def __init__(self, description, core=None):
        self.description, self.bus = description, description.bus_bytes
        self.core = core = core or NodeCore(description)
        sources, outputs = {"received": core.received}, {"sent": link_output(core.sent, self.bus)}
        for topic in description.topics:
            if topic.kind == "subscribe":
                outputs[topic.port] = (getattr(core.subscribe, topic.port), self.bus, None)
            elif topic.kind == "publish":
                sources[topic.port] = _with_tag(getattr(core.publish, topic.port))
            else:
                port = getattr(core.serve, topic.port)
                outputs[topic.port] = (port.request.packets, self.bus, port.request.tag)
                sources[f"{topic.port}_response"] = _with_tag(port.response)
        final = {
            each.number: _value(core, description, each) for each in registers(description)[6:]
        }
        self.bench = PacketBench(core, sources, outputs, final=final)

    def run(self, received=(), sent=None, want=None, **options):
        """Send messages to the core, and `sent`: by port, triples of packet, tag and abort."""
        streams = {"received": link_beats(received, self.bus)}
        for port, packets in (sent or {}).items():
            sides = [
                (lambda last, tag=tag, abort=abort: (tag if last else 99) | (abort & last) << 32)
                for _, tag, abort in packets
            ]
            streams[port] = list(beats([p for p, _, _ in packets], self.bus, sides))
        total = len(streams["received"])
        self.seen = self.bench.run(streams, {"received": total, **(want or {})}, **options)
        return self.seen

    def counters(self, topic, part):
        return {
            each.name: self.bench.state[each.number]
            for each in registers(self.description)[6:]
            if (each.topic, each.part) == (topic, part) and self.bench.state[each.number]
        }


def _with_tag(port):
    payload = Cat(port.packets.payload.as_value(), port.tag, port.abort)
    return SimpleNamespace(payload=payload, valid=port.packets.valid, ready=port.packets.ready)


def _value(core, description, register):
    if not register.topic:
        return core.counters[register.part][register.name]
    topic = description.topics[register.topic - 1]
    part = (
        {"in": "request", "out": "response"}[register.part] if topic.kind == "serve" else topic.kind
    )
    return core.counters[f"{part}_{topic.port}"][register.name]


@pytest.fixture(scope="module")
def wheels():
    description = read()
    return CoreBench(description, _Counted(description))


def damaged(packet):
    return packet[:-1]


def traffic(description, count, seed):
    """Return messages for all topics, good and bad, and the good ones by port."""
    rng, messages, good = random.Random(seed), [], {}
    for topic, store in description.received():
        for packet in packets_of(store.message, count, seed, 200):
            tag = rng.getrandbits(32) if topic.kind == "serve" else 0
            messages.append((topic, packet, tag, rng.random() < 0.3))
    rng.shuffle(messages)
    for topic, packet, tag, is_bad in messages:
        if not is_bad:
            good.setdefault(topic.port, []).append((packet, tag))
    sent = [
        NodeMessage(topic=topic.id, packet=damaged(packet) if is_bad else packet, tag=tag)
        for topic, packet, tag, is_bad in messages
    ]
    return sent, good


@pytest.mark.parametrize(
    ("bus_bytes", "stalls"),
    [
        (8, Stalls(0.2, max_cycles=4)),
        # A host that reads registers has a core of 16 bytes, with good and bad messages.
        pytest.param(16, None, marks=pytest.mark.thorough),
        pytest.param(1, None, marks=pytest.mark.thorough),
    ],
)
def test_only_good_packets_reach_the_topics_each_its_own(bus_bytes, stalls, wheels):
    own = bus_bytes == wheels.bus
    bench = wheels if own else CoreBench(read(bus_bytes=str(bus_bytes)))
    # No more than the memories take while an output stalls.
    sent, good = traffic(bench.description, by_depth(4, 12), 1)
    sent += [NodeMessage(topic=topic, packet=b"x" * 20) for topic in (3, 5, 65535)]
    seen = bench.run(sent, want={port: len(each) for port, each in good.items()}, stalls=stalls)
    for port, each in good.items():
        assert seen.packets[port] == [packet for packet, _ in each]
        if port.endswith("calibrate"):
            assert seen.sides[port] == [{tag} for _, tag in each]
    for topic, _ in bench.description.received():
        counters, passed = bench.counters(topic.id, "in"), good[topic.port]
        came = sum(message.topic == topic.id for message in sent)
        assert counters.pop("passed") == len(passed)
        assert counters.pop("bytes_low") == sum(len(packet) for packet, _ in passed)
        assert sum(counters.values()) == came - len(passed)
    assert bench.counters(0, "node") == {"unknown": 3}


def test_a_topic_that_is_not_taken_holds_no_other(wheels):
    """Twists wait, and those without room are dropped; strings still pass."""
    twists = packets_of(wheels.description.topics[0].stores[0][1].message, 9)
    names = packets_of(wheels.description.topics[1].stores[0][1].message, 5, most=100)
    sent = [NodeMessage(topic=1, packet=packet) for packet in twists]
    sent += [NodeMessage(topic=2, packet=packet) for packet in names]
    held = {"cmd_vel": Stalls.bits("0" * 300 + "1" * 600)}
    seen = wheels.run(sent, want={"robot_names": 5, "cmd_vel": 2}, stalls=held, deadline=900)
    assert seen.packets["robot_names"] == names
    assert seen.packets["cmd_vel"] == twists[:2]
    assert wheels.counters(1, "in")["full"] == 7


def test_publications_and_responses_leave_whole_with_their_ids(wheels):
    vectors = packets_of(wheels.description.topics[2].stores[0][1].message, 12)
    response = wheels.description.topics[3].store("out").message
    answers = packets_of(response, 12, most=200)
    published = [(packet, 0, number % 4 == 3) for number, packet in enumerate(vectors)]
    answered = [(packet, 1000 + number, number % 3 == 2) for number, packet in enumerate(answers)]
    for stalls in (None, Stalls(0.3, max_cycles=5)):
        seen = wheels.run(
            sent={"robot_odom": published, "robot_wheels_calibrate_response": answered},
            want={"sent": 9 + 8},
            stalls=stalls,
        )
        out = messages_of(seen, "sent")
        for topic, given in ((3, published), (4, answered)):
            want = [
                NodeMessage(topic=topic, packet=p, tag=t) for p, t, aborts in given if not aborts
            ]
            assert [message for message in out if message.topic == topic] == want
        assert wheels.counters(3, "out")["aborted"] == 3
        assert wheels.counters(4, "out")["aborted"] == 4
        assert wheels.counters(4, "out")["bytes_low"] == sum(
            len(p) for p, _, aborts in answered if not aborts
        )


def control(tag, **fields):
    return NodeMessage(topic=0, packet=ControlRequest(**fields).encode(), tag=tag)


def answers_of(seen):
    return {
        m.tag: ControlResponse.decode(m.packet) for m in messages_of(seen, "sent") if m.topic == 0
    }


# Each byte of each counter has its highest bit.
LINK = {
    name: (0xF0 + number) * 0x0101_0101
    for number, name in enumerate(
        ("passed", "lost", "late", "cut", "stray", "malformed", "full", "large", "unsent")
    )
}


class _Counted(NodeCore):
    """A core whose link has counted `LINK`."""

    def elaborate(self, platform):
        m = super().elaborate(platform)
        m.d.comb += [self.link_counters[name].eq(value) for name, value in LINK.items()]
        return m


def test_each_counter_has_32_bits():
    owners = [owner.shape for _, owner in node_counters_layout(read())]
    assert {field.width for owner in owners for _, field in owner} == {32}


@pytest.mark.parametrize("bus_bytes", by_depth([8], [1, 2, 4, 8, 16]))
def test_a_host_reads_all_registers(bus_bytes, wheels):
    description = read(bus_bytes=str(bus_bytes))
    is_wheels = bus_bytes == wheels.bus
    bench = wheels if is_wheels else CoreBench(description, _Counted(description))
    names = registers(description)
    # Identity, the counters of the link and of the first topic, and some of the others.
    names = by_depth(names[:15] + names[18:28] + names[28::24], names)
    # A request has 16 bytes and takes about 15 cycles and as many as its answer has beats.
    pause = Stalls.bits("1" + "0" * (24 * bus_bytes // 16))
    twists = packets_of(description.topics[0].stores[0][1].message, 5)
    sent = [
        NodeMessage(topic=1, packet=packet) for packet in [*twists[:2], *map(damaged, twists[2:])]
    ]
    sent += [control(each.number, operation=Operation.READ, argument=each.number) for each in names]
    sent += [control(9000, operation=9), control(9001, operation=1, argument=6)]
    sent += [control(9002, operation=1, argument=registers(description)[-1].number + 1)]
    sent += [
        NodeMessage(topic=0, packet=bytes([1] * size), tag=9100 + size) for size in (15, 17, 32, 48)
    ]
    total = len(names) + 7
    seen = bench.run(sent, want={"sent": total, "cmd_vel": 2}, stalls={"received": pause})
    answers = answers_of(seen)
    values = {each.number: answers[each.number].value for each in names}
    identity = [values[number] for number in range(6)]
    print_ = description.fingerprint
    assert identity == [0xF1, print_ & 0xFFFFFFFF, print_ >> 32, 4, 100_000_000, 10 << 22]
    found = {each.name: values[each.number] for each in names if each.topic == 1}
    assert (found["passed"], found["truncated"], found["bytes_low"]) == (2, 3, 104)
    assert {each.name: values[each.number] for each in names if each.owner == "link"} == LINK
    assert [answers[tag].result for tag in (9000, 9001, 9002)] == [
        Result.OPERATION,
        Result.ARGUMENT,
        Result.ARGUMENT,
    ]
    assert {answers[9100 + size].result for size in (15, 17, 32, 48)} == {Result.OPERATION}
    times = [each.nanoseconds for each in answers.values()]
    assert times == sorted(times) and times[-1] < 1_000_000
    assert bench.counters(0, "node") == {"control": total}


def test_requests_without_room_are_counted(wheels):
    sent = [control(number, operation=1) for number in range(40)]
    wheels.run(sent, settle=150)
    counters = wheels.counters(0, "node")
    assert counters["control"] + counters["control_full"] == 40 and counters["control_full"] > 0
    assert len(answers_of(wheels.seen)) == counters["control"]


def test_the_clock_is_set_and_kept_in_step(wheels):
    pause = {"received": Stalls.bits("1" + "0" * 49)}
    sent = [
        control(1, operation=Operation.SET_TIME, seconds=7, nanoseconds=999_999_900),
        control(2, operation=Operation.READ),
        control(3, operation=Operation.SET_RATE, argument=20 << 22),
        control(4, operation=Operation.READ),
        control(5, operation=Operation.READ),
        control(6, operation=Operation.SET_TIME, seconds=9, nanoseconds=1_000_000_000),
        control(7, operation=Operation.READ, argument=5),
    ]
    answers = answers_of(wheels.run(sent, want={"sent": 7}, stalls=pause))
    at = {tag: each.seconds * 10**9 + each.nanoseconds for tag, each in answers.items()}
    assert all(each.nanoseconds < 10**9 for each in answers.values())
    assert at[1] < 10**7
    # A request comes every 51 cycles, in its second beat; 2 cycles lie between set and output.
    assert 8_000_000_000 < at[2] < 8_000_001_000
    assert at[5] - at[4] == 2 * (at[3] - at[2]) > 1000
    assert answers[6].result == Result.ARGUMENT and answers[7].value == 20 << 22


def test_a_beat_per_cycle_from_the_link(wheels):
    """Packets of all topics come back to back, and the core takes a beat in every cycle."""
    sent, _ = traffic(wheels.description, 4, 5)
    seen = wheels.run(sent)
    times = seen.times["received"]
    assert times == list(range(times[0], times[0] + len(times)))


class _MixesTopics(NodeCore):
    def _route(self, m, control):
        super()._route(m, control)
        router = m.submodules.router
        m.d.comb += router.topic.eq(1)


class _ForgetsTags(NodeCore):
    def _serve(self, m, topic):
        super()._serve(m, topic)
        m.d.comb += getattr(self.serve, topic.port).request.tag.eq(0)


FEW = """\
node: few
distro: jazzy
subscribe:
  /number: {type: std_msgs/msg/Int64}
  /flag: {type: std_msgs/msg/Bool}
serve:
  /set: {type: few_msgs/srv/Set, memory_bytes: 64}
"""


@pytest.fixture(scope="module")
def few(tmp_path_factory):
    """A description with small types."""
    path = tmp_path_factory.mktemp("few")
    make_files(path, {"few_msgs/srv/Set.srv": "uint16 a\n---\nbool b\n"})
    return read_description_text(FEW, library=open_library("jazzy", [str(path)], ()))


def check_traffic(bench):
    """Check that good messages, and they alone, come out with their tags."""
    sent, good = traffic(bench.description, 4, 1)
    seen = bench.run(sent, want={port: len(each) for port, each in good.items()})
    for port, each in good.items():
        assert seen.packets[port] == [packet for packet, _ in each]
    for topic in bench.description.topics:
        if topic.kind == "serve":
            assert seen.sides[topic.port] == [{tag} for _, tag in good[topic.port]]


@pytest.mark.parametrize("fault", [_MixesTopics, _ForgetsTags])
@pytest.mark.sampled(2)
def test_a_fault_is_found(fault, few):
    description = by_depth(few, read())
    with pytest.raises(AssertionError):
        check_traffic(CoreBench(description, fault(description)))
