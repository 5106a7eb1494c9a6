"""An example of a message as ROS's own tools print it, for people to fill in.

That of ROS 2 is ``ros2 interface proto``, that of ROS 1 is ``rosmsg-proto``. Either shows a service
by its request, and we show an action by its goal, as ROS 2 does.
"""

from __future__ import annotations

from firm_hdl.identity.proto_errors import TooLargeError
from firm_hdl.identity.proto_ros1 import ros1_proto
from firm_hdl.identity.proto_ros2 import ros2_proto
from firm_hdl.model import Action, Interface, Message, Service

__all__ = ["TooLargeError", "proto"]


def proto(interface: Interface, *, quotes: bool = True) -> str:
    """Print an example of a type.

    Parameters
    ----------
    interface : Message, Service or Action
    quotes : bool
        Whether double quotes enclose the text, as both tools have it unless told otherwise.

    Returns
    -------
    str
        The text without the last line end, which is that of whoever prints it.

    Raises
    ------
    TooLargeError
        If the text would be too long for anybody.
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
