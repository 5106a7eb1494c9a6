"""Python names for ROS names: the members of message interfaces.

Almost every ROS field name is used as it is. Exceptions are words that Python or Amaranth reserves,
and names with ``__``. Amaranth joins the parts of a port's name with ``__``: ``a__b`` and ``a.b``
would be one port, and one of the two would silently be lost. Such a member gets trailing
underscores, as few as make it unique.
"""

from __future__ import annotations

import keyword
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

__all__ = ["MemberTree", "member_tree"]

RESERVED = frozenset({"signature", "metadata", "elaborate", "clk", "rst", *keyword.kwlist})
STREAM_PORTS = ("payload", "valid", "ready")


@dataclass(slots=True)
class MemberTree:
    """Members by ROS name, in wire order."""

    member: str = ""  # Name in Python; empty at the root.
    leaf: int | None = None  # Index of the leaf, if this is one.
    children: dict[str, MemberTree] = field(default_factory=dict)

    def leaves(self, path: tuple[str, ...] = ()) -> Iterator[tuple[int, tuple[str, ...]]]:
        """Yield the index and the member path of every leaf."""
        if self.leaf is not None:
            yield self.leaf, path
        for child in self.children.values():
            yield from child.leaves((*path, child.member))


def member_tree(paths: Iterable[tuple[str, ...]]) -> MemberTree:
    """Arrange leaves, given by their ROS paths in wire order, as a tree with Python names."""
    root = MemberTree()
    for index, path in enumerate(paths):
        node = root
        for name in path:
            node = node.children.setdefault(name, MemberTree())
        node.leaf = index
    _name(root)
    return root


def _name(node: MemberTree) -> None:
    for child in node.children.values():
        _name(child)
    taken: set[str] = set()
    # Names that cannot clash are assigned first, so that they stay unchanged.
    ordered = sorted(node.children.items(), key=lambda item: _may_clash(item[0]))
    with_ports = any(_may_clash(name) for name in node.children)
    for name, child in ordered:
        member = name + "_" if name in RESERVED else name
        while not taken.isdisjoint(_ports(member, child, with_ports)):
            member += "_"
        taken.update(_ports(member, child, with_ports))
        child.member = member


def _may_clash(name: str) -> bool:
    return "__" in name or name.endswith("_") or name in RESERVED


def _ports(member: str, node: MemberTree, with_ports: bool) -> Iterator[str]:
    """Yield the names that a member occupies: its own and, if `with_ports`, those of its ports."""
    yield member
    if not with_ports:
        return
    if node.leaf is not None:
        yield from (f"{member}__{port}" for port in STREAM_PORTS)
    for child in node.children.values():
        yield from (f"{member}__{port}" for port in _ports(child.member, child, with_ports))
