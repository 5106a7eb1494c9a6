"""Datagrams that real peers sent, and what their bytes say.

They were captured on the loopback interface on 2026-11-23, from rclpy 9.1.2 (Kilted) on Fast DDS
3.2.3, and from Cyclone DDS 11.0.1. The expected values were read from the bytes by hand, with the
tables of DDSI-RTPS 2.5. Fast DDS ends each datagram with a vendor-specific submessage, 0x80.
"""

from __future__ import annotations

from firm_hdl.rtps.wire.parameters import ParameterList
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    Gap,
    Heartbeat,
    HeartbeatFrag,
    NackFrag,
    NumberSet,
)

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
# Words of the bitmap: 80402010 and 08040000. Bit 31 of the first is fragment 9.
_FRAGMENTS = NumberSet(9, (9, 18, 27, 36, 45, 54))
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
        "10204080 00000408 01000000"
        f"06031800 00001304 00000503 0000000001000000 00000000 02000000 {_STATISTICS}",
        [
            NackFrag(reader=0x1304, writer=0x503, sequence_number=1, missing=_FRAGMENTS, count=1),
            AckNack(reader=0x1304, writer=0x503, missing=NumberSet(1), count=2, final=True),
        ],
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
        "12012400 00000204 00000503 0000000001000000 09000000 2e000000 10204080 00000408 01000000",
        [
            AckNack(reader=0x204, writer=0x503, missing=NumberSet(1), count=2, final=True),
            NackFrag(reader=0x204, writer=0x503, sequence_number=1, missing=_FRAGMENTS, count=1),
        ],
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

SEDP_FAST_DDS = (
    "525450530202010f010f7f01367d63360000000009010800f0e3036bd5dc2dbe1505540200001000000003c7"
    "000003c20000000002000000000300005a001000010f7f01367d633600000000000003030780040013000000"
    "2f00180013000000f71c0000557f01000000000000000000000000002f00180001000000f71c000000000000"
    "00000000000000007f00000150001000010f7f01367d633600000000000001c1050010000a00000072742f72"
    "6f736f7574000000070024002000000072636c5f696e74657266616365733a3a6d73673a3a6464735f3a3a4c"
    "6f675f0070001000010f7f01367d633600000000000003036000040034000000150004000202000016000400"
    "010f00001d000400010000001e001c0000000000000000000000000001000000ffffffffffffffffffffffff"
    "23000800ffffff7fffffffff2700080000000000000000001b000c0000000000ffffff7fffffffff1a000c00"
    "02000000000000009a9999192b0008000a000000000000002c0058005100000074797065686173683d524948"
    "5330315f65323863653235346361386162633036616266393237373362373436303263646266313136656433"
    "3466626166323934666239663831646139663331386561633b0000001f000400000000002500040000000000"
    "21000800000000000000000029000400000000002e000400000000002d0004000000000075005c0058000000"
    "011000502400000014000000f1779c7c317cb3139c3dfaaffdd1c80097000000ffffffff0400000000000000"
    "021000502400000014000000f23a2c07a43424b41fbcf8920cf9ba00f7000000ffffffff0400000000000000"
    "730008000100000000000000010000008001380001000000f21c00000000000000000000000000007f000001"
    "f0e3036b7de72ebe0700000000000000ac090000000000000000000000000000"
)
"""Kilted announces the writer of its node's log."""

SEDP_CYCLONE = (
    "52545053020501100110c8e901ec90d4d65c332e09010800f4e3036be8163a2d150504010000100000000000"
    "000003c200000000010000000003000005000c000500000072742f6300000000070024001d0000007374645f"
    "6d7367733a3a6d73673a3a6464735f3a3a537472696e675f000000001a000c00020000000a00000000000000"
    "400008000100000000000000750064006000000001100040280000002400000014000000f159656d080ab926"
    "a333a69d269cb1000000000000000000040000000000000002100040280000002400000014000000f2c3da80"
    "d638e91b9fad0a6b765cc2000000000000000000040000000000000015000400020500001600040001100000"
    "5a0010000110c8e901ec90d4d65c332e000002030c8004000100000001000000"
)
"""Cyclone DDS announces a writer; policies with their default values are left out."""
