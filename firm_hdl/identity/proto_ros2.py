"""An example of a message as ``ros2 interface proto`` prints it.

The example is the YAML of a new message: fixed arrays are written out, sequences are empty,
defaults are applied. The text of each type is made only once, from the texts of its parts. So an
array of millions of elements costs only the concatenation of their texts.
"""

from __future__ import annotations

import re
import struct
import sys
from dataclasses import dataclass
from typing import Any

import yaml

from firm_hdl.errors import DefinitionError
from firm_hdl.model import Array, Field, Message, Primitive, Sequence, String, Value, closure

__all__ = ["ros2_proto"]

# Several arrays of 8 MiB fit, but not an array of such arrays.
_MAX_CHARACTERS = 1 << 28

_LINE = re.compile(r"^(?=.)", re.MULTILINE)


def ros2_proto(message: Message) -> str:
    """Print an example of a message of ROS 2, without quotes around it."""
    parts = closure([message])
    sizes: dict[str, _Size] = {}
    for part in parts:
        sizes[part.name] = _size(part, sizes)
    texts: dict[str, str] = {}
    for part in parts:
        texts[part.name] = _message(part, texts)
    return texts[message.name]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Size:
    """Size of a text. Indentation adds two characters to each line."""

    characters: int
    lines: int


def _size(message: Message, sizes: dict[str, _Size]) -> _Size:
    """Count the text of a type before it is written.

    Raises `DefinitionError` if the text would be too long.
    """
    characters = lines = 0
    for item in message.fields:
        each = _field_size(item, sizes)
        characters += each.characters
        lines += each.lines
    if characters > _MAX_CHARACTERS:
        problem = (
            f"{message.name} has an example of {characters} characters, which is more than "
            f"{_MAX_CHARACTERS}"
        )
        raise DefinitionError.of(problem)
    return _Size(characters=characters, lines=lines) if lines else _Size(characters=3, lines=1)


def _field_size(item: Field, sizes: dict[str, _Size]) -> _Size:
    match item.type:
        case Message(fields=(_, *_)) as nested:
            inner, count = sizes[nested.name], 1
        case Array(element=Message() as nested, count=count):
            inner = sizes[nested.name]
        case Array(element=element, count=count) if item.default is None:
            entry = _dump([_initial(element)])
            inner = _Size(characters=len(entry) - 2, lines=1)
        case _:
            # A sequence is empty, or no longer than its default.
            text = _field(item, {})
            return _Size(characters=len(text), lines=text.count("\n"))
    # Either two blanks, or a dash and a blank.
    characters = len(_key(item)) + 1 + count * (inner.characters + 2 * inner.lines)
    return _Size(characters=characters, lines=1 + count * inner.lines)


def _message(message: Message, texts: dict[str, str]) -> str:
    return "".join(_field(item, texts) for item in message.fields) or "{}\n"


def _field(item: Field, texts: dict[str, str]) -> str:
    match item.type:
        case Message(fields=()):
            return f"{_key(item)} {{}}\n"
        case Message():
            return f"{_key(item)}\n{_indented(texts[item.type.name])}"
        case Array(element=Message() as element, count=count):
            # A list is not indented under its key; the dash and blank are the indentation.
            entry = texts[element.name]
            return f"{_key(item)}\n" + f"- {_indented(entry)[2:]}" * count
        case Array(element=element, count=count) if item.default is None:
            entry = _dump([_initial(element)])
            return f"{_key(item)}\n" + entry * count
        case _:
            return _dump({item.name: _value(item)})


def _key(item: Field) -> str:
    # YAML needs quotes around some names.
    return _dump({item.name: 0}).removesuffix(" 0\n")


def _indented(text: str) -> str:
    return _LINE.sub("  ", text)


def _value(item: Field) -> Any:
    kind, default = item.type, item.default
    match kind:
        case Array() | Sequence():
            assert not isinstance(kind.element, Message) or default is None
            values = default if isinstance(default, tuple) else ()
            return [_listed(_converted(value, kind.element), kind.element) for value in values]
        case Message():
            raise AssertionError
        case _:
            return _initial(kind) if default is None else _converted(default, kind)


def _initial(kind: Any) -> Any:
    if isinstance(kind, String):
        return ""
    return _converted(0, kind)


def _converted(value: Value, kind: Any) -> Any:
    """Convert a value to Python's type in rosidl_generator_py, as rosidl_runtime_py prints it."""
    if isinstance(kind, Primitive) and not isinstance(value, str | bytes | tuple):
        if kind.name == "byte" or _is_character(kind):
            # The upper half of Latin-1 is negative in a `char`.
            return chr(int(value) % (1 << 8 * kind.bytes))
        convert = {"bool": bool, "int": int, "float": float}[kind.kind]
        return convert(value)
    return value


def _is_character(kind: Primitive) -> bool:
    # In rosidl, the ``char`` of a ``.msg`` is a number; those of IDL are characters.
    return kind.name == "wchar" or (kind.name == "char" and kind.signed)


def _listed(value: Any, kind: Any) -> Any:
    """Round float32 in lists, which are NumPy arrays in ROS 2; a single float32 is not rounded."""
    if not isinstance(kind, Primitive) or kind.name != "float32":
        return value
    # In native form, a number that is too large becomes infinite.
    (rounded,) = struct.unpack("f", struct.pack("f", value))
    return rounded


def _dump(value: Any) -> str:
    return yaml.dump(value, allow_unicode=True, width=sys.maxsize, default_flow_style=False)
