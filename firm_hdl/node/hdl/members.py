"""The streams of an accelerator: what its writer has to take, and to offer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby

from firm_hdl.gateware.members import member_tree
from firm_hdl.node.description import Description, Topic, Way
from firm_hdl.node.hdl.ports import AcceleratorPort, accelerator_ports
from firm_hdl.plan import Leaf

__all__ = ["AcceleratorStream", "accelerator_streams", "by_message", "described", "members_text"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AcceleratorStream:
    """A field of a message at an accelerator."""

    topic: Topic
    message: str  # Name of the message, such as `std_srvs/srv/Trigger_Request`.
    member: str  # The member of the accelerator, such as `subscribe.cmd_vel.linear.x`.
    direction: Way  # That of its data.
    type: str  # What it carries, for people.
    ports: tuple[AcceleratorPort, ...]  # Data, perhaps `last`, then `valid` and `ready`.

    def port(self, name: str) -> AcceleratorPort | None:
        """Return a port by the last part of its member, such as ``valid``."""
        return next((each for each in self.ports if each.member.endswith(f".{name}")), None)


def accelerator_streams(description: Description) -> tuple[AcceleratorStream, ...]:
    """List the streams of an accelerator in the order of topics and fields."""
    return tuple(_streams(description))


def _streams(description: Description) -> Iterator[AcceleratorStream]:
    by_stream: dict[str, list[AcceleratorPort]] = {}
    for port in accelerator_ports(description):
        by_stream.setdefault(port.member.rpartition(".")[0], []).append(port)
    for topic in description.topics:
        for way, store in topic.stores:
            plan = description.plan(store)
            for index, path in member_tree(leaf.path for leaf in plan.leaves).leaves():
                member = ".".join((*topic.path(way), *path))
                # The data of `items` is a member of its payload.
                yield AcceleratorStream(
                    topic=topic,
                    message=store.message.name,
                    member=member,
                    direction=way,
                    type=described(plan.leaves[index]),
                    ports=tuple(by_stream[member]),
                )


def by_message(
    description: Description,
) -> Iterator[tuple[Topic, str, list[AcceleratorStream]]]:
    """Yield topic and name of each message of an accelerator, with its streams."""
    streams = accelerator_streams(description)
    for (topic, message), group in groupby(streams, key=lambda each: (each.topic, each.message)):
        yield topic, message, list(group)


def described(leaf: Leaf) -> str:
    """Say what a field carries, for people."""
    if leaf.kind == "items":
        return f"items of {leaf.type}, {leaf.lanes} in a transfer"
    return (
        "an event"
        if leaf.kind == "trigger"
        else f"{leaf.kind}, {leaf.type}".removeprefix("scalar, ")
    )


def members_text(description: Description) -> str:
    """List the streams of an accelerator as a table of text, with a heading for each message."""
    width = max(len(stream.member) for stream in accelerator_streams(description))
    lines = []
    for topic, message, streams in by_message(description):
        verb = "take" if streams[0].direction == "in" else "offer"
        lines += ["", f"{topic.name}, {message}: {verb}"]
        lines += [f"  {stream.member:<{width}}  {stream.type}" for stream in streams]
    return "\n".join(lines[1:])
