"""Small types with features that only large types of the distributions have.

In `make test`, `test_covering` simulates these in place of the large types.
"""

from __future__ import annotations

from pathlib import Path

__all__ = ["STAND_INS", "stand_in_package"]

FILES = {
    # Sequences of the elements that no small type has.
    "Sequences": "uint16[] a\nint16[] b\nuint32[] c\nuint64[] d\nbyte e\nint8[] f\n",
    # On the wire of ROS 1, `byte` is signed.
    "Signed": "uint16[] a\nbyte[] b\nbyte c\n",
    # Three levels of loops, and lengths that are one byte or three behind a value.
    "Deep": "uint16 a\nuint8 b\nMiddle[] middles\n",
    "Middle": "int32 a\nuint8 b\nInner[] inners\nuint8[] c\n",
    "Inner": "string[] names\nuint8 a\n",
    # An array whose alignment depends on the packet.
    "Calibration": "string model\nfloat64[4] k\n",
}
STAND_INS = {"lyrical": ("Sequences", "Deep", "Calibration"), "noetic": ("Signed",)}
"""The types of each distribution that are simulated."""


def stand_in_package(folder: Path) -> Path:
    """Write the definitions to a folder, as the package ``stand_ins``."""
    package = folder / "stand_ins"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>stand_ins</name></package>\n")
    for name, text in FILES.items():
        (package / "msg" / f"{name}.msg").write_text(text)
    return folder
