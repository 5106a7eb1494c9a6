"""Samples in fragments: how a sample is cut, and how one is put together again (8.4.14.1).

A peer can announce a sample of 4 GB with one small datagram. So memory is taken only for bytes that
came. All writers of all peers share one budget; a writer without a share loses its oldest
incomplete sample.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import islice

from firm_hdl.rtps.wire.numbers import NumberSet
from firm_hdl.rtps.wire.samples import Data, DataFrag

__all__ = ["Budget", "Reassembly", "fragment", "fragment_count"]

# Largest sample, and how many incomplete ones a writer may have.
_MAX_SAMPLE_BYTES = 64 << 20
_MAX_FRAGMENTS = 1 << 17
_MAX_SAMPLES = 64
# What a fragment or a sample takes besides its bytes, about.
_OVERHEAD_BYTES = 200


def fragment_count(sample_bytes: int, fragment_bytes: int) -> int:
    """Return the number of fragments of a sample."""
    return -(-sample_bytes // fragment_bytes)


def fragment(sample: Data, number: int, fragment_bytes: int) -> DataFrag:
    """Return fragment `number`, from 1 on, of a sample with a payload."""
    assert sample.payload is not None
    start = (number - 1) * fragment_bytes
    return DataFrag(
        reader=sample.reader,
        writer=sample.writer,
        sequence_number=sample.sequence_number,
        first=number,
        count=1,
        fragment_bytes=fragment_bytes,
        sample_bytes=len(sample.payload),
        payload=sample.payload[start : start + fragment_bytes],
        inline=sample.inline,
    )


class Budget:
    """Memory for what cannot be delivered yet.

    Parameters
    ----------
    limit : int
        Number of bytes.
    """

    def __init__(self, limit: int):
        self.limit = limit
        self.used = 0

    def take(self, size: int) -> bool:
        """Take the memory of a value of `size` bytes, if there is enough."""
        if self.used + size + _OVERHEAD_BYTES > self.limit:
            return False
        self.used += size + _OVERHEAD_BYTES
        return True

    def give_back(self, size: int, values: int = 1) -> None:
        """Give back the memory of `values` values, of `size` bytes together."""
        self.used -= size + values * _OVERHEAD_BYTES


@dataclass(slots=True)
class _Partial:
    """A sample of which fragments are missing."""

    fragment_bytes: int
    sample_bytes: int
    parts: dict[int, bytes] = field(default_factory=dict)
    size: int = 0

    @property
    def count(self) -> int:
        return fragment_count(self.sample_bytes, self.fragment_bytes)


class Reassembly:
    """Puts the samples of one writer together.

    Parameters
    ----------
    budget : Budget
        The memory, which others may share.
    """

    def __init__(self, budget: Budget):
        self._budget = budget
        self._partial: dict[int, _Partial] = {}

    def add(self, new: DataFrag) -> Data | None:
        """Take fragments. Return the sample if they were the last ones.

        Fragments that do not fit the earlier ones of their sample are ignored, as are those for
        which there is no memory.
        """
        partial = self._begun(new)
        # 8.3.8.3: both sizes are the same in all fragments of a sample.
        if partial is None or (partial.fragment_bytes, partial.sample_bytes) != (
            new.fragment_bytes,
            new.sample_bytes,
        ):
            return None
        for each in range(new.count):
            number = new.first + each
            start = each * new.fragment_bytes
            part = new.payload[start : start + new.fragment_bytes]
            if number in partial.parts or not part:
                continue
            if not self._room(len(part), new.sequence_number):
                return None
            partial.parts[number] = part
            partial.size += len(part)
        if partial.size < partial.sample_bytes:
            return None
        self.drop(new.sequence_number)
        return Data(
            reader=new.reader,
            writer=new.writer,
            sequence_number=new.sequence_number,
            payload=b"".join(partial.parts[each] for each in sorted(partial.parts)),
            inline=new.inline,
        )

    def drop(self, number: int) -> None:
        """Forget the fragments of a sample."""
        partial = self._partial.pop(number, None)
        if partial is not None:
            self._budget.give_back(partial.size, len(partial.parts))

    def drop_below(self, number: int) -> None:
        """Forget the fragments of all samples before sequence number `number`."""
        for each in [each for each in self._partial if each < number]:
            self.drop(each)

    def drop_all(self) -> None:
        """Forget all fragments."""
        for each in list(self._partial):
            self.drop(each)

    def missing(self, number: int, last: int | None = None) -> list[int]:
        """Return the fragments that a begun sample misses, ascending, up to fragment `last`.

        There are as many as one NACK_FRAG can name, at most.
        """
        partial = self._partial[number]
        end = partial.count if last is None else min(last, partial.count)
        missing = (each for each in range(1, end + 1) if each not in partial.parts)
        return list(islice(missing, NumberSet.MAX_SIZE))

    def __contains__(self, number: int) -> bool:
        """Whether a sample is begun."""
        return number in self._partial

    def _begun(self, new: DataFrag) -> _Partial | None:
        """Return the sample that fragments belong to."""
        partial = self._partial.get(new.sequence_number)
        if partial is None:
            count = fragment_count(new.sample_bytes, new.fragment_bytes)
            if new.sample_bytes > _MAX_SAMPLE_BYTES or count > _MAX_FRAGMENTS:
                return None
            if len(self._partial) == _MAX_SAMPLES:
                self.drop(next(iter(self._partial)))
            partial = _Partial(new.fragment_bytes, new.sample_bytes)
            self._partial[new.sequence_number] = partial
        return partial

    def _room(self, size: int, newest: int) -> bool:
        """Take memory for a fragment of sample `newest`, from older ones if need be."""
        while not self._budget.take(size):
            oldest = next(iter(self._partial))
            self.drop(oldest)
            if oldest == newest:
                return False
        return True
