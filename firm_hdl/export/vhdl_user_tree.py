"""The records of a message type in VHDL: what is nested in what, and what everything is called.

Decisions only; :mod:`firm_hdl.export.vhdl_types` prints them. Equal parts of a message share one
record type, so that a user's procedure for a vector serves every vector of the message.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from firm_hdl.export.names import first_free, scope_names
from firm_hdl.export.vhdl_user_types import SHARED_TYPES, primitive_name
from firm_hdl.model import Array, Field, FieldType, Message, Sequence, Text
from firm_hdl.plan import Leaf, Plan

__all__ = ["Node", "Tree", "member_names", "snake", "tree_of"]

_Paths = dict[str, "_Paths | int"]
_Key = tuple[object, ...]


@dataclass(slots=True, kw_only=True)
class Node:
    """A message, a part of one, or a leaf.

    Attributes
    ----------
    name : str
        As a field of the record that it is in.
    access : str
        Dotted names from the message's record down; empty for the message itself.
    leaf : int or None
        Index into `Plan.leaves`.
    source : Field or None
        The definition's field, if it is one.
    children : list of Node
    type : str
        Its record type, forwards; ``_ready_t`` in place of ``_t`` gives the one backwards.
    """

    name: str
    access: str
    leaf: int | None = None
    source: Field | None = None
    children: list[Node] = field(default_factory=list)
    type: str = ""

    @property
    def ready_type(self) -> str:
        """Type of what goes backwards."""
        return "std_logic" if self.leaf is not None else f"{self.type.removesuffix('_t')}_ready_t"

    def walk(self) -> Iterator[Node]:
        """Yield all nodes, children before their parents."""
        for child in self.children:
            yield from child.walk()
        yield self

    def leaves(self) -> Iterator[Node]:
        """Yield the leaves in wire order."""
        return (node for node in self.walk() if node.leaf is not None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Tree:
    """A message's records.

    Attributes
    ----------
    root : Node
    items : dict of str to (str, int)
        Stream types of items that the package declares: the primitive's name, and lanes.
    taken : frozenset of str
        Identifiers of the package, in lower case, `reserved` included.
    members : frozenset of str
        Identifiers of all members of records, in lower case.
    """

    root: Node
    items: Mapping[str, tuple[str, int]]
    taken: frozenset[str]
    members: frozenset[str]


def snake(name: str) -> str:
    """Give a message's name as VHDL writers write types.

    >>> snake("PoseWithCovariance"), snake("PointCloud2"), snake("IMUData")
    ('pose_with_covariance', 'point_cloud2', 'imu_data')
    """
    text = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name)
    return re.sub("_+", "_", text).lower().strip("_")


def member_names(names: Iterable[str]) -> dict[str, str]:
    """Give the identifiers for the members of a record.

    >>> member_names(["x", "range", "float64_stream_t"])
    {'x': 'x', 'range': 'range_field', 'float64_stream_t': 'float64_stream_t_2'}
    """
    # A member that has the name of a type would hide it from its neighbours.
    return scope_names(names, SHARED_TYPES)


def tree_of(message: Message, plan: Plan, reserved: frozenset[str]) -> Tree:
    """Decide on the records of a message.

    Parameters
    ----------
    reserved : frozenset of str
        Identifiers that no type may have, in lower case.
    """
    paths: _Paths = {}
    for index, leaf in enumerate(plan.leaves):
        place = paths
        for name in leaf.path[:-1]:
            below = place.setdefault(name, {})
            assert isinstance(below, dict), "a leaf has nothing below it"
            place = below
        place[leaf.path[-1]] = index
    maker = _Maker(plan.leaves, {*reserved, "std_logic"})
    root = maker.node(paths, message, "", "")
    maker.name_types(root)
    items = dict(sorted(maker.items.items()))
    return Tree(
        root=root, items=items, taken=frozenset(maker.taken), members=frozenset(maker.members)
    )


@dataclass(slots=True)
class _Maker:
    leaves: tuple[Leaf, ...]
    taken: set[str]
    items: dict[str, tuple[str, int]] = field(default_factory=dict)
    wanted: dict[_Key, str] = field(default_factory=dict)
    keys: dict[int, _Key] = field(default_factory=dict)
    members: set[str] = field(default_factory=set)

    def node(self, paths: _Paths, kind: FieldType | None, name: str, access: str) -> Node:
        node = Node(name=name, access=access)
        for child, vhdl in member_names(paths).items():
            self.members.add(vhdl.lower())
            below = paths[child]
            member, child_kind = _below(kind, child)
            path = f"{access}.{vhdl}".lstrip(".")
            if isinstance(below, int):
                made = Node(name=vhdl, access=path, leaf=below)
                made.type = self.leaf_type(self.leaves[below])
            else:
                made = self.node(below, child_kind, vhdl, path)
            made.source = member
            node.children.append(made)
        parts = tuple(
            (child.name, child.type or self.keys[id(child)]) for child in node.children
        )
        kind_name = kind.name if isinstance(kind, Message) else ""
        self.keys[id(node)] = (kind_name, _hint(kind), parts)
        self.wanted.setdefault(self.keys[id(node)], _hint(kind))
        return node

    def leaf_type(self, leaf: Leaf) -> str:
        primitive = primitive_name(leaf)
        if leaf.kind != "items":
            return f"{primitive}_stream_t"
        name = f"{primitive}_items_stream_t"
        self.items[name] = (primitive, leaf.lanes)
        return name

    def name_types(self, root: Node) -> None:
        """Name the record types, the message's own first."""
        self.taken.update(self.items)
        top = self.keys[id(root)]
        given: dict[_Key, str] = {}
        for key, wanted in {top: self.wanted[top], **self.wanted}.items():
            # Members hide types, too.
            text = first_free(wanted, self.taken | self.members, _type_and_ready)
            self.taken.update(_type_and_ready(text))
            given[key] = f"{text}_t"
        for node in root.walk():
            if node.leaf is None:
                node.type = given[self.keys[id(node)]]


def _type_and_ready(name: str) -> tuple[str, str]:
    return f"{name}_t", f"{name}_ready_t"


def _below(kind: FieldType | None, name: str) -> tuple[Field | None, FieldType | None]:
    """Give the field and the type of a member of a type."""
    if isinstance(kind, Message):
        found = next((item for item in kind.fields if item.name == name), None)
        return (found, found.type) if found is not None else (None, None)
    if isinstance(kind, Array | Sequence) and name == "item":
        return None, kind.element
    return None, None


def _hint(kind: FieldType | None) -> str:
    match kind:
        case Message():
            return snake(re.sub(r"[^A-Za-z0-9]+", "_", kind.base_name)) or "message"
        case Text():
            return "wstring" if kind.wide else "string"
        case Array():
            return f"{_hint(kind.element)}_array"
        case Sequence():
            return f"{_hint(kind.element)}_sequence"
        case None:
            return "part"
        case _:
            return str(kind)
