"""Acceptance: every case of a type through simulated converters, against the oracle.

For each case of :mod:`firm_hdl.verify.cases` the loopback of deserializer and serializer must give
the packet back byte for byte, every leaf must have transferred what the oracle says, and every
status must be ``OK``: once with nothing stalled and all packets back to back, and once with every
stream stalled. The golden model (:mod:`firm_hdl.plan.interpret`) must agree in both directions.
Then packets are broken, each between two good ones, and hardware and golden model must agree on
what is left of them.
"""

from __future__ import annotations

import random
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain

from firm_hdl.frontend import Library
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.model import Message
from firm_hdl.plan import Payload, Plan
from firm_hdl.plan.interpret import decode, encode
from firm_hdl.sim.harness import Harness
from firm_hdl.sim.record import Seen
from firm_hdl.sim.stalls import Stalls
from firm_hdl.verify.cases import Case, make_cases
from firm_hdl.verify.oracle import Oracle, Transfers, distro_oracle

__all__ = ["Options", "Result", "accept", "accept_message", "broken_packets", "stalls_for"]

MAX_MESSAGE_BYTES = 1 << 16
"""Small enough that a length over what it leaves room for can be completed in simulation."""


LARGE = 300_000
"""Beats times leaves, to which simulation time is roughly proportional, of a large type's cases."""

LARGE_STRIDE = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """How to run the cases of a type.

    Attributes
    ----------
    bus_bytes : int
    wire : "ros1", "cdr" or None
        `None`: that of the distribution.
    seed : int
    stalled, broken : bool
        Whether to run with stalls, and with broken packets, as well.
    most_cases : int or None
    """

    bus_bytes: int = 8
    wire: str | None = None
    seed: int = 0
    stalled: bool = True
    broken: bool = True
    most_cases: int | None = None

    def command(self, distro: str, name: str) -> str:
        """Return the command that runs one type again."""
        parts = ["python -m firm_hdl.verify", f"--distro {distro}", f"--bus-bytes {self.bus_bytes}"]
        parts += [f"--wire {self.wire}"] if self.wire else []
        parts += [f"--seed {self.seed}"]
        parts += [] if self.stalled else ["--no-stalls"]
        parts += [] if self.broken else ["--no-broken"]
        parts += [] if self.most_cases is None else [f"--cases {self.most_cases}"]
        return " ".join([*parts, name])


@dataclass(slots=True, kw_only=True)
class Result:
    """What became of a type.

    Attributes
    ----------
    distro, name : str
    failures : list of str
        Empty if all is well.
    cases, packets : int
        Cases of the type, and packets sent for them in all runs.
    beats, cycles : int
        Of the run without stalls.
    simulated_cycles : int
        Of all runs.
    seconds, setup_seconds : float
        In total, and until the circuit was ready to run.
    command : str
        How to run it again.
    """

    distro: str
    name: str
    failures: list[str] = field(default_factory=list)
    cases: int = 0
    packets: int = 0
    beats: int = 0
    cycles: int = 0
    simulated_cycles: int = 0
    seconds: float = 0.0
    setup_seconds: float = 0.0
    command: str = ""


def accept(distro: str, name: str, options: Options | None = None) -> Result:
    """Run all cases of an embedded type. Nothing is raised: what goes wrong is in the result.

    Parameters
    ----------
    distro : str
    name : str
        ``package/Type`` or ``package/msg/Type``.
    """
    options = options or Options()
    result = Result(distro=distro, name=name, command=options.command(distro, name))
    began = time.perf_counter()
    try:
        package, _, base = name.rpartition("/")
        full = f"{package.removesuffix('/msg')}/msg/{base}"
        accept_message(_library(distro).message(name), distro_oracle(distro), full, options, result)
    except Exception as error:  # Whatever it is, the other types are to go on.
        result.failures.append(f"{type(error).__name__}: {error}")
    result.seconds = time.perf_counter() - began
    return result


_libraries: dict[str, Library] = {}


def _library(distro: str) -> Library:
    if distro not in _libraries:
        _libraries[distro] = Library(distro)
    return _libraries[distro]


def accept_message(
    message: Message, oracle: Oracle, name: str, options: Options, result: Result
) -> None:
    """Run all cases of a message type that the oracle knows by `name`, and add to `result`."""
    began = time.perf_counter()
    wire = options.wire or message.wire
    cases = list(
        make_cases(
            oracle,
            name,
            wire=wire,
            bus_bytes=options.bus_bytes,
            seed=options.seed,
            most=options.most_cases,
        )
    )
    result.cases = len(cases)
    run = _Acceptance(message, wire, options, result)
    result.setup_seconds = time.perf_counter() - began
    run.golden(cases)
    run.good(cases, None)
    if run.is_large(cases):
        cases = cases[::LARGE_STRIDE]
    if options.stalled:
        run.good(cases, stalls_for(f"{options.seed}/{name}"))
    if options.broken:
        run.broken(cases)


def stalls_for(seed: str | float) -> Stalls:
    """Draw stalls: rare and long, frequent and short, or in between."""
    rng = random.Random(seed)
    probability, most = rng.choice(((0.05, 30), (0.2, 6), (0.5, 2), (0.8, 1), (0.3, 12)))
    return Stalls(probability, 1, most, seed=rng.getrandbits(32))


def broken_packets(plan: Plan, cases: Sequence[Case], rng: random.Random) -> Iterator[bytes]:
    """Yield packets that are cut, too long, just not too long, or of a wrong representation."""
    for case in cases:
        packet = case.packet
        kind = rng.choice(("cut", "cut", "long", "slack", "header"))
        if kind == "header" and plan.header_bytes:
            yield bytes((0, rng.choice((0, 2, 3, 7)))) + packet[2:]
        elif kind == "cut" and packet:
            yield packet[: rng.randrange(len(packet))]
        elif kind == "long":
            yield packet + rng.randbytes(plan.slack_bytes + rng.randint(1, 2 * plan.bus_bytes))
        else:
            # As many as are allowed, or one more.
            yield packet + rng.randbytes(plan.slack_bytes + rng.randint(0, 1))


class _Acceptance:
    """The runs of one type."""

    def __init__(self, message: Message, wire: str, options: Options, result: Result):
        self.options = options
        self.result = result
        settings = {
            "wire": wire,
            "bus_bytes": options.bus_bytes,
            "max_message_bytes": MAX_MESSAGE_BYTES,
        }
        rx = Deserializer(message, **settings)  # type: ignore[arg-type]
        tx = Serializer(message, **settings)  # type: ignore[arg-type]
        self.plan = rx.plan
        self.harness = Harness(rx, tx, message=message, gated=options.stalled)
        self.rng = random.Random(f"{options.seed}/{message.name}/broken")

    def is_large(self, cases: Sequence[Case]) -> bool:
        """Whether a type takes minutes to simulate; it is stalled and broken less often."""
        beats = sum(len(case.packet) for case in cases) // self.options.bus_bytes
        return beats * len(self.plan.leaves) > LARGE

    def fail(self, what: str) -> None:
        self.result.failures.append(what)

    def golden(self, cases: Sequence[Case]) -> None:
        """Check the golden model against the oracle."""
        for case in cases:
            decoded = decode(self.plan, case.packet)
            if decoded.status != "OK":
                self.fail(f"golden model, {case.what}: status {decoded.status}")
            self.transfers("golden model, " + case.what, decoded.streams, [case.transfers])
            streams = {self.leaf(path): list(items) for path, items in case.transfers.items()}
            try:
                packet, status = encode(self.plan, streams)
            except ValueError as error:
                self.fail(f"golden model, {case.what}: {error}")
                continue
            self.packets("golden model, " + case.what, [packet], [case.packet])
            if status != "OK":
                self.fail(f"golden model, {case.what}: status {status} when encoding")

    def leaf(self, path: tuple[str, ...]) -> int:
        for number, leaf in enumerate(self.plan.leaves):
            if leaf.path == path:
                return number
        raise AssertionError(f"The plan has no leaf {'.'.join(path)}")

    def send(self, packets: Sequence[bytes], stalls: Stalls | None) -> Seen:
        seen = self.harness.run(packets=packets, stalls=stalls)
        self.result.packets += len(packets)
        self.result.simulated_cycles += self.harness.bench.cycles
        return seen

    def good(self, cases: Sequence[Case], stalls: Stalls | None) -> None:
        """Check the hardware against the oracle."""
        where = "hardware" if stalls is None else f"hardware, {stalls}"
        try:
            seen = self.send([case.packet for case in cases], stalls)
        except AssertionError as error:
            self.fail(f"{where}: {type(error).__name__}: {error}")
            return
        if stalls is None:
            self.result.beats, self.result.cycles = seen.beats_in, seen.cycles
        self.packets(where, seen.packets, [case.packet for case in cases])
        self.transfers(where, seen.transfers, [case.transfers for case in cases])
        for what, statuses in (("status", seen.statuses), ("sent_status", seen.sent_statuses)):
            names = [status.name for status in statuses]
            if set(names) - {"OK"}:
                self.fail(f"{where}: {what} is {' '.join(names)}")
        if any(seen.marked):
            self.fail(f"{where}: packet_error is {seen.marked}")

    def broken(self, cases: Sequence[Case]) -> None:
        """Check the hardware against the golden model on packets that are wrong."""
        some = list(cases[:: max(1, len(cases) // 5)])
        broken = list(broken_packets(self.plan, some, self.rng))
        packets = list(chain.from_iterable(zip(broken, (c.packet for c in some), strict=True)))
        stalls = stalls_for(self.rng.random()) if self.options.stalled else None
        where = f"hardware, broken packets, {stalls}"
        expected = [decode(self.plan, packet) for packet in packets]
        try:
            seen = self.send(packets, stalls)
        except AssertionError as error:
            self.fail(f"{where}: {type(error).__name__}: {error}")
            return
        for number, (status, golden) in enumerate(zip(seen.statuses, expected, strict=True)):
            if status.name != golden.status:
                self.fail(
                    f"{where}: packet {number} ({packets[number].hex()}): status is {status.name}, "
                    f"golden model says {golden.status}"
                )
        by_path = [
            {self.plan.leaves[leaf].path: got for leaf, got in golden.streams.items()}
            for golden in expected
        ]
        self.transfers(where, seen.transfers, by_path)
        self.packets(where, seen.packets, [encode(self.plan, g.streams)[0] for g in expected])

    def packets(self, where: str, got: Sequence[bytes], wanted: Sequence[bytes]) -> None:
        """Compare packets, and report the first that differs."""
        for number, (one, other) in enumerate(zip(got, wanted, strict=True)):
            if one != other:
                at = next(
                    (n for n, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), -1
                )
                self.fail(
                    f"{where}: packet {number} of {len(wanted)} differs at byte {at}: "
                    f"{one.hex()} instead of {other.hex()}"
                )
                return

    def transfers(
        self, where: str, got: dict[int, list[Payload]], wanted: Sequence[Transfers]
    ) -> None:
        """Compare transfers, and report the first that differs of each leaf."""
        joined: dict[tuple[str, ...], list[Payload]] = {}
        for each in wanted:
            for path, payloads in each.items():
                joined.setdefault(path, []).extend(payloads)
        for number, leaf in enumerate(self.plan.leaves):
            mine, right = got.get(number, []), joined.pop(leaf.path, [])
            if mine == right:
                continue
            pairs = enumerate(zip(mine, right, strict=False))
            at = next((n for n, (a, b) in pairs if a != b), min(len(mine), len(right)))
            self.fail(
                f"{where}: leaf {leaf}, transfer {at} of {len(right)}: "
                f"{mine[at : at + 1]} instead of {right[at : at + 1]}"
            )
        if joined:
            self.fail(f"{where}: no leaves {', '.join('.'.join(path) for path in joined)}")
