"""The ports of a component as a simulation from outside sees them: streams, and plain values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

from amaranth.hdl import Const, Elaboratable, Shape, ShapeCastable, Value
from amaranth.lib import stream, wiring

from firm_hdl.gateware.signatures import bus_bytes_of

__all__ = ["PlainPort", "Ports", "StreamPort", "bytes_of", "ports_of"]


def bytes_of(bits: int) -> int:
    """Return the bytes that a value of `bits` bits takes in the protocol: at least one."""
    return max(1, -(-bits // 8))


@dataclass(frozen=True, slots=True, kw_only=True)
class PlainPort:
    """A member of a component that is not part of a stream."""

    name: str  # Names of the members on the way to it, joined with dots.
    is_input: bool
    shape: Any
    value: Value  # The component's own member, as bits.
    init: object = None  # Initial value of an input.

    @property
    def bytes(self) -> int:
        """Bytes of a value in the protocol."""
        return bytes_of(len(self.value))

    def bits(self, value: object) -> int:
        """Return the bits of a value; an integer must fit into the port.

        Raises `ValueError` if an integer has too many bits.
        """
        return _bits(self.name, self.shape, len(self.value), value)

    def view(self, bits: int) -> Any:
        """Return bits as a value of the port's shape, as a testbench of Amaranth reads it."""
        return _view(self.shape, bits)


@dataclass(frozen=True, slots=True, kw_only=True)
class StreamPort:
    """A stream of a component."""

    number: int  # Its place among the streams.
    name: str  # Names of the members on the way to it, joined with dots.
    is_input: bool  # Whether the component receives on it.
    port: stream.Interface  # The component's own member.
    bus_bytes: int  # Bytes per beat of a packet stream; 0 for any other stream.

    @property
    def width(self) -> int:
        """Bits of the payload."""
        return len(Value.cast(self.port.payload))

    @property
    def bytes(self) -> int:
        """Bytes of a payload in the protocol."""
        return bytes_of(self.width)

    @property
    def last_bit(self) -> int | None:
        """The bit of the payload that ends a packet; `None` if the stream has no packets."""
        return self.width - 1 if self.bus_bytes else None

    @property
    def is_always_ready(self) -> bool:
        return isinstance(self.port.ready, Const)

    def bits(self, payload: object) -> int:
        """Return the bits of a payload. See :meth:`PlainPort.bits`."""
        return _bits(self.name, self._shape, self.width, payload)

    def view(self, bits: int) -> Any:
        """Return bits as a payload, as a testbench of Amaranth reads it."""
        return _view(self._shape, bits)

    @property
    def _shape(self) -> Any:
        return self.port.signature.members["payload"].shape


@dataclass(frozen=True, slots=True, kw_only=True)
class Ports:
    """All ports of a component. Numbers of the protocol are places in these tuples."""

    streams: tuple[StreamPort, ...]
    plain: tuple[PlainPort, ...]

    @property
    def inputs(self) -> tuple[PlainPort, ...]:
        return tuple(port for port in self.plain if port.is_input)

    @property
    def outputs(self) -> tuple[PlainPort, ...]:
        return tuple(port for port in self.plain if not port.is_input)

    def stream(
        self, name: str, *, is_input: bool | None = None, is_packets: bool = False
    ) -> StreamPort:
        """Return a stream by its name; `is_input` and `is_packets` say what it has to be.

        Raises `ValueError`.
        """
        known = {s.name: s for s in self.streams if is_input in (None, s.is_input)}
        if name not in known:
            kind = {None: "", True: "input ", False: "output "}[is_input]
            raise ValueError(f"There is no {kind}stream {name!r}; {_listed(known)}")
        if is_packets and not known[name].bus_bytes:
            raise ValueError(f"Stream {name!r} does not carry packets")
        return known[name]

    def plain_port(self, name: str, *, is_input: bool) -> tuple[int, PlainPort]:
        """Return a plain port by its name, and its place among those of its direction.

        Raises `ValueError`.
        """
        ports = self.inputs if is_input else self.outputs
        for number, port in enumerate(ports):
            if port.name == name:
                return number, port
        kind = "input" if is_input else "output"
        names = _listed(port.name for port in ports)
        raise ValueError(f"There is no plain {kind} {name!r}; {names}")


def ports_of(component: Any) -> Ports:
    """Return the ports of a component, in the order of its signature.

    What a `DomainRenamer` made of a component has the same ports.

    Raises `TypeError` if it is not a component of `amaranth.lib.wiring`. Raises `ValueError` if it
    has an input stream with ``always_valid``, which cannot be fed from a queue.
    """
    is_component = isinstance(getattr(component, "signature", None), wiring.Signature)
    if not is_component or not isinstance(component, Elaboratable):
        raise TypeError(
            f"A simulated design must be a component of amaranth.lib.wiring, not {component!r}"
        )
    found = list(_members(component.signature, component, ()))
    streams = [port for port in found if isinstance(port, StreamPort)]
    return Ports(
        streams=tuple(replace(port, number=number) for number, port in enumerate(streams)),
        plain=tuple(port for port in found if isinstance(port, PlainPort)),
    )


def _members(
    signature: wiring.Signature, interface: Any, path: tuple[str, ...]
) -> Iterator[StreamPort | PlainPort]:
    for name, member in signature.members.items():
        for where, value in _elements((*path, name), getattr(interface, name), member.dimensions):
            if member.is_port:
                yield PlainPort(
                    name=".".join(where),
                    is_input=member.flow == wiring.In,
                    shape=member.shape,
                    value=Value.cast(value),
                    init=member.init,
                )
            elif isinstance(value.signature, stream.Signature):
                # The signature of a member has its flow: that of an input is flipped.
                is_input = isinstance(member.signature, wiring.FlippedSignature)
                yield _stream(".".join(where), value, is_input=is_input)
            else:
                yield from _members(member.signature, value, where)


def _elements(
    path: tuple[str, ...], value: Any, dimensions: tuple[int, ...]
) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield the elements of a member that is an array, each with its path."""
    if not dimensions:
        yield path, value
        return
    for index in range(dimensions[0]):
        yield from _elements((*path, str(index)), value[index], dimensions[1:])


def _stream(name: str, port: stream.Interface, *, is_input: bool) -> StreamPort:
    if is_input and isinstance(port.valid, Const):
        raise ValueError(f"Stream {name!r} is an input that is always valid")
    return StreamPort(
        number=0, name=name, is_input=is_input, port=port, bus_bytes=bus_bytes_of(port.payload)
    )


def _bits(name: str, shape: Any, width: int, value: object) -> int:
    mask = (1 << width) - 1
    if not isinstance(value, int):
        const = shape.const(value) if isinstance(shape, ShapeCastable) else value
        return int(Const.cast(const).value) & mask
    if not -(1 << width >> 1) <= value <= mask:
        raise ValueError(f"{name!r} has {width} bits, too few for {value}")
    return int(value) & mask


def _view(shape: Any, bits: int) -> Any:
    if isinstance(shape, ShapeCastable):
        return shape.from_bits(bits)
    cast = Shape.cast(shape)
    if cast.signed and bits >> (cast.width - 1) & 1:
        bits -= 1 << cast.width
    return bits


def _listed(names: Iterable[str]) -> str:
    listed = ", ".join(repr(name) for name in names)
    return f"there are {listed}" if listed else "there is none"
