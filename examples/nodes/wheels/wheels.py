"""A robot with two wheels: speeds of the wheels, odometry, and a service that resets it.

`Wheels` is the accelerator of ``wheels.yaml``. `mix` is what makes it a robot with two wheels;
the rest takes messages and offers new ones.
"""

from __future__ import annotations

import math
from typing import Any

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value, signed
from amaranth.lib import wiring
from amaranth.lib.memory import Memory

from firm_hdl.node import Description, accelerator_signature

__all__ = ["Wheels"]

BITS = 40
FRACTION_BITS = 20
"""Numbers inside are signed and fixed: +-500,000 in steps of a millionth, such as m/s."""

TICK_BITS = 24
"""Odometry is published when bit 24 of the nanoseconds changes: 60 times a second."""

TABLE_BITS = 10
"""The sine has 2**10 values per turn."""


def mix(forward: Any, turn: Any) -> tuple[Any, Any]:
    """Return the speeds of the left and the right wheel in m/s; they are 0.5 m apart."""
    return forward - (turn >> 2), forward + (turn >> 2)


class Offers:
    """Messages of a publication whose leaves are offered at once, each until it is taken."""

    def __init__(self, m: Module) -> None:
        self._m = m
        self._waiting: list[Any] = []
        self.go = Signal()
        self.is_free = Signal(init=1)

    def value(self, leaf: Any, value: Any) -> None:
        """Offer a leaf with one transfer."""
        waits = Signal()
        self._m.d.comb += [leaf.valid.eq(waits), leaf.payload.eq(value)]
        self._take(waits, leaf.ready)

    def text(self, leaf: Any, text: str) -> None:
        """Offer a text of at most one transfer, 8 bytes."""
        self.value(leaf.length, len(text))
        if text:
            self._m.d.comb += leaf.items.payload.last.eq(1)
            waits = Signal()
            data = leaf.items.payload.data
            self._m.d.comb += [data[lane].eq(ord(each)) for lane, each in enumerate(text)]
            self._m.d.comb += leaf.items.valid.eq(waits)
            self._take(waits, leaf.items.ready)
        else:
            self._m.d.comb += leaf.items.valid.eq(0)

    def zeros(self, leaf: Any, count: int) -> None:
        """Offer an array of zeros, one per transfer."""
        waits, place = Signal(), Signal(range(count))
        self._m.d.comb += [
            leaf.items.valid.eq(waits),
            leaf.items.payload.last.eq(place == count - 1),
        ]
        with self._m.If(waits & leaf.items.ready):
            self._m.d.sync += place.eq(Mux(place == count - 1, 0, place + 1))
        self._take(waits, leaf.items.ready & (place == count - 1))

    def _take(self, waits: Signal, taken: Any) -> None:
        with self._m.If(taken):
            self._m.d.sync += waits.eq(0)
        with self._m.If(self.go):
            self._m.d.sync += waits.eq(1)
        self._waiting.append(waits)

    def done(self) -> None:
        """No further leaf comes."""
        self._m.d.comb += self.is_free.eq(~Cat(self._waiting).any())


class Wheels(wiring.Component):
    """The accelerator: its ports are those of the description."""

    def __init__(self, description: Description) -> None:
        super().__init__(accelerator_signature(description))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        forward, turn = self._commands(m)
        reset = self._reset(m)
        self._odometry(m, forward, turn, reset)
        return m

    def _commands(self, m: Module) -> tuple[Signal, Signal]:
        """Take commands, and publish the speeds of the wheels."""
        command = self.subscribe.cmd_vel
        forward, turn = Signal(signed(BITS)), Signal(signed(BITS))
        offers = Offers(m)
        for leaf in (command.linear.y, command.linear.z, command.angular.x, command.angular.y):
            m.d.comb += leaf.ready.eq(1)
        # The turn is the last field: both numbers are taken together.
        ends = command.linear.x.valid & command.angular.z.valid & offers.is_free & ~offers.go
        m.d.comb += [command.linear.x.ready.eq(ends), command.angular.z.ready.eq(ends)]
        m.d.sync += offers.go.eq(ends)
        with m.If(ends):
            m.d.sync += [
                forward.eq(from_float64(m, command.linear.x.payload)),
                turn.eq(from_float64(m, command.angular.z.payload)),
            ]
        wheels = (self.publish.wheel_left, self.publish.wheel_right)
        for leaf, speed in zip(wheels, mix(forward, turn), strict=True):
            fixed = Signal(signed(BITS + 1))
            m.d.comb += fixed.eq(speed)
            offers.value(leaf.data, to_float64(m, fixed))
        offers.done()
        return forward, turn

    def _reset(self, m: Module) -> Signal:
        """Answer requests; return a signal that is high for a cycle with each."""
        service = self.serve.wheels_reset
        asked, answer = service.request.structure_needs_at_least_one_member, service.response
        offers = Offers(m)
        m.d.comb += [
            asked.ready.eq(offers.is_free & ~offers.go),
        ]
        m.d.sync += offers.go.eq(asked.valid & asked.ready)
        offers.value(answer.success, 1)
        offers.text(answer.message, "at zero")
        offers.done()
        return offers.go

    def _odometry(self, m: Module, forward: Signal, turn: Signal, reset: Signal) -> None:
        """Add up the way since the last tick, and publish where the robot is."""
        x, y = Signal(signed(BITS)), Signal(signed(BITS))
        # A turn has 2**32 steps, so that the heading needs no limit.
        heading = Signal(32)
        way, bend = Signal(signed(BITS)), Signal(signed(BITS))
        sec, nanosec = Signal(32), Signal(32)
        sine = {
            name: Signal(signed(18), name=name) for name in ("sin", "cos", "sin_half", "cos_half")
        }
        angle, now_at = self._sine(m)
        offers = self._offer_odometry(m, x, y, sine, forward, turn, sec, nanosec)
        seconds = self._seconds(m, sec, nanosec)
        changed = (self.time.sec != sec) | (self.time.nanosec[TICK_BITS:] != nanosec[TICK_BITS:])
        quarter = 1 << (TABLE_BITS - 2)
        places = {
            "sin": heading[32 - TABLE_BITS :],
            "cos": heading[32 - TABLE_BITS :] + quarter,
            "sin_half": heading[33 - TABLE_BITS :],
            "cos_half": heading[33 - TABLE_BITS :] + quarter,
        }
        with m.FSM():
            with m.State("WAIT"), m.If(changed & offers.is_free):
                m.d.sync += [
                    way.eq((forward * seconds) >> 30),
                    bend.eq((turn * seconds) >> 30),
                    sec.eq(self.time.sec),
                    nanosec.eq(self.time.nanosec),
                ]
                m.next = "TURN"
            with m.State("TURN"):
                # Radians become steps: 2**32 / (2 pi) / 2**20.
                steps = round((1 << 32 - FRACTION_BITS) / (2 * math.pi) * 256)
                m.d.sync += heading.eq(heading + ((bend * steps) >> 8))
                m.next = "sin"
            for name, following in zip(places, [*list(places)[1:], "MOVE"], strict=True):
                with m.State(name):
                    m.d.comb += angle.eq(places[name])
                    m.next = f"{name} comes"
                with m.State(f"{name} comes"):
                    m.d.sync += sine[name].eq(now_at)
                    m.next = following
            with m.State("MOVE"):
                m.d.sync += [
                    x.eq(x + ((way * sine["cos"]) >> 16)),
                    y.eq(y + ((way * sine["sin"]) >> 16)),
                ]
                m.next = "PUBLISH"
            with m.State("PUBLISH"):
                m.d.comb += offers.go.eq(1)
                m.next = "WAIT"
        with m.If(reset):
            m.d.sync += [x.eq(0), y.eq(0), heading.eq(0)]

    def _seconds(self, m: Module, sec: Signal, nanosec: Signal) -> Signal:
        """Return the time since a tick in 2**-30 s; 0 after a second, or if the clock was set."""
        passed, seconds = Signal(signed(33)), Signal(signed(32))
        with m.If(self.time.sec == sec):
            m.d.comb += passed.eq(self.time.nanosec - nanosec)
        with m.Elif(self.time.sec == (sec + 1)[:32]):
            m.d.comb += passed.eq(self.time.nanosec - nanosec + 1_000_000_000)
        with m.If((passed > 0) & (passed < 1_000_000_000)):
            m.d.comb += seconds.eq((passed * round(1.073741824 * 1024)) >> 10)
        return seconds

    def _sine(self, m: Module) -> tuple[Signal, Any]:
        """Return the address of a table of sines, and its value a cycle later, with 16 bits."""
        size = 1 << TABLE_BITS
        values = [round(65536 * math.sin(2 * math.pi * n / size)) for n in range(size)]
        m.submodules.sines = sines = Memory(shape=signed(18), depth=size, init=values)
        port = sines.read_port()
        angle = Signal(TABLE_BITS)
        m.d.comb += port.addr.eq(angle)
        return angle, port.data

    def _offer_odometry(
        self, m: Module, x: Any, y: Any, sine: Any, forward: Any, turn: Any, sec: Any, nanosec: Any
    ) -> Offers:
        """Offer an Odometry with what the signals are when it is begun."""
        message = self.publish.odom
        pose, twist = message.pose.pose, message.twist.twist
        offers = Offers(m)
        offers.value(message.header.stamp.sec, sec)
        offers.value(message.header.stamp.nanosec, nanosec)
        offers.text(message.header.frame_id, "odom")
        offers.text(message.child_frame_id, "base")
        halves = {"z": sine["sin_half"], "w": sine["cos_half"]}
        numbers = {
            pose.position.x: x,
            pose.position.y: y,
            twist.linear.x: forward,
            twist.angular.z: turn,
            **{getattr(pose.orientation, name): half << 4 for name, half in halves.items()},
        }
        for leaf, number in numbers.items():
            offers.value(leaf, to_float64(m, number))
        for group, names in ((pose.position, "z"), (pose.orientation, "xy"), (twist.linear, "yz")):
            for name in names:
                offers.value(getattr(group, name), Const(0, 64))
        for name in "xy":
            offers.value(getattr(twist.angular, name), Const(0, 64))
        offers.zeros(message.pose.covariance, 36)
        offers.zeros(message.twist.covariance, 36)
        offers.done()
        return offers


_BIAS = 1023
_MANTISSA_BITS = 52


def from_float64(m: Module, number: Value) -> Signal:
    """Return a float64 (IEEE 754) as a fixed-point number; combinational.

    What is too large becomes the largest one, what is no number becomes 0, and the rest is cut
    towards 0.
    """
    mantissa, exponent, sign = number[:_MANTISSA_BITS], number[_MANTISSA_BITS:63], number[63]
    largest = (1 << (BITS - 1)) - 1
    # The point of the mantissa is behind its highest bit.
    shift, magnitude = Signal(12), Signal(BITS - 1)
    shifted = Cat(mantissa, Const(1, 1)) >> shift[:6]
    fixed = Signal(signed(BITS))
    m.d.comb += [
        shift.eq(_BIAS + _MANTISSA_BITS - FRACTION_BITS - exponent),
        magnitude.eq(Mux(shift[6:].any(), 0, shifted)),
        fixed.eq(Mux(sign, -magnitude, magnitude)),
    ]
    with m.If(exponent >= _BIAS + BITS - 1 - FRACTION_BITS):
        is_nan = exponent.all() & mantissa.any()
        m.d.comb += magnitude.eq(Mux(is_nan, 0, largest))
    return fixed


def to_float64(m: Module, fixed: Value) -> Signal:
    """Return a fixed-point number of at most 53 bits as the equal float64."""
    sign = fixed[-1]
    magnitude = Signal(len(fixed))
    number = Signal(64)
    m.d.comb += magnitude.eq(Mux(sign, -fixed, fixed))
    # The highest bit that is set decides; later statements have priority.
    for place in range(len(fixed)):
        with m.If(magnitude[place]):
            mantissa = Cat(Const(0, _MANTISSA_BITS - place), magnitude[:place])
            exponent = Const(_BIAS + place - FRACTION_BITS, 11)
            m.d.comb += number.eq(Cat(mantissa, exponent, sign))
    return number
