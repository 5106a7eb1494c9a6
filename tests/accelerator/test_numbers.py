# amaranth: UnusedElaboratable=no
"""Floats and fixed point, against exact fractions.

The conversions were also compared with C and NumPy: docs/howto/floats.md says what was covered.
"""

from __future__ import annotations

import math
import random
import struct
from fractions import Fraction

import pytest
from amaranth.hdl import Cat, Module, Signal
from amaranth.sim import Simulator

from firm_hdl.accelerator import (
    Fixed,
    FixedToFloat,
    FloatToFixed,
    Fork,
    fixed_to_float,
    float_bits,
    float_to_fixed,
)
from firm_hdl.sim import Stalls, receive, send, watch
from tests.gateware.traffic import has_path

SHAPES = [
    *(Fixed(2, 0), Fixed(8, 4), Fixed(16, 8), Fixed(32, 16), Fixed(64, 32)),
    # As wide as a significand, a bit more, and two.
    *(Fixed(24, 10), Fixed(25, 10), Fixed(26, 30), Fixed(53, 20), Fixed(54, 20), Fixed(55, 20)),
    # The largest and the smallest numbers of float32, where denormal ones count.
    *(Fixed(17, 126), Fixed(17, -111)),
]


def number_of(bits, width):
    text = "<If" if width == 32 else "<Qd"
    (number,) = struct.unpack(f"<{text[2]}", struct.pack(f"<{text[1]}", bits))
    return number


def fixed_of(bits, width, shape, rounding):
    number = number_of(bits, width)
    least, most = -(1 << (shape.bits - 1)), (1 << (shape.bits - 1)) - 1
    if math.isnan(number):
        return 0
    if math.isinf(number):
        return most if number > 0 else least
    exact = Fraction(number) * Fraction(2) ** shape.fraction_bits
    return max(least, min(most, round(exact) if rounding == "nearest" else math.trunc(exact)))


def floats(shape, width, count, rng):
    """Yield bits of floats: hard cases of any format, those around the ends of this one, ties."""
    mantissa = 23 if width == 32 else 52
    inf = ((1 << (width - 1 - mantissa)) - 1) << mantissa
    for each in (0, 1, (1 << mantissa) - 1, 1 << mantissa, inf - 1, inf, inf + 1, 2 * inf - 1):
        yield from (each % (1 << (width - 1)), each % (1 << (width - 1)) | 1 << (width - 1))
    unit = Fraction(2) ** -shape.fraction_bits
    end = 1 << (shape.bits - 1)
    halves = [*range(-9, 10), *(s * 2 * end + d for s in (-1, 1) for d in range(-5, 6))]
    for half in halves:
        near = float_bits(float(Fraction(half, 2) * unit), width)
        yield from (near, near ^ 1)
    for _ in range(count):
        yield rng.getrandbits(width)
        places = rng.randrange(-3, shape.bits + 1) - shape.fraction_bits
        yield float_bits(math.ldexp(rng.uniform(-1, 1), places), width)


def rounded(raw, shape, width):
    """Return the bits of the float that is nearest to a fixed-point number."""
    if not raw:
        return 0
    mantissa, bias = (23, 127) if width == 32 else (52, 1023)
    exact = abs(shape.number(raw))
    exponent = abs(raw).bit_length() - 1 - shape.fraction_bits
    # `round` of a fraction takes the even one at a tie.
    significand = round(exact / Fraction(2) ** (exponent - mantissa))
    return (raw < 0) << (width - 1) | ((exponent + bias - 1) << mantissa) + significand


@pytest.mark.sampled(4)
@pytest.mark.parametrize("width", [32, 64])
@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_conversions_are_those_of_exact_numbers(shape, width):
    m = Module()
    number, fixed = Signal(width), Signal(shape)
    nearest = float_to_fixed(m, number, shape)
    cut = float_to_fixed(m, number, shape, rounding="zero")
    back = fixed_to_float(m, fixed, shape.fraction_bits, width)
    rng = random.Random(shape.bits + width)
    end = 1 << (shape.bits - 1)
    raws = [-end, end - 1, 1 - end, 0, 1, -1]
    raws += [rng.randrange(-end, end) >> rng.randrange(shape.bits) for _ in range(30)]

    async def testbench(ctx):
        for bits in floats(shape, width, 30, rng):
            ctx.set(number, bits)
            for found, rounding in ((nearest, "nearest"), (cut, "zero")):
                assert ctx.get(found) == fixed_of(bits, width, shape, rounding), (bits, rounding)
        for raw in raws:
            ctx.set(fixed, raw)
            assert ctx.get(back) == rounded(raw, shape, width), raw

    simulator = Simulator(m)
    simulator.add_testbench(testbench)
    simulator.run()


@pytest.mark.parametrize(
    ("kind", "width", "shape", "latency"),
    [
        (FloatToFixed, 32, Fixed(16, 8), 3),
        (FloatToFixed, 64, Fixed(8, 2), 3),
        (FixedToFloat, 32, Fixed(16, 8), 4),
        (FixedToFloat, 64, Fixed(2, 0), 4),
    ],
)
@pytest.mark.parametrize("stalls", [Stalls.none, Stalls(probability=0.5, seed=1)])
def test_components_do_the_same_with_a_number_per_cycle(kind, width, shape, latency, stalls):
    rng = random.Random(1)
    if kind is FloatToFixed:
        dut = FloatToFixed(width, shape, rounding="zero")
        sent = list(floats(shape, width, 20, rng))
        want = [fixed_of(each, width, shape, "zero") for each in sent]
    else:
        dut = FixedToFloat(shape, width)
        end = 1 << (shape.bits - 1)
        sent = [rng.randrange(-end, end) for _ in range(60)]
        want = [rounded(each, shape, width) for each in sent]
    times = []

    async def source(ctx):
        await send(ctx, dut.i, sent, stalls=stalls)

    async def sink(ctx):
        assert await receive(ctx, dut.o, len(want), stalls=stalls) == want

    async def clock(ctx):
        cycle = 0
        async for *_, i, o in ctx.tick().sample(dut.i.valid & dut.i.ready, dut.o.valid):
            times.append((cycle, i, o))
            cycle += 1

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(source)
    simulator.add_testbench(sink)
    simulator.add_process(clock)
    simulator.add_testbench(watch({"o": dut.o}), background=True)
    simulator.run()
    if stalls is Stalls.none:
        first = next(cycle for cycle, i, _ in times if i)
        assert [cycle for cycle, i, _ in times if i] == list(range(first, first + len(sent)))
        assert next(cycle for cycle, _, o in times if o) == first + latency


@pytest.mark.parametrize(
    "dut", [FloatToFixed(32, Fixed(8, 4)), FixedToFloat(Fixed(8, 4), 32), Fork(8, 3)]
)
def test_no_output_depends_on_an_input_in_the_same_cycle(dut):
    outputs = dut.o if isinstance(dut, Fork) else [dut.o]
    inputs = Cat(dut.i.payload, dut.i.valid, *(each.ready for each in outputs))
    held = [(each.valid, each.payload) for each in outputs]
    assert not has_path(dut, inputs, Cat(dut.i.ready, *held))


@pytest.mark.parametrize("stalls", [Stalls.none, Stalls(probability=0.5, seed=1)])
def test_a_fork_sends_each_transfer_to_all(stalls):
    dut = Fork(8, 3)
    times = []

    async def source(ctx):
        await send(ctx, dut.i, range(50), stalls=stalls, name="i")

    def sink(number):
        async def bench(ctx):
            name = f"o{number}"
            got = await receive(ctx, dut.o[number], 50, stalls=stalls, name=name)
            assert got == list(range(50))

        return bench

    async def clock(ctx):
        async for *_, moved in ctx.tick().sample(dut.o[2].valid & dut.o[2].ready):
            times.append(moved)

    simulator = Simulator(dut)
    simulator.add_clock(1e-8)
    simulator.add_testbench(source)
    for number in range(3):
        simulator.add_testbench(sink(number))
    simulator.add_process(clock)
    simulator.add_testbench(watch({f"o{n}": dut.o[n] for n in range(3)}), background=True)
    simulator.run()
    if stalls is Stalls.none:
        # One per cycle.
        assert "".join(map(str, times)).strip("0") == "1" * 50


def test_constants():
    shape = Fixed(8, 4)
    assert Signal(shape, init=-0.5).init == -8
    # Ties go to the even number.
    assert [shape.raw(each / 32) for each in (1, 3, -1, -3)] == [0, 2, 0, -2]
    assert (shape.number(-8), float(shape.number(3))) == (Fraction(-1, 2), 0.1875)
    assert (float_bits(1.0, 32), float_bits(-2.0, 64)) == (0x3F80_0000, 0xC000 << 48)
    for wrong in (8, -8.1, math.inf, math.nan):
        with pytest.raises(ValueError, match=r"fixed-point|does not fit"):
            shape.raw(wrong)
    with pytest.raises(ValueError, match=r"^1e\+39 is too large for a float of 32 bits$"):
        float_bits(1e39, 32)


def test_formats_are_checked():
    with pytest.raises(ValueError, match=r"from 2 to 64 bits, not 65$"):
        Fixed(65, 0)
    with pytest.raises(TypeError, match=r"^The number of bits must be an integer"):
        Fixed(8.0, 0)
    with pytest.raises(ValueError, match=r"^A float of ROS has 32 or 64 bits, not 16$"):
        FloatToFixed(16, Fixed(8, 0))
    with pytest.raises(ValueError, match="of float32: -119 to 126 bits after the point"):
        FloatToFixed(32, Fixed(9, 127))
    with pytest.raises(TypeError, match=r"^A fixed-point number is signed"):
        fixed_to_float(Module(), Signal(8), 4, 32)
    with pytest.raises(ValueError, match=r"^A fork has at least 1 output, not 0$"):
        Fork(8, 0)
    with pytest.raises(ValueError, match=r"^Rounding must be 'nearest' or 'zero', not 'up'$"):
        float_to_fixed(Module(), Signal(32), Fixed(8, 0), rounding="up")
