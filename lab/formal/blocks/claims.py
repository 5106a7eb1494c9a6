"""Claims about the budget of nested lengths: which length claims more than is left, and when.

The surroundings execute any steps of a plan, with any lengths that are legal by themselves. They
keep the budget with one multiplication and one subtraction per length; the block has a pipeline,
in which a multiplication is a sum of shifted lengths.
"""

from __future__ import annotations

from typing import Any, cast

from amaranth.hdl import Array, Cat, Mux, Signal, Value

from firm_hdl.frontend import load_message
from firm_hdl.gateware.parse.budget import Budget
from firm_hdl.plan import Charge, Length, Plan, build_plan
from firm_hdl.program import deserializer_program
from firm_hdl.wire import lay_out
from lab.formal.bugs import Bug
from lab.formal.catalog import Claim, Study
from lab.formal.scene import Scene

__all__ = ["studies"]

# Elements of 12 bytes, 16 - 4; and of 16 bytes with padding, so that lengths claim 14 bytes less.
_TYPES = {"noetic": "std_msgs/UInt8MultiArray", "lyrical": "sensor_msgs/msg/PointCloud2"}
MOST_BYTES = 700
"""`max_message_bytes`: lengths that claim 256 bytes or more are counted, so two fit."""

LATENCY = 3
"""Cycles from a step to the cycle that takes its claim from the budget."""


def _charged(plan: Plan) -> list[tuple[int, Length, Charge]]:
    """Return the steps with a length that is charged."""
    return [
        (index, begin.count, begin.count.charge)
        for index, begin in plan.begins.items()
        if isinstance(begin.count, Length) and begin.count.charge is not None
    ]


def _late(scene: Scene, value: Value, cycles: int, name: str) -> Value:
    for cycle in range(cycles):
        value = scene.was(value, f"{name}_{cycle}")
    return value


class _Steps:
    """Any steps: each stays until it is executed.

    Attributes
    ----------
    number : Value
        Which of the steps with a claim this is; one more stands for all other steps.
    issue, bad, counted : Signal
        The step is executed; the packet has an error; the step's length is counted.
    starts : Value
        A length is executed that takes something from the budget.
    count : Signal
        The length of the step of the cycle before.
    """

    def __init__(self, scene: Scene, plan: Plan, begins: list[tuple[int, Length, Charge]]):
        choice = scene.free(range(len(begins) + 1), "step_choice")
        scene.assume(choice <= len(begins))
        self.issue, self.bad = scene.free(1, "issue"), scene.free(1, "bad")
        kept = scene.was(cast("Any", self.issue), "issue")
        number = Signal.like(choice, name="number")
        before = scene.was(number, "number")
        scene.m.d.comb += number.eq(Mux(kept | scene.first, choice, before))
        self.number = number
        self.counted = scene.free(1, "counted")
        self.starts = self.issue & self.counted & ~self.bad & (number < len(begins))
        most = max(length.most for _, length, _ in begins)
        self.count = scene.free(range(most + 1), "count")
        # What is counted is large enough, and not over its limit.
        largest = Array([*(length.most for _, length, _ in begins), 0])
        least = Array([*(charge.charged_from for _, _, charge in begins), 0])
        started = scene.was(self.starts, "starts")
        fits = (self.count >= least[before]) & (self.count <= largest[before])
        scene.assume(~started | fits)
        self.step = Signal(len(plan.steps) + 1, name="step")
        for place, (index, _, _) in enumerate(begins):
            scene.m.d.comb += self.step[index].eq(number == place)


def _study(distro: str) -> Study:
    name = _TYPES[distro]

    def build(scene: Scene) -> None:
        layout = lay_out(load_message(name, distro=distro))
        plan = build_plan(layout, bus_bytes=8, max_message_bytes=MOST_BYTES)
        begins = _charged(plan)
        steps = _Steps(scene, plan, begins)
        scene.m.submodules.block = block = Budget(deserializer_program(plan))
        scene.m.d.comb += [
            block.step.eq(steps.step),
            block.starts.eq(steps.starts),
            block.count.eq(steps.count),
        ]
        _check(scene, block, steps, begins)

    claims = (
        Claim("fails", _FAILS[distro]),
        Claim("pending", Bug(Budget.elaborate, "multiplies | exceeds", "multiplies")),
    )
    return Study(
        f"claims-{distro}",
        f"`Budget` of {name} ({distro}), budget of at most {MOST_BYTES} bytes",
        build,
        claims,
    )


def _check(
    scene: Scene, block: Budget, steps: _Steps, begins: list[tuple[int, Length, Charge]]
) -> None:
    m = scene.m
    claims = [charge for _, _, charge in begins]
    number = _late(scene, steps.number, LATENCY, "number_late")
    starts = _late(scene, steps.starts, LATENCY, "starts_late")
    count = _late(scene, Value.cast(steps.count), LATENCY - 1, "count_late")
    issued = _late(scene, Value.cast(steps.issue), LATENCY, "issue_late")
    # After a length that failed, until the budget is renewed, nothing is claimed of later ones.
    width = len(steps.count) + 8
    budget, known = Signal(width, name="budget"), Signal(name="known")
    sizes = Array([*(claim.bytes for claim in claims), 0])
    totals = Array([*(claim.budget or 0 for claim in claims), 0])
    renews = Array([*(int(claim.budget is not None) for claim in claims), 0])[number]
    saved = max(claim.padding_credit for claim in claims)
    now, left = Signal(width, name="budget_now"), Signal(width + 1, name="budget_left")
    exceeds, is_known = Signal(name="ref_exceeds"), Signal(name="known_now")
    m.d.comb += [
        now.eq(Mux(renews, totals[number], budget)),
        is_known.eq(known | renews),
        left.eq(now + saved - count * sizes[number]),
        exceeds.eq(starts & left[-1]),
    ]
    with m.If(issued):
        m.d.sync += [budget.eq(Mux(starts, left[:width], now)), known.eq(is_known & ~exceeds)]
    judged = scene.was(starts & is_known, "judged")
    fails = scene.was(exceeds, "fails")
    none = ~scene.was(starts, "any")
    scene.claim("fails", ~judged | (block.fails == fails))
    scene.claim("fails", ~(none & block.fails))
    recent = Cat(_late(scene, steps.starts, cycle, f"recent_{cycle}") for cycle in (1, 2, 3)).any()
    scene.claim("pending", block.pending == (recent | block.fails))


_FAILS = {
    "noetic": Bug(Budget.elaborate, "Mux(renewed, total, remaining)", "Mux(renewed, total, total)"),
    "lyrical": Bug(Budget.elaborate, "added, padding_credit", "added, -padding_credit"),
}


def studies() -> list[Study]:
    """Return the studies of the budget of nested lengths."""
    return [_study(distro) for distro in _TYPES]
