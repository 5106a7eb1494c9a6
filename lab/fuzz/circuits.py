"""The circuits that are fuzzed, as exported Verilog, each in a wrapper with the harness's ports.

Python and C++ agree on the ports in `harness/circuit.h`: an input of beats, and outputs that all
have the same form. All ports but the clock are whole words of 32 bits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, TypeAlias

import jinja2

from firm_hdl.export.top import Direction, Port, Top, leaf_names, ports_of
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.packets import PacketGate
from firm_hdl.gateware.packets.memory import WhenFull
from firm_hdl.model import Message
from firm_hdl.plan import Plan
from firm_hdl.verilog import convert
from lab.fuzz.table import Table

__all__ = ["CIRCUITS", "Alter", "Circuit", "CircuitName", "circuits_of", "templates", "unaltered"]

CircuitName: TypeAlias = Literal["deserializer", "loop", "gate-wait", "gate-drop"]
CIRCUITS: tuple[CircuitName, ...] = ("deserializer", "loop", "gate-wait", "gate-drop")
"""What is fuzzed. In the loop, the leaves of the deserializer go into a serializer."""

Alter: TypeAlias = Callable[[str, str], str]
"""Changes Verilog, by the name of its module and the text; for tests, which plant faults."""

templates = jinja2.Environment(
    loader=jinja2.FileSystemLoader(Path(__file__).parent),
    trim_blocks=True,
    lstrip_blocks=True,
    undefined=jinja2.StrictUndefined,
)
_COUNTERS = 9
_STORED_PACKETS = 8
_LEAST_MEMORY_BYTES = 256
_GATE_PORTS = [
    ("clk", "clk"),
    ("rst", "~control[2]"),
    ("packets_in__valid", "control[0]"),
    ("packets_in__ready", "accept[0]"),
    ("packets_out__valid", "valid[0]"),
    ("packets_out__ready", "ready[0]"),
    ("packets_out__payload", "payload"),
    ("size", "size"),
    ("status__valid", "valid[1]"),
    ("status__ready", "ready[1]"),
    ("status__payload", "status_code"),
    ("counters", "counters"),
]


def unaltered(module: str, text: str) -> str:
    """Return the Verilog as it was exported."""
    return text


@dataclass(frozen=True, slots=True, kw_only=True)
class _Output:
    """An output stream: its name, and the values of its payload with their widths."""

    name: str
    index: int
    values: tuple[tuple[str, int], ...]

    @property
    def words(self) -> int:
        return sum(_words(width) for _, width in self.values)

    @property
    def parts(self) -> list[tuple[str, int, int]]:
        """Each value with its highest and lowest bit in the payload."""
        parts, low = [], 0
        for value, width in self.values:
            parts.append((value, low + 32 * _words(width) - 1, low))
            low = parts[-1][1] + 1
        return parts


@dataclass(frozen=True, slots=True, kw_only=True)
class _Instance:
    module: str
    name: str
    ports: list[tuple[str, str]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Circuit:
    """A circuit in its wrapper.

    Attributes
    ----------
    name : CircuitName
    kind : str
        Of `CircuitKind` in `circuit.h`.
    files : dict of str to str
        Verilog, by the name of the file.
    """

    name: CircuitName
    kind: str
    outputs: tuple[_Output, ...]
    files: dict[str, str] = field(repr=False)
    counters: int = 0
    drops: bool = False
    memory_bytes: int = 0
    memory_packets: int = 0

    @property
    def module(self) -> str:
        """Name of the wrapper."""
        return f"fuzz_{self.name.replace('-', '_')}"

    @property
    def prefix(self) -> str:
        """Name of the model's class."""
        return f"V{self.module}"


def circuits_of(
    message: Message,
    table: Table,
    *,
    max_message_bytes: int,
    names: Sequence[CircuitName] = CIRCUITS,
    alter: Alter = unaltered,
) -> list[Circuit]:
    """Write the circuits of a type.

    Parameters
    ----------
    table : Table
        It has the wire format and the width of the bus.
    """
    made: list[Circuit] = []
    maker = _Maker(message, table, max_message_bytes, alter)
    for name in names:
        match name:
            case "deserializer":
                made.append(maker.deserializer())
            case "loop":
                made.append(maker.loop())
            case "gate-wait":
                made.append(maker.gate(name, "wait"))
            case "gate-drop":
                made.append(maker.gate(name, "drop"))
    return made


class _Maker:
    """Writes the circuits of one type on one bus."""

    def __init__(self, message: Message, table: Table, max_message_bytes: int, alter: Alter):
        self.message, self.table, self.alter = message, table, alter
        self.max_message_bytes = max_message_bytes
        self.bus_bytes = table.bus_bytes
        self._tops: dict[Direction, tuple[Plan, str]] = {}

    def deserializer(self) -> Circuit:
        plan, text = self._top("deserializer")
        ports = {port.name: port for port in ports_of(plan, "deserializer")}
        wires: list[tuple[str, int]] = []
        outputs = []
        connected = self._input()
        for index, base in enumerate(self._bases(plan)):
            leaf = self.table.leaves[index]
            flags = (f"leaf_{index}_last", 1) if leaf.has_last else ("32'd0", 32)
            data = (f"leaf_{index}_data", leaf.bits * leaf.lanes)
            _check_width(ports[f"{base}_data"], data[1])
            wires += [value for value in (flags, data) if value[0].startswith("leaf_")]
            outputs.append(_Output(name=".".join(leaf.path), index=index, values=(flags, data)))
            connected += _stream(base, index)
            connected.append((f"{base}_data", data[0]))
            if leaf.has_last:
                connected.append((f"{base}_last", flags[0]))
        outputs.append(_status(len(outputs), "status", "status_code", 8))
        wires.append(("status_code", 8))
        connected += [*_stream("m_axis_status", len(outputs) - 1, "t")]
        connected.append(("m_axis_status_tdata", "status_code"))
        instance = _Instance(module="deserializer", name="dut", ports=connected)
        return self._circuit(
            "deserializer", "Deserializer", outputs, wires, [instance], {"deserializer.v": text}
        )

    def loop(self) -> Circuit:
        plan, deserializer = self._top("deserializer")
        _, serializer = self._top("serializer")
        ports = ports_of(plan, "deserializer")
        # Each port of a leaf has the same name on both sides.
        inner = [
            (port.name, f"inner_{n}", port.width) for n, port in enumerate(ports) if port.member
        ]
        shared = [(name, wire) for name, wire, _ in inner]
        bus = self.bus_bytes
        wires = [(wire, width) for _, wire, width in inner]
        wires += [("out_data", 8 * bus), ("out_keep", bus), ("out_flags", 2)]
        wires += [("status_code", 8), ("written_code", 8)]
        packets = (("out_flags", 2), ("out_data", 8 * bus), ("out_keep", bus))
        outputs = [
            _Output(name="packets_out", index=0, values=packets),
            _status(1, "deserializer's status", "status_code", 8),
            _status(2, "serializer's status", "written_code", 8),
        ]
        reader = [*self._input(), *shared, *_stream("m_axis_status", 1, "t")]
        reader.append(("m_axis_status_tdata", "status_code"))
        writer = [("aclk", "clk"), ("aresetn", "control[2]"), *shared, *_stream("m_axis", 0, "t")]
        writer += [("m_axis_tdata", "out_data"), ("m_axis_tkeep", "out_keep")]
        writer += [("m_axis_tlast", "out_flags[0]"), ("m_axis_tuser", "out_flags[1]")]
        writer += [*_stream("m_axis_status", 2, "t"), ("m_axis_status_tdata", "written_code")]
        instances = [
            _Instance(module="deserializer", name="reader", ports=reader),
            _Instance(module="serializer", name="writer", ports=writer),
        ]
        files = {"deserializer.v": deserializer, "serializer.v": serializer}
        return self._circuit("loop", "Loop", outputs, wires, instances, files)

    def gate(self, name: CircuitName, policy: WhenFull) -> Circuit:
        bus = self.bus_bytes
        # Some packets are larger.
        memory = _LEAST_MEMORY_BYTES
        while memory < max(4 * bus, 2 * self.table.least_bytes):
            memory *= 2
        gate = PacketGate(
            self.message,
            wire=self.table.wire,
            bus_bytes=bus,
            memory_bytes=memory,
            packets=_STORED_PACKETS,
            when_full=policy,
            max_message_bytes=self.max_message_bytes,
        )
        module = f"gate_{policy}"
        text = convert(gate, name=module)
        # A payload has the data in its lowest bits, then the count, then `last`.
        data, last = 8 * bus, 8 * bus + bus.bit_length()
        size_bits = memory.bit_length()
        wires = [("payload", last + 1), ("size", size_bits), ("status_code", 4)]
        packets = (
            (f"payload[{last}]", 1),
            (f"payload[{data - 1}:0]", data),
            (f"payload[{last - 1}:{data}]", last - data),
            ("size", size_bits),
        )
        outputs = [
            _Output(name="packets_out", index=0, values=packets),
            _status(1, "status", "status_code", 4),
        ]
        beat = f"{{control[1], keep[{last - data - 1}:0], data[{data - 1}:0]}}"
        instance = _Instance(
            module=module, name="dut", ports=[*_GATE_PORTS, ("packets_in__payload", beat)]
        )
        files = {f"{module}.v": self.alter(module, text)}
        return self._circuit(
            name, "Gate", outputs, wires, [instance], files, memory=memory, drops=policy == "drop"
        )

    def _top(self, direction: Direction) -> tuple[Plan, str]:
        """Export a converter, once."""
        if direction not in self._tops:
            kind = Deserializer if direction == "deserializer" else Serializer
            core = kind(
                self.message,
                wire=self.table.wire,
                bus_bytes=self.bus_bytes,
                max_message_bytes=self.max_message_bytes,
            )
            text = convert(Top(core), name=direction)
            self._tops[direction] = core.plan, self.alter(direction, text)
        return self._tops[direction]

    def _bases(self, plan: Plan) -> list[str]:
        """Return the names of the leaves' ports, in the order of the table."""
        names = leaf_names(plan)
        if {leaf.path for leaf in self.table.leaves} != set(names):
            raise ValueError(f"{self.message.name} has other leaves than the table")
        return [names[leaf.path] for leaf in self.table.leaves]

    def _input(self) -> list[tuple[str, str]]:
        bus = self.bus_bytes
        return [
            ("aclk", "clk"),
            ("aresetn", "control[2]"),
            ("s_axis_tvalid", "control[0]"),
            ("s_axis_tlast", "control[1]"),
            ("s_axis_tdata", f"data[{8 * bus - 1}:0]"),
            ("s_axis_tkeep", f"keep[{bus - 1}:0]"),
            ("s_axis_tready", "accept[0]"),
        ]

    def _circuit(
        self,
        name: CircuitName,
        kind: str,
        outputs: Sequence[_Output],
        wires: list[tuple[str, int]],
        instances: list[_Instance],
        files: dict[str, str],
        *,
        memory: int = 0,
        drops: bool = False,
    ) -> Circuit:
        circuit = Circuit(
            name=name,
            kind=kind,
            outputs=tuple(outputs),
            files=files,
            counters=_COUNTERS if memory else 0,
            drops=drops,
            memory_bytes=memory,
            memory_packets=_STORED_PACKETS if memory else 0,
        )
        files[f"{circuit.module}.v"] = templates.get_template("wrapper.v.j2").render(
            name=name,
            module=circuit.module,
            data_bits=32 * _words(8 * self.bus_bytes),
            keep_bits=32 * _words(self.bus_bytes),
            ready_bits=32 * _words(len(outputs)),
            outputs=outputs,
            wires=wires,
            instances=instances,
            counters=circuit.counters,
        )
        return circuit


def _status(index: int, name: str, wire: str, width: int) -> _Output:
    return _Output(name=name, index=index, values=(("32'd0", 32), (wire, width)))


def _stream(base: str, index: int, initial: str = "") -> list[tuple[str, str]]:
    """Connect the handshake of an output."""
    return [
        (f"{base}_{initial}valid", f"valid[{index}]"),
        (f"{base}_{initial}ready", f"ready[{index}]"),
    ]


def _check_width(port: Port, width: int) -> None:
    if port.width != width:
        raise ValueError(f"{port.name} has {port.width} bits, and the table says {width}")


def _words(bits: int) -> int:
    return (bits + 31) // 32
