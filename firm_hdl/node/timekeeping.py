"""Keep the clock of a node in step with that of its host, on the host.

Every response of the node has its time. The host knows when it sent the request and when the
response came, so it knows the distance of the clocks up to half of that delay, as in NTP (RFC 5905,
8). The clock is set once; then only its rate is changed, so that the time never jumps. A clock that
is further off than any crystal has another frequency than its description; it is set again and
again.
"""

from __future__ import annotations

import os
import time
from collections import deque
from collections.abc import Callable

from firm_hdl.errors import UserError
from firm_hdl.node.control import ControlRequest, ControlResponse, Operation

__all__ = ["ClockKeeper", "ptp_clock", "with_seconds_of"]

SECOND_NS = 1_000_000_000

STEP_NS = 1_000_000
"""A clock that is further away than this is set."""

DELAYS = 16
"""Delays from which the usual one is taken."""

MOST_CORRECTION = 500e-6
"""Largest change of the rate, as a fraction; crystals are within 100e-6."""

MOST_ERROR = 10.0
"""Of a clock, as a fraction. What looks like more is a time that was not set, or a host that has
set its own."""

# What a sample takes from the offset, and what of it is held to be the crystal's. With samples of
# equal distance and no noise, an offset of 1 goes through 0.52, 0.19 and -0.02 to -0.23 and then
# back: its swing shrinks by 0.77 per sample. Larger shares would follow the noise of the delays.
_PROPORTIONAL, _INTEGRAL = 0.4, 0.08


class ClockKeeper:
    """Decide what to tell a node about its clock.

    Send any request about once a second, and give each response to :meth:`sample`. If that returns
    a request, send it, and do not sample its response.

    * `nominal`: the rate of the node's clock without a correction: register `rate` after a reset,
      or :func:`firm_hdl.node.control.nominal_rate`.
    """

    def __init__(self, nominal: int) -> None:
        self._nominal = nominal
        self._delays: deque[int] = deque(maxlen=DELAYS)
        self._last_ns: int | None = None
        # The error of the node's crystal that is corrected, as a fraction.
        self._drift = 0.0
        # Time of the node less that of the host, at the last sample that counted.
        self.offset_ns: float | None = None
        # Error of the clock as a fraction, once it has twice been too large to be corrected.
        self.error: float | None = None
        self._error_before = self._correction = 0.0
        # When the clocks were compared, and their distance then.
        self._compared: tuple[int, float] | None = None

    def sample(
        self, sent_ns: int, response: ControlResponse, received_ns: int
    ) -> ControlRequest | None:
        """Take a response; return what to send to the node.

        * `sent_ns`, `received_ns`: times of the host, in ns since the epoch, when the request was
          sent and when the response came.

        Returns: `SET_TIME` at first, and whenever the clock is more than 1 ms away; else
        `SET_RATE`. `None` if the sample does not count, because its delay is more than twice the
        usual one.
        """
        delay = received_ns - sent_ns
        self._delays.append(delay)
        node_ns = response.seconds * SECOND_NS + response.nanoseconds
        # The times are integers up to here: as a float, one of today is a multiple of 256 ns.
        offset = (2 * node_ns - sent_ns - received_ns) / 2
        if abs(offset) > max(STEP_NS, delay):
            self._last_ns = None
            self._judge(received_ns, offset, is_set=True)
            # A time further ahead would have to be set back if the next delay is shorter.
            seconds, nanoseconds = divmod(received_ns + min(self._delays) // 2, SECOND_NS)
            return ControlRequest(
                operation=Operation.SET_TIME,
                seconds=seconds % (1 << 32),
                nanoseconds=nanoseconds,
            )
        if delay > 2 * sorted(self._delays)[len(self._delays) // 2]:
            return None
        self._judge(received_ns, offset, is_set=False)
        self.offset_ns = offset
        before, self._last_ns = self._last_ns, received_ns
        if before is None or received_ns <= before:
            return None
        error = offset / (received_ns - before)
        self._drift = _limited(self._drift - _INTEGRAL * error)
        self._correction = _limited(self._drift - _PROPORTIONAL * error)
        rate = round(self._nominal * (1 + self._correction))
        return ControlRequest(operation=Operation.SET_RATE, argument=rate)

    def _judge(self, received_ns: int, offset: float, *, is_set: bool) -> None:
        """Note how far the clock is off. One large error alone may be a step of the host."""
        before, self._compared = self._compared, (received_ns, 0.0 if is_set else offset)
        if before is None or received_ns <= before[0]:
            return
        error = (offset - before[1]) / (received_ns - before[0]) - self._correction
        if abs(error) <= MOST_CORRECTION or not -1 < error < MOST_ERROR:
            self._error_before = 0.0
        elif is_set:
            if error * self._error_before > 0:
                self.error = min(error, self._error_before, key=abs)
            self._error_before = error


def ptp_clock(device: str) -> Callable[[], int]:
    """Return a function that reads a PTP hardware clock of the host, in ns since the epoch.

    Such a clock often runs in TAI, or has never been set. So its whole seconds become those of the
    system's clock, which ROS has, as they are now.

    * `device`: such as ``/dev/ptp0``.

    Raises `UserError` if it cannot be read; also later, by the function.
    """
    try:
        file = os.open(device, os.O_RDONLY | os.O_CLOEXEC)
    except OSError as error:
        raise UserError(f"cannot open the clock '{device}': {error.strerror}") from None
    # FD_TO_CLOCKID of clock_getres(2): a dynamic clock is named by its open file.
    number = (~file << 3) | 3

    def read() -> int:
        try:
            return time.clock_gettime_ns(number)
        except OSError as error:
            reason = f"cannot read '{device}' as a PTP hardware clock: {error.strerror}"
            raise UserError(reason) from None

    return with_seconds_of(time.time_ns, read)


def with_seconds_of(system: Callable[[], int], clock: Callable[[], int]) -> Callable[[], int]:
    """Return a clock less its distance from another one, as it is now, in whole seconds."""
    ahead = round((clock() - system()) / SECOND_NS) * SECOND_NS
    return lambda: clock() - ahead


def _limited(correction: float) -> float:
    return max(-MOST_CORRECTION, min(MOST_CORRECTION, correction))
