"""Reconstructs packets, transfers and statuses from the ports in the rows of a trace."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial

from firm_hdl.export.top import leaf_names
from firm_hdl.gateware.signatures import Status
from firm_hdl.plan import Plan
from firm_hdl.sim.payloads import decoder_of
from firm_hdl.sim.record import RunResult
from firm_hdl.verify.results.texts import first_difference
from firm_hdl.verify.simulators.trace import Trace, read_row

__all__ = ["traffic"]


@dataclass(slots=True, kw_only=True)
class Traffic:
    """The traffic on the ports of both converters in a run.

    Attributes
    ----------
    name : str
        The name of the run.
    packets, packet_errors, statuses, sent_statuses
        As in :class:`firm_hdl.sim.record.RunResult`; statuses as bits.
    transfers : dict of int to list of str
        Bits that each leaf of the deserializer transferred, with ``last`` before the items.
    """

    name: str
    plan: Plan
    packets: list[bytes] = field(default_factory=list)
    packet_errors: list[bool] = field(default_factory=list)
    statuses: list[str] = field(default_factory=list)
    sent_statuses: list[str] = field(default_factory=list)
    transfers: dict[int, list[str]] = field(default_factory=dict)

    def difference(self, seen: RunResult) -> str | None:
        """Describe the first difference from the Python simulation."""
        for what, received, expected in (
            ("packets", self.packets, seen.packets),
            ("tuser", self.packet_errors, seen.packet_errors),
            ("statuses of the deserializer", self.statuses, _bits(seen.statuses)),
            ("statuses of the serializer", self.sent_statuses, _bits(seen.sent_statuses)),
        ):
            if received != expected:
                return f"{what} differ: {_first_difference_text(received, expected)}"
        for number, leaf in enumerate(self.plan.leaves):
            decode = decoder_of(leaf)
            wanted = seen.transfers.get(number, [])
            try:
                payloads = [decode(int(bits, 2)) for bits in self.transfers.get(number, ())]
            except ValueError:
                return f"transfers of {leaf} differ: some are undefined"
            if payloads != wanted:
                return f"transfers of {leaf} differ: {_first_difference_text(payloads, wanted)}"
        return None


def _bits(statuses: Sequence[Status]) -> list[str]:
    return [f"{status.value:08b}" for status in statuses]


def _first_difference_text(received: Sequence[object], expected: Sequence[object]) -> str:
    at = first_difference(received, expected)
    return (
        f"number {at} of {len(expected)} is {list(received[at : at + 1])} "
        f"instead of {list(expected[at : at + 1])}"
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Stream:
    """A stream by its ports: ``i3`` is an input, ``o3`` an output."""

    valid: str
    ready: str
    payload: tuple[str, ...]
    take: Callable[[Traffic, list[str]], None]


def traffic(trace: Trace, rows: Sequence[str]) -> list[Traffic]:
    """Reconstruct the traffic of each run from rows of outputs and the inputs of the trace."""
    watching: dict[str, list[_Stream]] = {}
    for stream in _streams(trace):
        watching.setdefault(stream.valid, []).append(stream)
        watching.setdefault(stream.ready, []).append(stream)
    values: dict[str, str] = {}
    # A dictionary, because streams are kept in the order in which they began to transfer.
    firing: dict[_Stream, None] = {}
    plan = trace.devices[0].plan
    found = [Traffic(name=name, plan=plan) for name, _ in trace.runs]
    for run, changes in _cycles(trace, rows):
        values.update(changes)
        for key in changes:
            for stream in watching.get(key, ()):
                if values.get(stream.valid) == "1" == values.get(stream.ready):
                    firing[stream] = None
                else:
                    firing.pop(stream, None)
        if run is not None:
            for stream in firing:
                stream.take(found[run], [values[key] for key in stream.payload])
    return found


def _cycles(trace: Trace, rows: Sequence[str]) -> Iterator[tuple[int | None, dict[str, str]]]:
    """Yield the run (`None` in a reset) and the changed ports of each cycle."""
    starts = {first: number for number, (_, first) in enumerate(trace.runs)}
    run = at = 0
    for stimulus in trace.stimuli:
        flag, _, inputs = stimulus.partition(" ")
        changes = {f"i{number}": bits for number, bits in read_row(inputs)}
        if flag == "0":
            yield None, changes
            continue
        if at == len(rows):
            return
        run = starts.get(at, run)
        changes.update((f"o{number}", bits) for number, bits in read_row(rows[at]))
        at += 1
        yield run, changes


def _streams(trace: Trace) -> Iterator[_Stream]:
    for number, device in enumerate(trace.devices):
        keys = {
            pin.port.name: f"{letter}{pin.number}"
            for letter, pins in (("i", trace.inputs), ("o", trace.outputs))
            for pin in pins
            if pin.device == number
        }
        is_receiver = device.direction == "deserializer"
        valid, ready, status = (keys[f"m_axis_status_{n}"] for n in ("tvalid", "tready", "tdata"))
        yield _Stream(valid, ready, (status,), _take_status if is_receiver else _take_sent_status)
        if not is_receiver:
            valid, ready, *payload = (keys[f"m_axis_{part}"] for part in _BEAT)
            yield _Stream(valid, ready, tuple(payload), _Beats().take)
            continue
        for leaf, (path, base) in enumerate(leaf_names(device.plan).items()):
            assert device.plan.leaves[leaf].path == path
            last = [keys[name] for name in (f"{base}_last",) if name in keys]
            bits = (*last, keys[f"{base}_data"])
            take = partial(_take_transfer, leaf)
            yield _Stream(keys[f"{base}_valid"], keys[f"{base}_ready"], bits, take)


_BEAT = ("tvalid", "tready", "tdata", "tkeep", "tlast", "tuser")


def _take_status(run: Traffic, payload: list[str]) -> None:
    run.statuses.append(payload[0])


def _take_sent_status(run: Traffic, payload: list[str]) -> None:
    run.sent_statuses.append(payload[0])


def _take_transfer(leaf: int, run: Traffic, payload: list[str]) -> None:
    run.transfers.setdefault(leaf, []).append("".join(payload))


@dataclass(slots=True)
class _Beats:
    """Joins beats to packets."""

    run: Traffic | None = None
    parts: list[bytes] = field(default_factory=list)

    def take(self, run: Traffic, payload: list[str]) -> None:
        if run is not self.run:
            # There was a reset, so the parts of an incomplete packet are dropped.
            self.run, self.parts = run, []
        data, keep, last, user = payload
        count = keep[::-1].find("0") if "0" in keep else len(keep)
        lanes = [data[at : at + 8] for at in range(len(data) - 8, -1, -8)]
        # Undefined bytes are left out. The packet is too short then, and differs.
        defined = [lane for lane in lanes[:count] if not set(lane) - {"0", "1"}]
        self.parts.append(bytes(int(lane, 2) for lane in defined))
        if last == "1":
            run.packets.append(b"".join(self.parts))
            run.packet_errors.append(user == "1")
            self.parts = []
