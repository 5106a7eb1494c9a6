"""The user's layer in VHDL: a message as nested records, and converters that speak them.

For each message type: a package with the records of its fields, its constants and components, and
an entity per direction around the core, whose flat ports stay usable on their own. A message of
fixed size also gets entities that give, and take, all of it at once. What the records are is
decided in :mod:`firm_hdl.export.vhdl_user_tree` and :mod:`firm_hdl.export.vhdl_user_values`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from firm_hdl.export.top import DIRECTIONS, Direction, ports_of
from firm_hdl.export.vhdl_user_constants import (
    Named,
    comment,
    declarations,
    named_constants,
    origin,
    quoted,
)
from firm_hdl.export.vhdl_user_tree import Node, Tree, tree_of
from firm_hdl.export.vhdl_user_types import SHARED_TYPES, TYPES_NAME, types_package
from firm_hdl.export.vhdl_user_values import Values, values_of
from firm_hdl.export.vhdl_user_wrapper import (
    IEEE,
    LIBRARIES,
    Core,
    component,
    plain_lines,
    record_lines,
    record_wrapper,
    stream_lines,
    stream_wrapper,
)
from firm_hdl.gateware.signatures import Status
from firm_hdl.model import Message
from firm_hdl.plan import Plan

__all__ = ["UserLayer", "flat_package", "user_layer"]

@dataclass(frozen=True, slots=True, kw_only=True)
class UserLayer:
    """The user's layer of a message type.

    Attributes
    ----------
    name : str
        What all its names start with.
    package : str
    entities : mapping of direction to str
        With a record of streams.
    record_entities : mapping of direction to str
        With a record of values; empty if the message has none.
    tree : Tree
    values : Values or None
    constants : list of Named
    packages : mapping of str to str
        Texts by file name, in compile order.
    wrappers : mapping of str to str
        Likewise; they need the packages and the cores.
    """

    name: str
    package: str
    entities: Mapping[Direction, str]
    record_entities: Mapping[Direction, str]
    tree: Tree
    values: Values | None
    constants: list[Named]
    packages: Mapping[str, str]
    wrappers: Mapping[str, str]


def user_layer(
    message: Message,
    plan: Plan,
    *,
    name: str,
    cores: Mapping[Direction, Core],
    record_cores: Mapping[Direction, Core] | None = None,
    header: str = "",
) -> UserLayer:
    """Write the user's layer of a message type.

    Parameters
    ----------
    name : str
        A legal identifier; the package is ``name_pkg``, the entities ``name_deserializer`` and
        ``name_serializer``.
    cores : mapping of direction to Core
        The entities with flat ports.
    record_cores : mapping of direction to Core, or None
        Those of the record view, if there is one.
    header : str
        Lines for a comment at the head of every file.
    """
    package = f"{name}_pkg"
    entities = {direction: f"{name}_{direction}" for direction in DIRECTIONS}
    whole = {way: f"{entity}_record" for way, entity in entities.items() if record_cores}
    tree = tree_of(message, plan, _reserved(package, (*entities.values(), *whole.values())))
    values = values_of(message, plan, tree.taken, tree.members) if record_cores else None
    writer = _Writer(message, plan, tree, values, header)
    constants = named_constants(message, writer.taken)
    return UserLayer(
        name=name,
        package=package,
        entities=entities,
        record_entities=whole,
        tree=tree,
        values=values,
        constants=constants,
        packages={
            f"{TYPES_NAME}.vhd": types_package(),
            f"{package}.vhd": writer.package(package, entities, whole, constants),
        },
        wrappers={
            **writer.wrappers(package, entities, cores),
            **writer.record_wrappers(package, whole, record_cores or {}),
        },
    )


def _reserved(package: str, entities: tuple[str, ...]) -> frozenset[str]:
    """Name all that the shared package declares, and ours, in lower case."""
    statuses: Any = Status
    return frozenset(
        [
            package.lower(),
            TYPES_NAME,
            "to_slv",
            "status_name",
            *(f"status_{status.name.lower()}" for status in statuses),
            *SHARED_TYPES,
            *(f"to_{name.removesuffix('_t')}" for name in SHARED_TYPES),
            *(entity.lower() for entity in entities),
        ]
    )


@dataclass(frozen=True, slots=True)
class _Writer:
    message: Message
    plan: Plan
    tree: Tree
    values: Values | None
    header: str

    @property
    def taken(self) -> frozenset[str]:
        """Identifiers of the package, but for constants."""
        return self.tree.taken | (self.values.taken if self.values is not None else frozenset())

    def remark(self) -> str:
        return "".join(comment(self.header, ""))

    def wrappers(
        self, package: str, entities: Mapping[Direction, str], cores: Mapping[Direction, Core]
    ) -> dict[str, str]:
        return {
            f"{entity}.vhd": self.remark()
            + stream_wrapper(
                self.message, self.plan, self.tree, way, entity, package, cores[way]
            )
            for way, entity in entities.items()
        }

    def record_wrappers(
        self, package: str, entities: Mapping[Direction, str], cores: Mapping[Direction, Core]
    ) -> dict[str, str]:
        if self.values is None:
            return {}
        return {
            f"{entity}.vhd": self.remark()
            + record_wrapper(
                self.message, self.plan, self.values, way, entity, package, cores[way]
            )
            for way, entity in entities.items()
        }

    def package(
        self,
        name: str,
        entities: Mapping[Direction, str],
        whole: Mapping[Direction, str],
        constants: list[Named],
    ) -> str:
        root = self.tree.root
        text = [
            self.remark(),
            *comment(
                f"{self.message.name} as records: {root.type} has data and valid of "
                f"every field, {root.ready_type} has ready, the other way.",
                "",
            ),
            *(["--\n"] if self.message.comment else []),
            *quoted(self.message.comment, ""),
            f"\n{LIBRARIES}\npackage {name} is\n",
            *self.items(),
            *self.records(),
        ]
        if self.values is not None:
            text += self.values.declarations()
        text += declarations(constants, self.taken)
        for way, entity in entities.items():
            text += component(entity, stream_lines(self.message, self.plan, self.tree, way))
        if self.values is not None:
            for way, entity in whole.items():
                lines = record_lines(self.message, self.plan, self.values, way)
                text += component(entity, lines)
        text.append(f"\nend package {name};\n")
        if self.values is not None:
            text += [
                f"\npackage body {name} is\n",
                *self.values.bodies(),
                f"\nend package body {name};\n",
            ]
        return "".join(text)

    def items(self) -> Iterator[str]:
        for name, (primitive, lanes) in self.tree.items.items():
            yield (
                f"\n  type {name} is record\n"
                f"    data  : {primitive}_items_t(0 to {lanes - 1});  -- past the end: zeros\n"
                "    last  : std_logic;  -- the transfer ends its array\n"
                "    valid : std_logic;\n"
                "  end record;\n"
            )

    def records(self) -> Iterator[str]:
        done: set[str] = set()
        for node in self.tree.root.walk():
            if node.leaf is not None or node.type in done:
                continue
            done.add(node.type)
            width = max(len(child.name) for child in node.children)
            yield f"\n  type {node.type} is record\n"
            kinds = max(len(child.type) for child in node.children) + 1
            for child in node.children:
                if child.source is not None and child.source.comment:
                    yield from quoted(child.source.comment, "    ")
                line = f"    {child.name:{width}} : {child.type + ';':{kinds}}{self.origin(child)}"
                yield f"{line.rstrip()}\n"
            yield "  end record;\n"
            yield f"\n  type {node.ready_type} is record\n"
            for child in node.children:
                yield f"    {child.name:{width}} : {child.ready_type};\n"
            yield "  end record;\n"

    def origin(self, node: Node) -> str:
        """Say of a member what ROS calls it."""
        if node.source is not None:
            return origin(node.source, node.name)
        if node.leaf is not None and self.plan.leaves[node.leaf].kind == "length":
            return "  -- how many follow"
        return ""


def flat_package(
    message: Message,
    plan: Plan,
    *,
    name: str,
    cores: Mapping[Direction, Core],
    header: str = "",
) -> tuple[str, list[Named]]:
    """Write a package without any record: constants of a message, and the flat entities.

    Parameters
    ----------
    name : str
        The package.
    cores, header
        As for :func:`user_layer`.
    """
    taken = frozenset([name.lower(), *(core.entity.lower() for core in cores.values())])
    constants = named_constants(message, taken)
    text = [
        *comment(header, ""),
        *comment(f"Constants of {message.name}, and its converters with flat ports.", ""),
        *(["--\n"] if message.comment else []),
        *quoted(message.comment, ""),
        f"\n{IEEE}\npackage {name} is\n",
        *declarations(constants, taken),
    ]
    for direction, core in cores.items():
        text += component(core.entity, plain_lines(ports_of(plan, direction), core.names))
    text.append(f"\nend package {name};\n")
    return "".join(text), constants
