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

from firm_hdl.formal.scene import Scene

__all__ = ["BeatTracker", "Tracker"]


class Tracker:
    """Claims that the packets that leave are those that came, whole and in order.

    Call `enter` and `leave` once each.

    Parameters
    ----------
    most : int
        Most units that a block may hold, with those of packets that it has not decided on.

    Attributes
    ----------
    inside : Signal
        Units of packets that are kept, and have not left.
    hits : Value
        The unit leaves in this cycle; after `leave`.
    is_end : Signal
        The unit is the end of its packet.
    place : Signal
        Units of the packet before it: if it is the end, the size in bytes.
    """

    def __init__(self, scene: Scene, name: str, most: int):
        self.scene, self.name, self.most = scene, name, most
        bits = (2 * most + 1).bit_length()
        self.inside = Signal(bits, name=f"{name}_inside")
        self.pending = Signal(bits, name=f"{name}_pending")
        self.place = Signal(bits, name=f"{name}_place")
        self._before = Signal(bits, name=f"{name}_before")
        # The unit was chosen; its packet is not decided; it is inside.
        self._chosen = Signal(name=f"{name}_chosen")
        self._open = Signal(name=f"{name}_open")
        self._alive = Signal(name=f"{name}_alive")
        self.is_end = Signal(name=f"{name}_is_end")
        self._byte = Signal(8, name=f"{name}_byte")
        self._left = Signal(bits, name=f"{name}_left")
        self._enters: tuple[Value, Value] = (Value.cast(0), Value.cast(0))

    def enter(
        self,
        transfers: Value,
        beat: Any,
        *,
        decides: Value | int = 1,
        keeps: Value | int = 1,
        count: Value | None = None,
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
        count : Value or None
            Valid lanes of the beat, if not `beat.count`.
        """
        m, name, bits = self.scene.m, self.name, len(self.inside)
        lanes = len(beat.data)
        count = beat.count if count is None else count
        mark = self.scene.free(1, f"{name}_mark")
        lane = self.scene.free(range(lanes + 1), f"{name}_lane")
        units, chooses = Signal(bits, name=f"{name}_units"), Signal(name=f"{name}_chooses")
        commits = Signal(name=f"{name}_commits")
        place, is_open = Signal(bits, name=f"{name}_at"), Signal(name=f"{name}_opens")
        m.d.comb += [
            units.eq(count + beat.last),
            chooses.eq(transfers & mark & ~self._chosen & (lane < units)),
            commits.eq(transfers & decides & keeps),
            place.eq(Mux(chooses, self.pending + lane, self.place)),
            is_open.eq(chooses | self._open),
        ]
        with m.If(chooses):
            m.d.sync += [
                self._chosen.eq(1),
                self.is_end.eq(lane == count),
                self._byte.eq(Value.cast(beat.data).word_select(lane, 8)),
            ]
        m.d.sync += [
            self.place.eq(place),
            self._open.eq(is_open & ~(transfers & decides)),
            self.inside.eq(self.inside + Mux(commits, self.pending + units, 0) - self._left),
        ]
        with m.If(transfers):
            m.d.sync += self.pending.eq(Mux(decides, 0, self.pending + units))
        with m.If(commits & is_open):
            m.d.sync += [self._alive.eq(1), self._before.eq(self.inside - self._left + place)]

    def leave(self, transfers: Value, beat: Any) -> None:
        """Say what leaves, and claim that it is what came."""
        m, name = self.scene.m, self.name
        left = Signal.like(self.inside, name=f"{name}_leaving")
        hits = Signal(name=f"{name}_hits")
        is_end = self._before == beat.count
        byte = Value.cast(beat.data).word_select(self._before[: len(beat.count)], 8)
        m.d.comb += [
            left.eq(beat.count + beat.last),
            self._left.eq(Mux(transfers, left, 0)),
            hits.eq(transfers & self._alive & (self._before < left)),
        ]
        with m.If(transfers & self._alive):
            m.d.sync += [self._before.eq(self._before - left), self._alive.eq(~hits)]
        self.hits = hits
        same = (is_end == self.is_end) & (self.is_end | (byte == self._byte))
        self.scene.claim("order", ~hits | same)
        self.scene.claim("nothing extra", self._left <= self.inside)
        self.scene.claim("nothing extra", self.inside <= self.most)


class BeatTracker:
    """The same claims about a block that leaves beats as they are: the unit is a beat.

    Of the beat, one bit is kept: any one, because the surroundings choose it for ever.

    Parameters
    ----------
    most : int
        Most beats that a block may hold, with those of packets that it has not decided on.

    Attributes
    ----------
    inside : Signal
        Beats of packets that are kept, and have not left.
    hits : Signal
        The beat leaves in this cycle.
    place : Signal
        Beats of its packet before it.
    """

    def __init__(self, scene: Scene, name: str, most: int):
        self.scene, self.name, self.most = scene, name, most
        counts = range(most + 2)
        self.inside = Signal(counts, name=f"{name}_inside")
        self.pending = Signal(counts, name=f"{name}_pending")
        self.place = Signal(counts, name=f"{name}_place")
        self.hits, self._leaves = Signal(name=f"{name}_hits"), Signal(name=f"{name}_leaves")
        self._before = Signal(counts, name=f"{name}_before")
        self._chosen = Signal(name=f"{name}_chosen")
        self._open = Signal(name=f"{name}_open")
        self._alive = Signal(name=f"{name}_alive")
        self._bit = Signal(name=f"{name}_bit")
        self._which: Value | None = None

    def enter(
        self, transfers: Value, beat: Value, *, decides: Value | int = 1, keeps: Value | int = 1
    ) -> None:
        """Say what enters; the parameters are those of :meth:`Tracker.enter`."""
        m, name = self.scene.m, self.name
        self._which = self.scene.rigid(range(len(beat)), f"{name}_which")
        chooses, is_open = Signal(name=f"{name}_chooses"), Signal(name=f"{name}_is_open")
        commits, place = Signal(name=f"{name}_commits"), Signal.like(self.place)
        m.d.comb += [
            chooses.eq(transfers & self.scene.free(1, f"{name}_mark") & ~self._chosen),
            commits.eq(transfers & decides & keeps),
            place.eq(Mux(chooses, self.pending, self.place)),
            is_open.eq(chooses | self._open),
        ]
        with m.If(chooses):
            m.d.sync += [self._chosen.eq(1), self._bit.eq(beat.bit_select(self._which, 1))]
        m.d.sync += [
            self.place.eq(place),
            self._open.eq(is_open & ~(transfers & decides)),
            self.inside.eq(self.inside + Mux(commits, self.pending + 1, 0) - self._leaves),
        ]
        with m.If(transfers):
            m.d.sync += self.pending.eq(Mux(decides, 0, self.pending + 1))
        with m.If(commits & is_open):
            m.d.sync += [self._alive.eq(1), self._before.eq(self.inside - self._leaves + place)]

    def leave(self, transfers: Value, beat: Value) -> None:
        """Say what leaves, and claim that it is what came."""
        m = self.scene.m
        assert self._which is not None
        m.d.comb += [
            self._leaves.eq(transfers),
            self.hits.eq(transfers & self._alive & (self._before == 0)),
        ]
        with m.If(transfers & self._alive):
            m.d.sync += [self._before.eq(self._before - 1), self._alive.eq(~self.hits)]
        same = beat.bit_select(self._which, 1) == self._bit
        self.scene.claim("order", ~self.hits | same)
        self.scene.claim("nothing extra", ~transfers | (self.inside != 0))
        self.scene.claim("nothing extra", self.inside <= self.most)
