"""A bench for parts with packet streams: it records transfers and their cycles."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace

from amaranth.hdl import Cat, Const, Value

from firm_hdl.sim.bench import Bench, Job, Ports, RunOptions
from firm_hdl.sim.payloads import PacketCollector, packet_beats
from firm_hdl.sim.watch import PacketRules

__all__ = ["PacketBench", "Trace", "beats", "with_side"]


def with_side(port, side):
    """Return a packet stream with a signal beside it as the highest bits of the payload."""
    payload = Cat(Value.cast(port.payload), side)
    return SimpleNamespace(payload=payload, valid=port.valid, ready=port.ready)


def beats(packets, bus_bytes, sides=None, *, noise=None):
    """Yield the beats of packets, with a value beside each of them.

    `sides` has a value for each packet, or a function from `last` to it. Lanes that are not valid
    have random bytes.
    """
    noise = noise or random.Random(bus_bytes)
    side_at = 8 * bus_bytes + bus_bytes.bit_length() + 1
    for number, packet in enumerate(packets):
        for beat in packet_beats(packet, bus_bytes, noise):
            side = 0 if sides is None else sides[number]
            last = beat >> (side_at - 1)
            yield beat | (side(last) if callable(side) else side) << side_at


@dataclass
class Trace:
    """The record of a run.

    Attributes
    ----------
    packets, sides
        By output: its packets, and the values beside the beats of each.
    times
        By stream: the cycles of its transfers.
    events
        By event: pairs of the cycle and the value.
    others
        By other stream: the bits of its payloads.
    """

    packets: dict[str, list[bytes]] = field(default_factory=dict)
    sides: dict[str, list[set[int]]] = field(default_factory=dict)
    times: dict[str, list[int]] = field(default_factory=dict)
    events: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    others: dict[str, list[int]] = field(default_factory=dict)

    def values(self, event):
        """Return the values of an event, without the cycles."""
        return [value for _, value in self.events[event]]

    @property
    def counts(self):
        """Return the numbers of packets, transfers and events so far."""
        return {
            **{name: len(packets) for name, packets in self.packets.items()},
            **{name: len(each) for name, each in self.events.items()},
            **{name: len(each) for name, each in self.others.items()},
        }


class PacketBench:
    """A part with packet streams, ready to run.

    Parameters
    ----------
    outputs : mapping of str to (stream, bus_bytes, side or None)
    others : mapping of str to stream
        Outputs that carry no packets.
    events : mapping of str to (signal, value)
        Signals of one bit that are high for a cycle per event.
    """

    def __init__(
        self,
        design,
        inputs: Mapping[str, object],
        outputs: Mapping[str, tuple],
        *,
        others=None,
        events=None,
        final=None,
        keeps_state: bool = False,
    ):
        self.inputs, self.outputs, self.others = dict(inputs), dict(outputs), dict(others or {})
        self.events = list(events or {})
        self.final = dict(final or {})
        sides = {
            name: Cat(Value.cast(port.payload), Const(0, 0) if side is None else side)
            for name, (port, _, side) in self.outputs.items()
        }
        sinks = {name: port for name, (port, _, _) in self.outputs.items()} | self.others
        ports = Ports(sources=self.inputs, sinks=sinks, payloads=sides)
        flags = [Cat(flag, value) for flag, value in (events or {}).values()]
        flags += [Value.cast(value) for value in self.final.values()]
        self.bench = Bench(design, ports, probes=flags, keeps_state=keeps_state)

    def run(
        self, sources: Mapping[str, Sequence[int]], want: Mapping[str, int], **options
    ) -> Trace:
        """Send beats until each output and event has reached the number in `want`.

        `want` may also have the number of transfers of an input.
        """
        seen = Trace(
            {name: [] for name in self.outputs},
            {name: [] for name in self.outputs},
            {name: [] for name in (*self.inputs, *self.outputs, *self.others)},
            {name: [] for name in self.events},
            {name: [] for name in self.others},
        )
        self.state: dict[str, int] = {}
        job = Job(
            sources=dict(sources),
            takes={
                **{name: self._input(seen, name) for name in self.inputs},
                **{name: self._output(seen, name) for name in self.outputs},
                **{name: self._other(seen, name) for name in self.others},
            },
            finished=lambda: all(self._has(seen, name) >= most for name, most in want.items()),
            outstanding=lambda: (
                f"{ {name: (self._has(seen, name), most) for name, most in want.items()} }"
            ),
            options=RunOptions(
                observe=self._observer(seen),
                **({"settle": 8, "deadline": 200} | options),
            ),
        )
        self.bench.run(job)
        return seen

    def _has(self, seen, name):
        return len(seen.times[name]) if name in self.inputs else seen.counts[name]

    def _input(self, seen, name):
        return lambda cycle, _: seen.times[name].append(cycle)

    def _other(self, seen, name):
        def take(cycle, bits):
            seen.times[name].append(cycle)
            seen.others[name].append(bits)

        return take

    def _output(self, seen, name):
        port, bus_bytes, _ = self.outputs[name]
        rules, collector = PacketRules(name, bus_bytes), PacketCollector(bus_bytes)
        width, now = len(Value.cast(port.payload)), set()

        def take(cycle, bits):
            nonlocal now
            seen.times[name].append(cycle)
            payload = bits & ((1 << width) - 1)
            rules.check(cycle, payload)
            now.add(bits >> width)
            if collector.take(payload):
                seen.packets[name].append(collector.packets[-1])
                seen.sides[name].append(now)
                now = set()

        return take

    def _observer(self, seen):
        cycle = -1

        def observe(values):
            nonlocal cycle
            for name, value in zip(self.events, values, strict=False):
                if value & 1 and cycle >= 0:
                    seen.events[name].append((cycle, value >> 1))
            self.state = dict(zip(self.final, values[len(self.events) :], strict=True))
            cycle += 1

        return observe
