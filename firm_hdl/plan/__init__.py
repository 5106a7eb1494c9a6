"""The plan of a converter: what it does in each cycle, decided before there is any circuit."""

from firm_hdl.plan.build import BUS_BYTES, DEFAULT_MAX_MESSAGE_BYTES, build_plan
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

__all__ = [
    "BUS_BYTES",
    "DEFAULT_MAX_MESSAGE_BYTES",
    "RUN_COUNTER",
    "Begin",
    "Exits",
    "Fixed",
    "Jump",
    "Leaf",
    "Pad",
    "Part",
    "Plan",
    "Run",
    "Slice",
    "Step",
    "build_plan",
]
