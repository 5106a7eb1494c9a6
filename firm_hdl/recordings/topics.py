"""What a file of a recording says of its topics and of their types, whatever its format."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterator
from dataclasses import dataclass

__all__ = ["RecordingFile", "Schema", "Topic"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Schema:
    """A definition as it was recorded."""

    type: str  # The name of the type.
    encoding: str  # The language, such as `ros2msg`; `ros1msg` in a `.bag`.
    # The text; `None` if it is longer than `firm_hdl.recordings.limits.MAX_TEXT_BYTES`.
    data: bytes | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Topic:
    """A topic of a recording. A topic with several types or digests counts several times."""

    # As they were recorded. The type of a channel of MCAP without a schema is empty.
    name: str
    type: str
    encoding: str  # The wire format of the messages: `ros1`, `cdr` or any other word.
    digest: str  # The recorded md5 sum or type hash; empty if there is none.


class RecordingFile(ABC):
    """An open file of a recording.

    It is made of a binary file, its number of bytes, and the `Budget` of the recording. All that
    cannot be read is an `UnreadableError`, from each method, too.

    Attributes
    ----------
    distro : str
        The distribution that the file names as its origin; empty if there is none.
    """

    distro = ""

    def __init__(self) -> None:
        self.topics: dict[int, Topic] = {}  # By the numbers that messages refer to.
        self.schemas: list[Schema] = []

    @abstractmethod
    def messages(self, numbers: Collection[int]) -> Iterator[tuple[int, int, bytes]]:
        """Yield number, time in nanoseconds and bytes of each message of some topics."""

    def close(self) -> None:
        """Close what was opened beside the file, which stays open."""
        return
