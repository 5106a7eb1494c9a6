"""The types that are fuzzed if none are named: 50, with every feature of a definition.

Most are of the covering sets of ``make cover``. Definitions of our own have what no type of a
distribution has: wide strings, bounds, sequences of empty messages, three levels of sequences.
"""

from __future__ import annotations

from pathlib import Path

from firm_hdl.frontend import Library
from firm_hdl.model import Message

__all__ = ["BUS_BYTES", "TYPES", "message_of"]

BUS_BYTES = (8, 1, 16, 4, 64)
"""The widths of the bus that are fuzzed if none are named."""

_DEFINITIONS = Path(__file__).parent / "definitions"

_ROS1 = (
    "std_msgs/Empty",
    "std_msgs/Int16",
    "std_msgs/UInt64",
    "std_msgs/String",
    "std_msgs/ByteMultiArray",
    "std_msgs/Int64MultiArray",
    "actionlib/TestRequestGoal",
    "actionlib_msgs/GoalStatusArray",
    "diagnostic_msgs/DiagnosticArray",
    "geometry_msgs/Twist",
    "nav_msgs/MapMetaData",
    "sensor_msgs/CompressedImage",
    "sensor_msgs/JointState",
    "sensor_msgs/JoyFeedbackArray",
    "sensor_msgs/MagneticField",
    "sensor_msgs/PointCloud",
    "shape_msgs/MeshTriangle",
    "shape_msgs/Plane",
    "fuzz_msgs/Deep",
    "fuzz_msgs/Times",
)
_ROS2 = (
    "std_msgs/msg/Empty",
    "std_msgs/msg/Char",
    "std_msgs/msg/Int16",
    "std_msgs/msg/String",
    "std_msgs/msg/Header",
    "std_msgs/msg/UInt16MultiArray",
    "std_msgs/msg/UInt64MultiArray",
    "diagnostic_msgs/msg/DiagnosticArray",
    "geometry_msgs/msg/PolygonStamped",
    "geometry_msgs/msg/PoseWithCovariance",
    "geometry_msgs/msg/Twist",
    "rcl_interfaces/msg/ParameterValue",
    "rmw_dds_common/msg/NodeEntitiesInfo",
    "sensor_msgs/msg/Imu",
    "sensor_msgs/msg/JointState",
    "sensor_msgs/msg/Joy",
    "sensor_msgs/msg/JoyFeedback",
    "sensor_msgs/msg/NavSatFix",
    "sensor_msgs/msg/PointCloud2",
    "service_msgs/msg/ServiceEventInfo",
    "shape_msgs/msg/MeshTriangle",
    "shape_msgs/msg/SolidPrimitive",
    "tf2_msgs/msg/TFMessage",
    "trajectory_msgs/msg/JointTrajectoryPoint",
    "type_description_interfaces/msg/FieldType",
    "fuzz_msgs/msg/Arrays",
    "fuzz_msgs/msg/Bounded",
    "fuzz_msgs/msg/Deep",
    "fuzz_msgs/msg/Nothings",
    "fuzz_msgs/msg/Wide",
)
TYPES = tuple(
    name for pair in zip(_ROS2, (*_ROS1, *[""] * 10), strict=True) for name in pair if name
)
"""Types of both wire formats in turn."""


def message_of(name: str) -> Message:
    """Load a type: of ROS 2 if its name has the part ``msg``, else of ROS 1.

    Raises
    ------
    DefinitionError
    """
    distro = "lyrical" if name.count("/") == 2 else "noetic"
    return Library(distro, [_DEFINITIONS / distro]).message(name)
