"""An example of a message as ``ros2 interface proto`` prints it.

The example is the YAML of a new message: fixed arrays are written out, sequences are empty,
defaults are applied. The text of each type is made only once, from the texts of its parts. So an
array of millions of elements costs only the concatenation of their texts.
"""

from __future__ import annotations

import re
import struct
import sys
from typing import Any

import yaml

from firm_hdl.errors import DefinitionError
from firm_hdl.model import Array, Field, Message, Primitive, Sequence, String, Value, closure

__all__ = ["ros2_proto"]

# Several arrays of 8 MiB fit, but not an array of such arrays.
_MAX_CHARACTERS = 1 << 28

_LINE = re.compile(r"^(?=.)", re.MULTILINE)


def ros2_proto(message: Message) -> str:
    """Print an example of a message of ROS 2, without quotes around it.

    Raises `DefinitionError` if the text would be too long. It is counted before it is written.
    """
    texts: dict[str, str] = {}
    for part in closure([message]):
        parts = [_field(item, texts) for item in part.fields]
        characters = sum(len(head) + len(entry) * count for head, entry, count in parts)
        if characters > _MAX_CHARACTERS:
            raise DefinitionError.of(
                f"{part.name} has an example of {characters} characters, which is more than "
                f"{_MAX_CHARACTERS}"
            )
        text = "".join(head + entry * count for head, entry, count in parts)
        texts[part.name] = text or "{}\n"
    return texts[message.name]


def _field(item: Field, texts: dict[str, str]) -> tuple[str, str, int]:
    """Return the text of a field: a head, the text of an entry, and how often that follows."""
    match item.type:
        case Message(fields=()):
            return f"{_key(item)} {{}}\n", "", 0
        case Message():
            return f"{_key(item)}\n", _indented(texts[item.type.name]), 1
        case Array(element=Message() as element, count=count):
            # A list is not indented under its key; the dash and blank are the indentation.
            return f"{_key(item)}\n", f"- {_indented(texts[element.name])[2:]}", count
        case Array(element=element, count=count) if item.default is None:
            return f"{_key(item)}\n", _dump([_initial(element)]), count
        case _:
            return _dump({item.name: _value(item)}), "", 0


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
