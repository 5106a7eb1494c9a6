"""rosbags as the oracle of any type, a user's own included.

rosbags gets the definitions of the type and of its nested types. It reads some texts differently
from ROS, or not at all: it takes ``uint8 a = 1`` for a field. So it gets definitions that are
written from the resolved fields. A note beside the result says if rosbags reads the original texts
differently.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from firm_hdl import model
from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.oracle import FieldType, RosbagsOracle, distro_oracle
from firm_hdl.cases.wide_oracle import STAND_IN_NOTE, WideOracle, stand_in_type, stand_ins
from firm_hdl.model import IDL_PRIMITIVES, Message, Primitive, String, closure, element_of
from firm_hdl.wire import refusals

__all__ = ["Judge", "check_wire", "judge_of", "oracle_name", "resolved_oracle"]

_BUILTIN = {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"}
_TIMES = dict.fromkeys(_BUILTIN, "int32 sec\nuint32 nanosec\n")
"""To rosbags, the times of ROS 1 are those of ROS 2; the bytes are the same."""


@dataclass(frozen=True, slots=True)
class Judge:
    """An oracle that knows a type, and the oracle's name of the type."""

    oracle: RosbagsOracle
    name: str
    note: str = ""  # A remark about the oracle; empty in most cases.


def judge_of(message: Message, distro: str | None = None, *, stand_in: bool = False) -> Judge:
    """Find the oracle of a type.

    * `distro`: the distribution, if `message` is one of its types. Then rosbags' own definition is
      used, if there is one.
    * `stand_in`: whether a message of numbers may replace a wstring, see
      :mod:`firm_hdl.cases.wide_oracle`. Then a library that supports wstring has to confirm the
      bytes.

    Raises `NotJudgedError`.
    """
    check_wire(message)
    name = oracle_name(message)
    if distro is not None:
        oracle = distro_oracle(distro)
        if name in oracle.store.fielddefs:
            return Judge(oracle, name)
    oracle = resolved_oracle(message, stand_in=stand_in)
    if isinstance(oracle, WideOracle):
        return Judge(oracle, name, STAND_IN_NOTE)
    return Judge(oracle, name, _note(message, oracle, name))


def resolved_oracle(message: Message, *, stand_in: bool = False) -> RosbagsOracle:
    """Return an oracle with a type and its nested types, defined by their resolved fields.

    Raises `NotJudgedError`.
    """
    wide: dict[str, str] = {}
    if stand_in:
        wide = stand_ins(closure([message]))
    else:
        _refuse_wide(message)
    resolved = {
        kind.name: "".join(f"{_spelled(item.type)} {item.name}\n" for item in kind.fields)
        for kind in closure([message])
    }
    oracle = _oracle(message, resolved, wide)
    if missing := _unknown(oracle, oracle_name(message)):
        raise NotJudgedError(f"rosbags has no {missing}")
    return oracle


def _spelled(kind: model.FieldType) -> str:
    """Return a type in rosbags' spelling, in which ``char`` is unsigned as in ``.msg`` files."""
    inner = element_of(kind)
    if isinstance(inner, String) and inner.wide:
        return stand_in_type(kind, inner)
    if isinstance(inner, Primitive) and (inner == IDL_PRIMITIVES["char"] or inner.name == "wchar"):
        integer = f"{'' if inner.signed else 'u'}int{8 * inner.bytes}"
        return str(kind).replace(inner.name, integer, 1)
    return str(kind)


def check_wire(message: Message) -> None:
    """Raise `NotJudgedError` if a message has a field that no wire supports."""
    if wrong := refusals(message):
        raise NotJudgedError(wrong[0].message)


def oracle_name(message: Message) -> str:
    """Name a type as rosbags does, ``package/msg/Type``."""
    if message.name in _BUILTIN:
        return _BUILTIN[message.name]
    head, _, base = message.name.rpartition("/")
    # This is rosbags' own rule: a type outside of `msg` and `action` gets a `msg` before its name.
    return message.name if head.endswith(("/msg", "/action")) else f"{head}/msg/{base}"


def _refuse_wide(message: Message) -> None:
    for kind in reversed(closure([message])):
        for item in kind.fields:
            inner = item.element_type
            if isinstance(inner, String) and inner.wide:
                raise NotJudgedError(f"rosbags has no wstring, which {kind.name}.{item.name} is")


def _oracle(
    message: Message, texts: Mapping[str, str], wide: Mapping[str, str] | None = None
) -> RosbagsOracle:
    store = get_typestore(Stores.EMPTY)
    names = {kind.name: oracle_name(kind) for kind in closure([message])}
    try:
        for name, text in {**texts, **{k: v for k, v in _TIMES.items() if k in texts}}.items():
            store.register(get_types_from_msg(text, names[name]))
        for name, text in (wide or {}).items():
            store.register(get_types_from_msg(text, name))
    # The exceptions of rosbags for definitions that it refuses have no common base class.
    except Exception as error:
        lines = str(error).strip().splitlines() or [type(error).__name__]
        raise NotJudgedError(f"rosbags refuses the definition: {lines[0]}") from None
    return (WideOracle if wide else RosbagsOracle)(store, message.dialect)


def _unknown(oracle: RosbagsOracle, name: str) -> str:
    """Return the first type that is used but not defined; empty if there is none."""
    seen, pending = {name}, [name]
    while pending:
        owner = pending.pop()
        if owner not in oracle.store.fielddefs:
            return owner.replace("/msg/", "/") if "/" in owner else owner
        for _, kind in oracle.fields(owner):
            inner = _named(kind)
            if inner is not None and inner not in seen:
                seen.add(inner)
                pending.append(inner)
    return ""


def _named(kind: FieldType) -> str | None:
    node, detail = kind
    if node == Nodetype.NAME:
        return str(detail)
    return None if node == Nodetype.BASE else _named(detail[0])


def _note(message: Message, oracle: RosbagsOracle, name: str) -> str:
    """Return a note if rosbags reads the original texts differently from us; else nothing."""
    texts = {kind.name: kind.text for kind in closure([message])}
    try:
        other = _oracle(message, texts)
        if other.structure(name) == oracle.structure(name):
            return ""
        how = "reads the definition in another way"
    except (NotJudgedError, KeyError):
        how = "cannot read the definition"
    return f"rosbags {how}, and was given the fields as they were resolved"
