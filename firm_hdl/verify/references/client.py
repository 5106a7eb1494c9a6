"""The interface of client libraries, which write and read packets of ROS messages.

To add one, write a subclass of :class:`Client`, and name it in
`firm_hdl.verify.references.clients`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import ClassVar, TypeVar

from firm_hdl.cases.values import Plain
from firm_hdl.errors import UserError
from firm_hdl.model import Message
from firm_hdl.wire import Wire

__all__ = [
    "Client",
    "ClientDiedError",
    "ClientMissingError",
    "Codec",
    "Refusal",
    "UnsupportedError",
    "each_answered",
]

T = TypeVar("T")
R = TypeVar("R")


class Refusal(Exception):  # noqa: N818 - it is an answer, which may be right.
    """A library refuses a value or a packet; the text is its message."""

    def __eq__(self, other: object) -> bool:
        # Libraries word their messages differently.
        return isinstance(other, Refusal)

    def __hash__(self) -> int:
        return hash(Refusal)


class ClientMissingError(UserError):
    """A library that was asked for is not installed; the text says how to get it."""


class UnsupportedError(Exception):
    """A library does not support a type; the text says why."""


class ClientDiedError(UnsupportedError):
    """A library died when it was asked, or gave a wrong number of answers.

    This is a failure, and not a missing judgement.
    """


class Codec:
    """A library's writer and reader of one message type on one wire.

    A subclass defines `encode` and `decode`, or, if its library is in another process, `encode_all`
    and `decode_all`. The other two methods call these.
    """

    def encode(self, value: Plain) -> bytes:
        """Write a packet.

        Raises
        ------
        Refusal
        """
        return _accepted(self.encode_all([value]))

    def decode(self, packet: bytes) -> Plain:
        """Read a packet.

        Raises
        ------
        Refusal
        """
        return _accepted(self.decode_all([packet]))

    def encode_all(self, values: Sequence[Plain]) -> list[bytes | Refusal]:
        """Write packets; a refused value has a `Refusal` in the list."""
        return [_answer(self.encode, value) for value in values]

    def decode_all(self, packets: Sequence[bytes]) -> list[Plain | Refusal]:
        """Read packets; a refused packet has a `Refusal` in the list."""
        return [_answer(self.decode, packet) for packet in packets]


def _accepted(answers: Sequence[R | Refusal]) -> R:
    (answer,) = answers
    if isinstance(answer, Refusal):
        raise answer
    return answer


def each_answered(library: str, questions: Sequence[object], answers: Sequence[R]) -> Sequence[R]:
    """Return the answers, if there is one to each question.

    Raises `ClientDiedError`.
    """
    if len(answers) != len(questions):
        raise ClientDiedError(
            f"{library} gave {len(answers)} answers to {len(questions)} questions"
        )
    return answers


def _answer(ask: Callable[[T], R], question: T) -> R | Refusal:
    try:
        return ask(question)
    except Refusal as refusal:
        return refusal


class Client(ABC):
    """A client library."""

    name: ClassVar[str]  # The name that `--sut` takes.
    wires: ClassVar[frozenset[Wire]]  # The wire formats that it supports.
    byte_orders: ClassVar[tuple[str, ...]] = ("little",)  # The byte orders of CDR that it supports.
    # Whether TS3 may compare its packets with those of rosbags (`--reference`).
    may_confirm: ClassVar[bool] = False

    @abstractmethod
    def missing(self) -> str | None:
        """Return why the library cannot be used, and how to get it; `None` if it can be used."""

    @abstractmethod
    def version(self) -> str:
        """Return the version of the installed library."""

    @abstractmethod
    def open(self, message: Message, wire: Wire) -> Codec:
        """Get ready for a message type.

        Raises `UnsupportedError`.
        """

    def close(self) -> None:  # noqa: B027 - most have nothing to do.
        """End the processes of the library. It can be used again after that."""
