"""Accelerators for tests, one that is right and some that are not."""

from __future__ import annotations

from amaranth.hdl import Module, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import Out

from firm_hdl.node import accelerator_signature

__all__ = ["Echo", "Exploding", "NoComponent", "Other", "echo_text"]


def echo_text(**keys: str) -> str:
    """Return the description of `Echo`."""
    lines = [f"{key}: {value}" for key, value in keys.items()]
    return "\n".join(
        [
            "node: echo",
            "distro: jazzy",
            "accelerator: tests.node.accelerators:Echo",
            "subscribe:",
            "  /heard: {type: std_msgs/msg/String, memory_bytes: 256}",
            "publish:",
            "  /said: {type: std_msgs/msg/String, memory_bytes: 256}",
            "  /stamp: {type: builtin_interfaces/msg/Time}",
            "serve:",
            "  /cal: {type: robot_msgs/srv/Calibrate, memory_bytes: 256}",
            *lines,
        ]
    )


class Echo(wiring.Component):
    """Publish each string as it came, with the time; answer requests with their duration."""

    def __init__(self, description):
        super().__init__(accelerator_signature(description, strings=Out(8)))

    def elaborate(self, platform):
        m = Module()
        came, sent = self.subscribe.heard.data, self.publish.said.data
        length, items = came.length, came.items
        # The time of a string is that of its length.
        stamp, waits = self.publish.stamp, Signal(2)
        free = ~waits.any()
        m.d.comb += [
            sent.length.payload.eq(length.payload),
            sent.length.valid.eq(length.valid & free),
            length.ready.eq(sent.length.ready & free),
            sent.items.payload.eq(items.payload),
            sent.items.valid.eq(items.valid),
            items.ready.eq(sent.items.ready),
            stamp.sec.valid.eq(waits[0]),
            stamp.nanosec.valid.eq(waits[1]),
        ]
        with m.If(length.valid & length.ready):
            m.d.sync += [
                waits.eq(3),
                stamp.sec.payload.eq(self.time.sec),
                stamp.nanosec.payload.eq(self.time.nanosec),
                self.strings.eq(self.strings + 1),
            ]
        with m.If(stamp.sec.valid & stamp.sec.ready):
            m.d.sync += waits[0].eq(0)
        with m.If(stamp.nanosec.valid & stamp.nanosec.ready):
            m.d.sync += waits[1].eq(0)
        self._answer(m)
        return m

    def _answer(self, m):
        request, response = self.serve.cal.request, self.serve.cal.response
        duration, left = request.duration, Signal(3)
        for name, port in vars(request.target).items():
            if name != "signature":
                m.d.comb += [each.ready.eq(1) for each in _streams(port)]
        answers = [response.success, response.errors.length, response.errors.items]
        m.d.comb += [
            duration.ready.eq(left == 0),
            response.success.payload.eq(1),
            response.errors.length.payload.eq(1),
            response.errors.items.payload.last.eq(1),
            *(port.valid.eq(left[number]) for number, port in enumerate(answers)),
        ]
        with m.If(duration.valid & duration.ready):
            m.d.sync += [left.eq(7), response.errors.items.payload.data[0].eq(duration.payload)]
        for number, port in enumerate(answers):
            with m.If(port.valid & port.ready):
                m.d.sync += left[number].eq(0)


def _streams(port):
    if isinstance(port, stream.Interface):
        return [port]
    return [each for name, p in vars(port).items() if name != "signature" for each in _streams(p)]


class Other(wiring.Component):
    """An accelerator for another description."""

    def __init__(self, description):
        super().__init__({"strings": Out(8)})


class NoComponent:
    """Something else."""

    def __init__(self, description):
        self.description = description


class Exploding(wiring.Component):
    """An accelerator with a mistake."""

    def __init__(self, description):
        raise KeyError("no such gain")
