"""Arguments that are not what they have to be: an error says what was given, and what is right."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from amaranth.sim import Simulator

from firm_hdl import Deserializer, Library, Parser, Serializer, load_message, record_layout
from firm_hdl.plan import build_plan
from firm_hdl.sim import (
    Harness,
    MessagePort,
    RunOptions,
    Stalls,
    decode,
    encode,
    from_transfers,
    loopback,
    receive,
    receive_packets,
    receive_statuses,
    send,
    send_packets,
    to_transfers,
    watch,
)
from firm_hdl.wire import lay_out

BOOL, TEXT = load_message("std_msgs/msg/Bool"), load_message("std_msgs/msg/String")
PACKET, VALUE = b"\0\1\0\0\1", {"data": True}
PLAN = build_plan(lay_out(BOOL))
SOME = Stalls(0.5)
RX, TX = Deserializer(BOOL), Serializer(BOOL)


@contextmanager
def expected(error: str) -> Iterator[None]:
    """Check the type of an error and its text, given as ``Type: text``."""
    kind, _, text = error.partition(": ")
    with pytest.raises((TypeError, ValueError), match=text) as raised:
        yield
    assert type(raised.value).__name__ == kind


def refused(call: Callable[[], object], error: str) -> None:
    with expected(error):
        call()


@pytest.mark.parametrize("run", [loopback, decode])
@pytest.mark.parametrize(
    ("packets", "options", "error"),
    [
        (PACKET, {}, r"TypeError: ^Packets must be a list of bytes, such as \[b'...'\], not b'"),
        (None, {}, "TypeError: ^Packets must be a list of bytes.* not None$"),
        (["01"], {}, "TypeError: ^A packet must be bytes, not '01'$"),
        ([PACKET], {"stalls": 0.5}, r"TypeError: Stalls\(0\.5\), or a dict of Stalls .* not 0\.5$"),
        ([PACKET], {"stalls": {"message": 0.5}}, "TypeError: ^The stalls of 'message' must be St"),
        (
            [PACKET],
            {"stalls": {"packet_in": SOME}},
            "ValueError: ^There is no stream 'packet_in' to stall; there are .*'packets_in'",
        ),
        ([PACKET], {"stalls": {"message.date": SOME}}, "ValueError: no stream 'message.date' to "),
        ([PACKET], {"deadline": "9"}, "TypeError: ^deadline= must be an integer, not '9'$"),
    ],
)
def test_runs_of_converters(run: Any, packets: Any, options: Any, error: str) -> None:
    refused(lambda: run(BOOL, packets, **options), error)


@pytest.mark.parametrize(
    ("values", "error"),
    [
        (VALUE, r"TypeError: ^Values must be a list of messages, such as \[{...}\], not {'data'"),
        (5, "TypeError: ^Values must be a list of messages"),
        ([5], r"TypeError: ^value must be a std_msgs/msg/Bool \(its fields: data\), not 5$"),
        (
            [{"date": 1}],
            r"ValueError: ^value lacks the field 'data' of .*\(its fields: data\)$",
        ),
        ([{"data": 1, "x": 1}], r"ValueError: 'x' that .*Bool does not have \(its fields: data\)$"),
        ([{7: [1]}], "ValueError: ^std_msgs/msg/Bool has the leaves 0 to 0, not 7$"),
        ([{0: 1}], "TypeError: ^data takes a list of integers, not 1$"),
    ],
)
def test_messages_to_encode(values: Any, error: str) -> None:
    refused(lambda: encode(BOOL, values), error)


@pytest.mark.parametrize(
    ("converters", "options", "error"),
    [
        ((TX, None), {}, "TypeError: ^The deserializer of a harness must be a Deserializer"),
        ((None, RX), {}, "TypeError: ^The serializer of a harness must be a Serializer, not "),
        ((Parser(BOOL), None), {}, "TypeError: ^The deserializer of a harness must be a"),
        (
            (RX, Serializer(TEXT)),
            {},
            "ValueError: ^The deserializer is for .*Bool .*, .* for .*Str",
        ),
        ((RX, None), {"message": TEXT}, "ValueError: ^The converter is for .*Bool, not for .*Str"),
    ],
)
def test_harnesses(converters: Any, options: Any, error: str) -> None:
    refused(lambda: Harness(*converters, **options), error)


def test_options_and_stalls() -> None:
    refused(lambda: RunOptions(stalls=1), "TypeError: ^stalls= must be Stalls")  # type: ignore[arg-type]
    refused(lambda: RunOptions(limit="1"), "TypeError: ^limit= must be")  # type: ignore[arg-type]
    refused(lambda: Stalls("0101"), "TypeError: Stalls.bits takes a pattern$")  # type: ignore[arg-type]
    refused(lambda: Stalls.bits(101), "TypeError: ^Pattern must be a text")  # type: ignore[arg-type]


CALLS: list[tuple[Callable[[Any, Any], Any], str]] = [
    (lambda c, d: send_packets(c, d, [PACKET]), "TypeError: must be a stream, such as rx"),
    (lambda c, d: send_packets(c, d.packets, PACKET), "TypeError: ^Packets must be a list"),
    (lambda c, d: send_packets(c, d.message.data, [PACKET]), "TypeError: stream of packets"),
    (
        lambda c, d: send_packets(d, d.packets, [PACKET]),
        "TypeError: the context of a testbench",
    ),
    (lambda c, d: send_packets(c, d.packets, [], stalls=0.5), "TypeError: ^stalls= must be"),
    (
        lambda c, d: send_packets(c, d.packets, [], domain=1),
        "TypeError: ^domain= must be the n",
    ),
    (lambda c, d: send(c, d.packets, [1 << 80]), "ValueError: 'stream' has 69 bits, too few"),
    (lambda c, d: send(c, d.packets, [None]), "TypeError: needs a payload, not None"),
    (lambda c, d: send(c, d.status, [0]), "ValueError: itself sends on .*; receive from it$"),
    (lambda c, d: receive(c, d.packets, 1), "ValueError: itself receives .*; send on it$"),
    (lambda c, d: receive(c, d.status, [1]), r"TypeError: number to receive .* not \[1\]$"),
    (lambda c, d: receive_packets(c, d.status, 1), "TypeError: a stream of packets, such as"),
    (lambda c, d: receive_packets(c, d.packets, -1), "ValueError: at least 0, not -1"),
    (lambda c, d: receive_statuses(c, d.message.data, 1), "TypeError: a stream of statuses"),
    (lambda c, d: MessagePort(d.message, BOOL).send(c, VALUE), "ValueError: itself sends on"),
    (
        lambda c, d: MessagePort(d.message, BOOL).receive(c, stalls={"data": SOME}),
        "ValueError: no stream 'data' to stall; there are 'message.data'$",
    ),
]


def test_helpers_of_testbenches() -> None:
    """All in one simulation, because compiling the circuit takes long."""
    design = Deserializer(BOOL)

    async def testbench(ctx: Any) -> None:
        for call, error in CALLS:
            with expected(error):
                await call(ctx, design)

    simulator = Simulator(design)
    simulator.add_clock(1e-6)
    simulator.add_testbench(testbench)
    simulator.run()


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda: MessagePort(None, BOOL), "TypeError: ^A message port needs a message"),
        (
            lambda: MessagePort(RX.packets, BOOL),
            "ValueError: ^The interface is not that of",
        ),
        (
            lambda: MessagePort(RX.message, BOOL, bus_bytes=4),
            "ValueError: ^The interface is that of .* bus_bytes=8 .*, not of .* bus_bytes=4 and",
        ),
        (lambda: MessagePort(RX.message, TEXT), "ValueError: .*Bool with .*, not of .*String with"),
        (lambda: watch(RX.packets), r"TypeError: ^watch takes a dict .* {'packets': rx.packets}"),
        (lambda: watch({"rx": RX}), "TypeError: ^'rx' must be a stream, such as rx.packets, not"),
        (
            lambda: to_transfers(PLAN, TEXT, VALUE),
            "ValueError: ^The plan is that of .*Bool",
        ),
        (lambda: to_transfers(BOOL, PLAN, VALUE), "TypeError: ^A Plan and its Message"),
        (lambda: from_transfers(PLAN, BOOL, [1]), "TypeError: ^Transfers must be a dict of lists"),
        (lambda: from_transfers(PLAN, BOOL, {0: [1], 9: []}), "ValueError: 0 to 0, not 9$"),
        (lambda: load_message("std_msgs/msg/Bool", paths="/tmp"), "TypeError: ^paths= must be a l"),
        (lambda: Library(paths="msgs"), r"TypeError: ^paths= must be a list .* \['msgs'\]"),
        (lambda: record_layout(BOOL, fields=[3]), r"TypeError: ^Fields must be a list of names"),
        (lambda: record_layout(BOOL, fields=["dat"]), "ValueError: size 'dat'; it has data$"),
    ],
)
def test_what_is_made_for_testbenches(make: Any, error: str) -> None:
    refused(make, error)
