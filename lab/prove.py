"""``python -m lab.prove``: proofs for types whose converters together have every feature.

Embedded types are chosen by the features of their definitions and plans. Definitions of our own
have features that no embedded type has. A few popular types are added. ``firm-hdl prove`` is the
command for chosen types.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from firm_hdl.arguments import add_bus_bytes, add_jobs
from firm_hdl.covering.choose import choose, cost, features
from firm_hdl.equivalence.command import ProofTask, add_timeout, both_directions, run_proofs
from firm_hdl.export.build import plan_of
from firm_hdl.frontend import Library
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES
from firm_hdl.terminal import printable_streams, progress

__all__ = ["covering_tasks", "main", "write_definitions"]

DISTROS = ("noetic", "lyrical")
"""One distribution for each wire format."""

_POPULAR = {
    "noetic": ("geometry_msgs/Twist", "nav_msgs/Odometry", "sensor_msgs/PointCloud2"),
    "lyrical": (
        "geometry_msgs/msg/Twist",
        "nav_msgs/msg/Odometry",
        "sensor_msgs/msg/Image",
        "sensor_msgs/msg/Imu",
        "sensor_msgs/msg/JointState",
        "sensor_msgs/msg/LaserScan",
        "sensor_msgs/msg/PointCloud2",
        "tf2_msgs/msg/TFMessage",
    ),
}
_PACKAGE = "proved_msgs"
_COMMON = {
    "Nothing": "",
    "Inner": "string label\nuint16[] values\n",
    "Nested": "Inner[] inners\nuint8 end\n",
    "Deep": "Nested[] all\nNothing nothing\nfloat64 end\n",
    "Arrays": "string[3] names\nInner[2] inners\nbool[3] flags\nuint8[13] key\nint16[5] rest\n",
    "Fixed": "Inner[2] inners\nfloat32[4] corners\nNothing[3] nothing\nuint64 end\n",
    "Nothings": "Nothing[] nothing\nint8[] small\nint64[] large\n",
}
_DEFINITIONS: Mapping[str, Mapping[str, str]] = {
    "noetic": {**_COMMON, "Times": "time[] stamps\nduration[2] spans\nchar c\nbyte b\n"},
    "lyrical": {
        **_COMMON,
        "Wide": "wstring name\nwstring[] names\nuint8 end\n",
        "WideFixed": "wstring<=5 name\nwstring[2] names\nfloat64 end\n",
        "Bounded": "string<=10 name\nfloat32[<=5] few\nstring<=4[<=3] tags\nInner[<=2] inners\n",
    },
}


def write_definitions(folder: Path) -> None:
    """Write our own definitions to a folder for each distribution."""
    for distro, definitions in _DEFINITIONS.items():
        messages = folder / distro / _PACKAGE / "msg"
        messages.mkdir(parents=True)
        for name, text in definitions.items():
            (messages / f"{name}.msg").write_text(text, encoding="utf-8")


def covering_tasks(folder: Path, *, bus_bytes: int = 8, timeout: float) -> list[ProofTask]:
    """List both converters of all types.

    Parameters
    ----------
    folder : Path
        Folder of `write_definitions`.
    """
    tasks: list[ProofTask] = []
    for distro in DISTROS:
        own = str(folder / distro)
        names = [*_chosen(distro, bus_bytes), *_POPULAR[distro]]
        for name in dict.fromkeys(names):
            tasks += both_directions(name, distro=distro, bus_bytes=bus_bytes, timeout=timeout)
        for name in Library(distro, [own], origins=()).names():
            tasks += both_directions(
                name, distro=distro, paths=(own,), bus_bytes=bus_bytes, timeout=timeout
            )
    return tasks


def _chosen(distro: str, bus_bytes: int) -> list[str]:
    """Choose types of a distribution that together have every feature of all its types."""
    library = Library(distro)
    types, costs = {}, {}
    for name in library.names():
        message = library.message(name)
        plan = plan_of(message, None, bus_bytes, DEFAULT_MAX_MESSAGE_BYTES)
        types[name] = features(message, plan)
        costs[name] = cost(plan)
    return [chosen.name for chosen in choose(types, costs)]


@printable_streams()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the proofs; return 0 if all succeed."""
    parser = argparse.ArgumentParser(prog="python -m lab.prove", description=__doc__)
    add_bus_bytes(parser)
    add_jobs(parser)
    add_timeout(parser)
    given = parser.parse_args(arguments)
    with progress("prove"), tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
        write_definitions(Path(folder))
        timeout = float(given.timeout)
        tasks = covering_tasks(Path(folder), bus_bytes=given.bus_bytes, timeout=timeout)
        return run_proofs(tasks, given.jobs, with_summary=True)


if __name__ == "__main__":
    sys.exit(main())
