"""The converters whose figures are in ``lab/notes/performance.md``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from firm_hdl.bench.cycles import STATED, Stated
from firm_hdl.bench.results import Converted
from firm_hdl.bench.run import BenchTask
from firm_hdl.bench.tools import BenchError
from firm_hdl.covering.command import read_chosen
from firm_hdl.frontend import load_all, open_library
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, DIRECTIONS

__all__ = ["ALL_TYPES", "MEASURED", "SOFTWARE", "Group", "covering_group", "group_tasks"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Converters that are measured in the same way, in both directions.

    Attributes
    ----------
    title : str
    types : dict of str to tuple of str
        Names by distribution; an empty tuple means all types of the distribution.
    bus_bytes : tuple of int
    devices : tuple of str
        Empty: cycles only.
    seeds : tuple of int
    stated : Stated or None
        The messages; `None`: no cycles.
    """

    title: str
    types: dict[str, tuple[str, ...]]
    bus_bytes: tuple[int, ...] = (8,)
    devices: tuple[str, ...] = ()
    seeds: tuple[int, ...] = (1,)
    stated: Stated | None = STATED


_FEW = (
    "geometry_msgs/msg/Twist",
    "sensor_msgs/msg/Imu",
    "sensor_msgs/msg/JointState",
    "std_msgs/msg/String",
)

MEASURED = {
    "figures": Group(
        title="8-byte bus, ECP5-8",
        types={
            "lyrical": (
                *_FEW,
                "diagnostic_msgs/msg/DiagnosticArray",
                "nav_msgs/msg/Odometry",
                "sensor_msgs/msg/Image",
                "sensor_msgs/msg/LaserScan",
                "sensor_msgs/msg/PointCloud2",
                "tf2_msgs/msg/TFMessage",
            ),
            "noetic": ("sensor_msgs/Imu",),
        },
        devices=("ecp5",),
        seeds=(1, 2, 3),
    ),
    "narrow": Group(
        title="other buses, ECP5-8",
        types={"lyrical": _FEW},
        bus_bytes=(1, 2, 4),
        devices=("ecp5",),
    ),
    "devices": Group(
        title="8-byte bus, other devices",
        types={"lyrical": _FEW[:2]},
        devices=("gowin", "ice40", "xc7"),
    ),
}
"""Groups with area and clock rate, by the name of the page's part."""

ALL_TYPES = {
    f"{distro}, {bus_bytes}-byte bus": Group(
        title=f"all types of {distro}", types={distro: ()}, bus_bytes=(bus_bytes,)
    )
    for bus_bytes in (8, 64)
    for distro in ("lyrical", "noetic")
}
"""Groups with cycles only, by their names on the page."""

_IMAGE = Stated(count=2, elements=(1 << 16, 1 << 16))

SOFTWARE = (
    Group(
        title="messages of software",
        types={
            "lyrical": MEASURED["figures"].types["lyrical"],
            # rosbags has no tf2_msgs for this distribution.
            "noetic": tuple(
                name.replace("/msg/", "/")
                for name in MEASURED["figures"].types["lyrical"]
                if not name.startswith("tf2_msgs/")
            ),
        },
    ),
    Group(
        title="images of 64 KiB",
        types={"lyrical": ("sensor_msgs/msg/Image",), "noetic": ("sensor_msgs/Image",)},
        stated=_IMAGE,
    ),
)
"""Converters whose messages libraries are timed with, too."""


def covering_group(folder: Path) -> Group:
    """Return the types of covering sets, for area and clock rate only.

    Parameters
    ----------
    folder : Path
        A file that ``firm-hdl cover`` wrote for each distribution, named after the distribution.

    Raises
    ------
    BuildError
        If a file names no types.
    BenchError
        If the folder has no such file.
    """
    types = {path.stem: tuple(read_chosen(path)) for path in sorted(folder.glob("*.txt"))}
    if not types:
        raise BenchError(f"'{folder}' has no covering sets")
    return Group(
        title="covering sets", types=types, devices=("ecp5",), seeds=(1, 2, 3), stated=None
    )


def group_tasks(group: Group, **options: Any) -> Iterator[BenchTask]:
    """Yield the tasks of a group.

    Parameters
    ----------
    options
        Other attributes of :class:`BenchTask`.
    """
    for distro, types in group.types.items():
        library = open_library(distro, (), ())
        for message in load_all(library, types or library.names()):
            what = Converted(
                distro=library.distro,
                type=message.name,
                wire=message.wire,
                bus_bytes=group.bus_bytes[0],
                max_message_bytes=DEFAULT_MAX_MESSAGE_BYTES,
                direction=DIRECTIONS[0],
            )
            for bus_bytes in group.bus_bytes:
                for device in group.devices or (None,):
                    for direction in DIRECTIONS:
                        yield BenchTask(
                            converter=replace(what, bus_bytes=bus_bytes, direction=direction),
                            device=device,
                            seeds=group.seeds,
                            stated=group.stated,
                            **options,
                        )
