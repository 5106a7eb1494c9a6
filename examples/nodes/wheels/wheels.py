"""A robot with two wheels, 0.5 m apart: Twist comes in, the speeds of both wheels go out."""

from amaranth.hdl import Module
from amaranth.lib import wiring

from firm_hdl.accelerator import (
    Fixed,
    fixed_to_float,
    float_to_fixed,
    offer_messages,
    take_message,
)
from firm_hdl.node import accelerator_signature

SPEED = Fixed(32, 16)
"""m/s and rad/s: up to 32,767, in steps of 1/65,536."""


class Wheels(wiring.Component):
    def __init__(self, description):
        super().__init__(accelerator_signature(description))

    def elaborate(self, platform):
        m = Module()
        command = take_message(m, self.subscribe.cmd_vel, fields=["linear.x", "angular.z"])
        speeds = offer_messages(m, left=self.publish.wheel_left, right=self.publish.wheel_right)

        forward = float_to_fixed(m, command.payload.linear.x, SPEED)
        turn = float_to_fixed(m, command.payload.angular.z, SPEED)
        left, right = forward - (turn >> 2), forward + (turn >> 2)

        # A register between both: it is free if it has no speeds, or they are taken now.
        is_free = ~speeds.valid | speeds.ready
        m.d.comb += command.ready.eq(is_free)
        with m.If(is_free):
            m.d.sync += [
                speeds.valid.eq(command.valid),
                speeds.payload.left.data.eq(fixed_to_float(m, left, 16, 64)),
                speeds.payload.right.data.eq(fixed_to_float(m, right, 16, 64)),
            ]
        return m
