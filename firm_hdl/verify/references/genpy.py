"""genpy, ROS 1's own serializer in Python, which runs in the Python that has ROS's modules."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

from firm_hdl.cases.values import Plain, from_json
from firm_hdl.model import Array, FieldType, Message, closure, element_of
from firm_hdl.model import Sequence as SequenceType
from firm_hdl.verify.references.client import (
    Client,
    ClientDiedError,
    Codec,
    Refusal,
    UnsupportedError,
)
from firm_hdl.verify.references.objects import full_text
from firm_hdl.verify.references.worker_genpy import to_json
from firm_hdl.verify.ros_python import worker
from firm_hdl.wire import Wire

__all__ = ["Genpy", "field_table"]


def field_table(message: Message) -> dict[str, list[tuple[str, bool, str]]]:
    """List the fields of a type and of its nested types, as `worker_genpy` takes them."""
    return {
        kind.name: [
            (item.name, isinstance(item.type, Array | SequenceType), _base(item.type))
            for item in kind.fields
        ]
        for kind in closure([message])
        if kind.package
    }


def _base(kind: FieldType) -> str:
    inner = element_of(kind)
    return inner.name if isinstance(inner, Message) else str(inner)


class Genpy(Client):
    """genpy, with classes that genpy generates from the text of a definition."""

    name = "genpy"
    wires: ClassVar = frozenset({"ros1"})
    may_confirm = True

    @cached_property
    def _worker(self) -> worker.Worker:
        folder = Path(__file__).parent
        return worker.Worker("genpy", "", modules=folder, python=worker.ROS_PYTHON)

    def missing(self) -> str | None:
        why = self._worker.missing
        return None if why is None else f"genpy cannot be used: {why} (Debian: python3-genpy)"

    def version(self) -> str:
        return self._worker.versions.get("genpy", "")

    def open(self, message: Message, wire: Wire) -> Codec:
        if message.dialect != "ros1":
            raise UnsupportedError("genpy has no types of ROS 2")
        return _GenpyCodec(self._worker, message)

    def close(self) -> None:
        if "_worker" in self.__dict__:
            self._worker.close()


class _GenpyCodec(Codec):
    _opened: ClassVar[dict[int, _GenpyCodec]] = {}
    """The codec that each worker is ready for, by the `id` of the worker."""

    def __init__(self, worker: worker.Worker, message: Message):
        self._worker = worker
        self._request = {
            "oracle": "open",
            "name": message.name,
            "text": full_text(message),
            "table": field_table(message),
        }
        self._open()

    def _open(self) -> None:
        self._facts(self._request)
        self._opened[id(self._worker)] = self

    def _facts(self, request: dict[str, Any]) -> Any:
        answer = self._worker.ask(request)
        if "facts" in answer:
            return answer["facts"]
        self._opened.pop(id(self._worker), None)
        problem = answer.get("refused") or answer.get("failed")
        if not problem or problem == worker.DIED:
            raise ClientDiedError(f"genpy: {problem or 'it answered nothing'}")
        raise UnsupportedError(f"genpy: {problem}")

    def _ask(self, what: str, items: Sequence[Any]) -> list[Any]:
        if self._opened.get(id(self._worker)) is not self:
            self._open()
        answers = self._facts({"oracle": what, "items": items})
        return [
            Refusal(each["refused"]) if "refused" in each else from_json(each["item"])
            for each in answers
        ]

    def encode_all(self, values: Sequence[Plain]) -> list[bytes | Refusal]:
        return self._ask("encode", [to_json(value) for value in values])

    def decode_all(self, packets: Sequence[bytes]) -> list[Plain | Refusal]:
        return self._ask("decode", [packet.decode("latin-1") for packet in packets])
