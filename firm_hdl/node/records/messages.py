"""The messages at the top level of a node, and the plain ports that each consists of."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from firm_hdl.errors import UserError
from firm_hdl.export.top import Direction, Port, ports_of
from firm_hdl.export.tree import Tree, tree_of
from firm_hdl.gateware.members import member_tree
from firm_hdl.model import Message
from firm_hdl.names.identifiers import flat_names
from firm_hdl.node.description import Description, Store
from firm_hdl.node.top import NodePort
from firm_hdl.plan import Plan, build_plan
from firm_hdl.wire import lay_out

__all__ = ["MessagePort", "message_ports", "other_ports"]

_SERVICE = {"in": "request", "out": "response"}


@dataclass(frozen=True, slots=True, kw_only=True)
class MessagePort:
    """A message at the top level of a node.

    Attributes
    ----------
    name, ready : str
        Names of the record with data and valid, and of the record with ready.
    member : str
        The member of :class:`Node`, such as ``subscribe.cmd_vel``.
    message : Message
    direction : Direction
        ``deserializer`` if the message comes out of the node.
    plan : Plan
    ports : mapping of str to Port
        The plain ports of the message's leaves, by their names at the node.
    """

    name: str
    ready: str
    member: str
    message: Message
    direction: Direction
    plan: Plan
    ports: Mapping[str, Port]

    def tree(self, reserved: Collection[str] = ()) -> Tree:
        """Return the records of the message; `reserved` as for :func:`tree_of`."""
        return tree_of(self.message, self.plan, reserved)


def message_ports(description: Description, ports: Sequence[NodePort]) -> list[MessagePort]:
    """List the messages that come out of a node, and go into it.

    Parameters
    ----------
    ports : sequence of NodePort
        All ports of the top level.

    Raises
    ------
    UserError
        If two types of the node would have one package of records.
    """
    found = list(_found(description))
    taken = [port.name for port in ports]
    paths = [tuple(member.split(".")) for member, _, _ in found]
    names = flat_names([*paths, *((*path, "rdy") for path in paths)], taken)
    by_member = {port.member: port.name for port in ports}
    messages = []
    for path, (member, direction, store) in zip(paths, found, strict=True):
        plan = build_plan(
            lay_out(store.message, description.wire),
            bus_bytes=description.bus_bytes,
            max_message_bytes=store.max_message_bytes,
        )
        places = dict(member_tree(leaf.path for leaf in plan.leaves).leaves())
        own = {
            by_member[".".join((member, *places[port.leaf], port.member))]: port
            for port in ports_of(plan, direction)
            if port.leaf is not None
        }
        messages.append(
            MessagePort(
                name=names[path],
                ready=names[(*path, "rdy")],
                member=member,
                message=store.message,
                direction=direction,
                plan=plan,
                ports=own,
            )
        )
    _check_packages(messages)
    return messages


def other_ports(ports: Sequence[NodePort], messages: Sequence[MessagePort]) -> list[NodePort]:
    """Return the ports of a node that belong to no message."""
    own = {name for each in messages for name in each.ports}
    return [port for port in ports if port.name not in own]


def _found(description: Description) -> Iterator[tuple[str, Direction, Store]]:
    """Yield the member, the direction and the type of each message."""
    for topic in description.topics:
        for way, store in topic.stores:
            base = f"{topic.kind}.{topic.port}"
            member = f"{base}.{_SERVICE[way]}" if topic.kind == "serve" else base
            yield member, "deserializer" if way == "in" else "serializer", store


def _check_packages(messages: Sequence[MessagePort]) -> None:
    """Refuse types whose names differ only where packages of VHDL do not."""
    owners: dict[str, str] = {}
    for each in messages:
        for package in each.tree().packages:
            owner = owners.setdefault(package.name, package.message.name)
            if owner != package.message.name:
                raise UserError(
                    f"{package.message.name} and {owner} would have one package of VHDL, "
                    f"'{package.name}', so the node has no records"
                )
