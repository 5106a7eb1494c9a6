# amaranth: UnusedElaboratable=no
"""The statuses of a parser, in the tables of a deserializer that were made by hand."""

from __future__ import annotations

import pytest

from firm_hdl import Parser
from tests.depth import by_depth
from tests.gateware.test_parser import run
from tests.gateware.test_status_table import LAST, MESSAGE, READ, READ_LAST, STALLS, packet


@pytest.mark.parametrize(
    ("message", "table", "bus_bytes"),
    [*((MESSAGE, READ, width) for width in by_depth((8,), (1, 8, 64))), (LAST, READ_LAST, 16)],
    ids=lambda value: value if isinstance(value, int) else "",
)
def test_the_first_error_of_a_packet_in_wire_order_is_its_status(message, table, bus_bytes):
    good = table[0]
    rows = [row for each in table for row in (each, good)]
    stalls = {"packets": STALLS[1]["packets_in"], "status": STALLS[1]["status"]}
    parser = Parser(message, bus_bytes=bus_bytes)
    for options in ({}, {"stalls": stalls}):
        seen = run(parser, [packet(text) for text, _, _ in rows], **options)
        for (text, status, _), reported in zip(rows, seen.statuses, strict=True):
            assert reported.name == status, text
