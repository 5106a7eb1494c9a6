"""The text of the benches of a node, in VHDL for GHDL, and in Verilog for Icarus Verilog.

Both do the same: they read the frames of a file, send them with random stalls, and compare what
comes out. Between subscriptions and publications that come out of the node, they connect messages,
with stalls on each stream. All other inputs are tied off.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from ipaddress import IPv4Address
from pathlib import Path
from typing import Any

from firm_hdl.export.component import ComponentPort
from firm_hdl.export.fusesoc import STALLS, copied, fileset, simulation
from firm_hdl.export.templates import templates, text_of
from firm_hdl.node.benches.script import FRAMES, LinkScript
from firm_hdl.node.description import Description, Topic
from firm_hdl.node.frame import HEADER_BYTES

__all__ = ["bench_core", "bench_files"]

_HELPERS = "firm_hdl_bench_pkg.vhd"

HOST_ADDRESS, HOST_PORT = 0xC0A8_0164, 50_000
"""Where the host of a bench is: 192.168.1.100:50000."""


@dataclass(frozen=True, slots=True)
class _Channel:
    """A stream that the bench connects: its ports at the subscription and at the publication."""

    valid: tuple[str, str]
    ready: tuple[str, str]
    payload: tuple[tuple[str, str], ...]


def bench_files(
    description: Description,
    name: str,
    ports: Sequence[ComponentPort],
    script: LinkScript,
    *,
    module: str,
    vhdl_ports: Mapping[str, str],
    vhdl_files: Sequence[str],
    header: str,
    more: Sequence[str] = (),
    verilog_tool: str = "iverilog",
) -> dict[str, str]:
    """Write the benches of a node, the frames, and the scripts that run them.

    * `name`: name of the entity; the benches are ``NAME_tb``.
    * `ports`: all ports of the top level.
    * `module`: name of the module in Verilog.
    * `vhdl_ports`: names of ports in VHDL, by those of the netlist.
    * `vhdl_files`: files of the node in compile order.
    * `header`: lines of a comment at the head of each file.
    * `more`: more files of Verilog.
    * `verilog_tool`: what runs the bench in Verilog.

    Returns: texts by paths in the folder of the node.
    """
    top = f"{name}_tb"
    values = _values(description, ports, script) | {
        "name": name,
        "top": top,
        "module": module,
        "vhdl_ports": vhdl_ports,
        "frames_file": FRAMES,
        "header": header.splitlines(),
        "more": more,
        "tool": verilog_tool,
        "title": {"iverilog": "Icarus Verilog", "verilator": "Verilator"}[verilog_tool],
        "standard": 2012 if any(file.endswith(".sv") for file in more) else 2005,
        "folders": list(dict.fromkeys(file.rpartition("/")[0] for file in more)),
    }
    bench = [_HELPERS, f"{top}.vhd"]
    return {
        FRAMES: "".join(f"# {line}\n" for line in header.splitlines()) + script.text,
        f"vhdl/{_HELPERS}": text_of(f"vhdl/{_HELPERS}"),
        f"vhdl/{top}.vhd": _render("bench.vhd", **values),
        "vhdl/bench_files.txt": "".join(f"{file}\n" for file in bench),
        "vhdl/run_ghdl.sh": _render("run_ghdl.sh", files=[*vhdl_files, *bench], **values),
        f"{top}.v": _render("bench.v", **values),
        f"run_{verilog_tool}.sh": _render("run_verilog.sh", **values),
    }


def _values(
    description: Description, ports: Sequence[ComponentPort], script: LinkScript
) -> dict[str, Any]:
    """Return what both languages have to know."""
    channels = [each for loop in script.loops for each in _channels(ports, loop)]
    driven = {each.ready[0] for each in channels}
    used = set()
    for each in channels:
        driven |= {goes for _, goes in (each.valid, *each.payload)}
        used |= {port for pair in (each.valid, each.ready, *each.payload) for port in pair}
    resets = {port.name for port in ports[2:] if port.name.endswith("_aresetn")}
    used |= {port.name for port in ports if port.member.startswith("link.")} - resets
    others = [
        port for port in ports[2:] if port.direction == "in" and port.name not in driven | used
    ]
    is_udp = description.link.kind == "udp"
    return {
        "udp": is_udp,
        "has_dest": description.link.kind == "stream",
        "word_bytes": description.link.data_bytes if is_udp else description.bus_bytes,
        "signals": [each for each in ports[2:] if each.name in used or each in others],
        # A stream that nobody connects is taken, and offers nothing. No reset is active.
        "ties": {
            each.name: int(each.member.endswith(".ready") or each.name in resets) for each in others
        },
        "widths": {each.name: each.width for each in ports},
        "channels": channels,
        "most_bytes": _most_bytes(description, script),
        "topics": len(description.topics),
        "ignores_topics": script.ignores_topics,
        "host": (HOST_ADDRESS, HOST_PORT),
        "link": description.link,
        "answers": int(IPv4Address(description.link.host or HOST_ADDRESS)),
        "answers_port": description.link.host_port if description.link.host else HOST_PORT,
    }


def _most_bytes(description: Description, script: LinkScript) -> int:
    """Return the size of the longest frame that fits into a memory, in bytes."""
    sizes = [each.memory_bytes for topic in description.topics for _, each in topic.stores]
    return max([script.most_bytes, *(HEADER_BYTES + each for each in sizes)])


def _channels(ports: Sequence[ComponentPort], loop: tuple[Topic, Topic]) -> list[_Channel]:
    """Return the streams of a subscription with those of its publication."""
    came, goes = (f"{topic.kind}.{topic.port}." for topic in loop)
    names = {port.member: port.name for port in ports}
    valids = [member for member in names if member.startswith(came) and member.endswith(".valid")]
    found = []
    for stream in (member.removesuffix(".valid") for member in valids):
        other = goes + stream.removeprefix(came)
        payload = [
            m.removeprefix(stream)
            for m in names
            if m.startswith(f"{stream}.") and m.removeprefix(stream) not in (".valid", ".ready")
        ]
        found.append(
            _Channel(
                (names[f"{stream}.valid"], names[f"{other}.valid"]),
                (names[f"{stream}.ready"], names[f"{other}.ready"]),
                tuple((names[stream + each], names[other + each]) for each in payload),
            )
        )
    return found


def _render(template: str, **values: Any) -> str:
    return templates(Path(__file__).parent).get_template(f"{template}.j2").render(values)


def bench_core(name: str) -> dict[str, dict[str, Any]]:
    """Return the entries of the benches, by section of the core.

    The target `sim` runs the bench in GHDL, and `sim_verilog` that in Icarus Verilog.

    * `name`: name of the node's entity.
    """
    top = f"{name}_tb"
    return {
        "filesets": {
            "bench": fileset("vhdl", ["vhdl/firm_hdl_bench_pkg.vhd", f"vhdl/{top}.vhd"]),
            "bench_verilog": fileset("verilog", [f"{top}.v"]),
            "frames": copied(FRAMES),
        },
        "targets": {
            "sim": simulation("ghdl", top, ["vhdl", "bench", "frames"], STALLS),
            "sim_verilog": simulation("icarus", top, ["verilog", "bench_verilog", "frames"]),
        },
        "parameters": STALLS,
    }
