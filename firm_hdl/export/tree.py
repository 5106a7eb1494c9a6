"""The records of a message type: their nesting and all names.

:mod:`firm_hdl.export.vhdl.package` prints them as records of VHDL, and
:mod:`firm_hdl.export.systemverilog.package` as structs. A ROS type has one package for each wire
format and bus width. The names in a package depend only on the type, not on the message that
contains it. So all converters of a design share the packages, and a header of one message can be
assigned to the header of another.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field

from firm_hdl.export.primitives import (
    BUS_TYPES,
    SHARED_TYPES,
    SHARED_WORDS,
    bus_name,
    primitive_name,
)
from firm_hdl.model import Array, Field, FieldType, Message, Sequence, String, element_of
from firm_hdl.names.identifiers import first_free, identifier, scope_names
from firm_hdl.plan import Leaf, Plan
from firm_hdl.wire import Wire

__all__ = ["Node", "Package", "Tree", "package_name", "snake", "taken_names", "tree_of"]

_Paths = dict[str, "_Paths | int"]


@dataclass(slots=True, kw_only=True)
class Node:
    """A message, a part of one, or a leaf.

    Attributes
    ----------
    name : str
        Name of the member in the record that contains it.
    access : str
        Dotted names of the members from the message's record to this one; empty for the message.
    leaf : int or None
        Index into `Plan.leaves`; `None` for records.
    source : Field or None
        Field of the definition; `None` for members that are not a field.
    children : list of Node
    type : str
        Type of data and valid. The type of ready has ``_ready_t`` instead of ``_t``.
    package : str
        The package of a message type that declares `type`; empty for types of a shared package.
    """

    name: str
    access: str
    leaf: int | None = None
    source: Field | None = None
    children: list[Node] = field(default_factory=list)
    type: str = ""
    package: str = ""

    @property
    def ready_type(self) -> str:
        """Type of ready of a record; that of a leaf is one bit in every language."""
        return f"{self.type.removesuffix('_t')}_ready_t"

    def walk(self) -> Iterator[Node]:
        """Yield all nodes, children before their parents."""
        for child in self.children:
            yield from child.walk()
        yield self

    def leaves(self) -> Iterator[Node]:
        """Yield the leaves in wire order."""
        return (node for node in self.walk() if node.leaf is not None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Package:
    """The package of a message type."""

    message: Message
    name: str
    base: str  # Prefix of the names of its types.
    node: Node  # A node with this message type.
    needs: tuple[str, ...]  # Packages of the types of its fields.


@dataclass(frozen=True, slots=True, kw_only=True)
class Tree:
    """A message's records."""

    root: Node
    # Packages of all message types in the message, each after those that it needs. The message's
    # own package comes last.
    packages: tuple[Package, ...]

    @property
    def package(self) -> Package:
        """The message's own package."""
        return self.packages[-1]

    def leaf_members(self, plan: Plan) -> dict[str, str]:
        """Return the dotted names of the members of all leaves, by the leaves' paths."""
        return {
            str(plan.leaves[node.leaf]): node.access
            for node in self.root.leaves()
            if node.leaf is not None
        }


def snake(name: str) -> str:
    """Return a message's name in snake case.

    >>> snake("PoseWithCovariance"), snake("PointCloud2"), snake("IMUData")
    ('pose_with_covariance', 'point_cloud2', 'imu_data')
    """
    text = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name)
    return re.sub("_+", "_", text).lower().strip("_")


def _member_names(names: Iterable[str]) -> dict[str, str]:
    """Return the identifiers of the members of a record.

    >>> _member_names(["x", "range", "float64_stream_t"])
    {'x': 'x', 'range': 'range_field', 'float64_stream_t': 'float64_stream_t_2'}
    """
    # A member with the name of a type or of the library would hide it in the same record.
    return scope_names(names, {*SHARED_TYPES, *BUS_TYPES, "work"})


def package_name(message: Message, wire: Wire, bus_bytes: int) -> str:
    """Name the package of a message type.

    >>> package_name(Message(name="time", dialect="ros1", fields=()), "ros1", 8)
    'builtin_time_ros1_8_pkg'
    """
    name = message.name if message.package else f"builtin/{message.name}"
    return f"{identifier(identifier(name) + f'_{wire}_{bus_bytes}').lower()}_pkg"


def _derived(base: str) -> tuple[str, ...]:
    """Return all identifiers of a message's package except constants of ROS, in lower case."""
    kinds = (base, f"{base}_sequence", f"{base}_array")
    return (
        *(f"{kind}_{what}" for kind in kinds for what in ("t", "ready_t", "all_ready", "idle")),
        *(f"{base}_value_t", f"{base}_values_t", f"{base}_value_bits"),
        *(f"to_{base}_value", f"to_{base}_values"),
    )


def taken_names(package: Package, plan: Plan) -> frozenset[str]:
    """Return the names that no constant may hide: those that the package declares or uses."""
    own = {package.name, *_derived(package.base)}
    return frozenset({*own, *SHARED_WORDS, *BUS_TYPES, bus_name(plan.bus_bytes)})


def tree_of(message: Message, plan: Plan, reserved: Collection[str] = ()) -> Tree:
    """Determine the records of a message, and all names in them.

    * `reserved`: names that a language needs in all packages, in addition to VHDL's; in lower case.
    """
    paths: _Paths = {}
    for index, leaf in enumerate(plan.leaves):
        place = paths
        for name in leaf.path[:-1]:
            below = place.setdefault(name, {})
            assert isinstance(below, dict), "a leaf has nothing below it"
            place = below
        place[leaf.path[-1]] = index
    maker = _Maker(plan, frozenset(reserved))
    root = maker.node(paths, message, "", "")
    return Tree(root=root, packages=tuple(maker.packages.values()))


@dataclass(slots=True)
class _Maker:
    plan: Plan
    reserved: frozenset[str]
    packages: dict[str, Package] = field(default_factory=dict)
    # Names of packages, in lower case.
    taken: set[str] = field(default_factory=set)

    def node(self, paths: _Paths, kind: FieldType | None, name: str, access: str) -> Node:
        node = Node(name=name, access=access)
        for child, vhdl in _member_names(paths).items():
            below = paths[child]
            member, child_kind = _below(kind, child)
            path = f"{access}.{vhdl}".lstrip(".")
            if isinstance(below, int):
                made = Node(name=vhdl, access=path, leaf=below)
                made.type = _leaf_type(self.plan.leaves[below])
            else:
                made = self.node(below, child_kind, vhdl, path)
            made.source = member
            node.children.append(made)
        self.name_type(node, kind)
        return node

    def name_type(self, node: Node, kind: FieldType | None) -> None:
        element = element_of(kind) if kind is not None else None
        form = "array" if isinstance(kind, Array) else "sequence"
        if isinstance(kind, Message):
            package = self.package(kind, node)
            node.type, node.package = f"{package.base}_t", package.name
        elif isinstance(kind, String):
            node.type = f"{_text(kind)}_stream_t"
        elif isinstance(element, Message):
            package = self.packages[element.name]
            node.type, node.package = f"{package.base}_{form}_t", package.name
        elif isinstance(element, String):
            node.type = f"{_text(element)}_{form}_stream_t"
        else:
            items = next(child for child in node.children if child.name == "items")
            assert items.leaf is not None
            node.type = f"{primitive_name(self.plan.leaves[items.leaf])}_{form}_stream_t"

    def package(self, message: Message, node: Node) -> Package:
        found = self.packages.get(message.name)
        if found is None:
            wanted = package_name(message, self.plan.wire, self.plan.bus_bytes)
            # `a_b/C` and `a/b_C` would have the same name, so the second gets a number.
            name = first_free(wanted.removesuffix("_pkg"), self.taken, lambda n: (f"{n}_pkg",))
            self.taken.add(f"{name}_pkg")
            wanted = snake(re.sub(r"[^A-Za-z0-9]+", "_", message.base_name)) or "message"
            hidden = {*SHARED_WORDS, *BUS_TYPES, *self.reserved}
            needs = dict.fromkeys(self.packages[child.name].name for child in message.children)
            found = Package(
                message=message,
                name=f"{name}_pkg",
                base=first_free(wanted, hidden, _derived),
                node=node,
                needs=tuple(needs),
            )
            self.packages[message.name] = found
        return found


def _text(kind: String) -> str:
    return "wstring" if kind.wide else "string"


def _leaf_type(leaf: Leaf) -> str:
    return f"{primitive_name(leaf)}{'_items' if leaf.kind == 'items' else ''}_stream_t"


def _below(kind: FieldType | None, name: str) -> tuple[Field | None, FieldType | None]:
    """Return the field and the type of a member of a type."""
    if isinstance(kind, Message):
        found = next((item for item in kind.fields if item.name == name), None)
        return (found, found.type) if found is not None else (None, None)
    if isinstance(kind, Array | Sequence) and name == "item":
        return None, kind.element
    return None, None
