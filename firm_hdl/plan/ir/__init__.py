"""The plan: all decisions about a converter, as a list of steps that hardware transcribes.

A plan is a small program over a window of wire bytes. Each step moves a fixed number of bytes whose
map to leaves is static, and may end in the head of a run of items. One plan serves both directions:
a deserializer takes the bytes of a step from its window and writes leaves, a serializer reads
leaves and appends the bytes.

Control flow: steps are in wire order. A step ends in its :class:`Exits`: loop counters are tried
from the innermost outwards, and the first loop that has elements left is repeated. If no loop has,
the plan continues at another step or ends the packet. `MapStep.begin` starts a loop over elements
or a run of items, which a length or a constant counts.
"""

from firm_hdl.plan.ir.leaves import Fixed, Leaf, LeafKind, Pad, Part, Run, Slice
from firm_hdl.plan.ir.plan import Plan
from firm_hdl.plan.ir.steps import (
    RUN_COUNTER,
    Begin,
    BeginArray,
    BeginLoop,
    BeginRun,
    CountedBegin,
    Exits,
    Jump,
    MapStep,
    RunStep,
    Step,
    Take,
)

__all__ = [
    "RUN_COUNTER",
    "Begin",
    "BeginArray",
    "BeginLoop",
    "BeginRun",
    "CountedBegin",
    "Exits",
    "Fixed",
    "Jump",
    "Leaf",
    "LeafKind",
    "MapStep",
    "Pad",
    "Part",
    "Plan",
    "Run",
    "RunStep",
    "Slice",
    "Step",
    "Take",
]
