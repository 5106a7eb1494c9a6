"""The definitions that rosbags ships for every ROS distribution, as ``.msg`` text.

rosbags has parsed definitions only. This module writes them as text again for our own parser, so
that embedded types and the user's types are processed in the same way. Two things are lost, because
rosbags does not keep them: comments, and the difference between ``builtin_interfaces/Time`` and
``time``. rosbags does not keep default values either; this module has the few that exist.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore

from firm_hdl.errors import Source
from firm_hdl.model import EMPTY_MEMBER, Dialect

__all__ = [
    "DEFAULT_DISTRO",
    "DISTROS",
    "Distro",
    "embedded_names",
    "embedded_source",
    "replacement_of",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Distro:
    """A ROS distribution."""

    name: str
    dialect: Dialect
    store: Stores  # The rosbags type store with its types.
    # Whether services have a message for introspection, `_Event`: since iron.
    has_events: bool = False
    # Size of a `wchar` of IDL as the default middleware writes it. It is 4 with Fast CDR 1, up to
    # iron, and 2 with Fast CDR 2.
    wchar_bytes: int = 2


DISTROS: dict[str, Distro] = {
    distro.name: distro
    for distro in (
        Distro(name="noetic", dialect="ros1", store=Stores.ROS1_NOETIC),
        Distro(name="foxy", dialect="ros2", store=Stores.ROS2_FOXY, wchar_bytes=4),
        Distro(name="humble", dialect="ros2", store=Stores.ROS2_HUMBLE, wchar_bytes=4),
        Distro(name="iron", dialect="ros2", store=Stores.ROS2_IRON, has_events=True, wchar_bytes=4),
        Distro(name="jazzy", dialect="ros2", store=Stores.ROS2_JAZZY, has_events=True),
        Distro(name="kilted", dialect="ros2", store=Stores.ROS2_KILTED, has_events=True),
        Distro(name="lyrical", dialect="ros2", store=Stores.ROS2_LYRICAL, has_events=True),
    )
}
"""Every distribution whose types are embedded, oldest first."""

DEFAULT_DISTRO = "lyrical"
"""The newest one with long-term support."""

# Distributions without embedded types, oldest first, and the next one that has them.
_NEXT = dict.fromkeys("fuerte groovy hydro indigo jade kinetic lunar melodic".split(), "noetic")
_NEXT |= dict.fromkeys("ardent bouncy crystal dashing eloquent".split(), "foxy")
_NEXT |= {"galactic": "humble"}

# Fields with a default value, and the first distribution that has it. ROS 1 has none. Sources:
# - Quaternion: ros2/common_interfaces, pull request 74, of 2019; its CHANGELOG has no change since.
# - NavSatStatus: ros2/common_interfaces, pull request 220, sensor_msgs 5.3.2 of April 2024.
# - ParameterDescriptor: ros2/rcl_interfaces, pull requests 35 (read_only, 0.7.1 of 2019) and 118
#   (dynamic_typing, 1.0.2 of 2021).
# - FieldType: ros2/rcl_interfaces, pull request 146, 1.5.0 of April 2023; no change since.
# All types of jazzy and kilted were compared with ROS's packages on PyPI (common_interfaces 5.3.6
# and 5.5.1, rcl_interfaces 2.0.3 and 2.3.0). A test repeats the comparison for the packages above.
_DEFAULTS: dict[tuple[str, str, str], tuple[str, str]] = {
    ("geometry_msgs", "Quaternion", "x"): ("0", "foxy"),
    ("geometry_msgs", "Quaternion", "y"): ("0", "foxy"),
    ("geometry_msgs", "Quaternion", "z"): ("0", "foxy"),
    ("geometry_msgs", "Quaternion", "w"): ("1", "foxy"),
    ("rcl_interfaces", "ParameterDescriptor", "read_only"): ("false", "foxy"),
    ("rcl_interfaces", "ParameterDescriptor", "dynamic_typing"): ("false", "humble"),
    ("sensor_msgs", "NavSatStatus", "status"): ("-2", "jazzy"),
    ("type_description_interfaces", "FieldType", "type_id"): ("0", "iron"),
}

# rosbags gives ROS 1's two builtin types the names that they have in ROS 2.
_ROS1_BUILTINS = {
    "builtin_interfaces/msg/Time": "time",
    "builtin_interfaces/msg/Duration": "duration",
}


def replacement_of(distro: str) -> str:
    """Say which distribution to take instead of one whose types are not embedded.

    Returns: empty if `distro` is not the name of such a distribution.
    """
    name = distro.strip().lower()
    if name == "rolling":
        return (
            f"the types of rolling change any day: take '{DEFAULT_DISTRO}', the newest one here; "
            "types of a workspace come from --path, or from its setup file"
        )
    if name in _NEXT:
        return f"the types of {name} do not come with firm-hdl: take '{_NEXT[name]}', the next one"
    return ""


# (constants, fields) of a type, as rosbags types them in its private `Typesdict`.
_Definition = tuple[list[tuple[str, str, Any]], list[tuple[str, Any]]]


@cache
def _definitions(distro: str) -> dict[tuple[str, str], _Definition]:
    fielddefs: dict[str, Any] = dict(get_typestore(DISTROS[distro].store).fielddefs)
    if DISTROS[distro].dialect == "ros1":
        for name in _ROS1_BUILTINS:
            fielddefs.pop(name, None)
    split = {tuple(name.split("/msg/")): value for name, value in fielddefs.items()}
    return {(package, name): value for (package, name), value in sorted(split.items())}


def embedded_names(distro: str) -> list[tuple[str, str]]:
    """List package and name of every type of a distribution, sorted."""
    return list(_definitions(distro))


def embedded_source(distro: str, package: str, name: str) -> Source | None:
    """Write out an embedded type; `None` if the distribution does not have it."""
    definition = _definitions(distro).get((package, name))
    if definition is None:
        return None
    constants, fields = definition
    dialect = DISTROS[distro].dialect
    lines = [f"{type_} {constant}={value}" for constant, type_, value in constants]
    lines += [
        f"{_field_type(description, package, dialect)} {field}"
        f"{_default(distro, package, name, field)}"
        for field, description in fields
        if field != EMPTY_MEMBER
    ]
    return Source(
        name=f"<rosbags {distro}>/{package}/msg/{name}.msg",
        text="".join(f"{line}\n" for line in lines),
    )


def _default(distro: str, package: str, name: str, field: str) -> str:
    value, since = _DEFAULTS.get((package, name, field), ("", "noetic"))
    distros = list(DISTROS)
    has_default = DISTROS[distro].dialect == "ros2" and distros.index(distro) >= distros.index(
        since
    )
    return f" {value}" if value and has_default else ""


def _field_type(description: Any, package: str, dialect: Dialect) -> str:
    kind, detail = description
    match kind:
        case Nodetype.BASE:
            name, bound = detail
            return f"{name}<={bound}" if bound else str(name)
        case Nodetype.NAME:
            if dialect == "ros1" and detail in _ROS1_BUILTINS:
                return _ROS1_BUILTINS[detail]
            owner, name = detail.split("/msg/")
            return str(name) if owner == package and name != "Header" else f"{owner}/{name}"
        case Nodetype.ARRAY:
            element, count = detail
            return f"{_field_type(element, package, dialect)}[{count}]"
        case _:
            element, count = detail
            bound = f"<={count}" if count else ""
            return f"{_field_type(element, package, dialect)}[{bound}]"
