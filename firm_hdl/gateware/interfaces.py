"""Types of the members of components, for type checkers and editors.

Amaranth makes the members of a component when it is constructed. So a component says, by
annotations in its class, which members it will have and of which type. The types are protocols: at
run time, members are the usual interfaces of Amaranth, and those of one's own ports are flipped.
"""

from __future__ import annotations

from typing import Any, Protocol, TypeAlias, TypeVar

from amaranth.hdl import Value
from amaranth.lib import wiring

__all__ = ["MessageInterface", "PacketBeat", "PacketStream", "StatusStream", "Stream"]

Payload = TypeVar("Payload", covariant=True)


class Stream(Protocol[Payload]):
    """A stream of `amaranth.lib.stream`."""

    @property
    def payload(self) -> Payload: ...
    @property
    def valid(self) -> Value: ...
    @property
    def ready(self) -> Value: ...
    @property
    def signature(self) -> wiring.Signature: ...


class PacketBeat(Protocol):
    """The payload of a packet stream; see :func:`.packet_layout`."""

    @property
    def data(self) -> Any: ...
    @property
    def count(self) -> Value: ...
    @property
    def last(self) -> Value: ...
    def eq(self, other: Any) -> Any: ...
    def shape(self) -> Any: ...
    def __getitem__(self, name: str) -> Any: ...


PacketStream: TypeAlias = Stream[PacketBeat]
"""What :func:`.PacketSignature` makes."""

StatusStream: TypeAlias = Stream[Value]
"""What :func:`.StatusSignature` and :func:`.GateStatusSignature` make."""


class MessageInterface(Protocol):
    """A message, a part of one, or a leaf: what :class:`.MessageSignature` makes.

    Members have the names of the fields, which are known at run time only. A leaf has `payload`,
    `valid` and `ready`.
    """

    @property
    def payload(self) -> Any: ...
    @property
    def valid(self) -> Value: ...
    @property
    def ready(self) -> Value: ...
    @property
    def signature(self) -> wiring.Signature: ...
    def __getattr__(self, name: str) -> MessageInterface: ...
