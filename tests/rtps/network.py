"""A network in virtual time, which loses, repeats and delays datagrams as a seed says."""

from __future__ import annotations

import heapq
import random
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count

from firm_hdl.rtps import Qos
from firm_hdl.rtps.core import Core
from firm_hdl.rtps.discovery import ParticipantData
from firm_hdl.rtps.events import Arrived, Event, Sample
from firm_hdl.rtps.peers import Peer, Route
from firm_hdl.rtps.reader import Reader
from firm_hdl.rtps.spdp import Settings
from firm_hdl.rtps.wire.locators import Address
from firm_hdl.rtps.writer import Writer

__all__ = ["GROUP", "TOPIC", "TYPE", "Network", "Station", "route_to"]

GROUP = Address("239.255.0.1", 7400)
TOPIC, TYPE = "rt/t", "p::msg::dds_::T_"


def route_to(address: Address) -> Route:
    """Return a way to a peer that may ask for whatever it likes."""
    data = ParticipantData(prefix=bytes(12), discovery=(address,), user=(address,), lease=10.0)
    return Route(Peer(data, address.host, None, credit=float("inf")))


@dataclass
class Station:
    """A participant in the network, with what happened in it."""

    network: Network
    core: Core
    events: list[Event] = field(default_factory=list)
    # Taken off the network, without a farewell.
    dead: bool = False
    # Not a member of the multicast group.
    deaf: bool = False

    @property
    def host(self) -> str:
        return self.core.settings.host

    def take_events(self) -> None:
        while (event := self.core.next_event()) is not None:
            self.events.append(event)

    @property
    def samples(self) -> list[Sample]:
        return [each.sample for each in self.events if isinstance(each, Arrived)]

    @property
    def payloads(self) -> list[bytes]:
        return [each.payload for each in self.samples]

    def named(self, name: str) -> list[Event]:
        return [each for each in self.events if type(each).__name__ == name]

    def writer(self, qos: Qos | None = None, topic: str = TOPIC, type_name: str = TYPE) -> Writer:
        return self.core.add_writer(topic, type_name, qos or Qos(), b"", self.network.now)

    def reader(self, qos: Qos | None = None, topic: str = TOPIC, type_name: str = TYPE) -> Reader:
        return self.core.add_reader(topic, type_name, qos or Qos(), b"", self.network.now)

    def write(self, writer: Writer, payload: bytes) -> int:
        stamp = int(self.network.now * 1e9)
        return self.core.write(writer, payload, self.network.now, stamp)


class Network:
    """Stations and the datagrams between them.

    Parameters
    ----------
    loss, repeat : float
        Probability that a datagram is lost, or comes twice.
    delay : float
        Longest delay, in seconds; delays differ, so datagrams overtake each other.
    """

    def __init__(self, seed: int = 0, loss: float = 0, repeat: float = 0, delay: float = 0.001):
        self.random = random.Random(seed)
        self.loss, self.repeat, self.delay = loss, repeat, delay
        self.now = 0.0
        self.stations: list[Station] = []
        self.sent: list[bytes] = []
        self.bytes_to: Counter[str] = Counter()
        self._order = count()
        self._flying: list[tuple[float, int, Address, bytes, str]] = []

    def station(
        self,
        prefix: bytes | None = None,
        domain: int | None = 0,
        elsewhere: tuple[str, ...] = (),
        **options: object,
    ) -> Station:
        """Add a participant. It also names hosts `elsewhere`, where nobody is."""
        number = len(self.stations) + 1
        hosts = (*elsewhere, f"10.0.0.{number}")
        lease = float(options.pop("lease", 10.0))
        own = ParticipantData(
            prefix=prefix or b"\x01\xff" + bytes(9) + bytes([number]),
            discovery=tuple(Address(host, 7410) for host in hosts),
            user=tuple(Address(host, 7411) for host in hosts),
            lease=lease,
            domain=domain,
        )
        settings = Settings(own=own, host=hosts[-1], targets=(GROUP,), **options)
        station = Station(self, Core(settings))
        self.stations.append(station)
        return station

    def run(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass, at most until a condition holds. Return whether it does."""
        end = self.now + seconds
        while self.now < end:
            self._collect()
            if until():
                return True
            due = min((s.core.tick(self.now) for s in self.stations if not s.dead), default=end)
            self._collect()
            flight = self._flying[0][0] if self._flying else end
            self.now = min(end, max(self.now + 1e-6, min(due, flight)))
            while self._flying and self._flying[0][0] <= self.now:
                _, _, address, datagram, host = heapq.heappop(self._flying)
                self._arrive(address, datagram, host)
        self._collect()
        return until()

    def _collect(self) -> None:
        for station in self.stations:
            station.take_events()
            while station.core.outbox:
                address, datagram = station.core.pop()
                if station.dead:
                    continue
                self.sent.append(datagram)
                self.bytes_to[address.host] += len(datagram)
                for _ in range(1 + (self.random.random() < self.repeat)):
                    if self.random.random() >= self.loss:
                        at = self.now + self.random.uniform(1e-6, self.delay)
                        item = (at, next(self._order), address, datagram, station.host)
                        heapq.heappush(self._flying, item)

    def _arrive(self, address: Address, datagram: bytes, host: str) -> None:
        for station in self.stations:
            is_here = address.host == station.host or (address == GROUP and not station.deaf)
            if is_here and not station.dead:
                station.core.receive(datagram, self.now, host)
