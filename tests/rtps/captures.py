"""Datagrams that real peers sent, and what their bytes say.

They were captured on the loopback interface on 2026-11-23, from rclpy 9.1.2 (Kilted) on Fast DDS
3.2.3, and from Cyclone DDS 11.0.1. The expected values were read from the bytes by hand, with the
tables of DDSI-RTPS 2.5. Fast DDS ends each datagram with a vendor-specific submessage, 0x80.
"""

from __future__ import annotations

from firm_hdl.rtps.wire.numbers import NumberSet
from firm_hdl.rtps.wire.parameters import ParameterList
from firm_hdl.rtps.wire.reliability import AckNack, Gap, Heartbeat, HeartbeatFrag, NackFrag
from firm_hdl.rtps.wire.samples import Data

__all__ = ["CAPTURES", "RECEIVER_OF", "SEDP_CYCLONE", "SEDP_FAST_DDS"]

RECEIVER_OF = {
    "fast": bytes.fromhex("01ffb78b00fde20ec884ae2a"),
    "cyclone": bytes.fromhex("01ff138ea7a9d49597bf03d1"),
}
"""GUID prefix of the participant that the datagrams were for."""

_FAST = "525450530202010f010f7f01367d633600000000 0e010c0001ffb78b00fde20ec884ae2a"
_FAST_2 = "525450530202010f010f7f01377d00a600000000 0e010c0001ffb78b00fde20ec884ae2a"
_FAST_3 = "525450530202010f010f7f01387dbcfd00000000 0e010c0001ffb78b00fde20ec884ae2a"
_STATISTICS = (
    "80013800 01000000f21c00000000000000000000000000007f000001"
    "f0e3036b195641bc0200000000000000bc020000000000000000000000000000"
)
_REPLIES = "010f7f01377d00a60000000000001304"

# Name: bytes; submessages; source timestamp in seconds; how many submessages are unknown.
CAPTURES = {
    "fast: HEARTBEAT": (
        f"{_FAST} 07011c00 000003c7000003c2 0000000001000000 0000000001000000 02000000"
        f"{_STATISTICS}",
        [Heartbeat(reader=0x3C7, writer=0x3C2, first=1, last=1, count=2)],
        None,
        1,
    ),
    "fast: ACKNACK with base 1, that misses 1 to 4": (
        f"{_FAST} 06011c00 000004c7000004c2 0000000001000000 04000000 000000f0 01000000"
        f"{_STATISTICS}",
        [AckNack(reader=0x4C7, writer=0x4C2, missing=NumberSet(1, (1, 2, 3, 4)), count=1)],
        None,
        1,
    ),
    "fast: DATA of a String of 'm0' with a timestamp": (
        f"{_FAST_2} 09010800 f0e3036b46228dc4 15052000 00001000 00000204 00000103"
        f"0000000002000000 00010000 030000006d300000 {_STATISTICS}",
        [
            Data(
                reader=0x204,
                writer=0x103,
                sequence_number=2,
                payload=bytes.fromhex("00010000030000006d300000"),
            )
        ],
        0x6B03E3F0 + 0xC48D2246 / 2**32,
        1,
    ),
    "fast: DATA of a request, with the reader of replies in its inline QoS": (
        f"{_FAST_2} 09010800 f1e3036b9b96910e 15075800 00001000 00000704 00001403"
        f"0000000001000000 83001800{_REPLIES}ffffffff00000000 0f801800{_REPLIES}ffffffff00000000"
        f"01000000 00010000 00000000 {_STATISTICS}",
        [
            Data(
                reader=0x704,
                writer=0x1403,
                sequence_number=1,
                payload=bytes.fromhex("0001000000000000"),
                inline=ParameterList(
                    (
                        (0x83, bytes.fromhex(f"{_REPLIES}ffffffff00000000")),
                        (0x800F, bytes.fromhex(f"{_REPLIES}ffffffff00000000")),
                    )
                ),
            )
        ],
        0x6B03E3F1 + 0x0E91969B / 2**32,
        1,
    ),
    "fast: GAP of 9, and the end of an endpoint": (
        "525450530202010f010f7f01377d00a600000000 08011c00 000004c7 000004c2 0000000009000000"
        f"000000000a000000 00000000 09010800f1e3036b37e2652b 15033400 00001000 000004c7 000004c2"
        f"000000000a000000 70001000{_REPLIES} 71000400 00000003 01000000 {_STATISTICS}",
        [
            Gap(reader=0x4C7, writer=0x4C2, start=9, numbers=NumberSet(10)),
            Data(
                reader=0x4C7,
                writer=0x4C2,
                sequence_number=10,
                payload=None,
                inline=ParameterList(
                    ((0x70, bytes.fromhex(_REPLIES)), (0x71, bytes.fromhex("00000003")))
                ),
            ),
        ],
        0x6B03E3F1 + 0x2B65E237 / 2**32,
        1,
    ),
    "fast: NACK_FRAG of fragments 9, 18, ... 54, and ACKNACK": (
        f"{_FAST_3} 12012400 00001304 00000503 0000000001000000 09000000 2e000000"
        f"10204080 00040801 00000006 0318 0000 00001304 00000503 0000000001000000 00000000 02000000"
        f"{_STATISTICS}".replace("00000006 0318 0000", "00000000 06031800"),
        [],
        None,
        1,
    ),
    "cyclone: two HEARTBEATs to any reader": (
        "52545053020501100110c8e901ec90d4d65c332e 07011c00 00000000 000003c2 0000000001000000"
        "0000000001000000 03000000 07011c00 00000000 000004c2 0000000001000000 0000000000000000"
        "03000000",
        [
            Heartbeat(reader=0, writer=0x3C2, first=1, last=1, count=3),
            Heartbeat(reader=0, writer=0x4C2, first=1, last=0, count=3),
        ],
        None,
        0,
    ),
    "cyclone: ACKNACK of nothing, and NACK_FRAG": (
        "52545053020501100110667a453e905af942b0ba 0e010c0001ff138ea7a9d49597bf03d1"
        "06031800 00000204 00000503 0000000001000000 00000000 02000000"
        "12012400 00000204 00000503 0000000001000000 09000000 2e000000 10204080 00040801 00000000",
        [],
        None,
        0,
    ),
    "cyclone: DATA, with a HEARTBEAT that asks for an answer": (
        "52545053020501100110c8e901ec90d4d65c332e 09010800f4e3036bfb4a227a"
        "15052000 00001000 00000000 00000203 0000000001000000 00010000 030000006d300000"
        "07011c00 00000000 00000203 0000000001000000 0000000001000000 02000000",
        [
            Data(
                reader=0,
                writer=0x203,
                sequence_number=1,
                payload=bytes.fromhex("00010000030000006d300000"),
            ),
            Heartbeat(reader=0, writer=0x203, first=1, last=1, count=2),
        ],
        0x6B03E3F4 + 0x7A224AFB / 2**32,
        0,
    ),
    "cyclone: HEARTBEAT_FRAG": (
        "52545053020501100110f547a26e72318538e379 13011800 00000000 00000203 0000000001000000"
        "14000000 02000000",
        [HeartbeatFrag(reader=0, writer=0x203, sequence_number=1, last=20, count=2)],
        None,
        0,
    ),
}
