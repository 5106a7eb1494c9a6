"""The summary of a node: its topics, ids, cycles, clocks, memory and area, as data and as text.

Nothing is elaborated. Cycles come from plans, areas from converters that were measured.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from functools import cache
from typing import Any, TypeAlias

from firm_hdl.estimates import Estimate, estimates_of, part_estimate, placed_cells
from firm_hdl.metrics import Metrics, metrics_of
from firm_hdl.node.capacity import assembly_bytes, rate_problems, size_problems
from firm_hdl.node.control import IDENTITY, registers
from firm_hdl.node.description import (
    SERVICE_PARTS,
    Description,
    Link,
    Store,
    Topic,
    Way,
)
from firm_hdl.node.frame import HEADER, HEADER_BYTES, VERSION
from firm_hdl.node.link_options import LINK_OPTIONS
from firm_hdl.node.rtps.endpoints import ports_of_link
from firm_hdl.node.rtps.templates import Job, templates_of
from firm_hdl.timing import Cost, timing

__all__ = [
    "area_of",
    "clock_needed",
    "facts_of",
    "kind_of",
    "memory_bytes",
    "parts_of",
    "summary",
    "warnings_of",
]


_Figures: TypeAlias = tuple[Metrics, Cost, Mapping[str, Estimate]]
"""Of a message: its sizes, its hardest packet, and the measured converters that are near."""


def facts_of(description: Description) -> dict[str, Any]:
    """Return what a host and a reader have to know of a node, as values of JSON.

    The key `topics` has an entry for each topic, in the order of ids. `registers` has those of
    :func:`firm_hdl.node.control.registers`.
    """
    link = description.link

    # Many topics may have one type, and planning takes its time.
    @cache
    def figures_of(store: Store) -> _Figures:
        plan = description.plan(store)
        metrics = metrics_of(store.message, description.wire)
        return metrics, timing(plan).hardest, estimates_of(plan)

    return {
        "node": description.node,
        "namespace": description.namespace,
        "distro": description.distro,
        "wire": description.wire,
        "bus_bytes": description.bus_bytes,
        "clock_hz": description.clock_hz,
        "fingerprint": f"{description.fingerprint:016x}",
        "link": {
            "kind": link.kind,
            **_link(link),
            **(ports_of_link(description)._asdict() if link.kind == "rtps" else {}),
        },
        "frame": {
            "version": VERSION,
            "header": [{"name": each.name, "bytes": each.bytes} for each in HEADER],
        },
        "accelerator": description.accelerator,
        "topics": [_topic(topic, figures_of) for topic in description.topics],
        "parts": {name: asdict(found) for name, found in _parts(description)},
        "registers": [
            {"number": each.number, "owner": each.owner, "part": each.part, "name": each.name}
            for each in registers(description)
        ],
    }


def _link(link: Link) -> dict[str, Any]:
    """Return the options of a link; those of Ethernet only if it has one."""
    options = {name: getattr(link, name) for name in LINK_OPTIONS[link.kind]}
    if not link.has_ethernet:
        for name in ("ethernet", "mac", "gateway", *(("address",) if link.kind == "udp" else ())):
            options.pop(name, None)
    return options


def _parts(description: Description) -> Iterator[tuple[str, Estimate]]:
    """Yield the estimates of what is not a converter."""
    link, bus_bytes = description.link, description.bus_bytes
    figures = {
        "memories": sum(1 for topic in description.topics for _ in topic.stores),
        "bus_bytes": bus_bytes,
        "peers": link.peers,
    }
    yield "core", part_estimate("core", **figures)
    yield "link", part_estimate(link.kind, **figures)
    if link.has_ethernet:
        yield "ethernet", part_estimate(f"ethernet {link.kind}")


def _topic(topic: Topic, figures_of: Callable[[Store], _Figures]) -> dict[str, Any]:
    qos = topic.qos
    return {
        "id": topic.id,
        "kind": topic.kind,
        "name": topic.name,
        "type": topic.type,
        "port": topic.port,
        "definition_sha256": topic.definition_hash,
        "rate_hz": topic.rate_hz,
        "qos": {
            "reliability": qos.reliability,
            "durability": qos.durability,
            "history": qos.history,
            "depth": qos.depth,
        },
        "packets": {
            direction: _store(topic, direction, store, figures_of(store))
            for direction, store in topic.stores
        },
    }


def _store(topic: Topic, direction: Way, store: Store, figures: _Figures) -> dict[str, Any]:
    """Return the figures of the packets of a topic in one direction."""
    metrics, hardest, estimates = figures
    estimate = estimates.get("deserializer" if direction == "in" else "serializer")
    rate = topic.rate_hz
    return {
        "message": store.message.name,
        "min_bytes": metrics.min_bytes,
        "max_bytes": metrics.max_bytes,
        "memory_bytes": store.memory_bytes,
        "stored_packets": store.packets,
        "when_full": store.when_full,
        "max_message_bytes": store.max_message_bytes,
        "cycles": {"bytes": hardest.bytes, "beats": hardest.beats, "cycles": hardest.cycles},
        "clock_hz": None if rate is None else rate * hardest.cycles,
        "estimate": None if estimate is None else asdict(estimate),
    }


def summary(description: Description) -> str:
    """Describe a node on a page of text, as ``firm-hdl node info`` prints it."""
    facts = facts_of(description)
    warnings = [f"warning: {line}" for line in warnings_of(description, facts)]
    lines = [*_head(description, facts), "", *_table(facts), "", *_totals(description, facts)]
    return "\n".join([*lines, *([""] if warnings else []), *warnings])


def _head(description: Description, facts: dict[str, Any]) -> Iterator[str]:
    name = f"{description.namespace.rstrip('/')}/{description.node}"
    yield (
        f"{name}: {description.distro}, {description.wire}, {8 * description.bus_bytes}-bit bus, "
        f"{description.clock_hz / 1e6:g} MHz"
    )
    link = dict(facts["link"])
    kind = link.pop("kind")
    options = ", ".join(f"{key} {_listed(value)}" for key, value in link.items() if value)
    yield f"link {kind}{': ' if options else ''}{options}"
    yield f"fingerprint {facts['fingerprint']}, {len(facts['registers']) - len(IDENTITY)} counters"
    if description.accelerator:
        yield f"accelerator {description.accelerator}"


def _listed(value: Any) -> str:
    return " ".join(map(str, value)) if isinstance(value, tuple) else str(value)


def _table(facts: dict[str, Any]) -> Iterator[str]:
    """Yield the rows of topics, a row for each direction, with aligned columns."""
    head = ["id", "kind", "name", "message", "bytes", "memory", "cycles", "rate", "clock"]
    rows = [head, *_rows(facts)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(head))]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        yield "  ".join(cells).rstrip()


def _rows(facts: dict[str, Any]) -> Iterator[list[str]]:
    for topic in facts["topics"]:
        for direction, store in topic["packets"].items():
            kind = kind_of(topic, direction)
            least, most = store["min_bytes"], store["max_bytes"]
            size = f"{least}" if least == most else f"{least}-{'' if most is None else most}"
            rate, clock = topic["rate_hz"], store["clock_hz"]
            yield [
                str(topic["id"]),
                kind,
                topic["name"],
                store["message"],
                size,
                f"{store['memory_bytes']} {store['when_full']}",
                str(store["cycles"]["cycles"]),
                "-" if rate is None else f"{rate:g} Hz",
                "-" if clock is None else f"{clock / 1e6:.3g} MHz",
            ]


def _totals(description: Description, facts: dict[str, Any]) -> Iterator[str]:
    """Yield sums: memory, area, and bytes on the link."""
    yield f"memory for packets: {memory_bytes(facts)} bytes"
    area = area_of(facts)
    parts = {"converters": area_of({**facts, "parts": {}}), **facts["parts"]}
    listed = "; ".join(f"{name} {each['lut']} LUT, {each['ff']} FF" for name, each in parts.items())
    yield (
        f"area on {area['part']}, estimated{area['without']}: {area['lut']} LUT, {area['ff']} FF"
    )
    yield f"    {listed}"
    yield (
        f"    {area['mhz']:.4g} MHz in its slowest part ({area['slowest']}); when placed, about "
        f"{placed_cells(area['lut'])} cells of look-up tables"
    )
    if needed := clock_needed(facts):
        yield f"clock for all stated rates on one link: {needed / 1e6:.3g} MHz"
    if facts["link"]["kind"] == "rtps":
        every = templates_of(description).every
        yield (
            f"a message costs {every[Job.SAMPLE].size} bytes of headers per reader, and a response "
            f"{every[Job.REPLY].size}"
        )
    else:
        yield f"a message costs {HEADER_BYTES} bytes of header"
    yield "cycles: of the packet that is hardest for its converter, of those that were tried"


def kind_of(topic: Mapping[str, Any], direction: Any) -> str:
    """Return what a topic is in a direction, such as ``subscribe`` or ``request``."""
    kind: str = topic["kind"]
    return SERVICE_PARTS[direction] if kind == "serve" else kind


def parts_of(facts: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any] | None]]:
    """Yield all parts of a node and their estimates; `None`: nothing like it was measured."""
    for topic in facts["topics"]:
        for direction, store in topic["packets"].items():
            yield f"converter of {topic['name']} ({kind_of(topic, direction)})", store["estimate"]
    yield from facts["parts"].items()
    if facts["accelerator"]:
        yield "accelerator", None


def area_of(facts: Mapping[str, Any]) -> dict[str, Any]:
    """Add up the parts: `part`, `lut`, `ff`, `mhz` of the `slowest`, and `without` what that is.

    The slowest part is one of those that have the node's clock: Ethernet has that of its PHY.
    """
    parts = list(parts_of(facts))
    known = {name: each for name, each in parts if each is not None}
    unknown = {name for name, each in parts if each is None}
    without = ", without the accelerator" if unknown == {"accelerator"} else ""
    clocked = known.keys() - {"ethernet"}
    slowest = min(sorted(clocked), key=lambda name: known[name]["mhz"], default="")
    return {
        "part": ", ".join(dict.fromkeys(each["part"] for each in known.values())),
        "lut": sum(each["lut"] for each in known.values()),
        "ff": sum(each["ff"] for each in known.values()),
        "mhz": known[slowest]["mhz"] if known else 0,
        "slowest": slowest,
        "without": without or (", without parts that were not measured" if unknown else ""),
    }


def memory_bytes(facts: Mapping[str, Any]) -> int:
    """Return the size of all memories for packets."""
    memory: int = facts["link"].get("memory_bytes", 0)
    for topic in facts["topics"]:
        packets = topic["packets"]
        memory += sum(store["memory_bytes"] for store in packets.values())
        # A service stores its requests before the gate, too.
        memory += packets["in"]["memory_bytes"] if topic["kind"] == "serve" else 0
        if facts["link"]["kind"] == "rtps":
            # Samples are kept for readers that miss them, and put together from fragments.
            memory += packets["out"]["memory_bytes"] if "out" in packets else 0
            if came := packets.get("in"):
                sizes = (came[each] for each in ("memory_bytes", "max_message_bytes", "max_bytes"))
                largest = min(each for each in sizes if each is not None)
                memory += assembly_bytes(facts["link"]["datagram_bytes"], largest)
    return memory


def clock_needed(facts: Mapping[str, Any]) -> float:
    """Return the clock in Hz that all stated rates need on one link; 0 if none is stated."""
    stores = (store for topic in facts["topics"] for store in topic["packets"].values())
    return sum(store["clock_hz"] or 0 for store in stores)


def warnings_of(description: Description, facts: dict[str, Any]) -> Iterator[str]:
    """Yield what the node cannot reach or carry: clocks, rates and sizes."""
    area, clock = area_of(facts), description.clock_hz / 1e6
    if clock > area["mhz"]:
        least = " (25 at least, with Ethernet)" if description.link.has_ethernet else ""
        yield (
            f"the clock of {clock:g} MHz is above the {area['mhz']:g} MHz that are estimated for "
            f"the slowest part ({area['slowest']}) on {area['part']}: lower clock_mhz{least}, or "
            "use a faster device"
        )
    for topic in facts["topics"]:
        for store in topic["packets"].values():
            if (needed := store["clock_hz"]) is not None and needed > description.clock_hz:
                yield (
                    f"{topic['name']}: a rate of {topic['rate_hz']:g} Hz needs a clock of "
                    f"{needed / 1e6:.3g} MHz"
                )
    yield from rate_problems(description)
    yield from size_problems(description)
