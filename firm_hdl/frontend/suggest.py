"""Messages about names that are not defined, with suggestions of similar names."""

from __future__ import annotations

import os
from collections.abc import Sequence
from difflib import get_close_matches

from firm_hdl.frontend.explain import alternatives, clip
from firm_hdl.frontend.names import KINDS, Kind, TypeName
from firm_hdl.frontend.sources import PackagePlace, Sources

__all__ = ["did_you_mean", "similar_types", "unknown_type"]

# Packages with interfaces that, for at least one distribution, are in ROS's variants desktop or
# perception but not in rosbags; see docs/reference/limits.md.
_NOT_EMBEDDED = frozenset(
    "action_tutorials_interfaces actionlib_msgs actionlib_tutorials bond composition_interfaces "
    "control_msgs controller_manager_msgs dynamic_reconfigure example_interfaces gazebo_msgs "
    "laser_assembler logging_demo map_msgs move_base_msgs nodelet pcl_msgs pendulum_msgs "
    "polled_camera rosbag2_interfaces roscpp_tutorials rospy_tutorials service_msgs smach_msgs "
    "std_srvs tf tf2_msgs theora_image_transport topic_tools turtle_actionlib turtlesim "
    "turtlesim_msgs type_description_interfaces unique_identifier_msgs".split()
)


def unknown_type(sources: Sources, names: Sequence[TypeName]) -> str:
    """Give the message for a type that is not defined.

    * `names`: all types that the user may mean, with one package and one name.
    """
    package, name = names[0].package, names[0].name
    place = sources.place(package)
    if place is not None and place.wrong:
        return place.wrong
    if place is not None or package in sources.types:
        message = f"type '{clip(name)}' is not defined in package '{clip(package)}'"
        hidden = sources.hidden_place(names)
        if place is not None and hidden is not None:
            message += (
                f", which is taken from '{place.where}' and hides that of '{hidden.where}', where "
                "the type is; as in ROS, a package comes from one place as a whole"
            )
    else:
        message, place = f"package '{clip(package)}' is not found", None
    if sources.has_implied:
        if sources.implied_distro:
            lacking = f"; the recording and {sources.implied_distro} lack it"
            return f"{message}{lacking}: name a folder that has it with --depends"
        return (
            f"{message}; the recording lacks it: name a folder that has it with --depends, or a "
            "distribution with --distro"
        )
    if package not in sources.types and package in _NOT_EMBEDDED:
        message += (
            "; this ROS package does not come with firm-hdl: name a folder that has it with "
            "--path (in a node: 'paths'), or source the setup file of an installation that does"
        )
    return message + _unread(sources, place)


def _unread(sources: Sources, place: PackagePlace | None) -> str:
    """Name a folder that could not be read, of a package or anywhere, that may have the type."""
    inside = "" if place is None else os.path.join(place.where, "")
    found = [path for path in sources.unreadable if path.startswith(inside)]
    return f"; '{found[0]}' cannot be read, and may have it" if found else ""


def similar_types(
    sources: Sources, package: str, name: str, *, kinds: tuple[Kind, ...] = KINDS
) -> list[tuple[str, Kind, str]]:
    """List package, kind and name of the types that the user may mean, the likeliest first.

    The order is: the same name but for case and underscores; the same name in a package with a
    similar name, then in any other package; then a similar name in the package, if it exists.
    Nothing is similar to a type of a known package that is not there.
    """
    if package not in sources.types and package in _NOT_EMBEDDED:
        return []
    found = [
        (other, kind, base)
        for other, types in sources.types.items()
        for kind, base in types
        if kind in kinds and (other, base) != (package, name)
        if _plain(base) == _plain(name) and _plain(other) == _plain(package)
    ]
    for kind in kinds:
        packages = sources.packages_of.get((kind, name), [])
        close = get_close_matches(package, packages)
        found += [(other, kind, name) for other in [*close, *packages]]
    if not found:
        found = [
            (other, kind, base)
            for other, types in sources.types.items()
            for kind, base in types
            if kind in kinds and _plain(base) == _plain(name)
        ]
    found += _close_names(sources, package, name, kinds)
    if package not in sources.types and not found:
        for other in get_close_matches(package, sources.types):
            found += _close_names(sources, other, name, kinds)
    return list(dict.fromkeys(found))


def _plain(name: str) -> str:
    """Write a name such that mistakes of case do not count, as in ``point_cloud2``."""
    return name.replace("_", "").casefold()


def _close_names(
    sources: Sources, package: str, name: str, kinds: tuple[Kind, ...]
) -> list[tuple[str, Kind, str]]:
    types = sources.types.get(package, [])
    close = get_close_matches(name, [base for kind, base in types if kind in kinds])
    return [(package, k, base) for base in close for k, b in types if b == base and k in kinds]


def did_you_mean(message: str, names: list[str]) -> str:
    """Add at most three suggestions to a message."""
    quoted = [f"'{name}'" for name in names[:3]]
    return f"{message}; did you mean {alternatives(quoted)}?" if quoted else message
