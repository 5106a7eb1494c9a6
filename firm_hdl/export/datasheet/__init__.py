"""The datasheet of the converters of a type: one page of HTML that loads nothing.

The page has what the manifest has, pictures, and instances to be copied. It shows the text of the
definition, which anyone may have written: everything is escaped.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import firm_hdl
from firm_hdl.drawing.document import pages
from firm_hdl.export.backend import Converters, Output
from firm_hdl.export.datasheet.layout import layout_figure
from firm_hdl.export.datasheet.rows import clipped
from firm_hdl.export.datasheet.steps import plan_figure
from firm_hdl.export.datasheet.waves import waves_of
from firm_hdl.export.facts import contract, definitions_of, lengths, port_groups, statuses
from firm_hdl.export.top import DIRECTIONS, Direction
from firm_hdl.gateware.members import member_tree
from firm_hdl.identity import md5sum, type_hash
from firm_hdl.metrics import metrics_of
from firm_hdl.model import Message
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES, Plan, to_yaml
from firm_hdl.wire import lay_out

__all__ = [
    "DATASHEET",
    "how_text",
    "render",
    "size_text",
    "sums_of",
    "write",
]

DATASHEET = "datasheet.html"

_FOLDER = Path(__file__).parent

_MOST_CHARACTERS = 300
"""Characters of a comment beside its ports; the definition has all."""


def write(
    converters: Converters,
    manifest: Mapping[str, Any],
    instances: Mapping[str, Mapping[Direction, str]],
) -> Output:
    """Write the datasheet.

    * `manifest`: the sections of the manifest.
    * `instances`: instances of the converters by the name of the language.
    """
    message, plan, inputs = converters.message, converters.plan, converters.inputs
    metrics = metrics_of(message, plan.wire)
    timing = manifest["timing"]
    layout = lay_out(message, plan.wire)
    distro = inputs["distro"]
    page = render(
        "converter.html.j2",
        message=message.name,
        lead=f"Deserializer and serializer: {distro}, wire format {plan.wire}, "
        f"{8 * plan.bus_bytes}-bit bus, {converters.name}",
        tiles=[
            (size_text(metrics.min_bytes, metrics.max_bytes), "bytes per packet"),
            (len(plan.leaves), "streams of the message"),
            (timing["shortest_packet"]["cycles"], "cycles, shortest packet"),
            (
                _clock(timing["hardest_packet_tried"]["clock_mhz"]["1 Gbit/s"]),
                "for 1 Gbit/s, hardest packet tried",
            ),
            *(
                (f"{each['lut']:,} LUT", f"{way}, {how_text(each).partition(':')[0]}")
                for way, each in manifest["estimates"].items()
            ),
        ],
        made_by=f"firm-hdl {firm_hdl.__version__}",
        wire=plan.wire,
        bus_bytes=plan.bus_bytes,
        options=_options(converters),
        has_texts=any(length.nul for length in plan.lengths.values()),
        max_message_bytes=plan.max_message_bytes,
        types=definitions_of([message]),
        sums=[*sums_of(message), ("SHA-256 of the definitions", inputs["definition_sha256"])],
        layout_figure=layout_figure(layout),
        port_groups=list(_port_groups(manifest)),
        instances={
            **instances,
            "Amaranth": {way: _amaranth(message, plan, way, distro) for way in DIRECTIONS},
        },
        plan_figure=plan_figure(plan),
        plan_text=to_yaml(plan),
        waves=waves_of(message, plan),
        costs=list(_costs(plan, timing)),
        latencies=list(_latencies(timing)),
        areas=[
            (
                way,
                each["part"],
                f"{each['lut']:,}",
                f"{each['ff']:,}",
                f"{each['mhz']:.0f}",
                how_text(each),
            )
            for way, each in manifest["estimates"].items()
        ],
        statuses=list(statuses(plan, manifest["status"])),
        contract=list(contract(plan, timing["recovery"])),
        lengths=list(lengths(plan)),
        commands=list(_commands(converters)),
    )
    return Output(files={DATASHEET: page})


def render(template: str, *folders: Path, **values: Any) -> str:
    """Fill a template of this package, or of a folder."""
    found = pages(*folders, _FOLDER)
    found.globals["own_style"] = _FOLDER.joinpath("sheet.css").read_text(encoding="utf-8")
    return found.get_template(template).render(values).strip() + "\n"


def sums_of(message: Message) -> Iterator[tuple[str, str]]:
    """Yield how ROS identifies a type."""
    if message.dialect == "ros1":
        yield "md5 sum", md5sum(message)
    else:
        yield "Type hash", type_hash(message)


def size_text(least: int | None, most: int | None) -> str:
    """Return the size of packets."""
    if least is None or most == least:
        return "?" if least is None else f"{least:,}"
    return f"from {least:,}" if most is None else f"{least:,} to {most:,}"


def how_text(estimate: Mapping[str, Any]) -> str:
    """Return how the figures of an estimate are known."""
    return "measured" if estimate["is_same"] else f"estimated: {estimate['type']}"


def _port_groups(manifest: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    comments = {leaf["path"]: leaf.get("comment", "") for leaf in manifest["leaves"]}
    for name, ports in port_groups(manifest):
        comment = clipped(comments.get(name, ""), _MOST_CHARACTERS)
        yield {"meaning": ports[0]["meaning"], "comment": comment, "ports": ports}


def _amaranth(message: Message, plan: Plan, way: Direction, distro: str) -> str:
    """Write an instance in Amaranth."""
    component = way.capitalize()
    options = f'wire="{plan.wire}", bus_bytes={plan.bus_bytes}'
    if plan.max_message_bytes != DEFAULT_MAX_MESSAGE_BYTES:
        options += f", max_message_bytes={plan.max_message_bytes}"
    short, port = ("rx", "ready") if way == "deserializer" else ("tx", "valid")
    value = int(way == "deserializer")
    tree = member_tree(leaf.path for leaf in plan.leaves)
    lines = [
        "from amaranth.hdl import Module",
        f"from firm_hdl import {component}, load_message",
        "",
        f'message = load_message("{message.name}", distro="{distro}")',
        "m = Module()",
        f"m.submodules.{way} = {short} = {component}(message, {options})",
        f"m.d.comb += {short}.status.ready.eq(1)",
        *(
            f"m.d.comb += {short}.message.{'.'.join(path)}.{port}.eq({value})"
            f"  # {plan.leaves[index].type}"
            for index, path in tree.leaves()
        ),
    ]
    return "\n".join(lines) + "\n"


def _costs(plan: Plan, timing: Mapping[str, Any]) -> Iterator[tuple[str, ...]]:
    short, hard = timing["shortest_packet"], timing["hardest_packet_tried"]
    is_fixed = not plan.lengths
    yield _cost("every packet" if is_fixed else "shortest", short)
    if any(run.counted for run in plan.run_of.values()):
        word = {"bytes": plan.bus_bytes, "beats": 1, "cycles": 1}
        clocks = timing["long_arrays_clock_mhz"]
        yield _cost("a bus word of a long string or array", {**word, "clock_mhz": clocks})
    if not is_fixed:
        yield _cost("hardest of those that were tried", hard)


def _cost(name: str, cost: Mapping[str, Any]) -> tuple[str, ...]:
    clocks = map(_clock, cost["clock_mhz"].values())
    return (name, *(f"{cost[key]:,}" for key in ("bytes", "beats", "cycles")), *clocks)


def _clock(mhz: float) -> str:
    return f"{mhz:.1f} MHz"


def _latencies(timing: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    latency, recovery = timing["latency_cycles"], timing["recovery"]
    yield (
        "Deserializer: from the last beat of a step to valid of its fields",
        latency["deserializer"],
    )
    yield (
        "Serializer: from the last field of a step to valid of the beat that it fills",
        latency["serializer"],
    )
    yield "Ready again after a damaged packet, at most", f"{recovery['most_cycles']:,}"
    yield "Longest legal packet", f"{recovery['longest_packet_cycles']:,}"


def _options(converters: Converters) -> str:
    """Return the arguments by which other commands find the same converters."""
    plan = converters.plan
    options = f"{plan.message} --distro {converters.inputs['distro']} --bus-bytes {plan.bus_bytes}"
    is_usual = plan.wire == lay_out(converters.message).rules.wire
    return options if is_usual else f"{options} --wire {plan.wire}"


def _commands(converters: Converters) -> Iterator[str]:
    options = _options(converters)
    yield f"firm-hdl verify {options}    # against ROS's own libraries"
    yield f"firm-hdl verify {options} --simulator ghdl    # the VHDL; also iverilog and verilator"
    yield f"firm-hdl prove {options}    # the VHDL is Amaranth's circuit"
    if converters.stimuli:
        yield "vhdl/run_ghdl.sh    # the test bench of this folder"
