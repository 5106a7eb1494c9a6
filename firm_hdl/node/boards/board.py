"""What a bridge needs of a board: frames out, frames in, and something to wait for."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Sequence

__all__ = ["Board", "BoardError"]


class BoardError(Exception):
    """A board cannot be opened, or is gone; the text says why. Opening it again may help."""


class Board(ABC):
    """A way to a node.

    Nothing blocks but :meth:`open` and :meth:`close`. A board is used from one thread.

    Attributes
    ----------
    sample_seconds : float
        How often the time of the node is compared with that of the host.
    silent_seconds : float
        A board from which nothing whole came for so long is gone.
    repeat_seconds : float
        A request without an answer is repeated after so long.
    has_real_time : bool
        Whether its clock is to have the frequency of the description; not that of a simulation.
    end_seconds : float
        How long, at most, a bridge asks at its end what has arrived and what was lost.
    """

    sample_seconds = 1.0
    silent_seconds = 5.0
    repeat_seconds = 0.25
    has_real_time = True
    end_seconds = 1.0

    def __init__(self, name: str, frame_bytes: int | None = None) -> None:
        self.name = name  # As the user named it.
        self.frame_bytes = frame_bytes  # Most bytes of a frame, header included. `None`: no limit.
        # How fast the way is; `None`: fast enough not to be waited for.
        self.bytes_per_second: float | None = None
        # What the way itself lost, by cause: `damaged` and `large` frames, `unreachable` for
        # datagrams. They go on when the board is opened again.
        self.counters: Counter[str] = Counter()

    @abstractmethod
    def open(self) -> None:
        """Open the way; a way that is open is closed first.

        Raises
        ------
        BoardError
        """

    @abstractmethod
    def fileno(self) -> int:
        """Return the file descriptor that can be read when frames have come."""

    @property
    def waits_to_send(self) -> bool:
        """Whether :meth:`flush` has something to do once the file descriptor can be written to."""
        return False

    @property
    def is_unreachable(self) -> bool:
        """Whether the network has said so since the last frame came; requests may still go."""
        return False

    @property
    def has_room(self) -> bool:
        """Whether a message that is sent now is soon on its way.

        If not, :meth:`send` takes it all the same, and it waits behind others.
        """
        return True

    @abstractmethod
    def send(self, frames: Sequence[bytes]) -> bool:
        """Send the frames of one message, or none of them.

        Returns
        -------
        bool
            Whether they were taken.

        Raises
        ------
        BoardError
            If the board is gone.
        """

    def flush(self) -> None:
        """Send what waits, as far as possible without blocking; raises as :meth:`send`."""
        return

    @abstractmethod
    def receive(self) -> list[bytes]:
        """Take the frames that have come; none is no error.

        Raises
        ------
        BoardError
            If the board is gone.
        """

    @abstractmethod
    def close(self) -> None:
        """Close the way. May be called at any time, and again."""
