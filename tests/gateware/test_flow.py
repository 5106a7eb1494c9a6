# amaranth: UnusedElaboratable=no
"""The control flow of plans: the same steps as the interpreter, through loops and runs."""

from __future__ import annotations

import random

import pytest
from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator

from firm_hdl.gateware.flow import Flow, exceeds, last_word
from firm_hdl.plan import RunStep, build_plan, decode
from firm_hdl.wire import lay_out
from tests.gateware.traffic import random_packets
from tests.strategies import make

TEXT = make("ros1", {"s": "string"}, "Text")
NUL_TEXT = make("ros2", {"s": "string"}, "Text")
ROW = make("ros1", {"texts": (TEXT, "[]"), "m": "float64[4]"}, "Row")
POINT = make("ros1", {"x": "uint32", "y": "uint32"}, "Point")
MESSAGES = {
    "fixed": make("ros1", {"a": "uint64", "b": "uint64", "c": "uint64"}),
    "constant counts": make("ros1", {"a": "uint8[37]", "p": (POINT, "[3]"), "b": "float64[5]"}),
    "a long run first": make("ros1", {"a": "uint8[300]", "b": "float64[3]", "c": "uint8[64]"}),
    "begins with a count": make("ros1", {"p": (ROW, "[2]"), "z": "uint8"}),
    # The step is in two registers.
    "many steps": make("ros1", {f"f{n}": ("uint64", "string")[n == 34] for n in range(40)}),
    "nested": make("ros1", {"rows": (ROW, "[]"), "s": "string", "t": (TEXT, "[]")}),
    # Lengths of strings count a NUL, others do not.
    "with NUL": make(
        "ros2", {"s": "string", "b": "uint8[]", "t": (NUL_TEXT, "[]"), "w": "uint16[]"}
    ),
}


class Walk(wiring.Component):
    """A flow that moves whenever `moves` is high.

    Parameters
    ----------
    plan : Plan
    most : int
        The largest length that is counted.

    Members
    -------
    moves : In(1)
    begins : In(1)
        The step begins a run or a loop, of `count` words or elements.
    count : In(16)
    single, skips : In(1)
        The body has one word or element; it is left out.
    step : Out(steps)
        One bit per step.
    trait : Out(1)
        The trait of the step: it is the body of a run.
    """

    def __init__(self, plan, most):
        self.plan, self.most = plan, most
        inputs = dict.fromkeys(("moves", "begins", "single", "skips"), In(1)) | {"count": In(16)}
        outputs = {"step": Out(len(plan.steps)), "trait": Out(1)}
        super().__init__(inputs | outputs)

    def elaborate(self, platform):
        m = Module()
        runs = [isinstance(step, RunStep) for step in self.plan.steps]
        flow = Flow(
            m,
            self.plan,
            lambda begin: self.most,
            {"is_run": 1},
            lambda index: {"is_run": runs[index]} if index is not None else {},
            has_end=False,
        )
        done, ends = Signal(), Signal()
        m.d.comb += [
            done.eq(Mux(flow.traits.is_run, flow.words.last, ~self.begins | self.skips)),
            ends.eq(done & flow.exit_ends),
            self.step.eq(Cat(flow.step)),
            self.trait.eq(flow.traits.is_run),
        ]
        flow.count(
            moves=self.moves,
            ends=ends,
            done=done,
            count=self.count,
            single=self.single,
            nul=True,
        )
        with m.If(self.moves):
            flow.go(ends=ends, done=done)
        return m


def walk(plan, packets, tamper=lambda length: length):
    """Compare the steps of a flow with those of the interpreter; `tamper` changes lengths."""
    found = [decode(plan, packet).streams for packet in packets]
    lengths = [length for each in found for leaf in plan.begins for length in each.get(leaf, [])]
    # With a NUL.
    dut, rng, steps = Walk(plan, max(lengths, default=0) + 1), random.Random(1), 0

    async def testbench(ctx):
        nonlocal steps
        for packet in packets:
            decoded = decode(plan, packet)
            lengths = {leaf: iter(decoded.streams.get(leaf, [])) for leaf in plan.begins}
            for visit in decoded.steps:
                step = plan.steps[visit.step]
                assert ctx.get(dut.step) == 1 << visit.step
                assert ctx.get(dut.trait) == isinstance(step, RunStep)
                ctx.set(dut.begins, step.begin is not None)
                if step.begin is not None:
                    length = tamper(next(lengths[step.begin.length]))
                    is_loop = not hasattr(step.begin, "run")
                    lanes = 1 if is_loop else plan.leaves[plan.runs[step.begin.run].items].lanes
                    # The last word of a run is not in its body.
                    turns = length if is_loop else max(0, -(-length // lanes) - 1)
                    nul = not is_loop and plan.runs[step.begin.run].terminated
                    ctx.set(dut.count, length + nul)
                    ctx.set(dut.skips, turns == 0)
                    ctx.set(dut.single, turns == 1)
                for moves in [0] * rng.choice((0, 0, 0, 2)) + [1]:
                    ctx.set(dut.moves, moves)
                    await ctx.tick()
                steps += 1
        assert ctx.get(dut.step) == 1 << (plan.start.step or 0)

    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()
    return steps


@pytest.mark.parametrize("bus_bytes", [1, 4, 8, 16])
@pytest.mark.parametrize("name", MESSAGES)
@pytest.mark.sampled(2)
def test_steps_are_those_of_the_interpreter(name, bus_bytes):
    plan = build_plan(lay_out(MESSAGES[name]), bus_bytes=bus_bytes)
    assert walk(plan, random_packets(plan, 12)) >= 12


def test_another_length_is_another_way():
    plan = build_plan(lay_out(MESSAGES["nested"]), bus_bytes=8)
    with pytest.raises((AssertionError, StopIteration)):
        walk(plan, random_packets(plan, 12), tamper=lambda length: length + 1)


@pytest.mark.parametrize("limit", [0, 1, 5, 7, 8, 100, 127, 128, 254, 255, 256, 1000])
def test_exceeds_is_a_comparison(limit):
    class Compare(wiring.Component):
        def __init__(self):
            super().__init__({"value": In(8), "above": Out(1)})

        def elaborate(self, platform):
            m = Module()
            m.d.comb += self.above.eq(exceeds(self.value, limit))
            return m

    dut = Compare()

    async def testbench(ctx):
        for value in range(256):
            ctx.set(dut.value, value)
            assert ctx.get(dut.above) == (value > limit)

    simulator = Simulator(dut)
    simulator.add_testbench(testbench)
    simulator.run()


@pytest.mark.parametrize("lanes", [1, 2, 8])
def test_the_last_word_has_what_whole_words_leave(lanes):
    items, left = Signal(8), Signal(8)
    m = Module()
    m.d.comb += left.eq(last_word(items, lanes))

    async def testbench(ctx):
        for count in range(1, 40):
            ctx.set(items, count)
            assert ctx.get(left) == count - (count - 1) // lanes * lanes

    simulator = Simulator(m)
    simulator.add_testbench(testbench)
    simulator.run()
