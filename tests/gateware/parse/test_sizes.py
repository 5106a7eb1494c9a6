# amaranth: UnusedElaboratable=no
"""The sizes of packets, while as many of them wait in a parser as have room."""

from __future__ import annotations

import random

import pytest

from firm_hdl import Parser, load_message
from firm_hdl.sim import Stalls
from tests.gateware.test_parser import run


@pytest.mark.parametrize("bus_bytes", [4, 64])
def test_sizes_of_packets_that_wait_for_their_status_are_kept(bus_bytes):
    parser = Parser(load_message("std_msgs/UInt8", distro="noetic"), bus_bytes=bus_bytes)
    rng = random.Random(bus_bytes)
    packets = [bytes(rng.randint(1, bus_bytes)) for _ in range(60)]
    # The ring is full of packets of a beat, and three more have been judged.
    stalls = {"status": Stalls.bits("0" * 60 + "1" * 300)}
    assert run(parser, packets, stalls=stalls).sizes == [len(packet) for packet in packets]
