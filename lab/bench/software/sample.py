"""The packets for timing libraries, and the results."""

from __future__ import annotations

from dataclasses import dataclass

from firm_hdl.bench.tools import BenchError
from firm_hdl.model import Message
from firm_hdl.wire import Wire

__all__ = ["NoFigureError", "Sample", "Timed", "check_written"]


class NoFigureError(BenchError):
    """A library does not have a type or a wire format, so there is nothing to time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sample:
    """Packets of one type."""

    message: Message
    wire: Wire
    packets: tuple[bytes, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Timed:
    """Processor time of one message, the mean of a sample's, in ns."""

    deserialize: float
    serialize: float

    def of(self, direction: str) -> float:
        """Return the time in which a message is read (``deserializer``) or written."""
        return self.deserialize if direction == "deserializer" else self.serialize


def check_written(sample: Sample, written: bytes, packet: bytes) -> None:
    """Check that rosbags writes the packet that it has read.

    Raises
    ------
    BenchError
        If the written packet differs.
    """
    if written != packet:
        raise BenchError(
            f"rosbags reads a packet of {sample.message.name} and writes another: "
            f"{packet.hex(' ')}, then {written.hex(' ')}"
        )
