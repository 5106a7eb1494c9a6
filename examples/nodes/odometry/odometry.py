"""A robot with two wheels that knows where it is: also odometry, and a service that resets it.

It goes on from `examples/nodes/wheels`: stamps come from the clock of the node, and a table gives
sines.
"""

from __future__ import annotations

import math
from typing import Any

from amaranth.hdl import Module, Signal, signed
from amaranth.lib import wiring
from amaranth.lib.memory import Memory

from firm_hdl.accelerator import (
    Fixed,
    fixed_to_float,
    float_to_fixed,
    offer_message,
    offer_messages,
    take_message,
)
from firm_hdl.node import Description, accelerator_signature

__all__ = ["Odometry"]

NUMBER = Fixed(40, 20)
"""Numbers inside: +-500,000 in steps of a millionth, such as m/s."""

TICK_BITS = 24
"""Odometry is published when bit 24 of the nanoseconds changes: 60 times a second."""

TABLE_BITS = 10
"""The sine has 2**10 values per turn."""


class Odometry(wiring.Component):
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
        """Take commands, and publish the speeds of the wheels, which are 0.5 m apart."""
        forward, turn = Signal(NUMBER), Signal(NUMBER)
        command = take_message(m, self.subscribe.cmd_vel, fields=["linear.x", "angular.z"])
        speeds = offer_messages(m, left=self.publish.wheel_left, right=self.publish.wheel_right)
        is_free = ~speeds.valid | speeds.ready
        m.d.comb += command.ready.eq(is_free)
        with m.If(is_free):
            m.d.sync += speeds.valid.eq(command.valid)
        with m.If(is_free & command.valid):
            m.d.sync += [
                forward.eq(float_to_fixed(m, command.payload.linear.x, NUMBER)),
                turn.eq(float_to_fixed(m, command.payload.angular.z, NUMBER)),
            ]
        for name, speed in (("left", forward - (turn >> 2)), ("right", forward + (turn >> 2))):
            m.d.comb += speeds.payload[name].data.eq(_float(m, speed))
        return forward, turn

    def _reset(self, m: Module) -> Any:
        """Answer requests; return what is high for a cycle with each."""
        service = self.serve.wheels_reset
        request = take_message(m, service.request)
        response = offer_message(m, service.response, constants={"message": "at zero"})
        m.d.comb += [
            response.valid.eq(request.valid),
            request.ready.eq(response.ready),
            response.payload.success.eq(1),
        ]
        return request.valid & request.ready

    def _odometry(self, m: Module, forward: Signal, turn: Signal, reset: Any) -> None:
        """Add up the way since the last tick, and publish where the robot is."""
        x, y = Signal(NUMBER), Signal(NUMBER)
        # A turn has 2**32 steps, so that the heading needs no limit.
        heading = Signal(32)
        way, bend = Signal(NUMBER), Signal(NUMBER)
        sec, nanosec = Signal(32), Signal(32)
        sine = {
            name: Signal(signed(18), name=name) for name in ("sin", "cos", "sin_half", "cos_half")
        }
        angle, now_at = self._sine(m)
        odom = offer_message(
            m,
            self.publish.odom,
            constants={"header.frame_id": "odom", "child_frame_id": "base"},
        )
        stamp, pose = odom.payload.header.stamp, odom.payload.pose.pose
        twist = odom.payload.twist.twist
        # What is not assigned is 0.
        m.d.comb += [
            stamp.sec.eq(sec),
            stamp.nanosec.eq(nanosec),
            pose.position.x.eq(_float(m, x)),
            pose.position.y.eq(_float(m, y)),
            pose.orientation.z.eq(_float(m, sine["sin_half"], 16)),
            pose.orientation.w.eq(_float(m, sine["cos_half"], 16)),
        ]
        seconds = self._seconds(m, sec, nanosec)
        changed = (self.time.sec != sec) | (self.time.nanosec[TICK_BITS:] != nanosec[TICK_BITS:])
        quarter = 1 << (TABLE_BITS - 2)
        places = {
            "sin": heading[32 - TABLE_BITS :],
            "cos": heading[32 - TABLE_BITS :] + quarter,
            "sin_half": heading[33 - TABLE_BITS :],
            "cos_half": heading[33 - TABLE_BITS :] + quarter,
        }
        is_reset = Signal()
        with m.FSM():
            with m.State("WAIT"):
                # Not while a position is computed, or a message is offered.
                with m.If(is_reset):
                    m.d.sync += [x.eq(0), y.eq(0), heading.eq(0), is_reset.eq(0)]
                with m.Elif(changed):
                    m.d.sync += [
                        way.eq((forward * seconds) >> 30),
                        bend.eq((turn * seconds) >> 30),
                        twist.linear.x.eq(_float(m, forward)),
                        twist.angular.z.eq(_float(m, turn)),
                        sec.eq(self.time.sec),
                        nanosec.eq(self.time.nanosec),
                    ]
                    m.next = "TURN"
            with m.State("TURN"):
                # Radians become steps: 2**32 / (2 pi) / 2**20.
                steps = round((1 << 32 - NUMBER.fraction_bits) / (2 * math.pi) * 256)
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
                m.d.comb += odom.valid.eq(1)
                with m.If(odom.ready):
                    m.next = "WAIT"
        with m.If(reset):
            m.d.sync += is_reset.eq(1)

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


def _float(m: Module, number: Any, fraction_bits: int = NUMBER.fraction_bits) -> Signal:
    return fixed_to_float(m, number, fraction_bits, 64)
