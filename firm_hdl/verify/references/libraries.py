"""Client libraries in Python: rosbags, Cyclone DDS, mcap's packages, our converters, and genpy.

genpy, ROS 1's own serializer, runs in the Python that has ROS's modules.
"""

from __future__ import annotations

import importlib
import logging
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from functools import cached_property
from importlib.metadata import version
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np

import firm_hdl
from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.user_oracle import oracle_name, resolved_oracle
from firm_hdl.cases.values import Plain, from_json, to_numbers
from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Array, FieldType, Message, Primitive, String, closure, element_of
from firm_hdl.model import Sequence as SequenceType
from firm_hdl.sim.harness import Harness
from firm_hdl.sim.values import from_transfers, to_transfers
from firm_hdl.verify.references.client import (
    Client,
    ClientDiedError,
    Codec,
    Refusal,
    UnsupportedError,
)
from firm_hdl.verify.references.objects import (
    ObjectCodec,
    first_line,
    full_text,
    plainly_named,
    refuse_wide,
)
from firm_hdl.verify.references.worker_genpy import Objects, to_json
from firm_hdl.verify.ros_python import worker
from firm_hdl.wire import Wire

__all__ = ["CycloneDds", "FirmHdl", "Genpy", "McapRos1", "McapRos2", "Rosbags"]


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


_HOW = "(python3 -m pip install 'firm-hdl[clients]')"


class _Imported(Client):
    """A library that is imported."""

    package: ClassVar[str]  # Its name on PyPI.
    module: ClassVar[str]  # The module of it that is imported.

    def missing(self) -> str | None:
        try:
            importlib.import_module(self.module)
        except ImportError:
            return f"{self.package} is not installed {_HOW}"
        return None

    def version(self) -> str:
        return version(self.package)


# rosbags.


class Rosbags(_Imported):
    """rosbags, with definitions that are written from the resolved fields."""

    name = package = module = "rosbags"
    wires: ClassVar = frozenset({"ros1", "cdr"})
    byte_orders = ("little", "big")

    def open(self, message: Message, wire: Wire) -> Codec:
        try:
            return _RosbagsCodec(message, wire)
        except NotJudgedError as error:
            raise UnsupportedError(str(error)) from None


class _RosbagsCodec(ObjectCodec):
    def __init__(self, message: Message, wire: Wire):
        super().__init__(message)
        self._oracle = resolved_oracle(message)
        self._wire = wire
        self._name = oracle_name(message)
        names = {kind.name: oracle_name(kind) for kind in closure([message])}
        self._classes: dict[str, Any] = {
            name: self._oracle.store.types[other] for name, other in names.items()
        }
        self._members = {
            kind.name: dict(
                zip(
                    [item.name for item in kind.fields],
                    self._classes[kind.name].__dataclass_fields__,
                    strict=False,
                )
            )
            for kind in closure([message])
        }

    def write(self, value: Any) -> bytes:
        return self._oracle.write(value, self._name, self._wire)

    def read(self, packet: bytes) -> Any:
        return self._oracle.read(packet, self._name, self._wire)

    def made(self, kind: Message, members: dict[str, Any]) -> Any:
        if not kind.fields and self._oracle.dialect == "ros2":
            # The name that rosbags gives the member; on purpose not that of the model.
            return self._classes[kind.name](structure_needs_at_least_one_member=0)
        return self._classes[kind.name](*members.values())

    def member(self, value: Any, kind: Message, name: str) -> Any:
        return getattr(value, self._members[kind.name][name])

    def array(self, kind: Primitive, numbers: list[Any]) -> Any:
        if kind.kind == "float":
            return np.array(numbers, f"u{kind.bytes}").view(f"f{kind.bytes}")
        return np.array(numbers, _dtype(kind))

    def items(self, kind: Primitive, values: Any) -> list[Plain]:
        if kind.kind == "float":
            values = values.astype(f"<f{kind.bytes}").view(f"<u{kind.bytes}")
        elif kind.name == "byte" and kind.signed:
            # Bytes of ROS 1 have a sign, also where rosbags holds them in an unsigned array.
            values = values.view(np.int8)
        return list(values.tolist())


def _dtype(kind: Primitive) -> str:
    if kind.kind == "bool":
        return "bool"
    return ("i" if kind.signed else "u") + str(kind.bytes)


# Cyclone DDS.


MOST_CYCLONE_BOUND = 0xFFFF
"""The highest bound of sequences in cyclonedds 11.0.1. Text and arrays may be longer."""


class CycloneDds(_Imported):
    """Eclipse Cyclone DDS: its own serializer in Python, with classes generated for a type."""

    name = package = "cyclonedds"
    module = "cyclonedds.idl"
    wires: ClassVar = frozenset({"cdr"})
    byte_orders = ("little", "big")
    may_confirm = True

    def open(self, message: Message, wire: Wire) -> Codec:
        refuse_wide(message, self.name)
        return _CycloneCodec(message)


class _CycloneCodec(ObjectCodec):
    def __init__(self, message: Message):
        super().__init__(message)
        self._idl: Any = importlib.import_module("cyclonedds.idl")
        self._types: Any = importlib.import_module("cyclonedds.idl.types")
        self._classes: dict[str, Any] = {}
        for kind in closure([message]):
            self._classes[kind.name] = self._class(kind)

    def _class(self, kind: Message) -> Any:
        # Names do not reach the wire, and some of ROS's are keywords of Python.
        members = {f"m{n}": self._type(item.type) for n, item in enumerate(kind.fields)}
        name = "T_" + "".join(c if c.isalnum() else "_" for c in kind.name)
        # rosidl gives an empty message one byte, because IDL has no structs without members.
        members = members or {"m0": self._types.uint8}
        found = self._idl.make_idl_struct(name, name, members, dataclassify=False)
        # A simple constructor, because making the default data class takes long.
        found.__init__ = _take_members
        return found

    def _type(self, kind: FieldType) -> Any:
        match kind:
            case Message():
                return self._classes[kind.name]
            case String():
                return str if kind.bound is None else self._types.bounded_str[kind.bound]
            case Primitive(kind="bool"):
                return bool
            case Primitive(kind="float"):
                return getattr(self._types, kind.name)
            case Primitive():
                sign = "" if kind.signed else "u"
                return getattr(self._types, f"{sign}int{8 * kind.bytes}")
            case Array():
                return self._types.array[self._type(kind.element), kind.count]
            case SequenceType(bound=None):
                return self._types.sequence[self._type(kind.element)]
            case SequenceType(bound=bound):
                assert bound is not None
                if bound > MOST_CYCLONE_BOUND:
                    raise UnsupportedError(f"cyclonedds has no bound of {bound} elements")
                return self._types.sequence[self._type(kind.element), bound]

    def write(self, value: Any) -> bytes:
        return bytes(value.serialize(use_version_2=False))

    def read(self, packet: bytes) -> Any:
        return self._classes[self.message.name].deserialize(packet)

    def made(self, kind: Message, members: dict[str, Any]) -> Any:
        named = {f"m{n}": member for n, member in enumerate(members.values())}
        return self._classes[kind.name](**(named or {"m0": 0}))

    def member(self, value: Any, kind: Message, name: str) -> Any:
        number = next(n for n, item in enumerate(kind.fields) if item.name == name)
        return getattr(value, f"m{number}")


def _take_members(self: Any, **members: Any) -> None:
    vars(self).update(members)


# mcap.


def _opened(kind: Callable[[Message], Codec], message: Message, library: str) -> Codec:
    try:
        # The parser prints what it does not accept.
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
            return kind(message)
    # The exceptions of the parser have no common base class.
    except Exception as error:
        raise UnsupportedError(f"{library} refuses the definition: {first_line(error)}") from None


class McapRos2(_Imported):
    """mcap-ros2-support, which reads and writes the messages of ROS 2 in MCAP files."""

    name = "mcap-ros2"
    package = "mcap-ros2-support"
    module = "mcap_ros2._dynamic"
    wires: ClassVar = frozenset({"cdr"})
    byte_orders = ("little", "big")

    def open(self, message: Message, wire: Wire) -> Codec:
        refuse_wide(message, self.name)
        return _opened(_McapRos2Codec, message, self.name)


class _McapRos2Codec(ObjectCodec):
    def __init__(self, message: Message):
        super().__init__(message)
        dynamic: Any = importlib.import_module("mcap_ros2._dynamic")
        named = plainly_named(message)
        text = full_text(named)
        self._write = dynamic.serialize_dynamic(named.name, text)[named.name]
        self._read = dynamic.generate_dynamic(named.name, text)[named.name]

    def write(self, value: Any) -> bytes:
        return bytes(self._write(value))

    def read(self, packet: bytes) -> Any:
        return self._read(packet)

    def made(self, kind: Message, members: dict[str, Any]) -> Any:
        return SimpleNamespace(**members)


class McapRos1(_Imported):
    """mcap-ros1-support, which reads and writes the messages of ROS 1 in MCAP files."""

    name = "mcap-ros1"
    package = "mcap-ros1-support"
    module = "mcap_ros1.decoder"
    wires: ClassVar = frozenset({"ros1"})

    def open(self, message: Message, wire: Wire) -> Codec:
        return _opened(_McapRos1Codec, message, self.name)


class _McapRos1Codec(Codec):
    """A codec of mcap-ros1-support, which has its own copy of genpy with the same classes."""

    def __init__(self, message: Message):
        dynamic: Any = importlib.import_module("mcap_ros1.decoder").dynamic
        genpy: Any = importlib.import_module(dynamic.__name__.rpartition(".")[0])
        # It logs each text that is not UTF-8. Without a handler, that goes to standard error.
        logging.getLogger("rosout").addHandler(logging.NullHandler())
        with _unchanged_path():
            classes = dynamic.generate_dynamic(message.name, full_text(message))
        self._objects = Objects(genpy, classes, field_table(message))
        self._name = message.name

    def encode(self, value: Plain) -> bytes:
        packet: bytes = _refused(self._objects.encode, self._name, value)
        return packet

    def decode(self, packet: bytes) -> Plain:
        return _refused(self._objects.decode, self._name, packet)


def _refused(work: Any, name: str, given: Any) -> Any:
    try:
        return work(name, given)
    # The exceptions of genpy have no common base class.
    except Exception as error:
        raise Refusal(first_line(error)) from None


@contextmanager
def _unchanged_path() -> Iterator[None]:
    """Remove what genpy adds to the search path for each module that it generates."""
    before = list(sys.path)
    try:
        yield
    finally:
        sys.path[:] = before


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
