"""Test benches in VHDL for each message type, and a script that runs them in GHDL.

Packets from a file go through the deserializer, an accelerator that changes nothing, and the
serializer, all with random stalls. The bench compares the packets that come out byte for byte with
another file. It writes all packets and all transfers of leaves to files.
"""

from __future__ import annotations

from collections.abc import Iterable

from firm_hdl.export.templates import render
from firm_hdl.export.top import DIRECTIONS, Direction
from firm_hdl.export.vhdl.bench_views import View
from firm_hdl.export.vhdl.constants import comment

__all__ = ["RUN_SCRIPT", "STIMULI", "bench", "run_script"]

STIMULI = "stimuli.txt"
"""The file with packets, in the folder of the script."""

RUN_SCRIPT = "run_ghdl.sh"


def bench(
    top: str, view: View, *, bus_bytes: int, what: str, files: str = "", header: str = ""
) -> str:
    """Write a test bench.

    Parameters
    ----------
    top : str
        Name of the entity.
    what : str
        Description of the converters, for the last line that the bench prints.
    files : str
        Suffix of the names of the files that the bench writes.
    header : str
        Lines of a comment at the head of the file.
    """
    title = f"Test bench of the converters of {what}. Simulation only."
    return render(
        "vhdl/bench.vhd",
        head="".join([*comment(header, ""), *comment(title, "")]),
        top=top,
        view=view,
        converters=[_converter(view, direction, bus_bytes) for direction in DIRECTIONS],
        bus_bytes=bus_bytes,
        what=what,
        files=files,
    )


def _converter(view: View, direction: Direction, bus_bytes: int) -> tuple[str, str, str]:
    """Return an instance of a converter: its label, the unit, and the lines of its port map."""
    if direction == "deserializer":
        side, bench, axis = "rx", "i", "s_axis"
        beat = ["tdata", "tkeep", "tlast", "tvalid", "tready"]
    else:
        side, bench, axis = "tx", "o", "m_axis"
        beat = ["tdata", "tkeep", "tlast", "tuser", "tvalid", "tready"]
    signals = {"aclk": "aclk", "aresetn": "aresetn"}
    signals |= {f"{axis}_{name}": f"{bench}_{name}" for name in beat}
    if view.bit_keep and bus_bytes == 1:
        signals[f"{axis}_tkeep"] += "(0)"
    signals |= view.message_ports[direction]
    signals |= {f"m_axis_status_{name}": f"{side}_{name}" for name in ("tdata", "tvalid", "tready")}
    names = view.port_names.get(direction, {})
    ports = {names.get(port, port): signal for port, signal in signals.items()}
    width = max(map(len, ports))
    lines = ",\n".join(f"      {port:{width}} => {signal}" for port, signal in ports.items())
    return side, view.instances[direction], lines


def run_script(files: Iterable[str], top: str) -> str:
    """Write the script that runs the benches in GHDL.

    Parameters
    ----------
    files : iterable of str
        Names of the files in compile order, in the folder of the script.
    top : str
        Entity of the bench that runs by default.
    """
    return render(
        "vhdl/run_ghdl.sh", files=list(files), top=top, script=RUN_SCRIPT, stimuli=STIMULI
    )
