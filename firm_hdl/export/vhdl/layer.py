"""The user's layer in VHDL: a message as nested records, and converters with record ports.

A message type gets a package with the records of its fields and its constants; all converters share
this package. It also gets a package with components, and an entity per direction around the core.
The core with its flat ports can also be used directly. A message of fixed size also gets entities
that transfer the whole message at once. :mod:`firm_hdl.export.tree` and
:mod:`firm_hdl.export.vhdl.values` determine the records.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from firm_hdl.export.constants import NamedConstant, named_constants
from firm_hdl.export.primitives import TYPES_NAME, bus_name
from firm_hdl.export.top import DIRECTIONS, Direction, ports_of
from firm_hdl.export.tree import Tree, tree_of
from firm_hdl.export.vhdl.constants import comment, declarations, quoted
from firm_hdl.export.vhdl.package import bus_package, constants_of, message_package, types_package
from firm_hdl.export.vhdl.values import ValueType, values_of
from firm_hdl.export.vhdl.wrapper import (
    IEEE,
    LIBRARIES,
    Core,
    Line,
    component,
    plain_lines,
    record_lines,
    record_wrapper,
    stream_lines,
    stream_wrapper,
)
from firm_hdl.model import Message
from firm_hdl.plan import Plan

__all__ = ["RecordEntities", "UserLayer", "flat_package", "shared_packages", "user_layer"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Shared:
    """A package that folders of other message types may also have, with the same text."""

    name: str
    # Shared packages that this package uses, except the package of primitives.
    needs: tuple[str, ...] = ()
    # The message type that the package declares; empty for the package of the bus width.
    message: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordEntities:
    """The entities that transfer the whole message as one record of values."""

    values: ValueType  # The record.
    entities: Mapping[Direction, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class UserLayer:
    """The user's layer of a message type."""

    name: str  # Prefix of the names of its entities.
    package: str  # Name of the package with the message's own records.
    entities: Mapping[Direction, str]  # Entities with a record of streams.
    # Entities with a record of values; `None` if the message has no record view.
    record: RecordEntities | None
    tree: Tree
    constants: Mapping[str, list[NamedConstant]]  # Constants by package.
    shared: tuple[Shared, ...]  # Packages that other messages' folders have, too, in compile order.
    # Texts of all packages by file name, in compile order, including the shared ones.
    packages: Mapping[str, str]
    # Texts of the entities by file name; they compile after the packages and the cores.
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

    * `name`: a legal identifier; the entities are ``name_deserializer`` and ``name_serializer``,
      and the package of their components ``name_components_pkg``.
    * `cores`: the entities with flat ports.
    * `record_cores`: the entities of the record view; `None` if the message has none.
    * `header`: lines of a comment at the head of every file that is not shared.
    """
    entities = {direction: f"{name}_{direction}" for direction in DIRECTIONS}
    tree = tree_of(message, plan)
    values = values_of(tree, plan)
    components = f"{name}_components_pkg"
    head = "".join(comment(header, ""))
    lines = {entity: stream_lines(plan, tree, way) for way, entity in entities.items()}
    wrappers = {
        entity: stream_wrapper(plan, tree, way, entity=entity, core=cores[way])
        for way, entity in entities.items()
    }
    record = None
    if record_cores is not None:
        own = values[message.name]
        whole = {way: f"{entity}_record" for way, entity in entities.items()}
        record = RecordEntities(values=own, entities=whole)
        for way, entity in whole.items():
            lines[entity] = record_lines(plan, own, way)
            wrappers[entity] = record_wrapper(plan, own, way, entity=entity, core=record_cores[way])
    return UserLayer(
        name=name,
        package=tree.package.name,
        entities=entities,
        record=record,
        tree=tree,
        constants={package.name: constants_of(package, plan) for package in tree.packages},
        shared=_shared(plan, tree),
        packages={
            **shared_packages(plan, tree, values),
            f"{components}.vhd": head + _components(plan, tree, components, lines),
        },
        wrappers={f"{entity}.vhd": head + text for entity, text in wrappers.items()},
    )


def _shared(plan: Plan, tree: Tree) -> tuple[Shared, ...]:
    bus = bus_name(plan.bus_bytes)
    own = (
        Shared(name=each.name, needs=(bus, *each.needs), message=each.message.name)
        for each in tree.packages
    )
    return (Shared(name=bus), *own)


def shared_packages(plan: Plan, tree: Tree, values: Mapping[str, ValueType]) -> dict[str, str]:
    """Write the packages that other messages' folders have, too, by file name.

    * `tree`: the records of the message.
    * `values`: the records of values that :func:`firm_hdl.export.vhdl.values.values_of` found.

    Returns: texts in compile order.
    """
    texts = {TYPES_NAME: types_package(), bus_name(plan.bus_bytes): bus_package(plan.bus_bytes)}
    for each in tree.packages:
        texts[each.name] = message_package(each, plan, values.get(each.message.name))
    return {f"{name}.vhd": text for name, text in texts.items()}


def _components(plan: Plan, tree: Tree, name: str, lines: Mapping[str, list[Line]]) -> str:
    """Write the package of the components; `lines` has the ports of each."""
    text = [
        *comment(f"Components of the converters of {plan.message}.", ""),
        f"\n{LIBRARIES}use work.{tree.package.name}.all;\n\npackage {name} is\n",
    ]
    for entity, ports in lines.items():
        text += component(entity, ports)
    text.append(f"\nend package {name};\n")
    return "".join(text)


def flat_package(
    message: Message,
    plan: Plan,
    *,
    name: str,
    cores: Mapping[Direction, Core],
    header: str = "",
) -> tuple[str, list[NamedConstant]]:
    """Write a package without records: constants of a message, components of the flat entities.

    Parameters
    ----------
    name : str
        Name of the package.
    cores, header
        As for :func:`user_layer`.

    Returns
    -------
    text : str
    constants : list of NamedConstant
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
