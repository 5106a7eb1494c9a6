"""Services and actions: definitions that have several messages."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from firm_hdl.model.message import Message
from firm_hdl.model.types import Dialect

__all__ = ["Action", "Interface", "Service"]


@dataclass(frozen=True, kw_only=True)
class Service:
    """A service type.

    Attributes
    ----------
    name : str
        Full name: ``std_srvs/srv/SetBool`` in ROS 2, ``std_srvs/SetBool`` in ROS 1.
    dialect : "ros1" or "ros2"
    request, response : Message
        Named ``<name>_Request`` and ``<name>_Response`` in ROS 2; in ROS 1, without underscore.
    event : Message or None
        ``<name>_Event``, which ROS 2 publishes for introspection since iron.
    comment : str
        The comment at the head of the file.
    text : str
        The definition as it was read.
    """

    name: str
    dialect: Dialect
    request: Message
    response: Message
    event: Message | None = None
    comment: str = field(default="", compare=False)
    text: str = field(default="", compare=False, repr=False)

    def __str__(self) -> str:
        return self.name

    @property
    def messages(self) -> tuple[Message, ...]:
        """All messages that the service has on a wire."""
        return (self.request, self.response, *(() if self.event is None else (self.event,)))


@dataclass(frozen=True, kw_only=True)
class Action:
    """An action type.

    Attributes
    ----------
    name : str
        Full name: ``tf2_msgs/action/LookupTransform`` in ROS 2, ``tf2_msgs/LookupTransform`` in
        ROS 1.
    dialect : "ros1" or "ros2"
    goal, result, feedback : Message
        What the definition declares.
    services : tuple of Service
        In ROS 2 ``<name>_SendGoal`` and ``<name>_GetResult``; none in ROS 1.
    wrappers : tuple of Message
        In ROS 2 ``<name>_FeedbackMessage``; in ROS 1 ``<name>ActionGoal``, ``<name>ActionResult``,
        ``<name>ActionFeedback`` and ``<name>Action``.
    comment : str
        The comment at the head of the file.
    text : str
        The definition as it was read.
    """

    name: str
    dialect: Dialect
    goal: Message
    result: Message
    feedback: Message
    services: tuple[Service, ...] = ()
    wrappers: tuple[Message, ...] = ()
    comment: str = field(default="", compare=False)
    text: str = field(default="", compare=False, repr=False)

    def __str__(self) -> str:
        return self.name

    @property
    def messages(self) -> tuple[Message, ...]:
        """All messages that the action has on a wire."""
        served = (message for service in self.services for message in service.messages)
        return (self.goal, self.result, self.feedback, *served, *self.wrappers)


Interface: TypeAlias = "Message | Service | Action"
"""What a definition file declares."""
