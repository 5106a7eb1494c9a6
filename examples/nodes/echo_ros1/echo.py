"""The shortest node: `Echo`, the accelerator of ``echo.yaml``, publishes each text that it gets."""

from __future__ import annotations

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import connect, flipped

from firm_hdl.node import Description, accelerator_signature

__all__ = ["Echo"]


class Echo(wiring.Component):
    """The accelerator: its ports are those of the description."""

    def __init__(self, description: Description) -> None:
        super().__init__(accelerator_signature(description))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        connect(m, flipped(self.subscribe.heard), flipped(self.publish.said))
        return m
