"""The user's layer in VHDL: a message as nested records, and converters that speak them.

For each message type: a package with the records of its fields, its constants and components, and
an entity per direction around the core, whose flat ports stay usable on their own. What the records
are is decided in :mod:`firm_hdl.export.vhdl_user_tree`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from firm_hdl.export.top import DIRECTIONS, Direction, Port, leaf_names, ports_of
from firm_hdl.export.vhdl_user_constants import Named, comment, declarations, named_constants
from firm_hdl.export.vhdl_user_tree import Node, Tree, tree_of
from firm_hdl.export.vhdl_user_types import TYPES_NAME, primitive_name, types_package
from firm_hdl.gateware.signatures import Status
from firm_hdl.model import Message
from firm_hdl.plan import Plan

__all__ = ["UserLayer", "user_layer"]

_LIBRARIES = f"""\
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

use work.{TYPES_NAME}.all;
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class UserLayer:
    """The user's layer of a message type.

    Attributes
    ----------
    name : str
        What all its names start with.
    package : str
    entities : mapping of direction to str
    tree : Tree
    constants : list of Named
    packages : mapping of str to str
        Texts by file name, in compile order.
    wrappers : mapping of str to str
        Likewise; they need the packages and the cores.
    """

    name: str
    package: str
    entities: Mapping[Direction, str]
    tree: Tree
    constants: list[Named]
    packages: Mapping[str, str]
    wrappers: Mapping[str, str]


def user_layer(
    message: Message,
    plan: Plan,
    *,
    name: str,
    cores: Mapping[Direction, str],
    core_ports: Mapping[Direction, Mapping[str, str]] | None = None,
    header: str = "",
) -> UserLayer:
    """Write the user's layer of a message type.

    Parameters
    ----------
    name : str
        A legal identifier; the package is ``name_pkg``, the entities ``name_deserializer`` and
        ``name_serializer``.
    cores : mapping of direction to str
        The entities with flat ports.
    core_ports : mapping, or None
        What ports of these are called, by direction and name of :func:`ports_of`, where the names
        differ.
    header : str
        Lines for a comment at the head of every file.
    """
    entities = {direction: f"{name}_{direction}" for direction in DIRECTIONS}
    package = f"{name}_pkg"
    tree = tree_of(message, plan, _reserved(package, entities))
    constants = named_constants(message, tree.taken)
    nodes = {node.leaf: node for node in tree.root.leaves() if node.leaf is not None}
    remark = "".join(comment(header, ""))
    layer = _Writer(message, plan, tree, nodes, leaf_names(plan), remark)
    renamed = core_ports or {}
    wrappers = {
        f"{entities[direction]}.vhd": layer.wrapper(
            direction, entities[direction], package, cores[direction], renamed.get(direction, {})
        )
        for direction in DIRECTIONS
    }
    packages = {
        f"{TYPES_NAME}.vhd": types_package(),
        f"{package}.vhd": layer.package(package, entities, constants),
    }
    return UserLayer(
        name=name,
        package=package,
        entities=entities,
        tree=tree,
        constants=constants,
        packages=packages,
        wrappers=wrappers,
    )


def _reserved(package: str, entities: Mapping[Direction, str]) -> frozenset[str]:
    """Name all that the shared package declares, and ours, in lower case."""
    integers = (f"{sign}int{8 << k}" for sign in ("", "u") for k in range(4))
    primitives = ("bool", "float32", "float64", *integers)
    statuses: Any = Status
    return frozenset(
        [
            package.lower(),
            TYPES_NAME,
            "to_slv",
            "status_name",
            *(f"status_{status.name.lower()}" for status in statuses),
            *(f"{kind}_{what}_t" for kind in primitives for what in ("stream", "items")),
            *(f"to_{kind}_items" for kind in primitives),
            *(entity.lower() for entity in entities.values()),
        ]
    )


@dataclass(frozen=True, slots=True)
class _Writer:
    message: Message
    plan: Plan
    tree: Tree
    nodes: dict[int, Node]
    names: dict[tuple[str, ...], str]
    header: str

    def package(
        self, name: str, entities: Mapping[Direction, str], constants: list[Named]
    ) -> str:
        return "".join(
            [
                self.header,
                *comment(
                    f"{self.message.name} as records: {self.tree.root.type} has data and valid of "
                    f"every field, {self.tree.root.ready_type} has ready, the other way.",
                    "",
                ),
                *(["--\n"] if self.message.comment else []),
                *comment(self.message.comment, ""),
                f"\n{_LIBRARIES}\npackage {name} is\n",
                *self.items(),
                *self.records(),
                *declarations(constants, self.tree.taken),
                *(text for way in DIRECTIONS for text in self.component(way, entities[way])),
                f"\nend package {name};\n",
            ]
        )

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
                    yield from comment(child.source.comment, "    ")
                line = f"    {child.name:{width}} : {child.type + ';':{kinds}}{self.remark(child)}"
                yield f"{line.rstrip()}\n"
            yield "  end record;\n"
            yield f"\n  type {node.ready_type} is record\n"
            for child in node.children:
                yield f"    {child.name:{width}} : {child.ready_type};\n"
            yield "  end record;\n"

    def remark(self, node: Node) -> str:
        """Say of a member what ROS calls it."""
        if node.source is not None:
            what = str(node.source.type)
            if node.source.name != node.name:
                what = f"{node.source.name}: {what}"
            return f"  -- {what} [{node.source.unit}]" if node.source.unit else f"  -- {what}"
        if node.leaf is not None and self.plan.leaves[node.leaf].kind == "length":
            return "  -- how many follow"
        return ""

    def component(self, direction: Direction, entity: str) -> Iterator[str]:
        yield f"\n  component {entity} is\n"
        yield from (f"  {line}" for line in self.ports(direction, meanings=False))
        yield "  end component;\n"

    def ports(self, direction: Direction, *, meanings: bool = True) -> Iterator[str]:
        """Yield a port clause, a line each: clock, packets, message, status."""
        forwards, backwards = ("out", "in ") if direction == "deserializer" else ("in ", "out")
        lines = [self.port(port) for port in ports_of(self.plan, direction) if port.leaf is None]
        status = next(k for k, line in enumerate(lines) if "m_axis_status" in line[0])
        root = self.tree.root
        lines[status:status] = [
            ("msg", f"{forwards} {root.type}", f"The fields of {self.message.name}."),
            ("rdy", f"{backwards} {root.ready_type}", "Which of them are taken."),
        ]
        names = max(len(name) for name, _, _ in lines)
        kinds = max(len(kind) for _, kind, _ in lines) + 1
        yield "  port (\n"
        for index, (name, kind, meaning) in enumerate(lines):
            end = ";" if index < len(lines) - 1 else ""
            line = f"    {name:{names}} : {kind + end:{kinds}}  -- {meaning}"
            if not meanings or len(line) > 100:
                if meanings:
                    yield from comment(meaning, "    ")
                line = f"    {name:{names}} : {kind}{end}"
            yield f"{line}\n"
        yield "  );\n"

    @staticmethod
    def port(port: Port) -> tuple[str, str, str]:
        kind = "std_logic" if port.width == 1 and not _is_vector(port.name) else (
            f"std_logic_vector({port.width - 1} downto 0)"
        )
        return port.name, f"{port.direction:3} {kind}", port.meaning

    def wrapper(
        self, direction: Direction, entity: str, package: str, core: str, names: Mapping[str, str]
    ) -> str:
        signals: list[tuple[str, str]] = []
        assignments: list[str] = []
        parts = {
            port.name: self.actual(port, direction, signals, assignments)
            for port in ports_of(self.plan, direction)
        }
        width = max(len(names.get(port, port)) for port in parts)
        joined = ",\n".join(
            f"      {names.get(port, port):{width}} => {actual}" for port, actual in parts.items()
        )
        return "".join(
            [
                self.header,
                f"-- The {direction} of {self.message.name} with records.\n",
                f"-- {core} has flat ports.\n",
                f"\n{_LIBRARIES}use work.{package}.all;\n",
                f"\nentity {entity} is\n",
                *self.ports(direction),
                f"end entity;\n\narchitecture wrapper of {entity} is\n",
                *(["\n"] if signals else []),
                *_aligned(signals),
                f"\nbegin\n\n  core : entity work.{core}\n    port map (\n{joined}\n    );\n",
                *(["\n"] if assignments else []),
                *assignments,
                "\nend architecture;\n",
            ]
        )

    def actual(
        self,
        port: Port,
        direction: Direction,
        signals: list[tuple[str, str]],
        assignments: list[str],
    ) -> str:
        """Give what a port of the core is connected to; conversions get a signal of their own.

        Some synthesis tools take no conversion in a port map.
        """
        if port.leaf is None:
            # A vector of one bit is a bit to the core.
            return f"{port.name}(0)" if port.width == 1 and _is_vector(port.name) else port.name
        leaf = self.plan.leaves[port.leaf]
        node = self.nodes[port.leaf]
        member = port.name.removeprefix(f"{self.names[leaf.path]}_")
        if member == "ready":
            return f"rdy.{node.access}"
        whole = f"msg.{node.access}.{member}"
        if member != "data":
            return whole
        primitive = primitive_name(leaf)
        if leaf.kind == "items" and port.width == 1:
            return f"{whole}(0)"
        if leaf.kind != "items" and (primitive == "bool" or primitive.startswith("float")):
            return whole
        signals.append((port.name, f"std_logic_vector({port.width - 1} downto 0)"))
        if direction == "serializer":
            convert = "to_slv" if leaf.kind == "items" else "std_logic_vector"
            assignments.append(f"  {port.name} <= {convert}({whole});\n")
        else:
            convert = (
                f"to_{primitive}_items"
                if leaf.kind == "items"
                else "signed" if leaf.signed else "unsigned"
            )
            assignments.append(f"  {whole} <= {convert}({port.name});\n")
        return port.name


def _aligned(signals: list[tuple[str, str]]) -> Iterator[str]:
    width = max((len(name) for name, _ in signals), default=0)
    return (f"  signal {name:{width}} : {kind};\n" for name, kind in signals)


def _is_vector(name: str) -> bool:
    """Tell whether a packet port is a vector whatever the bus: AXI4-Stream's ``tkeep`` is."""
    return name.endswith("_tkeep")
