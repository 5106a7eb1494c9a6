"""Endpoints of peers on a topic of the node that do not fit: another type, other QoS."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from firm_hdl.identity import type_hash
from firm_hdl.node.description import Description, Topic
from firm_hdl.rtps import Durability, Qos, Reliability
from firm_hdl.rtps.ros import names

__all__ = ["OwnEndpoint", "own_endpoints", "qos_of"]


@dataclass(frozen=True, slots=True)
class OwnEndpoint:
    """An endpoint of the node."""

    topic: Topic  # Its topic or service.
    writes: bool  # Whether it sends: messages, or the responses of a service.
    type_hash: str  # That of its message.

    @property
    def name(self) -> str:
        """The name of its topic on the wire."""
        if self.topic.kind != "serve":
            return names.topic(self.topic.name)
        return (names.reply_topic if self.writes else names.request_topic)(self.topic.name)

    def mismatch(
        self, node: str, writes: bool, type_name: str, hashed: str | None, qos: Qos
    ) -> str | None:
        """Say in a line why an endpoint of a peer, on this topic, does not fit; `None` if it does.

        * `node`: full name of its node; empty if that is not known.
        * `writes`: whether it sends.
        * `type_name`: name of its type, in ROS or on the wire.
        * `hashed`: its type hash, where that is known.
        * `qos`: what it offers or asks for.
        """
        type_name = names.demangled_type(type_name) or type_name
        is_alike = writes == self.writes
        does = "publishes" if writes else "subscribes to"
        if self.topic.kind == "serve":
            type_name = type_name.removesuffix("_Request").removesuffix("_Response")
            does = "serves" if is_alike else "calls"
        head = f"{self.topic.name}: {f'node {node}' if node else 'a peer'} {does}"
        if type_name != self.topic.type:
            here = f"the type here is '{self.topic.type}'"
            return f"{head} '{type_name}', and {here}; no messages pass"
        if hashed not in (None, self.type_hash):
            return (
                f"{head} another definition of '{type_name}': its type hash is {hashed}, and that "
                f"of the description is {self.type_hash}"
            )
        if is_alike:
            return None
        own = qos_of(self.topic)
        offered, asked = (own, qos) if self.writes else (qos, own)
        wrong = ", ".join(_policy(name, offered, asked) for name in asked.refused(offered))
        if not wrong:
            return None
        return f"{head} it with a QoS that does not fit, so no messages pass: {wrong}"


def own_endpoints(description: Description) -> Iterator[OwnEndpoint]:
    """Yield the endpoints of a node; a service has two."""
    for topic in description.topics:
        for direction, store in topic.stores:
            yield OwnEndpoint(topic, direction == "out", type_hash(store.message))


def qos_of(topic: Topic) -> Qos:
    """Return the policies of a topic, as participants have them."""
    qos = topic.qos
    return Qos(
        reliability=Reliability[qos.reliability.upper()],
        durability=Durability[qos.durability.upper()],
        depth=0 if qos.history == "keep_all" else qos.depth,
    )


def _policy(name: str, offered: Qos, asked: Qos) -> str:
    """Name a policy, with both values if they are words."""
    if name not in ("RELIABILITY", "DURABILITY"):
        return name.lower()
    values = [getattr(each, name.lower()).name.lower() for each in (offered, asked)]
    return f"{name.lower()} ({values[0]} is offered, and {values[1]} asked for)"
