"""Top levels with the record view: a message of fixed size as one vector with one handshake.

The vector has the layout of `gateware.record_layout`, with the first field in the lowest bits. The
user's layer in VHDL converts it to a record (:mod:`firm_hdl.export.vhdl.values`).
"""

from __future__ import annotations

from collections.abc import Mapping

from amaranth.hdl import Instance, Module, Value

from firm_hdl.export.top import (
    MAX_INPUT_BITS,
    Direction,
    Port,
    add_domain,
    leaf_members,
    port_members,
    ports_of,
)
from firm_hdl.gateware import RecordReader, RecordWriter
from firm_hdl.gateware.component import Component
from firm_hdl.gateware.record_layout import Record
from firm_hdl.model import Message
from firm_hdl.plan import Plan

__all__ = ["RecordTop", "record_ports", "why_no_record"]

_RECORD = "msg"
"""Prefix of the names of the record's ports."""


def why_no_record(message: Message, plan: Plan) -> str:
    """Return why a message cannot have a record view; empty if it can."""
    if not message.is_fixed_size:
        return f"{message.name} has no fixed size"
    if not message.fields:
        return f"Message {message.name} has no field of fixed size for a record; its fields: none"
    try:
        layout = Record(message, plan, None).layout
    except ValueError as error:
        return str(error)
    # The vector and all other inputs of a serializer.
    inputs = [p.width for p in record_ports(plan, "serializer", layout.size) if p.direction == "in"]
    if sum(inputs) > MAX_INPUT_BITS:
        return (
            f"Record of {message.name} is too wide: it has {layout.size} bits, its serializer "
            f"{sum(inputs)} input bits, and Amaranth elaborates at most {MAX_INPUT_BITS}"
        )
    return ""


def record_ports(plan: Plan, direction: Direction, bits: int) -> tuple[Port, ...]:
    """List the ports of a top level: clock, reset, packets, the record, status.

    * `bits`: size of the record.
    """
    ports = [port for port in ports_of(plan, direction) if port.leaf is None]
    status = next(k for k, port in enumerate(ports) if port.name.startswith("m_axis_status"))
    forward, backward = ("in", "out") if direction == "serializer" else ("out", "in")
    record = [
        (f"{_RECORD}_data", forward, bits, f"{plan.message}, first field in the lowest bits."),
        (f"{_RECORD}_valid", forward, 1, "Valid: the whole message is offered."),
        (f"{_RECORD}_ready", backward, 1, "Ready: the message is taken."),
    ]
    ports[status:status] = [
        Port(name=name, direction="in" if way == "in" else "out", width=width, meaning=meaning)
        for name, way, width, meaning in record
    ]
    return tuple(ports)


class RecordTop(Component):
    """An instance of a converter, with AXI4-Stream and one vector on its message side.

    The latency is the converter's; see `RecordReader` and `RecordWriter` for the paths between
    ``msg_valid`` and ``msg_ready``. Clock and reset are those of :class:`Top`.

    Parameters
    ----------
    message : Message
        Has a fixed size.
    plan : Plan
        The plan of the converter.
    direction : Direction
    entity : str
        Name of the converter's top level.
    names : mapping of str to str
        Names of its ports, where they differ from those of :func:`ports_of`.

    Members
    -------
    As :func:`record_ports` lists them.

    Raises
    ------
    ValueError
        If the message has no record view; :func:`why_no_record` says why.
    """

    def __init__(
        self,
        message: Message,
        plan: Plan,
        direction: Direction,
        entity: str,
        names: Mapping[str, str],
    ):
        reason = why_no_record(message, plan)
        if reason:
            raise ValueError(reason)
        adapter = RecordReader if direction == "deserializer" else RecordWriter
        self.record = adapter(message, plan=plan)
        self.plan, self.direction = plan, direction
        self.entity, self.names = entity, names
        bits = len(Value.cast(self.record.record.payload))
        super().__init__(port_members(record_ports(plan, direction, bits)))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        add_domain(m, "sync", self.aclk, self.aresetn)
        m.submodules.record = self.record
        leaves = dict(leaf_members(self.record.message, self.record.tree))
        actuals = {}
        for port in ports_of(self.plan, self.direction):
            leaf = port.leaf
            value = getattr(self, port.name) if leaf is None else leaves[leaf][port.member]
            actuals[f"{port.direction[0]}_{self.names.get(port.name, port.name)}"] = value
        m.submodules.core = Instance(self.entity, **actuals)
        stream = self.record.record
        vector = Value.cast(stream.payload)
        if self.direction == "deserializer":
            m.d.comb += [
                self.msg_data.eq(vector),
                self.msg_valid.eq(stream.valid),
                stream.ready.eq(self.msg_ready),
            ]
        else:
            m.d.comb += [
                vector.eq(self.msg_data),
                stream.valid.eq(self.msg_valid),
                self.msg_ready.eq(stream.ready),
            ]
        return m
