# amaranth: UnusedElaboratable=no
"""A serializer and messages with errors: the first error counts, and the next packets are right."""

from __future__ import annotations

from itertools import product

import pytest

from firm_hdl import Serializer
from firm_hdl.plan import encode
from firm_hdl.sim import Harness
from tests.strategies import make


@pytest.mark.parametrize("bus_bytes", [1, 2, 4])
def test_padding_is_right_after_a_message_with_an_error(bus_bytes):
    """On narrow buses, padding depends on where in 8 bytes the packet before has ended."""
    message = make("ros2", {"a": "uint8[<=9]", "d": "float64", "b": "uint8[]"})
    tx = Serializer(message, bus_bytes=bus_bytes)
    lanes = next(leaf.lanes for leaf in tx.plan.leaves if leaf.kind == "items")
    leaves = {str(leaf): number for number, leaf in enumerate(tx.plan.leaves)}

    def items(count, is_wrong=False):
        words = [tuple(range(1, lanes + 1))] * -(-count // lanes)
        return [(word, (at == len(words) - 1) ^ is_wrong) for at, word in enumerate(words)]

    messages = [
        {
            leaves["a.length"]: [first],
            leaves["a.items"]: items(first),
            leaves["d"]: [0x0102030405060708],
            leaves["b.length"]: [last],
            # One message in two has an error at its end.
            leaves["b.items"]: items(last, is_wrong=number % 2 == 0),
        }
        for number, (first, last) in enumerate(product((1, 2, 4, 9), (1, 2, 3, 4, 6, 7)))
    ]
    want = [encode(tx.plan, each) for each in messages]
    assert {status for _, status in want} == {"OK", "ITEMS"}
    seen = Harness(None, tx, message=message).run_messages(messages)
    assert seen.packets == [packet for packet, _ in want]
    assert [status.name for status in seen.statuses] == [status for _, status in want]


@pytest.mark.parametrize("bus_bytes", [1, 8])
def test_the_first_error_in_wire_order_is_the_status(bus_bytes):
    """The items of one field and the length of the next one may be taken in one step."""
    message = make("ros2", {"s": "uint8[<=9]", "t": "uint8[<=3]", "u": "uint8[<=9]"})
    tx = Serializer(message, bus_bytes=bus_bytes)
    leaves = {str(leaf): number for number, leaf in enumerate(tx.plan.leaves)}

    def field(name, count, is_wrong=False):
        words = -(-count // bus_bytes)
        items = [((1,) * bus_bytes, (at == words - 1) ^ is_wrong) for at in range(words)]
        return {leaves[f"{name}.length"]: [count], leaves[f"{name}.items"]: items}

    flags = list(product((False, True), repeat=3))
    messages = [
        field("s", 2, wrong) | field("t", 4 if is_over else 3) | field("u", 2, last_wrong)
        for wrong, is_over, last_wrong in flags
    ]
    errors = ("ITEMS", "LENGTH", "ITEMS")
    want = [next((e for e, on in zip(errors, each, strict=True) if on), "OK") for each in flags]
    seen = Harness(None, tx, message=message).run_messages(messages)
    assert [status.name for status in seen.statuses] == want
