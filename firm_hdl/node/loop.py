# amaranth: UnusedElaboratable=no
"""A ready accelerator that does nothing: each message goes back as it came.

With it, a node tests the whole way of a board: link, gates, converters, FIFOs, and the wires to the
host. ``accelerator: firm_hdl.node.loop:Loop`` names it in a description.
"""

from __future__ import annotations

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import connect, flipped

from firm_hdl.errors import UserError
from firm_hdl.node.accelerator import accelerator_signature
from firm_hdl.node.description import Description

__all__ = ["Loop"]


class Loop(wiring.Component):
    """Send the messages of each subscription to the publication of the same type.

    There is only wire inside: latency 0, and ``ready`` of a subscription is that of its
    publication.

    Parameters
    ----------
    description : Description
        Every topic is a subscription or a publication, and has a partner of the same type
        (:meth:`Description.loops`).

    Members
    -------
    As `accelerator_signature` has them.

    Raises
    ------
    UserError
        If a topic has no partner, or is a service.
    """

    def __init__(self, description: Description):
        self._loops = description.loops()
        paired = {topic.id for loop in self._loops for topic in loop}
        for topic in description.topics:
            if topic.kind == "serve":
                raise UserError(f"a loop has no services, and '{topic.name}' is one")
            if topic.id not in paired:
                other = "publication" if topic.kind == "subscribe" else "subscription"
                raise UserError(f"a loop needs a {other} of {topic.type} for '{topic.name}'")
        super().__init__(accelerator_signature(description))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        for came, goes in self._loops:
            inner = getattr(self.subscribe, came.port)
            connect(m, flipped(inner), flipped(getattr(self.publish, goes.port)))
        return m
