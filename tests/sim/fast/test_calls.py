# amaranth: UnusedElaboratable=no
"""What each call says to an engine, and what becomes of its answers; the engine does not run."""

from __future__ import annotations

from collections import deque
from itertools import islice

import numpy as np
import pytest
from amaranth.hdl import Fragment, Module
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from firm_hdl import PacketSignature
from firm_hdl.sim import DeadlineError, Stalls
from firm_hdl.sim.fast import FastSimulation, protocol, simulation
from firm_hdl.sim.fast.arrivals import Arrivals
from firm_hdl.sim.fast.packing import Packet, PacketJoiner, packed_packets
from firm_hdl.sim.fast.ports import ports_of
from firm_hdl.sim.fast.protocol import Answer, Done, Order, Reason


class Design(wiring.Component):
    """Ports of different widths; nothing is inside."""

    def __init__(self):
        super().__init__(
            {
                "narrow": In(stream.Signature(5)),
                "bytes": In(stream.Signature(8)),
                "packets": In(PacketSignature(4)),
                "sums": Out(stream.Signature(20)),
                "answers": Out(PacketSignature(4)),
                "level": In(12, init=3),
                "flag": In(1, init=0),
                "free": In(1),
                "small": Out(12),
                "wide": Out(100),
                "last": Out(4),
            }
        )

    def elaborate(self, platform):
        return Module()


class Recorded:
    """The other side of the protocol: it keeps what it gets, and answers what it was told to."""

    engine = "amaranth"

    def __init__(self):
        self.sent, self.answers, self.is_closed = [], deque(), False

    def send(self, data):
        self.sent += protocol.messages(bytearray(data))

    def receive(self, seconds):
        if not self.answers and seconds is None:
            raise KeyboardInterrupt
        found = self.answers.popleft() if self.answers else b""
        return protocol.messages(bytearray(found))

    def close(self):
        self.is_closed = True

    def take(self):
        """Return what came since the last time."""
        sent, self.sent = self.sent, []
        return [(Order(kind), body) for kind, body in sent]


@pytest.fixture
def channel(monkeypatch):
    channel = Recorded()

    def start(top, engine, **options):
        # Amaranth warns of what nothing elaborates.
        Fragment.get(top, None)
        return channel

    monkeypatch.setattr(simulation, "start", start)
    return channel


def done(reason=Reason.CYCLES, cycle=9, queued=(0,) * 5):
    return protocol.done(Done(reason=reason, cycle=cycle, queued=queued))


def came(number, *payloads, size=3):
    """Return the message of transfers on a stream, in cycles from 20 on."""
    records = [
        (20 + n).to_bytes(8, "little") + payload.to_bytes(size, "little")
        for n, payload in enumerate(payloads)
    ]
    return protocol.transfers(number, b"".join(records))


def test_at_first_inputs_have_their_initial_values_and_stalls_their_patterns(channel):
    stalls = {"narrow": Stalls.bits("0110101"), "sums": Stalls(0.5, 1, 3, seed=2)}
    FastSimulation(Design(), stalls=stalls)
    first, second, *patterns = channel.take()
    # `free` has no initial value.
    assert (first, second) == ((Order.SET, b"\0\0\3\0"), (Order.SET, b"\1\0\0"))
    assert [order for order, _ in patterns] == [Order.STALL] * 2
    (number, pattern), (other, drawn) = (protocol.read_stall(body) for _, body in patterns)
    assert (number, pattern) == (0, [bit == "0" for bit in "0110101"])
    cycles = Stalls(0.5, 1, 3, seed=2).cycles("sums")
    assert (other, drawn) == (3, list(islice(cycles, 16_384)))


def test_a_simulation_that_cannot_begin_is_closed(channel):
    with pytest.raises(ValueError, match="would stall for ever"):
        FastSimulation(Design(), stalls={"narrow": Stalls.bits("01"), "sums": _Endless()})
    assert channel.is_closed


class _Endless(Stalls):
    """A pattern that lets nothing through."""

    def __init__(self):
        super().__init__(pattern="01")

    def cycles(self, name):
        while True:
            yield True


def test_a_simulation_is_closed_at_the_end_of_its_block(channel):
    with pytest.raises(KeyError), FastSimulation(Design()):
        assert not channel.is_closed
        raise KeyError
    assert channel.is_closed


def test_silence_and_limits_that_nobody_asked_for(channel):
    design = FastSimulation(Design())
    channel.answers += [done(Reason.QUIET), done(Reason.CONDITIONS)]
    design.run_until_idle()
    design.run_until({"sums": 1})
    design.go_live()
    idle, until, live = (body for _, body in channel.take()[-3:])
    assert protocol.read_run(idle) == (1_000_000, 1000, [])
    assert protocol.read_run(until) == (1_000_000, 0, [(3, protocol.ALL_TRANSFERS, 1)])
    # Awake for 4,096 cycles without a transfer; then 1,000 cycles every 10 milliseconds.
    assert protocol.read_live(live) == (4096, 10, 1000)


@pytest.mark.parametrize("name", ["narrow", "nothing"])
def test_only_outputs_can_be_ignored(channel, name):
    with pytest.raises(ValueError, match=f"There is no output stream '{name}'"):
        FastSimulation(Design(), ignored=[name])


def test_bytes_are_many_payloads_of_a_stream_of_eight_bits_only(channel):
    design = FastSimulation(Design())
    channel.take()
    design.send("bytes", b"\xff\0")
    design.send("narrow", b"\x1f\2")
    assert channel.take() == [(Order.SEND, b"\1\0\xff\0"), (Order.SEND, b"\0\0\x1f\2")]
    with pytest.raises(ValueError, match="'narrow' has 5 bits, too few for 32"):
        design.send("narrow", b"\x20")


def test_what_is_sent_is_divided_between_payloads(channel, monkeypatch):
    monkeypatch.setattr(simulation, "_MOST_BYTES", 12)
    design = FastSimulation(Design())
    channel.take()
    # A beat has five bytes here.
    design.send_packets("packets", [bytes(range(1, 11)), b"xyz!"])
    (order, first), (same, second) = channel.take()
    assert order == same == Order.SEND
    assert first == b"\2\0" + b"\1\2\3\4\4" + b"\5\6\7\x08\4"
    assert (second[:4], second[6:]) == (b"\2\0" + b"\x09\x0a", b"\x0a" + b"xyz!\x0c")
    assert (first + second[2:])[2:] == packed_packets([bytes(range(1, 11)), b"xyz!"], 4)


@pytest.mark.parametrize("counts", [False, True])
def test_what_a_receiver_ignores_in_packets_is_noise(channel, counts):
    design, packets = FastSimulation(Design()), [bytes([n]) * 9 for n in range(200)]
    channel.take()
    design.send_packets("packets", packets, counts=counts)
    ((_, body),) = channel.take()
    beats = np.frombuffer(body[2:], np.uint8).reshape(-1, 3, 5)
    assert [each[:, :4].tobytes()[:9] for each in beats] == packets
    for lane in (1, 2, 3):
        assert len(set(beats[:, 2, lane])) > 64
    assert {*beats[:, :2, 4].flat} == ({0, 1, 2, 3, 4} if counts else {4})
    assert {*beats[:, 2, 4]} == {1 | 8}
    # The same in each run.
    assert body[2:] == packed_packets(packets, 4, counts=counts)


def test_each_output_has_its_own_bytes_of_the_values(channel):
    design = FastSimulation(Design())
    values = {"small": 0xABC, "wide": (1 << 99) + 5, "last": 9}
    body = b"".join(
        values[name].to_bytes(size, "little")
        for name, size in (("small", 2), ("wide", 13), ("last", 1))
    )
    for name, value in values.items():
        channel.answers.append(protocol.message(Answer.VALUES, body))
        assert design.get(name) == value


def test_a_run_waits_for_what_is_still_missing(channel):
    design = FastSimulation(Design())
    channel.answers.append(came(3, 7) + came(4, 0x0A_0000_0201, size=5) + done())
    design.run(9)
    channel.take()
    channel.answers.append(done(Reason.CONDITIONS, 12))
    design.run_until({"sums": 3, "answers": 2}, limit=50)
    ((order, body),) = channel.take()
    # All transfers of a stream, but only the last beats of packets.
    conditions = [(3, protocol.ALL_TRANSFERS, 2), (4, 4 * 8 + 3, 1)]
    assert (order, protocol.read_run(body)) == (Order.RUN, (50, 0, conditions))
    assert design.cycle == 12
    # What is there already is not waited for.
    design.run_until({"sums": 1, "answers": 1})
    assert channel.take() == []
    channel.answers.append(came(3, 8) + done())
    with pytest.raises(DeadlineError, match=r"^Did not come in 5 cycles: 2 on 'sums'$"):
        design.run_until({"sums": 4}, limit=5)
    assert design.receive("sums") == [7, 8] and design.receive("sums") == []
    assert design.packets("answers") == [Packet(b"\1\2", 20)] and design.packets("answers") == []


@pytest.mark.parametrize("reason", list(Reason))
def test_only_silence_is_idle(channel, reason):
    design = FastSimulation(Design())
    channel.answers.append(done(reason, queued=(0,) * 5))
    if reason == Reason.QUIET:
        design.run_until_idle(quiet=7, limit=70)
    else:
        with pytest.raises(DeadlineError, match=r"^There are still transfers after 70 cycles$"):
            design.run_until_idle(quiet=7, limit=70)
    assert protocol.read_run(channel.take()[-1][1]) == (70, 7, [])
    channel.answers.append(done(Reason.QUIET, queued=(0, 3, 1, 0, 0)))
    left = "^Not taken up to cycle 9: 3 on 'bytes', 1 on 'packets'$"
    with pytest.raises(DeadlineError, match=left):
        design.run_until_idle()
    assert [design.queued(name) for name in ("narrow", "bytes", "packets")] == [0, 3, 1]


def test_a_reset_discards_what_came_before_it_and_with_its_answer(channel):
    design = FastSimulation(Design())
    channel.answers.append(came(3, 1) + came(4, 0x04_0000_0001, size=5) + done(queued=(1,) * 5))
    design.run(3)
    channel.take()
    channel.answers.append(came(3, 2) + done(Reason.HALTED, 0))
    design.reset()
    assert channel.take() == [(Order.RESET, b""), (Order.HALT, b"")]
    assert design.receive("sums") == [] and design.cycle == 0 and design.queued("bytes") == 0
    # The packet that had begun does not go on.
    channel.answers.append(came(4, 0x09_0000_0002, size=5) + done())
    design.run(1)
    assert design.receive_packets("answers") == [b"\2"]


def test_a_live_simulation_runs_nothing_else_until_it_is_halted(channel):
    design = FastSimulation(Design(), ignored=["answers"])
    channel.take()
    design.go_live(quiet=1, nap_cycles=2, nap_ms=3)
    ((order, body),) = channel.take()
    assert (order, protocol.read_live(body)) == (Order.LIVE, (1, 3, 2)) and design.is_live
    for call in (
        lambda: design.run(1),
        design.run_until_idle,
        design.reset,
        design.go_live,
        lambda: design.run_until({"sums": 1}),
    ):
        with pytest.raises(RuntimeError, match="halt it first"):
            call()
    assert channel.take() == []
    channel.answers.append(came(4, 0x0C_0000_0000, size=5))
    assert not design.wait(0)
    channel.answers.append(came(3, 5))
    assert design.wait(0) and design.wait(0)
    # Before and after the answer of a call.
    values = protocol.message(Answer.VALUES, bytes(16))
    channel.answers.append(came(3, 6) + values + came(3, 7))
    assert design.get("small") == 0
    channel.answers.append(came(3, 8) + done(Reason.HALTED, 40))
    design.halt()
    assert not design.is_live and design.cycle == 40
    assert design.receive("sums") == [5, 6, 7, 8]
    assert not design.wait(0)


def test_a_call_that_is_interrupted_closes_the_simulation(channel):
    design = FastSimulation(Design())
    with pytest.raises(KeyboardInterrupt):
        design.run(1)
    assert channel.is_closed


def test_arrivals_wait_as_transfers_or_as_packets():
    arrivals = Arrivals(ports_of(Design()).streams, {"sums"})
    assert not arrivals
    arrivals.keep(3, bytes(11))
    assert not arrivals and arrivals.count("sums") == 0
    beat = (30).to_bytes(8, "little") + b"abcd\x0b"
    arrivals.keep(4, beat[:8] + b"abcd\4" + beat)
    assert arrivals and arrivals.count("answers") == 1 and arrivals
    assert arrivals.take_packets("answers") == [Packet(b"abcdabc", 30)]
    assert not arrivals and arrivals.take_packets("answers") == []
    hidden = Arrivals(ports_of(Design()).streams, {"answers"})
    hidden.keep(4, beat)
    assert not hidden and hidden.count("answers") == 0


def test_packets_are_joined_over_messages_of_any_size():
    joiner = PacketJoiner(4)
    # Longer than 64 KiB, so that ends need more than 16 bits.
    packets = [bytes(range(256)) * 300, b"", b"12345678", b"x"]
    beats = np.frombuffer(packed_packets(packets, 4), np.uint8).reshape(-1, 5)
    cycles = np.arange(len(beats), dtype="<u8").view(np.uint8).reshape(-1, 8)
    records = np.hstack([cycles, beats])
    found = []
    for start, end in ((0, 3), (3, 5), (5, 19_203), (19_203, None)):
        found += joiner.add(records[start:end].tobytes())
    assert [packet.data for packet in found] == packets
    assert [packet.cycle for packet in found] == [19_199, 19_200, 19_202, 19_203]
    assert joiner.partial == b""
    # A count that no beat may have is not one of bytes of the next beat.
    wrong = [b"abcd\7", b"ef\0\0\x0a", b"gh\0\0\x0a"]
    found = joiner.add(b"".join(bytes(8) + beat for beat in wrong))
    assert found == [Packet(b"abcdef", 0), Packet(b"gh", 0)]
