# amaranth: UnusedElaboratable=no
"""What circuits around the parts rely on: the codes on the wires, and the parameters not given."""

from __future__ import annotations

import pytest

from firm_hdl import (
    GateStatus,
    Status,
)
from firm_hdl.gateware.packets import Outcome

# docs/reference/parts.md; software and other circuits read these numbers.
ERRORS = {"OK": 0, "TRUNCATED": 1, "TRAILING": 2, "LENGTH": 3, "ENCAPSULATION": 4, "STRING": 5}


@pytest.mark.parametrize(
    ("kind", "codes"),
    [
        (Status, ERRORS | {"ITEMS": 6}),
        (GateStatus, ERRORS | {"FULL": 8, "LARGE": 9, "OVERRUN": 10}),
        (Outcome, {"KEPT": 0, "ABORTED": 1, "FULL": 2, "LARGE": 3}),
    ],
)
def test_codes_are_those_of_the_documentation(kind, codes):
    assert {each.name: each.value for each in kind} == codes
