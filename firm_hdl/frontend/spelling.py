"""The ways in which people write the name of a type, and files of definitions in place of names."""

from __future__ import annotations

import os
import re
from difflib import get_close_matches
from pathlib import Path
from typing import NoReturn

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend.names import KINDS
from firm_hdl.frontend.scan import package_name

__all__ = ["SUFFIXES", "package_of_file", "spelled"]

SUFFIXES = tuple(f".{kind}" for kind in (*KINDS, "idl"))
"""How the names of files of definitions end."""

_PARTS = ("Request", "Response", "Event", "Goal", "Result", "Feedback")
_HEADER = re.compile(r"(?<=\w)\.(h|hpp)$")

# A structure of C.
_OF_C = re.compile(r"(\w+?)__(msg|srv|action)__(\w+)")


def spelled(name: str) -> str:
    """Write the name of a type with slashes; a text that is no name stays as it is.

    >>> spelled("sensor_msgs.msg.Imu"), spelled("sensor_msgs::msg::Imu")
    ('sensor_msgs/msg/Imu', 'sensor_msgs/msg/Imu')

    Also taken are the name of a file, ``sensor_msgs/msg/Imu.msg``; of a class in Python,
    ``sensor_msgs.msg._imu.Imu``; of a part of a service, ``std_srvs::srv::Empty::Request``; of a
    header, ``sensor_msgs/Imu.h``; of a type in DDS, ``sensor_msgs::msg::dds_::Imu_``; and of a
    structure in C, ``sensor_msgs__msg__Imu``. The kind may be missing, as in ROS 1.
    """
    text = name.strip()
    if found := _OF_C.fullmatch(text):
        return "/".join(found.groups())
    parts = re.split(r"::|[./]", _HEADER.sub("", text))
    match parts:
        case [_, "msg" | "srv" | "action", _, suffix] if f".{suffix}" in SUFFIXES:
            parts = parts[:3]
        case [package, "msg" | "srv" | "action" as kind, module, base] if module.startswith("_"):
            parts = [package, kind, base]
        case [package, kind, "dds_", base] if base.endswith("_"):
            parts = [package, kind, base.removesuffix("_")]
        case [package, "srv" | "action" as kind, base, part] if part in _PARTS:
            parts = [package, kind, f"{base}_{part}"]
    is_name = len(parts) in (2, 3) and all(parts) and parts[-1] not in KINDS
    return "/".join(parts) if is_name else name


def package_of_file(path: str) -> tuple[str, str]:
    """Find the package of a file of a definition.

    The package is the nearest folder above with a ``package.xml``, else the folder that has the
    file's folder ``msg``, ``srv`` or ``action``.

    Returns: the folder of the package, and the name of the type with its package and kind.

    Raises `DefinitionError` if there is no such file, or the folders above it are not those of a
    package.
    """
    if not os.path.isfile(path):
        _refuse_missing(path)
    file = Path(os.path.abspath(path))
    owners = [folder for folder in file.parents if (folder / "package.xml").is_file()][:1]
    owners += [folder.parent for folder in file.parents if folder.name in KINDS][:1]
    for folder in owners:
        kind = file.relative_to(folder).parts[0]
        if kind in KINDS:
            break
    else:
        raise DefinitionError.of(
            f"'{path}' is in no package of ROS: its folder has to be 'msg', 'srv' or 'action' in "
            "the folder of the package"
        )
    if file.suffix not in (f".{kind}", ".idl"):
        raise DefinitionError.of(
            f"'{path}' is in a folder '{kind}', whose files end in .{kind} or .idl"
        )
    package, wrong = package_name(str(folder), (folder / "package.xml").is_file())
    if wrong:
        raise DefinitionError.of(wrong)
    place = str(folder) if os.path.isabs(path) else os.path.relpath(folder)
    return place, f"{package}/{kind}/{file.stem}"


def _refuse_missing(path: str) -> NoReturn:
    folder = os.path.dirname(path)
    if not os.path.isdir(folder or "."):
        raise DefinitionError.of(f"there is no file '{path}', and no folder '{folder}'")
    names = {each.casefold(): each for each in os.listdir(folder or ".")}
    near = get_close_matches(os.path.basename(path).casefold(), names, n=1)
    hint = f"; did you mean '{os.path.join(folder, names[near[0]])}'?" if near else ""
    raise DefinitionError.of(f"there is no file '{path}'{hint}")
