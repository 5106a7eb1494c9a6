"""Top levels with the record view: a message of fixed size as one vector with one handshake.

The vector has the layout of `gateware.record_layout`, with the first field in the lowest bits. The
user's layer in VHDL converts it to a record (:mod:`firm_hdl.export.vhdl.values`).
"""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Module, Value
from amaranth.lib import wiring

from firm_hdl.export.top import MAX_INPUT_BITS, Direction, Port, Top, ports_of
from firm_hdl.gateware import Deserializer, RecordReader, RecordWriter, Serializer, record_layout
from firm_hdl.model import Message
from firm_hdl.plan import Plan

__all__ = ["RecordTop", "record_ports", "why_no_record"]

_RECORD = "msg"
"""Prefix of the names of the record's ports."""


def why_no_record(message: Message, plan: Plan) -> str:
    """Return why a message cannot have a record view; empty if it can."""
    if not message.is_fixed_size:
        return f"{message.name} has no fixed size"
    try:
        layout = record_layout(message, wire=plan.wire)
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

    Parameters
    ----------
    bits : int
        Size of the record.
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


class RecordTop(Top):
    """A converter with AXI4-Stream on its packet side and one vector on its message side.

    The latency is the converter's; see `RecordReader` and `RecordWriter` for the paths between
    ``msg_valid`` and ``msg_ready``. Clock and reset are those of :class:`Top`.

    Parameters
    ----------
    core : Deserializer or Serializer
    message : Message
        The converter's message; has a fixed size.

    Members
    -------
    As :func:`record_ports` lists them.

    Raises
    ------
    ValueError
        If the message has no record view; :func:`why_no_record` says why.
    """

    def __init__(self, core: Deserializer | Serializer, message: Message):
        reason = why_no_record(message, core.plan)
        if reason:
            raise ValueError(reason)
        adapter = RecordReader if isinstance(core, Deserializer) else RecordWriter
        self.record = adapter(message, wire=core.plan.wire, bus_bytes=core.plan.bus_bytes)
        self.bits = record_layout(message, wire=core.plan.wire).size
        super().__init__(core)

    @classmethod
    def of(cls, message: Message, direction: Direction, **options: Any) -> RecordTop:
        """Make a converter of a message and a top level around it.

        Parameters
        ----------
        options
            Keyword arguments of the converter.
        """
        converter = Deserializer if direction == "deserializer" else Serializer
        return cls(converter(message, **options), message)

    def _ports(self) -> tuple[Port, ...]:
        return record_ports(self.core.plan, self.direction, self.bits)

    def _message(self, m: Module) -> None:
        m.submodules.record = self.record
        stream = self.record.record
        vector = Value.cast(stream.payload)
        if self.direction == "deserializer":
            wiring.connect(m, self.core.message, self.record.message)
            m.d.comb += [
                self.msg_data.eq(vector),
                self.msg_valid.eq(stream.valid),
                stream.ready.eq(self.msg_ready),
            ]
        else:
            wiring.connect(m, self.record.message, self.core.message)
            m.d.comb += [
                vector.eq(self.msg_data),
                stream.valid.eq(self.msg_valid),
                self.msg_ready.eq(stream.ready),
            ]
