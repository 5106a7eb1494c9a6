"""A few types that together have every construct of plans, for slow tests."""

from __future__ import annotations

from pathlib import Path

__all__ = ["OWN", "SAMPLE", "Sample", "own_package"]

Sample = tuple[str, str, int]

# Distribution, type, width of the bus in bytes; and the reason for the type.
SAMPLE: list[Sample] = [
    # Loops over strings and over nothing, padding that depends on the packet, values in two steps.
    ("lyrical", "rcl_interfaces/msg/ParameterValue", 8),
    # Two levels of loops; on a narrow bus every value is in several steps.
    ("lyrical", "diagnostic_msgs/msg/DiagnosticArray", 4),
    # Runs of a constant length in a loop, and the bytes after a run in its own step.
    ("lyrical", "shape_msgs/msg/Mesh", 8),
    # An array whose first items are in the step of what comes before it.
    ("lyrical", "service_msgs/msg/ServiceEventInfo", 16),
    # An array of floats at the very start, on a bus that is wider than the message.
    ("noetic", "shape_msgs/Plane", 64),
    # A bound that a length may break.
    ("lyrical", "shape_msgs/msg/SolidPrimitive", 2),
    # Only the byte of an empty message.
    ("lyrical", "rcl_interfaces/msg/ParameterType", 8),
    # No bytes at all: an empty packet, and a leaf that is only a trigger.
    ("noetic", "bond/Constants", 8),
    # A trigger leaf after other leaves.
    ("noetic", "nav_msgs/GetMapActionGoal", 8),
    # No alignment: strings in loops start in any lane.
    ("noetic", "sensor_msgs/JointState", 8),
    # A bus of one byte: no lanes to shift between.
    ("noetic", "std_msgs/Header", 1),
]

# Constructs of no small type of a distribution: three levels of loops, one run after another,
# a bounded sequence of messages, bounds of all kinds, a service.
OWN = {
    "msg/Deep.msg": "Middle[] items\nuint8 end\n",
    "msg/Middle.msg": "Inner[<=2] items\nint64 end\n",
    "msg/Inner.msg": "string[] names\nbool flag\n",
    "msg/Runs.msg": "float64[3] a\nfloat64[2] b\nuint16[5] c\nuint8[3] d\nfloat32[<=3] e\n",
    "srv/Ask.srv": "string<=5 what\nstring<=3[<=2] how\n---\nbool ok\nbyte[<=9] data\n",
}


def own_package(folder: Path) -> Path:
    """Write the definitions of `OWN` to a folder, as the package ``own_msgs``."""
    package = folder / "own_msgs"
    for name, text in OWN.items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text)
    (package / "package.xml").write_text("<package><name>own_msgs</name></package>\n")
    return folder
