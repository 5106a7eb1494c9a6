"""Positions of bytes in the ring, and the logic that computes with them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data

from firm_hdl.names.attributes import REMARK
from firm_hdl.plan import Plan
from firm_hdl.program import align_addend
from firm_hdl.timing.rings import ring_beats

__all__ = [
    "Ring",
    "align_up",
    "any_of",
    "beat_layout",
    "constant_low_lane_bits",
    "named",
    "pick",
    "rotate",
    "sum_of_three",
]


class Ring:
    """The shape of positions: a lane of a bus word, the word's slot in the ring, and a lap bit::

        | lap | slot | lane |      8 words of 8 bytes: 1 + 3 + 3 bits
        |<- beat --->|

    A position is a number of `bits` bits, with the lane in the lowest ones and the lap bit in the
    highest one. It counts bytes and wraps around. The sign of the difference compares two positions
    that are less than `depth` words apart.
    """

    def __init__(self, plan: Plan):
        self.plan = plan
        self.bus = plan.bus_bytes
        # Words of the ring: a power of two. A step touches fewer words.
        self.depth = ring_beats(self.bus)
        # Bits of the lane, of the slot with the lap bit, and of a whole position.
        self.lane_bits = self.bus.bit_length() - 1
        self.beat_bits = self.depth.bit_length()
        self.bits = self.lane_bits + self.beat_bits

    def position(self, name: str, *, init: int = 0, remark: str = "") -> Signal:
        """Make a signal for a position."""
        attrs = {REMARK: remark} if remark else None
        return Signal(self.bits, name=name, init=init, attrs=attrs)

    def lane(self, position: Value) -> Value:
        """Return the lane of a byte in its bus word."""
        return position[: self.lane_bits]

    def beat(self, position: Value) -> Value:
        """Return the slot of the byte's word, with the lap bit."""
        return position[self.lane_bits :]

    def slot(self, position: Value) -> Value:
        """Return the slot of the byte's word in the ring, without the lap bit."""
        return position[self.lane_bits : self.bits - 1]


def beat_layout(plan: Plan) -> data.StructLayout:
    """Return the shape of a beat that is written to the packet buffer.

    Members
    -------
    data : unsigned(8 * bus_bytes)
    count : range(bus_bytes + 1)
        Valid bytes; only used if `last`.
    last : unsigned(1)
    at : beat
        Slot in which the beat is written, with the lap bit.
    valid : unsigned(1)
        The beat is written in this cycle.
    """
    bus = plan.bus_bytes
    return data.StructLayout(
        {
            "data": 8 * bus,
            "count": range(bus + 1),
            "last": 1,
            "at": Ring(plan).beat_bits,
            "valid": 1,
        }
    )


def named(m: Module, name: str, value: Value, remark: str = "") -> Signal:
    """Give a value a name in the circuit's text, and perhaps a comment beside the name."""
    signal = Signal(len(value), name=name, attrs={REMARK: remark} if remark else None)
    m.d.comb += signal.eq(value)
    return signal


def align_up(
    m: Module,
    name: str,
    value: Value,
    distance: Value | int,
    align: int,
    phase: Value | int,
    shift: int = 0,
) -> Value:
    """Return `value + distance`, rounded up to an aligned position, plus `shift`.

    All positions are modulo `2 ** len(value)`.

    * `name`: prefix of the names of signals: of the sum before the rounding, for example.
    * `align`: a power of two, at most 8. Aligned positions are `phase` plus a multiple of `align`.
    * `phase`: with a constant, the logic has one carry chain.
    * `shift`: bytes to add after the rounding; a constant, so that it needs no addition of its own.
    """
    total = Signal(len(value), name=f"{name}_sum")
    if align == 1:
        m.d.comb += total.eq(value + distance + shift)
        return total
    if isinstance(phase, int):
        low = align.bit_length() - 1
        m.d.comb += total.eq(value + (distance + align_addend(align, phase, shift)))
        return Cat(Const((phase + shift) % align, low), total[low:])
    pad = Signal(3, name=f"{name}_pad")
    result = Signal(len(value), name=f"{name}_aligned")
    m.d.comb += [
        total.eq(value + distance),
        pad.eq((phase - total) & (align - 1)),
        result.eq(total + pad + shift),
    ]
    return result


def pick(cases: Iterable[tuple[Value, Value | int]], width: int) -> Value:
    """Select a value by signals of which at most one is high: an AND-OR without priority.

    * `cases`: the signal, of one bit, and the value. Values shorter than `width` are extended with
      zeros; longer ones are cut.
    * `width`: bits of the result, which is 0 if no signal is high.
    """
    constants: list[list[Value]] = [[] for _ in range(width)]
    picked: list[Value] = []
    for chosen, value in cases:
        if isinstance(value, int):
            for k in range(width):
                if value >> k & 1:
                    constants[k].append(chosen)
        else:
            picked.append(Mux(chosen, value[:width], 0))
    if any(constants) or not picked:
        picked.append(Cat(any_of(column) for column in constants))
    # A tree: a plan has hundreds of steps, and expressions must not be nested so deeply.
    while len(picked) > 1:
        pairs = zip(picked[::2], picked[1::2], strict=False)
        picked = [a | b for a, b in pairs] + picked[len(picked) & ~1 :]
    (result,) = picked
    return result[:width] if len(result) >= width else Cat(result, Const(0, width - len(result)))


def any_of(values: Sequence[Value]) -> Value:
    """Return whether any bit of the values is high; 0 if there are none."""
    return Cat(values).any() if values else Const(0, 1)


def rotate(
    m: Module, value: Value, lane: Value, lanes: Sequence[int], name: str, *, back: bool = False
) -> Value:
    """Rotate a bus word so that the byte of a lane comes to lane 0.

    With `back`, the byte of lane 0 comes to that lane. There is one stage for each bit of `lane`
    that is not constant: fewer stages with wider multiplexers need more cells, and are not faster.

    * `value`: the bus word, 8 bits per lane.
    * `lane`: number of the lane; `log2(lanes of the bus word)` bits.
    * `lanes`: possible values of `lane`; others are don't care.
    * `name`: prefix of the stages' signals; the suffix is the bit of `lane` that selects.
    """
    count = len(value) // 8

    def turned(value: Value, lane: int) -> Value:
        at = 8 * ((-lane if back else lane) % count)
        return Cat(value, value)[at : at + len(value)]

    first, known = constant_low_lane_bits(lanes, count)
    now = turned(value, first)
    for bit in reversed(range(known, count.bit_length() - 1)):
        result = Signal(len(value), name=f"{name}_{bit}")
        m.d.comb += result.eq(Mux(lane[bit], turned(now, 1 << bit), now))
        now = result
    return now


def constant_low_lane_bits(lanes: Sequence[int], bus_bytes: int) -> tuple[int, int]:
    """Return the low bits that are equal in all lanes: their value and their number."""
    common = bus_bytes
    while any(lane % common != lanes[0] % common for lane in lanes):
        common //= 2
    return lanes[0] % common, common.bit_length() - 1


def sum_of_three(m: Module, name: str, a: Value, b: Value, c: Value) -> Value:
    """Return a sum modulo `2 ** len(a)` with one carry chain; `b` and `c` are sign-extended.

    The sum of three bits at each place is a bit at this place and a carry to the next one.
    """
    width = len(a)
    b, c = (Cat(x, x[-1].replicate(width))[:width] for x in (b, c))
    carry = named(
        m,
        f"{name}_carries",
        ((a & b) | (a & c) | (b & c))[:-1],
        "of the sum of three numbers, bit by bit; one addition is left",
    )
    return named(m, f"{name}_without_carries", a ^ b ^ c) + Cat(Const(0, 1), carry)
