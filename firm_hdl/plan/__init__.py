"""The plan of a converter: what it does in each cycle, decided before there is any circuit."""

from firm_hdl.plan.build import BUS_BYTES, DEFAULT_MAX_MESSAGE_BYTES, build_plan, check_bus_bytes
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
from firm_hdl.plan.ir import (
    RUN_COUNTER,
    Begin,
    Exits,
    Fixed,
    Jump,
    Leaf,
    Pad,
    Part,
    Plan,
    Run,
    Slice,
    Step,
)
from firm_hdl.plan.yaml import from_yaml, to_yaml

__all__ = [
    "BUS_BYTES",
    "DEFAULT_MAX_MESSAGE_BYTES",
    "RUN_COUNTER",
    "Begin",
    "DecodeStatus",
    "Decoded",
    "Edge",
    "EncodeStatus",
    "Exits",
    "Fixed",
    "Jump",
    "Leaf",
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
    "from_yaml",
    "to_yaml",
]
