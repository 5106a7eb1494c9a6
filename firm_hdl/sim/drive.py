"""The inputs of a bench in each cycle of a run: offers of sources, and readiness of sinks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from firm_hdl.sim.job import Job
from firm_hdl.sim.stalls import stalls_of

__all__ = ["Drive", "Inputs"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Inputs:
    """The signals that a bench drives, packed into words.

    Bits of word 0, from bit 0 up: `ready` of the sinks, then the gates, then `valid` of the
    sources.

    Attributes
    ----------
    sinks, gates : tuple of str
        Streams that the bench receives from, and streams that it can hold back.
    sources : mapping of str to (int, int)
        Streams that the bench sends on, with the word and the bit where the payload starts.
    first_source : int
        Number of ports before those of the sources, in bit masks of ports.
    words : int
        Number of words.
    """

    sinks: tuple[str, ...]
    gates: tuple[str, ...]
    sources: Mapping[str, tuple[int, int]]
    first_source: int
    words: int


@dataclass(slots=True)
class _Source:
    """A stream on which the bench sends: the offered payload, and the payloads after it."""

    valid: int
    word: int
    at: int
    payloads: Iterator[int]
    stalled: Iterator[bool] | None
    payload: int = 0


class Drive:
    """The inputs of a run: the values of the bench's words in each cycle."""

    def __init__(self, inputs: Inputs, job: Job):
        self.words = [0] * inputs.words
        self.always, self.changing = 0, []
        taken = [*inputs.sinks, *inputs.gates]
        self.gates = (1 << len(taken)) - (1 << len(inputs.sinks))
        for index, name in enumerate(taken):
            if stalls := stalls_of(job.options.stalls, name):
                self.changing.append((1 << index, stalls.cycles(name)))
            else:
                self.always |= 1 << index
        self.first = inputs.first_source
        self.sources = []
        for index, (name, (word, at)) in enumerate(inputs.sources.items()):
            stalls = stalls_of(job.options.stalls, name)
            source = _Source(
                valid=1 << (len(taken) + index),
                word=word,
                at=at,
                payloads=iter(job.sources.get(name, ())),
                stalled=stalls.cycles(name) if stalls else None,
            )
            self.sources.append(source)
        self.idle = list(self.sources)
        self.control = 0

    def next(self, fired: int, held: int) -> int:
        """Go to the next cycle; return the words that change, as a bit mask.

        Parameters
        ----------
        fired : int
            Bit mask of the ports that transferred in this cycle.
        held : int
            Bit mask of the ports whose offered transfer was not taken.
        """
        held &= self.gates & self.control
        control = self.control
        changed = 0
        fired >>= self.first
        while fired:
            low = fired & -fired
            source = self.sources[low.bit_length() - 1]
            fired ^= low
            control &= ~source.valid
            self.idle.append(source)
        if self.idle:
            control, changed = self._offer(control)
        control |= self.always
        for bit, stalled in self.changing:
            control = control & ~bit if next(stalled) else control | bit
        control |= held
        if control != self.control:
            self.words[0] ^= control ^ self.control
            self.control = control
            changed |= 1
        return changed

    def _offer(self, control: int) -> tuple[int, int]:
        """Let every idle source offer its next payload, unless it is stalled or has no more."""
        changed = 0
        idle = []
        for source in self.idle:
            if source.stalled is not None and next(source.stalled):
                idle.append(source)
                continue
            payload = next(source.payloads, None)
            if payload is None:
                continue
            if payload != source.payload:
                self.words[source.word] ^= (payload ^ source.payload) << source.at
                source.payload = payload
                changed |= 1 << source.word
            control |= source.valid
        self.idle = idle
        return control, changed
