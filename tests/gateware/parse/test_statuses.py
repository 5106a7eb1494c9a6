# amaranth: UnusedElaboratable=no
"""The statuses of a parser, in the tables of a deserializer that were made by hand."""

from __future__ import annotations

import pytest

from firm_hdl import Parser
from tests.gateware.test_parser import run
from tests.gateware.test_status_table import (
    LAST,
    MESSAGE,
    READ,
    READ_LAST,
    every_bus,
    packet,
    stalls_on,
)


@pytest.mark.parametrize(
    ("message", "table"), [(MESSAGE, READ), (LAST, READ_LAST)], ids=["", "last"]
)
@every_bus
@pytest.mark.sampled(3)
def test_the_first_error_of_a_packet_in_wire_order_is_its_status(message, table, bus_bytes):
    good = table[0]
    rows = [row for each in table for row in (each, good)]
    parser = Parser(message, bus_bytes=bus_bytes)
    for plan in stalls_on(bus_bytes):
        stalls = plan and {"packets": plan["packets_in"], "status": plan["status"]}
        seen = run(parser, [packet(text) for text, _, _ in rows], stalls=stalls)
        for (text, status, _), reported in zip(rows, seen.statuses, strict=True):
            assert reported.name == status, text
