"""A message type in C++ for Fast CDR: structures, and the calls of ROS 2's type support.

The calls follow rosidl_typesupport_fastrtps_cpp. Arrays and vectors of numbers and of text need one
call. Those of messages and of wide text need one call for each element. A bool is read as an octet,
and a message without fields is an octet. Members are numbered, because a field's name may be a
keyword of C++.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.model import Array, FieldType, Message, Primitive, Sequence, String, closure
from lab.bench.software.sample import NoFigureError

__all__ = ["cpp_types"]


def cpp_types(message: Message) -> str:
    """Return the C++ of a type, named ``Root``, and of all message types in it.

    Raises
    ------
    NoFigureError
        If a field has a type that is not supported here: wide characters, and floats of 16 bytes.
    """
    kinds = closure([message])
    numbers = {kind.name: number for number, kind in enumerate(kinds)}
    lines = [line for kind in kinds for line in _of_message(kind, numbers)]
    return "\n".join([*lines, f"using Root = M{numbers[message.name]};", ""])


def _of_message(message: Message, numbers: dict[str, int]) -> Iterator[str]:
    name = f"M{numbers[message.name]}"
    yield f"// {message.name}"
    yield f"struct {name} {{"
    for index, item in enumerate(message.fields):
        yield f"  {_type(item.type, numbers)} f{index}{{}};  // {item.name}"
    if not message.fields:
        yield "  uint8_t f0{};"
    yield "};"
    kinds: list[FieldType] = [item.type for item in message.fields]
    kinds = kinds or [Primitive(name="uint8", bytes=1, kind="int", signed=False)]
    yield f"inline void write(Cdr & cdr, const {name} & message) {{"
    for index, kind in enumerate(kinds):
        yield f"  {_write(kind, f'message.f{index}')}"
    yield "}"
    yield f"inline void read(Cdr & cdr, {name} & message) {{"
    for index, kind in enumerate(kinds):
        yield f"  {_read(kind, f'message.f{index}')}"
    yield "}"


def _type(kind: FieldType, numbers: dict[str, int]) -> str:
    match kind:
        case Message():
            return f"M{numbers[kind.name]}"
        case String(wide=wide):
            return "std::u16string" if wide else "std::string"
        case Array():
            return f"std::array<{_type(kind.element, numbers)}, {kind.count}>"
        case Sequence():
            return f"std::vector<{_type(kind.element, numbers)}>"
        case Primitive():
            return _number(kind)


def _number(kind: Primitive) -> str:
    if kind.kind == "bool":
        return "bool"
    if kind.kind == "float" and kind.bytes in (4, 8):
        return {4: "float", 8: "double"}[kind.bytes]
    if kind.kind == "int" and kind.name != "wchar":
        return f"{'' if kind.signed else 'u'}int{8 * kind.bytes}_t"
    raise NoFigureError(f"{kind.name} is not written in C++")


def _is_whole(kind: FieldType) -> bool:
    """Return whether Fast CDR has a single call for an array or a vector of a type."""
    return isinstance(kind, Primitive) or (isinstance(kind, String) and not kind.wide)


def _write(kind: FieldType, what: str) -> str:
    match kind:
        case Message():
            return f"write(cdr, {what});"
        case String(wide=True):
            return f"write_wide(cdr, {what});"
        case Array(element=element) | Sequence(element=element):
            check, size = "", ""
            if isinstance(kind, Sequence):
                check = "" if kind.bound is None else f"check_bound({what}.size(), {kind.bound}); "
                size = f"cdr << static_cast<uint32_t>({what}.size()); "
            if _is_whole(element):
                return f"{check}cdr << {what};"
            return f"{check}{size}for (const auto & each : {what}) {{{_write(element, 'each')}}}"
        case _:
            return f"cdr << {what};"


def _read(kind: FieldType, what: str) -> str:
    match kind:
        case Message():
            return f"read(cdr, {what});"
        case Primitive(kind="bool"):
            return f"{{uint8_t octet; cdr >> octet; {what} = octet != 0;}}"
        case String(wide=True):
            return f"read_wide(cdr, {what});"
        case Array(element=element) | Sequence(element=element):
            check, size = "", ""
            if isinstance(kind, Sequence):
                number = f"{what}.size()" if _is_whole(element) else "size"
                check = "" if kind.bound is None else f"check_bound({number}, {kind.bound}); "
                size = f"uint32_t size; cdr >> size; {check}{what}.resize(size); "
            if _is_whole(element):
                return f"cdr >> {what}; {check}".rstrip()
            return f"{{{size}for (auto & each : {what}) {{{_read(element, 'each')}}}}}"
        case _:
            return f"cdr >> {what};"
