"""Our own converters as a client library: circuits in Amaranth's simulator."""

from __future__ import annotations

from functools import cached_property
from typing import ClassVar

import firm_hdl
from firm_hdl.cases.values import Plain, to_numbers
from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Message
from firm_hdl.sim.harness import Harness
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.verify.references.client import Client, Codec, Refusal, UnsupportedError
from firm_hdl.wire import Wire

__all__ = ["FirmHdl"]

BUS_BYTES = 8
MAX_MESSAGE_BYTES = 1 << 16
"""Small enough that a packet with a length over this limit can be completed in simulation."""


class FirmHdl(Client):
    """A deserializer that decodes, and a serializer that encodes."""

    name = "firm-hdl"
    wires: ClassVar = frozenset({"ros1", "cdr"})

    def missing(self) -> str | None:
        return None

    def version(self) -> str:
        return firm_hdl.__version__

    def open(self, message: Message, wire: Wire) -> Codec:
        return _Converters(message, wire)


class _Converters(Codec):
    """Both converters of a type, each made when it is first needed."""

    def __init__(self, message: Message, wire: Wire):
        self._message = message
        self._settings = {
            "wire": wire,
            "bus_bytes": BUS_BYTES,
            "max_message_bytes": MAX_MESSAGE_BYTES,
        }

    @cached_property
    def _deserializer(self) -> Harness:
        return self._harness(Deserializer)

    @cached_property
    def _serializer(self) -> Harness:
        return self._harness(Serializer)

    def _harness(self, kind: type[Deserializer] | type[Serializer]) -> Harness:
        try:
            made = kind(self._message, **self._settings)  # type: ignore[arg-type]
            both = (made, None) if isinstance(made, Deserializer) else (None, made)
            return Harness(*both, message=self._message)
        except (BuildError, DefinitionError, ValueError) as error:
            raise UnsupportedError(f"firm-hdl cannot build it: {error}") from None

    def encode(self, value: Plain) -> bytes:
        harness = self._serializer
        numbers = to_numbers(self._message, value)
        transfers = to_transfers(harness.plan, self._message, numbers, check_bounds=False)
        seen = harness.run_messages([transfers])
        (status,) = seen.statuses
        if status.name != "OK":
            raise Refusal(f"status {status.name}")
        return seen.packets[0]

    def decode(self, packet: bytes) -> Plain:
        harness = self._deserializer
        seen = harness.run_packets([packet])
        (status,) = seen.statuses
        if status.name != "OK":
            raise Refusal(f"status {status.name}")
        return from_transfers(harness.plan, self._message, seen.transfers, exact=True)
