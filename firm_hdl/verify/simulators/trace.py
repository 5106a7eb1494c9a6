"""Traces: the values of all ports of both exported converters, in each cycle of a simulation.

The Python simulation runs the converters themselves. The trace has the values that the ports of
their exported tops (:class:`firm_hdl.export.top.Top`) would have. So any simulator of the exported
text can be given the same inputs, and must show the same outputs in the same cycles. This includes
payloads that are not valid.

Form. A trace is two lists of rows of text, one row a cycle. A row has a number and bits for each
port that changed, such as ``3 0101 7 1``. A row of inputs begins with ``1``, or with ``0`` if no
row of outputs belongs to it. Rows with ``0`` are the cycles of a reset between two runs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from amaranth.hdl import Cat, Const, Value
from amaranth.lib import data

from firm_hdl.export.top import Direction, Port, leaf_names, ports_of
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.gateware.axi_stream import keep_of_count
from firm_hdl.gateware.signatures import leaf_streams
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import Plan
from firm_hdl.sim.bench import RESET_CYCLES

__all__ = ["ARESETN", "Trace", "read_row"]

ARESETN = 0
"""The number of the reset among the inputs; both converters share it."""

CHUNK = 24
"""The number of pins in one probe. If a probe changes, each of its pins is checked."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Device:
    """A converter that is exported."""

    direction: Direction
    name: str  # Name of its outermost entity, as `firm-hdl build` names it.
    plan: Plan

    @classmethod
    def of(cls, core: Deserializer | Serializer, message: str) -> Device:
        """Describe a converter of a type."""
        direction: Direction = "deserializer" if isinstance(core, Deserializer) else "serializer"
        base = identifier(f"{message}_{core.plan.wire}_{core.plan.bus_bytes}").lower()
        return cls(direction=direction, name=f"{base}_{direction}_flat", plan=core.plan)


@dataclass(frozen=True, slots=True, kw_only=True)
class Pin:
    """A port of one of the devices."""

    device: int
    port: Port
    # The number of the port in rows. Inputs and outputs are numbered separately, over all devices.
    number: int


class Trace:
    """Recorded runs of converters.

    * `cores`: the converters that are simulated.
    * `message`: name of their type.
    """

    def __init__(self, cores: Sequence[Deserializer | Serializer], message: str):
        self.devices = [Device.of(core, message) for core in cores]
        # All ports except `aclk` and `aresetn`.
        self.inputs: list[Pin] = []
        self.outputs: list[Pin] = []
        values: dict[str, list[Value]] = {"in": [], "out": []}
        for number, core in enumerate(cores):
            device = self.devices[number]
            sources = _port_values(core)
            for port in ports_of(device.plan, device.direction)[2:]:
                pins = self.inputs if port.direction == "in" else self.outputs
                # The reset is the first input.
                at = len(pins) + (port.direction == "in")
                pins.append(Pin(device=number, port=port, number=at))
                values[port.direction].append(sources[port.name])
        self._inputs = _Changes(self.inputs, values["in"])
        self._outputs = _Changes(self.outputs, values["out"])
        # The values to observe. Each of them has several pins.
        self.probes = [*self._inputs.probes, *self._outputs.probes]
        # Rows of inputs of all cycles, and rows of outputs of all cycles but those of resets.
        self.stimuli: list[str] = []
        self.expected: list[str] = []
        # The name of each run, and the index of its first row of outputs.
        self.runs: list[tuple[str, int]] = []
        self._is_reset = False

    def start(self, name: str) -> None:
        """Begin a run, with a reset if it is not the first. The first one tests initial values."""
        if self.runs:
            self.stimuli += [f"0 {ARESETN} 0", *["0"] * (RESET_CYCLES - 1)]
        self.runs.append((name, len(self.expected)))
        self._is_reset = True

    def observe(self, values: Sequence[int]) -> None:
        """Record a cycle, given the values of the probes."""
        split = len(self._inputs.probes)
        released = [f"{ARESETN} 1"] if self._is_reset else []
        self._is_reset = False
        self.stimuli.append(" ".join(["1", *released, *self._inputs.next(values[:split])]))
        self.expected.append(" ".join(self._outputs.next(values[split:])))

    def run_of(self, row: int) -> tuple[str, int]:
        """Return the name of the run that a row of outputs belongs to, and its cycle there."""
        name, first = next(run for run in reversed(self.runs) if run[1] <= row)
        return name, row - first


class _Changes:
    """Finds the pins that have changed since the last cycle, and yields them as words of a row."""

    def __init__(self, pins: Sequence[Pin], values: Sequence[Value]):
        self.probes: list[Value] = []
        self.parts: list[list[tuple[int, int, int]]] = []
        for start in range(0, len(values), CHUNK):
            part = values[start : start + CHUNK]
            self.probes.append(Cat(*part))
            places, at = [], 0
            for pin, value in zip(pins[start : start + CHUNK], part, strict=True):
                places.append((pin.number, at, len(value)))
                at += len(value)
            self.parts.append(places)
        self.before: list[int | None] = [None] * len(self.parts)

    def next(self, values: Sequence[int]) -> Iterator[str]:
        for index, now in enumerate(values):
            before = self.before[index]
            if now == before:
                continue
            self.before[index] = now
            # Before the first cycle, everything is new.
            changed = -1 if before is None else now ^ before
            for number, at, width in self.parts[index]:
                if changed >> at & (mask := (1 << width) - 1):
                    yield f"{number} {now >> at & mask:0{width}b}"


def _port_values(core: Deserializer | Serializer) -> dict[str, Value]:
    """Return the values of the ports of a converter's top, by port name."""
    plan = core.plan
    packets, status = core.packets, core.status
    side = "s_axis" if isinstance(core, Deserializer) else "m_axis"
    values: dict[str, Value] = {
        f"{side}_tdata": Value.cast(packets.payload.data),
        f"{side}_tkeep": keep_of_count(packets.payload.count, plan.bus_bytes),
        f"{side}_tlast": packets.payload.last,
        f"{side}_tvalid": packets.valid,
        f"{side}_tready": packets.ready,
        "m_axis_status_tdata": Cat(Value.cast(status.payload), Const(0, 8))[:8],
        "m_axis_status_tvalid": status.valid,
        "m_axis_status_tready": status.ready,
    }
    if isinstance(core, Serializer):
        values["m_axis_tuser"] = core.packet_error
    names = leaf_names(plan)
    for leaf, port in leaf_streams(core.message, core.tree).items():
        base = names[plan.leaves[leaf].path]
        payload = port.payload
        if isinstance(payload, data.View):
            values[f"{base}_last"] = payload["last"]
            payload = payload["data"]
        values[f"{base}_data"] = Value.cast(payload)
        values[f"{base}_valid"], values[f"{base}_ready"] = port.valid, port.ready
    return values


def read_row(row: str) -> Iterable[tuple[int, str]]:
    """Yield the number and the bits of each change in a row, without the flag of inputs."""
    words = iter(row.split())
    return zip(map(int, words), words, strict=True)
