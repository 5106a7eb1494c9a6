"""The plan of a converter: its work in each cycle, decided before any circuit is built."""

from firm_hdl.plan.build import build_plan
from firm_hdl.plan.check import check
from firm_hdl.plan.interpret import (
    Decoded,
    DecodeStatus,
    Edge,
    EncodeStatus,
    Payload,
    Transfer,
    Visit,
    decode,
    encode,
)
from firm_hdl.plan.limits import BUS_BYTES, DEFAULT_MAX_MESSAGE_BYTES, check_bus_bytes
from firm_hdl.plan.tree import (
    DIRECTIONS,
    Charge,
    Constant,
    Count,
    Direction,
    Fixed,
    Item,
    Leaf,
    Length,
    Loop,
    Pad,
    Part,
    Plan,
    Run,
    Slice,
    Step,
)
from firm_hdl.plan.yaml import to_yaml

__all__ = [
    "BUS_BYTES",
    "DEFAULT_MAX_MESSAGE_BYTES",
    "DIRECTIONS",
    "Charge",
    "Constant",
    "Count",
    "DecodeStatus",
    "Decoded",
    "Direction",
    "Edge",
    "EncodeStatus",
    "Fixed",
    "Item",
    "Leaf",
    "Length",
    "Loop",
    "Pad",
    "Part",
    "Payload",
    "Plan",
    "Run",
    "Slice",
    "Step",
    "Transfer",
    "Visit",
    "build_plan",
    "check",
    "check_bus_bytes",
    "decode",
    "encode",
    "to_yaml",
]
