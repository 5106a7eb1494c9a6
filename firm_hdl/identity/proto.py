"""An example of a message as ROS's own tools print it, to be filled in by the user.

The tool is ``ros2 interface proto`` in ROS 2 and ``rosmsg-proto`` in ROS 1. For a service, both
print the request. For an action, the goal is printed, as ROS 2 does.
"""

from __future__ import annotations

from firm_hdl.identity.proto_ros1 import ros1_proto
from firm_hdl.identity.proto_ros2 import ros2_proto
from firm_hdl.model import Action, Interface, Message, Service

__all__ = ["proto"]


def proto(interface: Interface, *, quotes: bool = True) -> str:
    """Print an example of a type.

    * `quotes`: whether double quotes enclose the text, which is the default of both tools.

    Returns the text without the last line end.

    Raises `DefinitionError` if the text would be too long.
    """
    match interface:
        case Message():
            message = interface
        case Service():
            message = interface.request
        case Action():
            message = interface.goal
    text = ros1_proto(message) if message.dialect == "ros1" else ros2_proto(message)
    return f'"{text}"' if quotes else text
