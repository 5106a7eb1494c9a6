"""Residue sets, compared with brute force over offsets."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firm_hdl.wire import residues as rs

sets = st.integers(1, rs.ALL)
aligns = st.sampled_from([1, 2, 4, 8])


def mask(offsets):
    return sum({1 << (offset % 8) for offset in offsets})


def offsets(residues):
    """Return some offsets of each residue, well above zero."""
    return [8 * k + r for k in (0, 3) for r in range(8) if residues >> r & 1]


@given(residues=sets, count=st.integers(0, 1000))
def test_advance_moves_every_offset(residues, count):
    assert rs.advance(residues, count) == mask(at + count for at in offsets(residues))


@given(residues=sets, align=aligns)
def test_aligned_pads_every_offset_to_the_next_multiple(residues, align):
    assert rs.aligned(residues, align) == mask(
        next(there for there in range(at, at + align) if there % align == 0)
        for at in offsets(residues)
    )


@given(residues=sets, align=aligns)
def test_pad_of_is_known_exactly_when_all_offsets_need_the_same(residues, align):
    pads = {-at % align for at in offsets(residues)}
    assert rs.pad_of(residues, align) == (pads.pop() if len(pads) == 1 else None)


@given(residues=sets, unit=st.integers(1, 16))
def test_spread_reaches_every_number_of_units_and_no_more(residues, unit):
    assert rs.spread(residues, unit) == mask(
        at + n * unit for at in offsets(residues) for n in range(17)
    )


def mask_of(offsets, modulus):
    return sum({1 << (offset % modulus) for offset in offsets})


@given(data=st.data(), modulus=st.sampled_from([1, 2, 4, 16, 64]))
def test_sets_may_have_another_modulus(data, modulus):
    """A plan asks for lanes of a bus of 1 to 64 bytes."""
    lanes = data.draw(st.sets(st.integers(0, modulus - 1), min_size=1))
    residues = mask_of(lanes, modulus)
    count = data.draw(st.integers(0, 200))
    want = mask_of((lane + count for lane in lanes), modulus)
    assert rs.advance(residues, count, modulus) == want
    unit = data.draw(st.integers(1, 16))
    want = mask_of((lane + n * unit for lane in lanes for n in range(modulus)), modulus)
    assert rs.spread(residues, unit, modulus) == want
    align = data.draw(aligns)
    want = mask_of((next(at for at in range(lane, lane + 8) if at % align == 0)
                    for lane in lanes), modulus)  # fmt: skip
    assert rs.aligned(residues, align, modulus) == want
    assert rs.single(count, modulus) == 1 << count % modulus


@given(residues=sets)
def test_members_are_the_residues_in_ascending_order(residues):
    assert list(rs.members(residues)) == sorted({at % 8 for at in offsets(residues)})


@given(offset=st.integers(0, 1 << 32))
def test_single_is_the_set_of_one_offset(offset):
    assert list(rs.members(rs.single(offset))) == [offset % 8]


# Any body of a loop is a function of single residues, distributed over union.
bodies = st.lists(sets, min_size=8, max_size=8)


def image(body, residues):
    result = 0
    for r in range(8):
        if residues >> r & 1:
            result |= body[r]
    return result


@given(residues=sets, body=bodies, count=st.integers(1, 600))
def test_repeat_of_a_constant_count_is_the_count_th_image(residues, body, count):
    now, entry = residues, 0
    for _ in range(count):
        entry |= now
        now = image(body, now)
    assert rs.repeat(residues, lambda at: image(body, at), count) == (entry, now)


@given(residues=sets, body=bodies)
def test_repeat_of_an_unknown_count_is_the_union_of_all_images(residues, body):
    now, everything = residues, 0
    for _ in range(300):
        everything |= now
        now = image(body, now)
    assert rs.repeat(residues, lambda at: image(body, at), None) == (everything, everything)


def test_repeat_goes_around_a_cycle_in_its_direction():
    assert rs.repeat(rs.single(0), lambda at: rs.advance(at, 1), 11) == (rs.ALL, rs.single(3))


@pytest.mark.parametrize(
    ("count", "entry", "after"),
    [
        (1, {1}, 0),
        (2, {1, 0}, 4),
        (3, {1, 0, 4}, 0),
        (4, {1, 0, 4}, 4),
        (5, {1, 0, 4}, 0),
        (1000, {1, 0, 4}, 4),
    ],
)
def test_repeat_goes_around_a_cycle_that_its_first_turn_is_no_part_of(count, entry, after):
    """`uint8 x` and then `uint32[count]`: only the first element is padded, from 1 to 4."""
    body = {1 << 1: 1 << 0, 1 << 0: 1 << 4, 1 << 4: 1 << 0}
    assert rs.repeat(rs.single(1), body.__getitem__, count) == (mask(entry), rs.single(after))
