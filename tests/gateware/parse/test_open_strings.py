# amaranth: UnusedElaboratable=no
"""A string whose last byte is not NUL transfers as a whole: docs/reference/status.md."""

from __future__ import annotations

import pytest

from tests.depth import by_depth
from tests.gateware.test_status_table import HEAD, check_reading
from tests.strategies import make

LETTERS = b"abcdefghijklmnopqrstuvwxyz"


def with_length(text: bytes) -> str:
    """Return the length of a string on CDR, and its bytes, without padding."""
    return (len(text).to_bytes(4, "little") + text).hex()


@pytest.mark.parametrize("bus_bytes", by_depth([1, 8], [1, 4, 8]))
@pytest.mark.parametrize("end", ["", "uint8"])
@pytest.mark.sampled(4)
def test_all_characters_before_the_wrong_byte_transfer(bus_bytes, end):
    last = "07" if end else ""
    fields = {"s": "string"} | ({"z": end} if end else {})
    nothing = {"z": 0} if end else {}
    table = [(HEAD + with_length(b"ok\0") + last, "OK", {"s": "ok"} | ({"z": 7} if end else {}))]
    for size in range(2 * bus_bytes + 3):
        text = LETTERS[:size]
        table.append(
            (HEAD + with_length(text + b"x") + last, "STRING", {"s": text.decode()} | nothing)
        )
    check_reading(make("ros2", fields), table, bus_bytes)
