"""Pictures and figures of popular types, for ``reference/types.md``, and waveforms.

The site's build calls `write`. Nothing that it writes is kept in the repository.
"""

from __future__ import annotations

import io
from contextlib import redirect_stdout
from pathlib import Path

from firm_hdl import load_message
from firm_hdl.cli import main as firm_hdl
from firm_hdl.drawing.document import document
from firm_hdl.export.datasheet.layout import layout_figure
from firm_hdl.export.datasheet.waves import waves_of
from firm_hdl.plan import build_plan
from firm_hdl.sim import Stalls
from firm_hdl.wire import lay_out

__all__ = ["TYPES", "write"]

TYPES = {
    "lyrical": (
        "std_msgs/msg/Bool",
        "std_msgs/msg/Header",
        "std_msgs/msg/String",
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/PoseStamped",
        "nav_msgs/msg/Odometry",
        "sensor_msgs/msg/Imu",
        "sensor_msgs/msg/JointState",
        "sensor_msgs/msg/LaserScan",
        "sensor_msgs/msg/Image",
        "sensor_msgs/msg/PointCloud2",
        "tf2_msgs/msg/TFMessage",
        "diagnostic_msgs/msg/DiagnosticArray",
    ),
    "noetic": ("geometry_msgs/Twist", "sensor_msgs/Imu", "sensor_msgs/LaserScan"),
}
"""The types of the gallery, by distribution."""


def write(folder: Path) -> None:
    """Write ``gallery/``: a picture of each type, a page that shows them all, and waveforms."""
    out = folder / "gallery"
    out.mkdir(exist_ok=True)
    header = load_message("std_msgs/msg/Header")
    # The consumer takes `stamp.sec` two cycles late.
    late = {"message.stamp.sec": Stalls.bits(f"{'0' * 8}1")}
    for wave in waves_of(header, build_plan(lay_out(header)), stalls=late, columns=16):
        [(_, figure)] = wave.figures
        (out / f"{wave.direction}.svg").write_text(document(figure), encoding="utf-8")
    text = []
    for distro, names in TYPES.items():
        for name in names:
            picture = name.replace("/", "_") + ".svg"
            figure = layout_figure(lay_out(load_message(name, distro=distro)))
            (out / picture).write_text(document(figure), encoding="utf-8")
            info = _printed("info", name, "--distro", distro)
            text.append(
                f"## {name}\n\n```text\n{info}```\n\n![Bytes of {name}](gallery/{picture})\n"
            )
    (out / "types.inc").write_text("\n".join(text), encoding="utf-8")


def _printed(*arguments: str) -> str:
    with redirect_stdout(io.StringIO()) as printed:
        status = firm_hdl(arguments)
    if status:
        raise RuntimeError(f"firm-hdl {' '.join(arguments)} ended with {status}")
    return printed.getvalue()
