"""The datasheet of a node: one page of HTML that loads nothing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import firm_hdl
from firm_hdl.drawing.svg import Figure
from firm_hdl.estimates import placed_cells
from firm_hdl.export.component import ComponentPort
from firm_hdl.export.datasheet import how_text, render, size_text, sums_of
from firm_hdl.export.datasheet.layout import layout_figure
from firm_hdl.export.datasheet.rows import CHARACTER_WIDTH, clipped
from firm_hdl.export.datasheet.steps import plan_figure
from firm_hdl.export.datasheet.waves import waves_of
from firm_hdl.export.facts import definitions_of
from firm_hdl.export.vhdl.wrapper import instance, plain_lines
from firm_hdl.node.description import Description, Store
from firm_hdl.node.frame import HEADER
from firm_hdl.node.summary import (
    area_of,
    clock_needed,
    facts_of,
    kind_of,
    memory_bytes,
    parts_of,
    warnings_of,
)
from firm_hdl.wire import lay_out

__all__ = ["node_datasheet"]


def node_datasheet(
    description: Description,
    name: str,
    ports: Sequence[ComponentPort],
    *,
    module: str,
    vhdl_ports: Mapping[str, str],
    placed: Mapping[str, Mapping[str, Any]],
) -> str:
    """Write the datasheet of a node.

    * `name`, `module`: the outermost entity and module.
    * `vhdl_ports`: names of ports in VHDL, where they differ.
    * `placed`: what the manifests of bitstreams say of them, by the name of the board.
    """
    facts = facts_of(description)
    stores = list(_stores(facts))
    area = area_of(facts)
    how = f"estimated{area['without']}"
    rows = [_placed(board, found) for board, found in sorted(placed.items())]
    needed = clock_needed(facts)
    return render(
        "node.html.j2",
        Path(__file__).parent,
        title=f"{description.namespace.rstrip('/')}/{description.node}",
        lead=f"Node of ROS {description.distro}: wire format {description.wire}, "
        f"{8 * description.bus_bytes}-bit bus, {description.clock_hz / 1e6:g} MHz, "
        f"link {description.link.kind}, fingerprint {facts['fingerprint']}",
        tiles=[
            (len(facts["topics"]), "topics and services"),
            (f"{memory_bytes(facts):,}", "bytes of packet memory"),
            (f"{area['lut']:,} LUT", how),
            (f"{area['ff']:,} FF", how),
            (f"{description.clock_hz / 1e6:g} MHz", "clock of the description"),
            (f"{area['mhz']:.4g} MHz", f"estimated, slowest part: {area['slowest']}"),
            *((row[2], f"measured, placed on {row[1]}") for row in rows),
            *((f"{row[4]} MHz", f"measured, placed on {row[1]}") for row in rows),
            *([(_clock(needed), "needed for all stated rates")] if needed else []),
        ],
        made_by=f"firm-hdl {firm_hdl.__version__}",
        wire=description.wire,
        facts=facts,
        blocks=_blocks(facts, stores),
        warnings=list(warnings_of(description, facts)),
        stores=[_row(*each) for each in stores],
        areas=[_area(name, each) for name, each in parts_of(facts)],
        total=_area("sum, clock of the slowest part", area, how),
        placed=rows,
        cells=placed_cells(area["lut"]),
        header=HEADER,
        messages=list(_messages(description)),
        ports=ports,
        instances={
            "VHDL": instance("the_node", name, plain_lines(ports, vhdl_ports), ()),
            "Verilog and SystemVerilog": _verilog(ports, module),
            "Amaranth": _AMARANTH,
        },
    )


_AMARANTH = """\
from amaranth.hdl import Module
from firm_hdl.node import Node, read_description

m = Module()
m.submodules.the_node = the_node = Node(read_description("FILE"))
"""


def _stores(facts: Mapping[str, Any]) -> Iterator[tuple[dict[str, Any], str, dict[str, Any]]]:
    """Yield each topic with each of its directions, and the packets of that direction."""
    for topic in facts["topics"]:
        for direction, store in topic["packets"].items():
            yield topic, direction, store


_ROW, _MOST_ROWS = 30, 40
_COLUMNS = {"link": (4, 110), "store": (150, 190), "converter": (380, 250), "user": (670, 230)}
"""Left edge and width of the columns of the block diagram."""


def _blocks(
    facts: Mapping[str, Any], stores: Sequence[tuple[dict[str, Any], str, dict[str, Any]]]
) -> Figure:
    """Draw the way of packets: a row for each direction of a topic, from link to accelerator."""
    shown = stores[:_MOST_ROWS]
    bottom = _ROW * (len(shown) + 1)
    figure = Figure(904, bottom + _ROW + 4, f"Block diagram of {facts['node']}")

    def block(column: str, top: float, height: float, kind: str, text: str, title: str) -> None:
        left, width = _COLUMNS[column]
        figure.box(left, top, width, height, f"bytes {kind}", title)
        most = int((width - 8) / CHARACTER_WIDTH)
        figure.text(left + width / 2, top + height / 2 + 4, clipped(text, most), "code")

    names = ("medium", "packets in memory", "converters", "accelerator or your ports")
    for name, (left, width) in zip(names, _COLUMNS.values(), strict=True):
        figure.text(left + width / 2, 16, name)
    block("link", _ROW, bottom - 4, "header", f"link {facts['link']['kind']}", "")
    for number, (topic, direction, store) in enumerate(shown):
        top, is_in = _ROW * (number + 1) + 3.0, direction == "in"
        what = f"{'gate' if is_in else 'FIFO'}, {store['memory_bytes']:,} bytes"
        title = f"{what}, {store['when_full']} when full"
        block("store", top, _ROW - 6, "data", what, title)
        converter = f"{'de' if is_in else ''}serializer"
        text = f"{converter} {store['message'].rpartition('/')[2]}"
        block("converter", top, _ROW - 6, "field", text, f"{converter} of {store['message']}")
        block("user", top, _ROW - 6, "loop", topic["name"], facts["accelerator"])
        for (left, width), (right, _) in pairwise(_COLUMNS.values()):
            y = top + _ROW / 2 - 3
            figure.line(left + width, y, right, y, "axis")
            tip, back = (right, right - 7) if is_in else (left + width, left + width + 7)
            figure.path([(back, y - 4), (tip, y), (back, y + 4)], "curve c6")
    more = len(stores) - len(shown)
    rest = f", and {more} more rows" if more else ""
    text = f"control: clock, {len(facts['registers'])} registers{rest}"
    left, width = _COLUMNS["store"][0], 480
    figure.box(left, bottom + 3, width, _ROW - 6, "bytes padding")
    figure.text(left + width / 2, bottom + _ROW / 2 + 4, text, "code")
    figure.line(114, bottom + _ROW / 2, left, bottom + _ROW / 2, "axis")
    return figure


def _clock(hz: float) -> str:
    units = ((1e6, "MHz"), (1e3, "kHz"))
    scale, unit = next((each for each in units if hz >= each[0]), (1, "Hz"))
    return f"{float(f'{hz / scale:.3g}'):g} {unit}"


def _row(topic: Mapping[str, Any], direction: str, store: Mapping[str, Any]) -> tuple[str, ...]:
    rate, clock = topic["rate_hz"], store["clock_hz"]
    return (
        str(topic["id"]),
        f"{topic['name']} ({kind_of(topic, direction)})",
        store["message"],
        size_text(store["min_bytes"], store["max_bytes"]),
        f"{store['max_message_bytes']:,}",
        f"{store['memory_bytes']:,}",
        store["when_full"],
        f"{store['cycles']['cycles']:,}",
        "" if rate is None else f"{rate:g} Hz",
        "" if clock is None else _clock(clock),
    )


_NAMES = {
    "core": "core: gates, FIFOs, router, arbiter, clock",
    "ethernet": "Ethernet: MAC to UDP",
}


def _area(name: str, found: Mapping[str, Any] | None, how: str = "") -> tuple[str, ...]:
    """Return a row: part, device, look-up tables, flip-flops, clock, and how that is known."""
    if found is None:
        return _NAMES.get(name, name), "", "", "", "", "not measured"
    figures = (f"{found['lut']:,}", f"{found['ff']:,}", f"{found['mhz']:.4g}")
    return _NAMES.get(name, name), found["part"], *figures, how or how_text(found)


def _placed(board: str, found: Mapping[str, Any]) -> tuple[str, ...]:
    """Return a row of a bitstream, whose figures `found` are those of its manifest."""
    used = {name: f"{n:,}" for name, (n, _) in found["cells"].items()}
    cells = "ICESTORM_LC" if "ICESTORM_LC" in used else "TRELLIS_COMB"
    clocks = found["clocks"]
    name = min(clocks, key=lambda each: clocks[each]["reached_mhz"] / clocks[each]["needed_mhz"])
    reached, needed = (clocks[name][key] for key in ("reached_mhz", "needed_mhz"))
    tools = ", ".join(f"{tool} {version}" for tool, version in found["tools"].items())
    return (
        "the whole node with its accelerator, placed",
        board,
        f"{used.get(cells, '0')} {cells}",
        used.get("TRELLIS_FF", ""),
        f"{reached:.1f}",
        f"measured: {name} needs {needed:g} ({tools})",
    )


def _messages(description: Description) -> Iterator[dict[str, Any]]:
    """Yield what a page shows of each message type."""
    stores: dict[str, dict[str, Store]] = {}
    for topic in description.topics:
        for direction, store in topic.stores:
            way = "deserializer" if direction == "in" else "serializer"
            stores.setdefault(store.message.name, {}).setdefault(way, store)
    for name, ways in stores.items():
        store = next(iter(ways.values()))
        message, plan = store.message, description.plan(store)
        yield {
            "name": name,
            "types": definitions_of([message]),
            "sums": list(sums_of(message)),
            "layout": layout_figure(lay_out(message, description.wire)),
            "plan": plan_figure(plan),
            "waves": [wave for wave in waves_of(message, plan) if wave.direction in ways],
        }


def _verilog(ports: Sequence[ComponentPort], module: str) -> str:
    wires = (
        f"wire {port.verilog_range}{port.name};\n"
        for port in ports
        if port.name not in ("aclk", "aresetn")
    )
    joined = ",\n".join(f"  .{port.name}({port.name})" for port in ports)
    return f"{''.join(wires)}\n{module} the_node (\n{joined}\n);\n"
