"""The plan: all decisions about a converter, as a list of steps that hardware transcribes.

A plan is a small program over the bytes of a packet. A :class:`MapStep` takes the rest of a run,
then padding, then a fixed number of bytes whose map to leaves is static. A :class:`RunStep` takes a
bus word of items. One plan serves both directions: a deserializer takes the bytes of a step from
the packet and writes leaves, a serializer reads leaves and appends the bytes.

Control flow: steps are in wire order. A step ends in its :class:`Exits`: loop counters are tried
from the innermost outwards, and the first loop that has elements left is repeated. If no loop has,
the plan continues at another step or ends the packet. `MapStep.begin` starts a loop over elements
or a run of items that a length counts. Loops and runs of constant count start in the jump to them.

Runs: only the last bus word of a run that a length counts may be short. This word is the *rest*.
The step after the run takes the rest together with its own bytes, so that the rest costs no cycle.
The counter of the run has the size of the rest: 0 if no run was started, or the run was empty.
"""

from firm_hdl.plan.ir.leaves import (
    ArrayEnd,
    Fixed,
    Leaf,
    LeafKind,
    LoopEnd,
    Pad,
    Part,
    Run,
    Slice,
)
from firm_hdl.plan.ir.plan import Plan
from firm_hdl.plan.ir.steps import (
    RUN_COUNTER,
    Begin,
    BeginLoop,
    BeginRun,
    Claim,
    Exits,
    IntoBody,
    Jump,
    LoopAgain,
    MapStep,
    Next,
    RunStep,
    Step,
    Way,
    successors,
)

__all__ = [
    "RUN_COUNTER",
    "ArrayEnd",
    "Begin",
    "BeginLoop",
    "BeginRun",
    "Claim",
    "Exits",
    "Fixed",
    "IntoBody",
    "Jump",
    "Leaf",
    "LeafKind",
    "LoopAgain",
    "LoopEnd",
    "MapStep",
    "Next",
    "Pad",
    "Part",
    "Plan",
    "Run",
    "RunStep",
    "Slice",
    "Step",
    "Way",
    "successors",
]
