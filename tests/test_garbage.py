"""The search for reference cycles, put off while a block runs."""

from __future__ import annotations

import gc
import weakref

import pytest

from firm_hdl.garbage import search_put_off


@pytest.fixture(autouse=True)
def searches():
    """Let Python search as it does by default, but not what other tests have left: that is much."""
    before = gc.get_threshold()
    gc.freeze()
    gc.set_threshold(700, 10, 10)
    yield
    gc.set_threshold(*before)


class Ring:
    """An object that refers to itself, so that only a search frees it."""

    def __init__(self) -> None:
        self.itself = self


def rings(count: int) -> list[weakref.ref[Ring]]:
    return [weakref.ref(Ring()) for _ in range(count)]


def test_cycles_are_freed_when_the_block_ends_and_not_before():
    with search_put_off():
        # Far more than Python makes between two searches.
        made = rings(10_000)
        assert all(ring() is not None for ring in made)
    assert gc.isenabled()
    # Python searches when the next object is made.
    rings(1)
    assert all(ring() is None for ring in made)


def test_without_a_block_cycles_are_freed_while_they_are_made():
    assert any(ring() is None for ring in rings(10_000))


def test_an_error_ends_the_block_and_is_reported_before_anything_is_freed():
    made = []
    with pytest.raises(KeyError), search_put_off():
        made += rings(1)
        raise KeyError
    assert gc.isenabled()
    assert made[0]() is not None


def test_a_block_inside_another_changes_nothing():
    with search_put_off():
        with search_put_off():
            made = rings(1)
        assert not gc.isenabled()
        assert made[0]() is not None


def test_a_program_without_the_search_stays_without():
    gc.disable()
    try:
        with search_put_off():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()
