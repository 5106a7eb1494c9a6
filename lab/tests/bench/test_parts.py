"""Figures of packet parts."""

from __future__ import annotations

import pytest

from firm_hdl.bench import Device
from lab.bench.parts import PARTS, run_parts

NAMES = [f"{part.name}, {part.parameters}" for part in PARTS]
WIDTH = NAMES.index("`PacketWidth`, 8 to 1 bytes")


@pytest.mark.thorough
def test_a_part_is_mapped(ecp5: Device) -> None:
    (found,) = run_parts(parts=[WIDTH], seeds=(), jobs=1)
    assert found.problem == "" and found.measured is not None
    assert found.part == PARTS[WIDTH]
    # A word that is sent byte by byte, and the byte that is sent, are registers.
    assert found.measured.area.ff >= 72 and found.measured.device == ecp5
