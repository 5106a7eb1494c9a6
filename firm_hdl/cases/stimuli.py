"""Packets for the test benches of generated VHDL: chosen messages, written by rosbags.

The type may be a user's own; see :mod:`firm_hdl.cases.user_oracle`.
"""

from __future__ import annotations

from collections.abc import Iterator

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.make import Case, make_cases
from firm_hdl.cases.user_oracle import Judge, judge_of
from firm_hdl.model import Message
from firm_hdl.plan import Plan

__all__ = ["stimuli", "stimulus_cases"]

MOST_PACKETS = 16
MOST_BYTES = 1 << 15
"""The most bytes of all packets together, so that a bench takes about a second.

The first packet may be longer.
"""


def stimuli(message: Message, plan: Plan) -> list[bytes]:
    """Return packets of a type; none, if rosbags cannot write it."""
    try:
        # A bench only shows what the circuits do. TS3 checks that the bytes are those of a wstring.
        judge = judge_of(message, stand_in=True)
        return [case.packet for case in stimulus_cases(judge, plan)]
    except NotJudgedError:
        return []


def stimulus_cases(judge: Judge, plan: Plan) -> Iterator[Case]:
    """Yield the cases whose packets are the stimuli of a type.

    Raises `NotJudgedError` if rosbags cannot write the type.
    """
    cases = make_cases(
        judge.oracle, judge.name, wire=plan.wire, bus_bytes=plan.bus_bytes, most=MOST_PACKETS
    )
    sizes: list[int] = []
    try:
        for case in cases:
            size = len(case.packet)
            if sizes and sum(sizes) + size > MOST_BYTES:
                return
            if size <= plan.max_message_bytes:
                sizes.append(size)
                yield case
    except NotJudgedError:
        raise
    # The exceptions of rosbags for values that it cannot write have no common base class.
    except Exception as error:
        raise NotJudgedError(f"rosbags cannot write it: {type(error).__name__}: {error}") from None
