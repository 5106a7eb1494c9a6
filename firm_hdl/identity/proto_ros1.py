"""An example of a message as ``rosmsg-proto`` prints it.

The example is the YAML of a new message, with one element in every sequence. The style of a part,
block or flow (braces and brackets), depends on the parts before. The tool starts with block style.
At the first message with more than four fields, or with a fixed array of more than four elements,
it leaves the choice to PyYAML for the rest of the text. This includes the enclosing parts, because
their style is decided at their end.
"""

from __future__ import annotations

import base64
import keyword
from dataclasses import dataclass

import yaml

from firm_hdl.errors import DefinitionError
from firm_hdl.model import (
    PRIMITIVES,
    Array,
    Field,
    FieldType,
    Message,
    Primitive,
    Sequence,
    String,
    closure,
)

__all__ = ["ros1_proto"]

# Limit on the size of an example: with more values, PyYAML takes minutes.
_MAX_VALUES = 1_000_000
# Limit on nesting, because PyYAML recurses for each level.
_MAX_LEVELS = 100

# Largest number of fields or elements that rosmsg writes in block style.
_MAX_BLOCK = 4

_TAG = "tag:yaml.org,2002:"

# Field names to which genpy adds an underscore. The example has the names of genpy's attributes.
_RESERVED = frozenset({*keyword.kwlist, "self"})

# Element types of arrays that are `bytes` in Python. Such an array is a single value.
_PACKED = frozenset({"uint8", "char"})


def ros1_proto(message: Message) -> str:
    """Print an example of a message of ROS 1, without quotes around it."""
    values: dict[str, int] = {}
    for part in closure([message]):
        values[part.name] = sum(1 + _values(item.type, values) for item in part.fields)
        if values[part.name] > _MAX_VALUES:
            raise DefinitionError.of(
                f"{part.name} has an example of {values[part.name]} values, which is more than "
                f"{_MAX_VALUES}"
            )
    node = _Writer(name=message.name).message(message, 1)
    return yaml.serialize(node, Dumper=yaml.SafeDumper).rstrip("\n")


def _values(kind: FieldType, values: dict[str, int]) -> int:
    """Count the keys and values of a field before they are written."""
    match kind:
        case Message():
            return values[kind.name]
        case Array(count=count) if _is_packed(kind):
            # PyYAML takes time for the text of a long array of bytes, too.
            return 1 + count // 16
        case Array(element=element, count=count):
            return count * (1 + _values(element, values))
        case Sequence(element=element):
            return 1 + _values(element, values)
        case _:
            return 1


@dataclass(slots=True)
class _Writer:
    """Builds YAML nodes in the order of rosmsg, because the order decides their style."""

    name: str
    # `flow_style` of PyYAML. `False`: one line for each item; `None`: PyYAML's own choice.
    style: bool | None = False

    def message(self, message: Message, level: int) -> yaml.MappingNode:
        if level > _MAX_LEVELS:
            raise DefinitionError.of(
                f"{self.name} has an example of more than {_MAX_LEVELS} levels"
            )
        has_long_list = any(
            item.type.count > _MAX_BLOCK and not _is_packed(item.type)
            for item in message.fields
            if isinstance(item.type, Array)
        )
        if has_long_list or len(message.fields) > _MAX_BLOCK:
            self.style = None
        return self.mapping([(item.name, item) for item in message.fields], level)

    def mapping(self, members: list[tuple[str, Field]], level: int) -> yaml.MappingNode:
        pairs = []
        for name, item in members:
            key = self.scalar("str", f"{name}_" if name in _RESERVED else name)
            pairs.append((key, self.value(item.type, level)))
        is_plain = all(_is_plain(node) for _, node in pairs)
        return yaml.MappingNode(f"{_TAG}map", pairs, flow_style=self.flow(is_plain))

    def value(self, kind: FieldType, level: int) -> yaml.Node:
        if isinstance(kind, Array | Sequence) and _is_packed(kind):
            data = bytes(kind.count) if isinstance(kind, Array) else b""
            text = base64.encodebytes(data).decode("ascii")
            return yaml.ScalarNode(f"{_TAG}binary", text, style="|")
        match kind:
            case Message():
                return self.message(kind, level + 1)
            case Array(element=element, count=count):
                return self.sequence([self.value(element, level) for _ in range(count)])
            case Sequence(element=Message(name="time" | "duration") as element):
                # rosmsg writes an element of the message `Time` or `Duration` instead.
                return self.sequence([self.mapping([("data", _field(element))], level + 1)])
            case Sequence(element=element):
                # As the element of a sequence, rosmsg writes 0 even for a float.
                number = isinstance(element, Primitive) and element.kind == "float"
                return self.sequence([self.value(_INTEGER if number else element, level)])
            case String():
                return self.scalar("str", "")
            case Primitive(kind="bool"):
                return self.scalar("bool", "false")
            case Primitive(kind="float"):
                return self.scalar("float", "0.0")
            case Primitive():
                return self.scalar("int", "0")

    def sequence(self, nodes: list[yaml.Node]) -> yaml.SequenceNode:
        is_plain = all(_is_plain(node) for node in nodes)
        return yaml.SequenceNode(f"{_TAG}seq", nodes, flow_style=self.flow(is_plain))

    def flow(self, is_plain: bool) -> bool:
        return is_plain if self.style is None else self.style

    def scalar(self, tag: str, text: str) -> yaml.ScalarNode:
        return yaml.ScalarNode(f"{_TAG}{tag}", text, style="")


_INTEGER = PRIMITIVES["ros1"]["int32"]


def _field(message: Message) -> Field:
    return Field(name=message.name, type=message)


def _is_packed(kind: Array | Sequence) -> bool:
    return isinstance(kind.element, Primitive) and kind.element.name in _PACKED


def _is_plain(node: yaml.Node) -> bool:
    return isinstance(node, yaml.ScalarNode) and not node.style
