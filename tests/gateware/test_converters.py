# amaranth: UnusedElaboratable=no
"""Both converters, compared with the bytes of rosbags and with the interpreter of the plan."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from firm_hdl import Deserializer, Serializer, Status
from firm_hdl.plan import decode, encode
from firm_hdl.sim import Harness, RunOptions, Stalls, to_transfers
from firm_hdl.sim.transfers import join_transfers
from firm_hdl.wire import lay_out
from tests.depth import by_depth
from tests.gateware.traffic import is_quick
from tests.plan.test_random_messages import damaged, serialize, typed_values
from tests.strategies import BUS_WIDTHS, make, values

few = settings(
    deadline=None,
    max_examples=by_depth(2, 12),
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
    suppress_health_check=list(HealthCheck),
)
WIRES = ("ros1", "cdr")
stall_plans = st.none() | st.builds(
    Stalls, probability=st.sampled_from([0.2, 0.5, 0.8]), seed=st.integers(0, 1000)
)
options = st.fixed_dictionaries({"bus_bytes": st.sampled_from(BUS_WIDTHS)})


def expected(plan, packets):
    """Return transfers by leaf, and statuses, that the plan's interpreter gives for packets."""
    decoded = [decode(plan, packet) for packet in packets]
    transfers = join_transfers(one.streams for one in decoded)
    return transfers, [Status[str(one.status)] for one in decoded]


def carried(seen):
    return {leaf: payloads for leaf, payloads in seen.items() if payloads}


@pytest.mark.parametrize("wire", WIRES)
@few
@given(data=st.data(), case=typed_values(), options=options, stalls=stall_plans)
def test_messages_come_through_byte_for_byte(wire, data, case, options, stalls):
    definition, value = case
    more = data.draw(st.lists(values(definition.message), min_size=1, max_size=4))
    packets = [serialize(definition, item, wire)[1] for item in (value, *more)]
    rx = Deserializer(definition.message, wire=wire, **options)
    tx = Serializer(definition.message, wire=wire, **options)
    assume(is_quick(rx.plan))
    seen = Harness(rx, tx, gated=stalls is not None).run_packets(packets, RunOptions(stalls=stalls))
    assert seen.packets == packets
    assert carried(seen.transfers) == expected(rx.plan, packets)[0]
    assert set(seen.statuses) | set(seen.sent_statuses) == {Status.OK}
    assert not any(seen.packet_errors)


LAST = make("ros1", {"a": "uint64", "s": "string", "b": "uint8", "t": "string"}, "Last")
NOTHING = make("ros1", {}, "Nothing")
ENDS = {
    "the last string of a sequence": make("ros1", {"h": "uint32[4]", "a": (LAST, "[]")}),
    "a trigger after a string": make("ros1", {"a": "uint32", "s": "string", "e": NOTHING}),
    "a string": make("ros1", {"a": "uint32", "s": "string"}),
    "a sequence of triggers": make("ros1", {"a": "uint32", "e": (NOTHING, "[]")}),
}


# Each end on one bus.
QUICK_ENDS = tuple(zip(ENDS, (16, 8, 1, 1), strict=True))


@pytest.mark.parametrize(
    ("end", "bus_bytes"),
    [
        pytest.param(end, bus, marks=[] if (end, bus) in QUICK_ENDS else [pytest.mark.thorough])
        for end in ENDS
        for bus in (1, 8, 16)
    ],
)
@pytest.mark.sampled(4)
def test_a_packet_may_end_with_a_length_or_a_step_without_bytes(end, bus_bytes):
    rx, tx = (kind(ENDS[end], bus_bytes=bus_bytes) for kind in (Deserializer, Serializer))
    # Strings of 0 and 3 characters, after a whole number of beats and not.
    empty, text = bytes(8), bytes(4) + b"\3\0\0\0abc"
    if end == "the last string of a sequence":
        ends = [bytes(13) + each[4:] for each in (empty, text)]
        bodies = ([], [0], [1], [1, 0], *[[0] * 4] * 3, [1] * 4 + [0])
        packets = [
            bytes(16) + len(body).to_bytes(4, "little") + b"".join(ends[k] for k in body)
            for body in bodies
        ]
    elif "string" in end:
        packets = [empty, text] * 3
    else:
        packets = [bytes(4) + count.to_bytes(4, "little") for count in (0, 1, 5)]
    packets *= by_depth(1 if len(packets) == 8 else 2, 5)
    messages = [decode(tx.plan, packet).streams for packet in packets]
    both = Harness(rx, tx, gated=True)
    for stalls in (None, Stalls(probability=0.5, seed=1)):
        seen = both.run_packets(packets, RunOptions(stalls=stalls))
        assert seen.packets == packets
        assert carried(seen.transfers) == expected(rx.plan, packets)[0]
    # Beats leave at once, and must not overtake the end; or a status waits for long.
    alone = Harness(None, tx)
    for stalled in ("message", "status"):
        slow = RunOptions(stalls={stalled: Stalls(probability=0.5, max_cycles=6)})
        assert alone.run_messages(messages, slow).packets == packets


def test_strings_and_bytes_side_by_side_may_be_empty():
    """On CDR, the length of a string counts its NUL, and that of bytes counts none."""
    message = make("ros2", {"s": "string", "a": "uint8[]", "t": "string"})
    rx, tx = Deserializer(message), Serializer(message)

    def part(items, nul=b""):
        data = (len(items) + len(nul)).to_bytes(4, "little") + items + nul
        return data + bytes(-len(data) % 4)

    texts, numbers = (b"", b"x", b"abc"), (b"", b"\1", b"\1\2\3")
    packets = [
        # The last string has no padding behind it.
        b"\0\1\0\0" + part(text, b"\0") + part(items) + part(last, b"\0")[: 5 + len(last)]
        for text in texts
        for items in numbers
        for last in texts[:2]
    ]
    seen = Harness(rx, tx).run_packets(packets)
    assert seen.packets == packets
    assert carried(seen.transfers) == expected(rx.plan, packets)[0]
    assert set(seen.statuses) | set(seen.sent_statuses) == {Status.OK}


def test_items_of_one_size_with_and_without_padding_before_them():
    """The items of `a` are always at byte 8; before those of `b` and `c` there may be padding."""
    message = make("ros2", {"x": "uint32"} | dict.fromkeys("abc", "float64[]"))
    rx = Deserializer(message)
    packets = []
    for sequences in ([], [1.0], [1.0]), ([2.0], [], [3.0]), ([], [], [4.0, 5.0]):
        value = {"x": 7} | dict(zip("abc", sequences, strict=True))
        packets.append(encode(rx.plan, to_transfers(rx.plan, message, value))[0])
    seen = Harness(rx, None).run_packets(packets)
    assert carried(seen.transfers) == expected(rx.plan, packets)[0]
    assert list(seen.statuses) == [Status.OK] * 3


@pytest.mark.parametrize("wire", WIRES)
@few
@given(data=st.data(), case=typed_values(wide=True), options=options, stalls=stall_plans)
def test_bad_packets_are_reported_and_do_not_affect_the_next(wire, data, case, options, stalls):
    definition, value = case
    # A deserializer completes what a damaged length claims: tens of thousands of cycles.
    most = by_depth(lay_out(definition.message, wire).least_bytes + 300, 100_000)
    rx = Deserializer(definition.message, wire=wire, max_message_bytes=most, **options)
    assume(is_quick(rx.plan))
    good = encode(rx.plan, to_transfers(rx.plan, definition.message, value))[0]
    packets = [good]
    for packet in data.draw(st.lists(damaged(good), min_size=1, max_size=6)):
        packets += [packet, good]
    transfers, statuses = expected(rx.plan, packets)
    # Many claimed elements, or no end of them in a narrow bus.
    assume(sum(map(len, transfers.values())) <= by_depth(1000, 1_000_000))
    seen = Harness(rx, None).run_packets(packets, RunOptions(stalls=stalls, limit=2_000_000))
    assert list(seen.statuses) == statuses
    assert carried(seen.transfers) == transfers


@pytest.mark.parametrize("wire", WIRES)
@few
@given(data=st.data(), case=typed_values(), options=options, stalls=stall_plans)
def test_wrong_streams_are_marked_and_do_not_affect_the_next(wire, data, case, options, stalls):
    definition, value = case
    tx = Serializer(definition.message, wire=wire, **options)
    assume(is_quick(tx.plan))
    good = to_transfers(tx.plan, definition.message, value)
    lasts = [leaf for leaf, transfers in good.items() if tx.plan.leaves[leaf].kind == "items"]
    messages = [good]
    for _ in range(data.draw(st.integers(1, 3))):
        bad = {leaf: list(transfers) for leaf, transfers in good.items()}
        for leaf in lasts:
            for index, (lanes, last) in enumerate(bad[leaf]):
                if data.draw(st.integers(0, 4)) == 0:
                    bad[leaf][index] = (lanes, not last)
        messages += [bad, good]
    want = [encode(tx.plan, {k: iter(v) for k, v in message.items()}) for message in messages]
    seen = Harness(None, tx).run_messages(messages, RunOptions(stalls=stalls))
    assert seen.packets == [packet for packet, _ in want]
    assert [status.name for status in seen.statuses] == [str(status) for _, status in want]
    assert seen.packet_errors == [status != Status.OK for status in seen.statuses]
