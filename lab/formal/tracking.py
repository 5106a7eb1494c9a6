"""One unit of a packet stream, followed on its way through a block.

A packet is a sequence of units: its bytes, and an end. The surroundings choose one unit of all that
enter, whenever they like; this is any unit, because a solver tries all choices. When as many units
have left as were before it, it has to be the one that leaves. So units are neither lost nor
repeated, changed, or out of order, and ends are where they were. This needs no copy of what a
block holds: one unit, and how many units are inside and before it.
"""

from __future__ import annotations

from typing import Any

from amaranth.hdl import Mux, Signal, Value

from lab.formal.scene import Scene

__all__ = ["BeatTracker", "Tracker"]


class _Follower:
    """The unit, from the cycle in which it enters to that in which it leaves.

    Parameters
    ----------
    most : int
        Most units that a block may hold, with those of packets that it has not decided on.
    bits : int
        Width of a number of units.

    Attributes
    ----------
    inside : Signal
        Units of packets that are kept, and have not left.
    pending : Signal
        Units that entered, of the packet that is not decided.
    place : Signal
        Units of the unit's packet before it.
    hits : Signal
        The unit leaves in this cycle.
    """

    def __init__(self, scene: Scene, name: str, most: int, bits: int):
        self.scene, self.name, self.most = scene, name, most
        self.inside = Signal(bits, name=f"{name}_inside")
        self.pending = Signal(bits, name=f"{name}_pending")
        self.place = Signal(bits, name=f"{name}_place")
        self.hits = Signal(name=f"{name}_hits")
        self._left = Signal(bits, name=f"{name}_left")
        self._before = Signal(bits, name=f"{name}_before")
        # The unit was chosen; its packet is not decided; it is inside.
        self._chosen = Signal(name=f"{name}_chosen")
        self._open = Signal(name=f"{name}_open")
        self._alive = Signal(name=f"{name}_alive")

    def _enter(
        self,
        transfers: Value,
        units: Value | int,
        lane: Value | int,
        *,
        decides: Value | int,
        keeps: Value | int,
    ) -> Value:
        """Count units that enter; return whether that at `lane` is chosen in this cycle."""
        m, name, bits = self.scene.m, self.name, len(self.inside)
        mark = self.scene.free(1, f"{name}_mark")
        chooses, commits = Signal(name=f"{name}_chooses"), Signal(name=f"{name}_commits")
        place, is_open = Signal(bits, name=f"{name}_at"), Signal(name=f"{name}_opens")
        m.d.comb += [
            chooses.eq(transfers & mark & ~self._chosen & (lane < Value.cast(units))),
            commits.eq(transfers & decides & keeps),
            place.eq(Mux(chooses, self.pending + lane, self.place)),
            is_open.eq(chooses | self._open),
        ]
        m.d.sync += [
            self._chosen.eq(chooses | self._chosen),
            self.place.eq(place),
            self._open.eq(is_open & ~(transfers & decides)),
            self.inside.eq(self.inside + Mux(commits, self.pending + units, 0) - self._left),
        ]
        with m.If(transfers):
            m.d.sync += self.pending.eq(Mux(decides, 0, self.pending + units))
        with m.If(commits & is_open):
            m.d.sync += [self._alive.eq(1), self._before.eq(self.inside - self._left + place)]
        return chooses

    def _leave(self, transfers: Value, units: Value | int, same: Value) -> None:
        """Count units that leave. Claim `same` of the unit, and that no other unit leaves."""
        m, scene = self.scene.m, self.scene
        m.d.comb += [
            self._left.eq(Mux(transfers, units, 0)),
            self.hits.eq(transfers & self._alive & (self._before < Value.cast(units))),
        ]
        with m.If(transfers & self._alive):
            m.d.sync += [self._before.eq(self._before - units), self._alive.eq(~self.hits)]
        scene.claim("order", ~self.hits | same)
        scene.claim("nothing extra", self._left <= self.inside)
        scene.claim("nothing extra", self.inside <= self.most)


class Tracker(_Follower):
    """Claims that the packets that leave are those that came, whole and in order.

    Call `enter` and `leave` once each. If the unit is the end of its packet, `place` is the size of
    the packet in bytes.

    Attributes
    ----------
    is_end : Signal
        The unit is the end of its packet.
    """

    def __init__(self, scene: Scene, name: str, most: int):
        super().__init__(scene, name, most, (2 * most + 1).bit_length())
        self.is_end = Signal(name=f"{name}_is_end")
        self._byte = Signal(8, name=f"{name}_byte")

    def enter(
        self,
        transfers: Value,
        beat: Any,
        *,
        decides: Value | int = 1,
        keeps: Value | int = 1,
    ) -> None:
        """Say what enters.

        Parameters
        ----------
        transfers : Value
            `beat` enters in this cycle.
        decides : Value
            With this beat it is decided what becomes of it and of those that are undecided.
        keeps : Value
            They will leave; else they will not.
        """
        m = self.scene.m
        lane = self.scene.free(range(len(beat.data) + 1), f"{self.name}_lane")
        units = Signal.like(self.inside, name=f"{self.name}_units")
        m.d.comb += units.eq(beat.count + beat.last)
        with m.If(self._enter(transfers, units, lane, decides=decides, keeps=keeps)):
            m.d.sync += [
                self.is_end.eq(lane == beat.count),
                self._byte.eq(Value.cast(beat.data).word_select(lane, 8)),
            ]

    def leave(self, transfers: Value, beat: Any) -> None:
        """Say what leaves, and claim that it is what came."""
        units = Signal.like(self.inside, name=f"{self.name}_leaving")
        self.scene.m.d.comb += units.eq(beat.count + beat.last)
        is_end = self._before == beat.count
        byte = Value.cast(beat.data).word_select(self._before[: len(beat.count)], 8)
        same = (is_end == self.is_end) & (self.is_end | (byte == self._byte))
        self._leave(transfers, units, same)


class BeatTracker(_Follower):
    """The same claims about a block that leaves beats as they are: the unit is a beat.

    Of the beat, one bit is kept: any one, because the surroundings choose it for ever.
    """

    def __init__(self, scene: Scene, name: str, most: int):
        super().__init__(scene, name, most, (most + 1).bit_length())
        self._bit = Signal(name=f"{name}_bit")
        self._which: Value | None = None

    def enter(
        self, transfers: Value, beat: Value, *, decides: Value | int = 1, keeps: Value | int = 1
    ) -> None:
        """Say what enters; the parameters are those of :meth:`Tracker.enter`."""
        self._which = self.scene.rigid(range(len(beat)), f"{self.name}_which")
        with self.scene.m.If(self._enter(transfers, 1, 0, decides=decides, keeps=keeps)):
            self.scene.m.d.sync += self._bit.eq(beat.bit_select(self._which, 1))

    def leave(self, transfers: Value, beat: Value) -> None:
        """Say what leaves, and claim that it is what came."""
        assert self._which is not None
        self._leave(transfers, 1, beat.bit_select(self._which, 1) == self._bit)
