"""A whole node: link, core, converters, and the accelerator."""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Cat, Module, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import Out

from firm_hdl.gateware.component import Component
from firm_hdl.node.accelerator import (
    check_accelerator,
    elaborate_accelerator,
    load_accelerator,
    other_members,
)
from firm_hdl.node.description import Description
from firm_hdl.node.gateware import NodeCore, time_layout
from firm_hdl.node.gateware.converters import NodeConverters, message_groups
from firm_hdl.node.gateware.registers import NodeRegisters, node_register_members
from firm_hdl.node.gateware.streams import node_counters_layout, passes
from firm_hdl.node.links import link_of, medium_of
from firm_hdl.node.rtps.idle import TopicIdle

__all__ = ["Node"]


class Node(Component):
    """The circuit of a description.

    With an accelerator, its message ports are connected with the converters, and its other members
    come out as `io`. Without one, the message ports come out of the node.

    One clock domain, `sync`, whose frequency the description names; its reset discards all packets
    and messages inside, and sets the time to 0.

    Parameters
    ----------
    description : Description
    accelerator : component or None
        An accelerator in place of the one that the description names.

    Members
    -------
    link : the members of the link that face the medium
        Such as `link.datagrams_in` of a :class:`firm_hdl.node.links.UdpLink`.
    time : Out(time_layout())
    counters : Out(node_counters_layout(description))
    axi or csr, interrupt, soft_reset
        As :func:`.node_register_members` has them; only with registers.
    io : the other members of the accelerator
        Only with an accelerator that has some.
    subscribe, publish, serve : as `message_groups` has them
        Only without an accelerator.

    Raises
    ------
    TypeError
        If the description is none.
    DefinitionError
        If the description names an accelerator that cannot be used.
    UserError
        If `accelerator` does not match the description.
    """

    def __init__(self, description: Description, accelerator: Any = None):
        if not isinstance(description, Description):
            raise TypeError(
                "A node is made of a Description, as read_description gives it, "
                f"not {description!r}"
            )
        self.description = description
        if accelerator is not None:
            check_accelerator(description, accelerator)
        elif description.accelerator:
            accelerator = load_accelerator(description)
        self.accelerator = accelerator
        members: dict[str, Any] = {
            "link": Out(wiring.Signature(medium_of(description))),
            "time": Out(time_layout()),
            "counters": Out(node_counters_layout(description)),
            **node_register_members(description),
        }
        if accelerator is None:
            groups = message_groups(description)
            members |= {name: Out(group) for name, group in groups.items()}
        elif others := other_members(accelerator):
            members["io"] = Out(wiring.Signature(others))
        super().__init__(members)

    def elaborate(self, platform: object) -> Module:
        # Streams, and their signatures; a request has a tag, which goes back with its response:
        #
        #   link            core                 converters                accelerator
        #    | LinkSignature |   PacketSignature     |   MessageSignature       |
        #    |-------------->|---------------------->|------------------------->|  subscribe
        #    |               |   RequestSignature    |                          |
        #    |-------------->|---------------------->|------------------------->|  serve: request
        #    |               |   ResponseSignature   |                          |
        #    |<--------------|<----------------------|<-------------------------|  publish, response
        m = Module()
        description = self.description
        m.submodules.link = link = link_of(description)
        m.submodules.core = core = NodeCore(description)
        m.submodules.converters = converters = NodeConverters(description)
        m.d.comb += [
            *passes(link.received, core.received),
            *passes(core.sent, link.sent),
            core.link_counters.eq(link.counters),
            self.time.eq(core.time),
            self.counters.eq(core.counters),
        ]
        _bring_out(m, self.link, link)
        if description.registers:
            self._add_registers(m, core)
        if description.link.kind == "rtps":
            came = [topic for topic in description.topics if topic.has("in")]
            m.d.comb += link.idle.eq(Cat(TopicIdle.of(m, topic, core) for topic in came))
        groups = list(message_groups(description))
        for name in groups:
            wiring.connect(m, getattr(core, name), getattr(converters.packets, name))
        if self.accelerator is None:
            for name in groups:
                inner, outer = getattr(converters, name), getattr(self, name)
                wiring.connect(m, inner, wiring.flipped(outer))
            return m
        accelerator = self.accelerator
        m.submodules.accelerator = elaborate_accelerator(description, accelerator, platform)
        for name in groups:
            wiring.connect(m, getattr(converters, name), getattr(accelerator, name))
        if "time" in accelerator.signature.members:
            m.d.comb += accelerator.time.eq(core.time)
        if "io" in self.signature.members:
            _bring_out(m, self.io, accelerator)
        return m

    def _add_registers(self, m: Module, core: NodeCore) -> None:
        m.submodules.registers = own = NodeRegisters(self.description)
        wiring.connect(m, core.registers, own.core)
        bus = "axi" if self.description.registers == "axi4lite" else "csr"
        wiring.connect(m, wiring.flipped(getattr(self, bus)), getattr(own, bus))
        m.d.comb += [
            own.time.eq(core.time),
            own.counters.eq(core.counters),
            self.interrupt.eq(own.interrupt),
            self.soft_reset.eq(own.soft_reset),
        ]


def _bring_out(m: Module, outer: Any, inner: Any) -> None:
    """Connect the members of an interface of the node with those of a part of it."""
    for path, member, value in outer.signature.flatten(outer):
        target = inner
        for name in path:
            target = target[name] if isinstance(name, int) else getattr(target, name)
        ours, theirs = Value.cast(value), Value.cast(target)
        m.d.comb += ours.eq(theirs) if member.flow == Out else theirs.eq(ours)
