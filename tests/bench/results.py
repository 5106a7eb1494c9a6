"""Invented results of measurements."""

from __future__ import annotations

from typing import Any

from firm_hdl.bench.cycles import STATED, Cycles
from firm_hdl.bench.devices import DEVICES, Area
from firm_hdl.bench.flow import Measured, Placed
from firm_hdl.bench.netlist import CriticalPath
from firm_hdl.bench.results import Converted, Result

__all__ = ["result"]


def result(name: str = "p/msg/A", **changes: Any) -> Result:
    """Return a result of 100 LUTs, 50 FFs, 80 to 90 MHz and 0.8 beats per cycle, with changes."""
    given: dict[str, Any] = {
        "lut": 100,
        "ff": 50,
        "mhz": (80.0, 90.0, 82.5),
        "beats": 80,
        "latency": 2,
        "direction": "deserializer",
        "mapping": "synth_ecp5 -top top",
        "problem": "",
        "bus_bytes": 8,
        "distro": "lyrical",
        **changes,
    }
    points = ((0.5, "step"), (12.0, "& fill, offset"), (12.5, "run"))
    path = CriticalPath(ns=12.5, routing_ns=8.0, cells=9, points=points)
    return Result(
        converter=Converted(
            distro=given["distro"],
            type=name,
            wire="cdr",
            bus_bytes=given["bus_bytes"],
            max_message_bytes=1 << 27,
            direction=given["direction"],
        ),
        cycles=Cycles(
            messages=STATED, bytes=600, beats=given["beats"], cycles=100, latency=given["latency"]
        ),
        measured=Measured(
            device=DEVICES["ecp5"],
            area=Area(lut=given["lut"], ff=given["ff"]),
            port_registers=40,
            placed=tuple(
                Placed(seed=seed, mhz=mhz, path=path) for seed, mhz in enumerate(given["mhz"], 1)
            ),
            mapping=given["mapping"],
            placement="--45k",
            tools={"Yosys": "0.70", "nextpnr-ecp5": "0.11.1"},
        ),
        problem=given["problem"],
    )
