"""The converters of a type in simulators: in Python, and as exported text, cycle by cycle.

All runs of the Python simulation are recorded. A simulator of exported text replays them in one go,
with a reset between two runs. The first output that differs, of any port in any cycle, is reported.
Inputs and outputs come from the same recording. So what is missing in the recording of one side is
a difference, and no packet, transfer or status is lost unseen.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from firm_hdl.cases import NotJudgedError
from firm_hdl.export.build import BuildError, check_size
from firm_hdl.export.top import Top
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.jobs.processes import ToolError
from firm_hdl.model import Message
from firm_hdl.names.identifiers import identifier
from firm_hdl.plan import Plan
from firm_hdl.sim.bench import DeadlineError, RunOptions
from firm_hdl.sim.harness import Harness, RunResult
from firm_hdl.sim.stalls import Stalls
from firm_hdl.verify.simulators.programs import TextSimulator, simulator
from firm_hdl.verify.simulators.trace import Trace, read_row
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.system import Trial

__all__ = ["Circuit", "first_wrong_port", "replay_failures"]

FULL_CYCLES = 60
"""Converters are full after this many cycles in which nothing leaves them."""


class Circuit:
    """Both converters of a type in a loop, simulated in Python and replayed in another simulator.

    * `plan`: the type's plan. The converters are made for its wire, bus and limit.
    * `trial`: receives failures, numbers of packets and cycles, and times.

    Raises `NotJudgedError` if a simulator of exported text is asked for, and the converters are too
    large to export.
    """

    def __init__(self, message: Message, plan: Plan, options: CaseOptions, trial: Trial):
        self._message, self._plan, self._options, self._trial = message, plan, options, trial
        self._runs = 0
        self._other = simulator(options.simulator)
        if self._other is not None:
            check_exportable(plan)
        rx, tx = self._converters()
        self._trace = None if self._other is None else Trace((rx, tx), message.name)
        # Exported text keeps its state between runs, so the Python simulation keeps it as well.
        self._harness = Harness(
            rx,
            tx,
            message=message,
            gated=options.stalled,
            probes=() if self._trace is None else self._trace.probes,
            keeps_state=self._trace is not None,
        )
        self._waves = self._harness
        if self._trace is not None and options.vcd is not None:
            # Waveforms come from another harness, in which each run starts from initial values.
            self._waves = Harness(*self._converters(), message=message, gated=options.stalled)

    def _converters(self) -> tuple[Deserializer, Serializer]:
        wire, width, most = self._plan.wire, self._plan.bus_bytes, self._plan.max_message_bytes
        return (
            Deserializer(self._message, wire=wire, bus_bytes=width, max_message_bytes=most),
            Serializer(self._message, wire=wire, bus_bytes=width, max_message_bytes=most),
        )

    def send(self, where: str, packets: Sequence[bytes], stalls: Stalls | None) -> RunResult | None:
        """Send packets; return what came out, or `None` if the run failed.

        Parameters
        ----------
        where : str
            The name of the run in failures.
        """
        observe = self._observed(where)
        self._trial.watch.enter("simulation")
        try:
            vcd = self._waveform()
            if vcd is not None and self._waves is not self._harness:
                self._waves.run_packets(packets, RunOptions(stalls=stalls, vcd=vcd))
                vcd = None
            options = RunOptions(stalls=stalls, observe=observe, vcd=vcd)
            seen = self._harness.run_packets(packets, options)
        except AssertionError as error:
            self._trial.failures.append(f"{where}: {type(error).__name__}: {error}")
            return None
        finally:
            self._trial.watch.enter("testing")
        self._trial.record.packets += len(packets)
        self._trial.record.cycles += self._harness.bench.cycles
        return seen

    def interrupt(self, packets: Sequence[bytes]) -> None:
        """Fill the circuits and stop, so that the next run resets full ones in the replay."""
        if self._trace is None:
            return
        blocked = Stalls.bits("0" * (2 * FULL_CYCLES) + "1")
        stalls = dict.fromkeys(("packets_out", "status", "sent_status"), blocked)
        where = "hardware, nothing taken"
        observe = self._observed(where)
        try:
            options = RunOptions(stalls=stalls, limit=FULL_CYCLES, observe=observe)
            self._harness.run_packets(packets, options)
        except DeadlineError:
            # The run is meant to end like this.
            pass
        except AssertionError as error:
            self._trial.failures.append(f"{where}: {type(error).__name__}: {error}")
        self._trial.record.cycles += self._harness.bench.cycles

    def crosscheck(self) -> None:
        """Replay all runs in another simulator, if there is one, and compare."""
        if self._other is None or self._trace is None:
            return
        self._trial.watch.enter("simulation")
        self._trial.failures += replay_failures(self._other, self._trace, self._converters)
        self._trial.watch.enter("testing")

    def _observed(self, where: str) -> Callable[[list[int]], None] | None:
        """Begin a run in the trace; return what observes its cycles."""
        if self._trace is None:
            return None
        self._trace.start(where)
        return self._trace.observe

    def _waveform(self) -> str | None:
        """Return the file for the waveform of the next run, if it is to have one."""
        if self._options.vcd is None:
            return None
        self._runs += 1
        os.makedirs(self._options.vcd, exist_ok=True)
        plan = self._plan
        base = identifier(f"{self._message.name}_{plan.wire}_{plan.bus_bytes}")
        file = os.path.join(self._options.vcd, f"{base}_run{self._runs}.vcd")
        # A link is replaced, not followed: the user named the folder, not the files in it.
        with suppress(FileNotFoundError):
            os.unlink(file)
        return file


def replay_failures(
    simulator: TextSimulator, trace: Trace, make: Callable[[], Sequence[Deserializer | Serializer]]
) -> list[str]:
    """Replay all runs of a trace, and return what is wrong.

    * `make`: returns new instances of the converters of the trace, to be exported.
    """
    try:
        with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
            rows = simulator.replay(trace, [Top(core) for core in make()], Path(folder))
    except ToolError as error:
        return [f"{simulator.title}: {error}"]
    if not rows:
        return [f"{simulator.title}: no cycle was compared"]
    difference = first_wrong_port(trace, [row.rstrip() for row in rows])
    return [f"{simulator.title}: {difference}"] if difference else []


def check_exportable(plan: Plan) -> None:
    """Raise `NotJudgedError` if converters with that plan are too large to be exported."""
    try:
        check_size(plan)
    except BuildError as error:
        raise NotJudgedError(f"it cannot be exported: {error}") from None


def first_wrong_port(trace: Trace, rows: Sequence[str]) -> str | None:
    """Describe the first output that is not as recorded; `None` if all are."""
    if trace.expected == rows:
        return None
    ports = {pin.number: pin for pin in trace.outputs}
    right: dict[int, str] = {}
    shown: dict[int, str] = {}
    for index, (row, other) in enumerate(zip(trace.expected, rows, strict=False)):
        if row == other:
            changes = dict(read_row(row))
            right.update(changes)
            shown.update(changes)
            continue
        right.update(read_row(row))
        shown.update(read_row(other))
        for number, bits in right.items():
            if shown.get(number) != bits:
                pin = ports[number]
                run, cycle = trace.run_of(index)
                return (
                    f"{run}, cycle {cycle}: {pin.port.name} of the "
                    f"{trace.devices[pin.device].direction} is {_short(shown.get(number, 'U'))} "
                    f"instead of {_short(bits)}"
                )
    if len(rows) != len(trace.expected):
        return f"{len(rows)} cycles instead of {len(trace.expected)}"
    # The values are equal. One of the rows has a port that did not change.
    return None


def _short(bits: str) -> str:
    return hex(int(bits, 2)) if len(bits) > 4 and not set(bits) - {"0", "1"} else f"'{bits}'"
