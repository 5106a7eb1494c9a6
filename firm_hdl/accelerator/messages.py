"""Whole messages inside an accelerator: one stream in place of one for each leaf.

The functions connect a message interface in a module: a port of the component itself, such as
``self.subscribe.cmd_vel``, or of a converter inside it, such as ``rx.message``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from amaranth.hdl import Cat, Module, Signal, Value
from amaranth.lib import data, stream
from amaranth.lib.wiring import FlippedInterface, connect, flipped

from firm_hdl.gateware import MessageSignature, RecordReader, RecordWriter
from firm_hdl.gateware.interfaces import Stream
from firm_hdl.gateware.members import member_tree
from firm_hdl.gateware.signatures import PartSignature
from firm_hdl.model import Array, FieldType, Message, Primitive, Sequence, String, is_fixed_size
from firm_hdl.plan import Leaf, build_plan
from firm_hdl.sim.payloads import encoder_of
from firm_hdl.sim.values import to_transfers
from firm_hdl.wire import lay_out

__all__ = ["offer_message", "offer_messages", "take_message", "tie_off"]


def take_message(m: Module, message: Any, *, fields: Iterable[str] | None = None) -> Stream[Any]:
    """Take messages as one stream, which is valid when all of its fields have come.

    Latency 0; `valid` depends combinationally on the leaves' `valid`, and their `ready` on `ready`.
    Fields that are not in the stream are taken at once, and ignored.

    Parameters
    ----------
    message : interface of a MessageSignature
        A message that comes.
    fields : iterable of str or None
        Dotted names, such as ``"linear.x"``. `None`: all fields of fixed size that are not inside a
        sequence.

    Returns
    -------
    stream
        Its payload is that of :func:`.record_layout`: ``command.payload.linear.x``.

    Raises
    ------
    TypeError
        If `message` is no message.
    ValueError
        As :func:`.record_layout`.
    """
    source, signature = _plain(message)
    reader = RecordReader(
        signature.message, wire=signature.wire, bus_bytes=signature.bus_bytes, fields=fields
    )
    m.submodules += reader
    connect(m, source, reader.message)
    if "rest" in reader.signature.members:
        _take_all(m, reader.rest)
    record: Stream[Any] = reader.record
    return record


def tie_off(m: Module, *messages: Any) -> None:
    """Take messages that come, or parts of them, and ignore them.

    A message that an accelerator never sends needs nothing: its `valid` is 0 by itself.

    Parameters
    ----------
    messages : interfaces
        Of a MessageSignature, or of a part of one: ``rx.message.header``, ``rx.message.height``.

    Raises
    ------
    TypeError
        If one of them is no part of a message.
    """
    for each in messages:
        plain = flipped(each) if isinstance(each, FlippedInterface) else each
        kinds = MessageSignature, PartSignature, stream.Signature
        if not isinstance(getattr(plain, "signature", None), kinds):
            raise TypeError(f"A message interface is needed, not {each!r}")
        _take_all(m, plain)


def offer_message(
    m: Module,
    message: Any,
    *,
    fields: Iterable[str] | None = None,
    constants: Mapping[str, object] | None = None,
) -> Stream[Any]:
    """Offer messages as one stream. A transfer of it ends when all leaves were taken.

    Latency 0; the leaves' `valid` depends combinationally on `valid`, and `ready` on their `ready`.
    As on any stream, `valid` must not wait for `ready`.

    Parameters
    ----------
    message : interface of a MessageSignature
        A message that is sent.
    fields : iterable of str or None
        Dotted names of the fields in the stream. `None`: all fields of fixed size that are not
        inside a sequence.
    constants : mapping or None
        Values of other fields by dotted name, as :class:`firm_hdl.sim.MessagePort` takes them:
        ``{"header.frame_id": "odom"}``. What has neither is 0, or empty.

    Returns
    -------
    stream
        Its payload is that of :func:`.record_layout`, with no members if there is no such field.

    Raises
    ------
    TypeError, ValueError
        As :func:`.record_layout`; or if `message` is no message, or a constant is no value of a
        field, or has its place in the stream.
    """
    source, signature = _plain(message)
    kind: Message = signature.message
    parts: list[tuple[Value, Value]] = []
    layout = data.StructLayout({})
    fixed: Any = None
    rest: Any = flipped(source)
    if fields is not None or _has_fixed(kind):
        writer = RecordWriter(
            kind, wire=signature.wire, bus_bytes=signature.bus_bytes, fields=fields
        )
        m.submodules += writer
        connect(m, writer.message, rest)
        fixed, layout = writer.record, writer.record.payload.shape()
        parts.append((fixed.valid, fixed.ready))
        rest = writer.rest if "rest" in writer.signature.members else None
    offered: Stream[Any] = stream.Signature(layout).create(path=("offered",))
    if fixed is not None:
        m.d.comb += Value.cast(fixed.payload).eq(Value.cast(offered.payload))
    plan = build_plan(lay_out(kind, signature.wire), bus_bytes=signature.bus_bytes)
    transfers = to_transfers(plan, kind, _constants(kind, constants or {}))
    tree = member_tree(leaf.path for leaf in plan.leaves)
    left = set()
    for index, path in tree.leaves():
        port = _member(rest, path)
        if port is not None:
            leaf = plan.leaves[index]
            left.add(leaf.path)
            encode = encoder_of(leaf)
            if payloads := [encode(each) for each in transfers[index]]:
                parts.append(_repeated(m, port, payloads))
            else:
                m.d.comb += port.valid.eq(0)
    _check_constants(constants or {}, plan.leaves, left)
    _together(m, offered, parts)
    return offered


def offer_messages(m: Module, **messages: Any) -> Stream[Any]:
    """Offer several messages as one stream; the parts are those of :func:`offer_message`.

    A transfer ends when all of the messages were taken.

    Parameters
    ----------
    messages : interfaces of a MessageSignature

    Returns
    -------
    stream
        The payload has the messages by name: ``speeds.payload.left.data``.
    """
    offers = {name: offer_message(m, message) for name, message in messages.items()}
    layout = data.StructLayout({name: each.payload.shape() for name, each in offers.items()})
    offered: Stream[Any] = stream.Signature(layout).create(path=("offered",))
    for name, each in offers.items():
        m.d.comb += each.payload.eq(offered.payload[name])
    _together(m, offered, [(each.valid, each.ready) for each in offers.values()])
    return offered


def _plain(message: Any) -> tuple[Any, Any]:
    """Return a message as the side that sends it sees it, and its signature.

    That is a port `Out` of a part, and one's own port `In` without its flip. What is offered goes
    to the flipped one: a port `In` of a part, and one's own port `Out`.
    """
    plain = flipped(message) if isinstance(message, FlippedInterface) else message
    signature = getattr(plain, "signature", None)
    if isinstance(signature, PartSignature | stream.Signature):
        path, ready = next((p, s) for p, _, s in signature.flatten(plain) if p[-1] == "ready")
        name = ready.name.removesuffix("__".join(["", *map(str, path)])).replace("__", ".")
        raise TypeError(f"The interface of a whole message is needed, not {name!r}")
    if not isinstance(signature, MessageSignature):
        raise TypeError(f"A message interface is needed, not {message!r}")
    return plain, signature


def _take_all(m: Module, interface: Any) -> None:
    for path, _, ready in interface.signature.flatten(interface):
        if path[-1] == "ready":
            m.d.comb += ready.eq(1)


def _member(interface: Any, path: tuple[str, ...]) -> Any:
    """Return the member of an interface at a path; `None` if it has none."""
    for name in path:
        if interface is None or name not in interface.signature.members:
            return None
        interface = getattr(interface, name)
    return interface


def _repeated(m: Module, port: Any, payloads: list[int]) -> tuple[Value, Value]:
    """Offer constants, one after the other; return `valid`, and whether the last is taken."""
    index = Signal(range(len(payloads)))
    is_last = index == len(payloads) - 1
    with m.Switch(index):
        for number, payload in enumerate(payloads):
            with m.Case(number):
                m.d.comb += Value.cast(port.payload).eq(payload)
    if len(payloads) > 1:
        with m.If(port.valid & port.ready):
            m.d.sync += index.eq(index + 1)
            with m.If(is_last):
                m.d.sync += index.eq(0)
    return port.valid, port.ready & is_last


def _together(m: Module, offered: Stream[Any], parts: list[tuple[Value, Value]]) -> None:
    """Offer all parts with a stream, which is taken when the last of them is."""
    ends: list[Value] = []
    for valid, ready in parts:
        done = Signal(name="done")
        m.d.comb += valid.eq(offered.valid & ~done)
        ends.append(done | ready)
        with m.If(offered.valid & offered.ready):
            m.d.sync += done.eq(0)
        with m.Elif(valid & ready):
            m.d.sync += done.eq(1)
    m.d.comb += offered.ready.eq(Cat(ends).all())


def _has_fixed(message: Message) -> bool:
    """Return whether a record of a message has members."""
    kinds = [item.type for item in message.fields]
    return not kinds or any(
        _has_fixed(kind) if isinstance(kind, Message) else is_fixed_size(kind) for kind in kinds
    )


def _constants(message: Message, constants: Mapping[str, object]) -> dict[str, Any]:
    """Return the value of a message: 0 and empty, but for the constants."""
    value: dict[str, Any] = _zero(message)
    for name, constant in constants.items():
        *outer, last = name.split(".")
        place: Any = value
        for part in outer:
            place = place.get(part) if isinstance(place, dict) else None
        if not isinstance(place, dict) or last not in place:
            raise ValueError(f"Message {message.name} has no field {name!r}")
        place[last] = constant
    return value


def _zero(kind: FieldType) -> Any:
    match kind:
        case Primitive():
            return False if kind.kind == "bool" else 0
        case String():
            return ""
        case Array(element=element, count=count):
            return [_zero(element)] * count
        case Sequence():
            return []
        case Message(fields=fields):
            return {item.name: _zero(item.type) for item in fields}


def _check_constants(
    constants: Mapping[str, object], leaves: Iterable[Leaf], left: set[tuple[str, ...]]
) -> None:
    """Check that no constant is that of a field in the stream."""
    for name in constants:
        path = tuple(name.split("."))
        for leaf in leaves:
            if leaf.path[: len(path)] == path and leaf.path not in left:
                raise ValueError(f"Field {name!r} is in the stream: assign its payload")
