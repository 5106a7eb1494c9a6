"""What came of a writer and cannot be delivered yet: fragments, and samples before their turn.

A peer can announce a sample of 4 GB with one small datagram. So memory is taken only for bytes that
came.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from firm_hdl.rtps.budget import Budget
from firm_hdl.rtps.wire.submessages import Data, DataFrag, NumberSet, fragment_count

__all__ = ["MOST_SAMPLE_BYTES", "Backlog", "Waiting"]

MOST_SAMPLE_BYTES = 64 << 20
"""The largest sample."""

_MOST_FRAGMENTS = 1 << 17
# Incomplete samples of a writer. One that sends nothing again completes few that are late.
_MOST_INCOMPLETE, _MOST_INCOMPLETE_BEST_EFFORT = 64, 4


@dataclass(frozen=True, slots=True)
class Waiting:
    """A sample before its turn, with the time that its writer gave, in nanoseconds."""

    data: Data
    timestamp: int | None

    @property
    def size(self) -> int:
        """Bytes of memory, about."""
        items = self.data.inline.items
        return len(self.data.payload or b"") + sum(100 + len(value) for _, value in items)


@dataclass(slots=True)
class _Incomplete:
    """A sample of which fragments are missing."""

    fragment_bytes: int
    sample_bytes: int
    parts: dict[int, bytes] = field(default_factory=dict)
    # A byte for each fragment up to the last one that came: 1 if it came.
    came: bytearray = field(default_factory=bytearray)
    # Bytes of memory, and those of the parts.
    size: int = 0
    part_bytes: int = 0


class Backlog:
    """What waits of one writer.

    * `prefix`: GUID prefix of the writer.
    * `budget`: the memory, which peers share.
    * `in_order`: whether samples are delivered in order, so that the first ones count most. Of a
      best-effort writer, the last one does.
    * `most_bytes`: the largest sample.
    * `counters`: counts what was ``refused``.
    """

    def __init__(
        self,
        prefix: bytes,
        budget: Budget,
        in_order: bool = True,
        most_bytes: int = MOST_SAMPLE_BYTES,
        counters: Counter[str] | None = None,
    ):
        self.prefix = prefix
        self._budget = budget
        self._in_order = in_order
        self._most_bytes = most_bytes
        self._counters = Counter[str]() if counters is None else counters
        self._whole: dict[int, Waiting] = {}
        self._incomplete: dict[int, _Incomplete] = {}

    def __contains__(self, number: int) -> bool:
        """Whether a sample waits for earlier ones."""
        return number in self._whole

    def __bool__(self) -> bool:
        return bool(self._whole or self._incomplete)

    def has_part(self, number: int) -> bool:
        """Whether fragments of a sample came, but not all."""
        return number in self._incomplete

    def keep(self, data: Data, timestamp: int | None) -> bool:
        """Keep a sample before its turn, if there is memory."""
        number, waiting = data.sequence_number, Waiting(data, timestamp)
        self.drop(number)
        if not self._room(waiting.size, number):
            self._counters["refused"] += 1
            return False
        self._whole[number] = waiting
        return True

    def take_below(self, number: int) -> list[Waiting]:
        """Remove all before sequence number `number`; return the samples in their order."""
        ready = sorted(each for each in self._whole if each < number)
        found = [self._whole[each] for each in ready]
        for each in (*ready, *[each for each in self._incomplete if each < number]):
            self.drop(each)
        return found

    def add(self, new: DataFrag) -> Data | None:
        """Take fragments. Return the sample if they were the last ones.

        They are refused if they do not fit the earlier ones of their sample, if the sample is too
        large, or if there is no memory; then, all of the sample is forgotten.
        """
        number = new.sequence_number
        begun = self._begun(new)
        # 8.3.8.3: both sizes are the same in all fragments of a sample.
        if begun is None or (begun.fragment_bytes, begun.sample_bytes) != (
            new.fragment_bytes,
            new.sample_bytes,
        ):
            self._counters["refused"] += 1
            return None
        for each in range(new.count):
            index, start = new.first + each, each * new.fragment_bytes
            part = new.payload[start : start + new.fragment_bytes]
            if index in begun.parts or not part:
                continue
            # A fragment far ahead costs the map of those before it, too. Without that, fragments of
            # a byte each would take memory that no budget knows of.
            size = len(part) + max(0, index - 1 - len(begun.came))
            if not self._room(size, number):
                self.drop(number)
                self._counters["refused"] += 1
                return None
            begun.came.extend(bytes(max(0, index - len(begun.came))))
            begun.came[index - 1] = 1
            begun.parts[index] = part
            begun.size += size
            begun.part_bytes += len(part)
        if begun.part_bytes < begun.sample_bytes:
            return None
        self.drop(number)
        return Data(
            reader=new.reader,
            writer=new.writer,
            sequence_number=number,
            payload=b"".join(begun.parts[each] for each in sorted(begun.parts)),
            inline=new.inline,
        )

    def absent(self, numbers: range) -> tuple[list[int], list[int]]:
        """Return those samples of which nothing came, and those of which some fragments did."""
        absent = set(numbers) - self._whole.keys()
        partial = absent & self._incomplete.keys()
        return sorted(absent - partial), sorted(partial)

    def missing(self, number: int, last: int | None = None) -> list[int]:
        """Return the fragments that a begun sample misses, ascending, up to fragment `last`.

        There are as many as one NACK_FRAG can name, at most.
        """
        begun = self._incomplete[number]
        count = fragment_count(begun.sample_bytes, begun.fragment_bytes)
        end = count if last is None else min(last, count)
        found: list[int] = []
        at = begun.came.find(0, 0, end)
        while at >= 0 and len(found) < NumberSet.MAX_SIZE:
            found.append(at + 1)
            at = begun.came.find(0, at + 1, end)
        rest = range(len(begun.came) + 1, end + 1)
        return [*found, *rest[: NumberSet.MAX_SIZE - len(found)]]

    def drop(self, number: int) -> None:
        """Forget a sample, or its fragments."""
        waiting = self._whole.pop(number, None)
        if waiting is not None:
            self._budget.give_back(self, waiting.size)
        begun = self._incomplete.pop(number, None)
        if begun is not None:
            self._budget.give_back(self, begun.size, len(begun.parts))

    def clear(self) -> None:
        """Forget all."""
        for each in (*self._whole, *self._incomplete):
            self.drop(each)

    def shrink(self) -> None:
        """Forget the sample that counts least."""
        self.drop(self._least())

    def _least(self) -> int:
        """Return the number of the sample that counts least."""
        numbers = (*self._whole, *self._incomplete)
        return max(numbers) if self._in_order else min(numbers)

    def _room(self, size: int, number: int) -> bool:
        """Take memory for a sample, perhaps from those of this writer that count less."""
        while not self._budget.take(self, size):
            # In order, what counts less than this sample is above it; else, below it. Nothing that
            # counts more gives way.
            least = self._least() if self else number
            if least == number or (least < number) is self._in_order:
                return False
            self.drop(least)
        return True

    def _begun(self, new: DataFrag) -> _Incomplete | None:
        """Return the sample that fragments belong to."""
        begun = self._incomplete.get(new.sequence_number)
        if begun is None:
            count = fragment_count(new.sample_bytes, new.fragment_bytes)
            if new.sample_bytes > self._most_bytes or count > _MOST_FRAGMENTS:
                return None
            most = _MOST_INCOMPLETE if self._in_order else _MOST_INCOMPLETE_BEST_EFFORT
            if len(self._incomplete) >= most:
                least = (max if self._in_order else min)(self._incomplete)
                if (least < new.sequence_number) is self._in_order:
                    return None
                self.drop(least)
            begun = _Incomplete(new.fragment_bytes, new.sample_bytes)
            self._incomplete[new.sequence_number] = begun
        return begun
