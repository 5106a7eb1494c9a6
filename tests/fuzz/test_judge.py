"""The reference decoder in C++ and the golden model agree on what each packet must cause.

They share no code: one goes through the packet primitive by primitive, the other executes a plan.
"""

from __future__ import annotations

import random
import subprocess
from pathlib import Path

import pytest

from firm_hdl.cases.damage import broken_packets
from firm_hdl.cases.make import Case
from firm_hdl.fuzz.table import table_of
from firm_hdl.plan import build_plan
from firm_hdl.plan.interpret import decode, encode
from firm_hdl.sim.payloads import encoder_of
from firm_hdl.sim.values import to_transfers
from firm_hdl.wire import lay_out
from tests.fuzz.programs import compiled
from tests.strategies import make

# Reads packets as lines of hex; writes what the judge says of each.
MAIN = r"""
#include <fstream>
#include <iostream>
#include "judge.h"

int main(int, char** argv) {
    std::ifstream text(argv[1]);
    const Table table = read_table(text);
    std::cout << table.transfers_once() << "\n";
    Judge judge(table);
    Expected expected;
    std::string line;
    while (std::getline(std::cin, line)) {
        std::vector<uint8_t> packet;
        for (size_t at = 0; at < line.size(); at += 2)
            packet.push_back(static_cast<uint8_t>(std::stoi(line.substr(at, 2), nullptr, 16)));
        judge.judge(packet, expected);
        std::cout << name_of(expected.status) << " " << expected.good << " ";
        for (uint8_t each : expected.rewritten) std::cout << " " << int(each);
        for (const Transfer& each : expected.transfers) {
            std::cout << "," << each.leaf << " " << each.is_last;
            for (int n = 0; n < table.leaves[each.leaf].words(); ++n)
                std::cout << " " << expected.words[each.at + n];
        }
        std::cout << "\n";
    }
}
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory) -> Path:
    """The judge as a program, compiled once."""
    return compiled(tmp_path_factory.mktemp("judge"), MAIN, "judge", "table")


class Both:
    """A type for both decoders: its plan, and the program with its table."""

    def __init__(self, program, folder, message, bus_bytes=4, most=1000):
        options = {"bus_bytes": bus_bytes, "max_message_bytes": most}
        self.message, self.program = message, program
        self.plan = build_plan(lay_out(message), **options)
        self.table = table_of(message, wire=message.wire, **options)
        self.file = folder / "table.txt"
        self.file.write_text(self.table.text())
        # Leaves of the table are those of the plan, in another order maybe.
        number = {leaf.path: index for index, leaf in enumerate(self.plan.leaves)}
        self.leaves = [number[leaf.path] for leaf in self.table.leaves]

    def packet(self, value) -> bytes:
        return encode(self.plan, to_transfers(self.plan, self.message, value))[0]

    def by_judge(self, packets):
        """Return the status, the packet that a serializer writes, and transfers by leaf."""
        lines = "".join(f"{packet.hex()}\n" for packet in packets)
        command = [str(self.program), str(self.file)]
        said = subprocess.run(
            command, input=lines, capture_output=True, text=True, check=True, timeout=60
        ).stdout.splitlines()
        self.transfers_once = said[0] == "1"
        return [self._read(line) for line in said[1:]]

    def _read(self, line):
        head, *transfers = line.split(",")
        status, good, *rewritten = head.split()
        streams, order = {}, []
        for each in transfers:
            leaf, last, *words = map(int, each.split())
            data = sum(word << 32 * n for n, word in enumerate(words))
            bits = self.table.leaves[leaf].bits * self.table.leaves[leaf].lanes
            streams.setdefault(self.leaves[leaf], []).append(data | last << bits)
            order.append(self.leaves[leaf])
        return status, bytes(map(int, rewritten)), streams, order, int(good)

    def by_golden_model(self, packet):
        found = decode(self.plan, packet)
        streams = {
            leaf: [encoder_of(self.plan.leaves[leaf])(each) for each in payloads]
            for leaf, payloads in found.streams.items()
            if payloads
        }
        return found.status, encode(self.plan, found.streams)[0], streams

    def compare(self, packets):
        """Compare all packets; return the statuses that came."""
        judged = self.by_judge(packets)
        assert len(judged) == len(packets)
        for packet, (status, rewritten, streams, order, good) in zip(packets, judged, strict=True):
            assert (status, rewritten, streams) == self.by_golden_model(packet), packet.hex()
            assert good == len(order) if status in ("OK", "TRAILING") else good <= len(order)
        return {status for status, *_ in judged}


@pytest.fixture
def both(program, tmp_path):
    return lambda message, **options: Both(program, tmp_path, message, **options)


NUMBERS = {
    "a": "uint8",
    "b": "int16",
    "c": "bool",
    "d": "float64",
    "e": "int32[3]",
    "f": "bool[5]",
    "g": "uint16[]",
    "h": "bool[]",
    "i": "float64[]",
    "s": "string",
    "j": "uint64",
}


def numbers(count, text):
    """Return a value with so many items in each sequence."""
    return {
        "a": 200,
        "b": -2 - count,
        "c": count == 0,
        "d": 0.5,
        "e": [1, -1, 1 << 30],
        "f": [True, False, True, False, True],
        "g": list(range(0x1234, 0x1234 + count)),
        "h": [True, False, True][:count],
        "i": [-1.5] * count,
        "s": text,
        "j": (1 << 64) - 1 - count,
    }


def damaged(both, packets, count):
    """Return the packets, and damaged ones."""
    cases = [Case(what="", value=None, packet=each, transfers={}) for each in packets] * count
    return [*packets, *broken_packets(both.plan, cases, random.Random(7))]


@pytest.mark.parametrize("bus_bytes", [1, 4, 16])
@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_numbers_arrays_and_strings(both, dialect, bus_bytes):
    made = both(make(dialect, NUMBERS), bus_bytes=bus_bytes)
    texts = ("", "t", "texts", "text and more")
    packets = [made.packet(numbers(count, text)) for count, text in enumerate(texts)]
    # A bool may have any byte but 0.
    packets.append(packets[0].replace(b"\1\0\1\0\1", b"\7\0\x80\0\xff"))
    assert packets[-1] != packets[0]
    some = {"OK", "TRUNCATED", "TRAILING", "LENGTH"}
    some |= {"ENCAPSULATION", "STRING"} if dialect == "ros2" else set()
    # Text whose NUL is another character.
    packets.append(packets[3].replace(b"more\0", b"more!"))
    assert made.compare(damaged(made, packets, 12)) == some
    assert not made.transfers_once


@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_loops_in_loops_and_messages_without_fields(both, dialect):
    empty = make(dialect, {}, "Empty")
    inner = make(dialect, {"x": "uint8", "names": "string[]", "none": empty}, "Inner")
    fields = {"all": (inner, "[]"), "two": (inner, "[2]"), "no": (empty, "[]"), "d": "float64[2]"}
    made = both(make(dialect, fields), bus_bytes=8)

    def element(n):
        return {"x": n, "names": ["abcdefgh"[: n + k] for k in range(n)], "none": {}}

    packets = [
        made.packet(
            {
                "all": [element(k) for k in range(n)],
                "two": [element(n), element(1)],
                "no": [{}] * n,
                "d": [0.25, -n],
            }
        )
        for n in (0, 1, 4)
    ]
    assert {"OK", "TRUNCATED", "TRAILING", "LENGTH"} <= made.compare(damaged(made, packets, 20))
    assert not made.transfers_once


def test_bounds_and_wide_text(both):
    fields = {"w": "wstring<=3", "n": "int16[<=2]", "s": "string<=4", "m": "string[<=2]"}
    made = both(make("ros2", fields))
    good = {"w": "añ€", "n": [1, -1], "s": "abcd", "m": ["", "xy"]}
    packets = [made.packet(value) for value in (good, {"w": "", "n": [], "s": "", "m": []})]
    longer = [
        # Each length is one more than its bound, and the packet is as long.
        bytes.fromhex("00010000 04000000") + bytes(100),
        bytes.fromhex("00010000 00000000 03000000") + bytes(100),
        bytes.fromhex("00010000 00000000 00000000 06000000") + bytes(100),
        bytes.fromhex("00010000 00000000 00000000 01000000 00 000000 03000000") + bytes(100),
    ]
    assert [status for status, *_ in made.by_judge(longer)] == ["LENGTH"] * 4
    # Text whose NUL is another character.
    packets.append(packets[0].replace(b"xy\0", b"xyz"))
    found = made.compare([*packets, *longer, *damaged(made, packets, 20)])
    assert found == {"OK", "TRUNCATED", "TRAILING", "LENGTH", "ENCAPSULATION", "STRING"}


def test_what_may_follow_a_message(both):
    small = both(make("ros2", {"a": "uint8", "b": "uint32[2]"}), bus_bytes=8)
    whole = small.packet({"a": 1, "b": [2, 3]})
    small.compare([whole + bytes(n) for n in range(5)])
    assert [status for status, *_ in small.by_judge([whole + b"?" * n for n in range(5)])] == [
        *["OK"] * 4,
        "TRAILING",
    ]
    assert small.transfers_once
    # The array has two transfers on a bus of four bytes.
    narrow = both(make("ros2", {"a": "uint8", "b": "uint32[2]"}), bus_bytes=4)
    narrow.compare([whole])
    assert not narrow.transfers_once
    old = both(make("ros1", {"a": "uint8"}))
    assert [status for status, *_ in old.by_judge([b"", b"1", b"12"])] == [
        *("TRUNCATED", "OK", "TRAILING")
    ]


@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_lengths_that_claim_too_much_together(both, dialect):
    """Lists of strings: what the lengths of an outer list claim is added up."""
    inner = make(dialect, {"names": "string[]", "d": "float64"}, "Inner")
    made = both(make(dialect, {"all": (inner, "[]"), "last": "uint8[]"}), most=4000, bus_bytes=8)
    head = b"\0\1\0\0" if dialect == "ros2" else b""

    def packet(count, *lengths, last=0):
        words = b"".join(each.to_bytes(4, "little") for each in (count, *lengths))
        return head + words + bytes(last)

    packets = [
        packet(count, *[0] * zeros, length, last=800)
        for count in (1, 3, 100, 200, 400)
        for zeros in (0, 3)
        for length in (0, 63, 64, 65, 700, 990)
    ]
    found = made.compare(packets)
    assert {"TRUNCATED", "LENGTH"} <= found


INNER = {"names": "string[]", "d": "float64"}


@pytest.mark.parametrize(
    ("dialect", "fields", "words", "statuses"),
    [
        # Of 4000 bytes, 3996 are left for 12 of each element, and for 4 of each string.
        ("ros1", INNER, [(333,)], "T"),
        ("ros1", INNER, [(334,)], "L"),
        ("ros1", INNER, [(300, 99), (300, 100)], "TL"),
        # 63 strings are too few to be counted. The second 64 are too many, after the first ones.
        ("ros1", INNER, [(300, 63, *[0] * 65, 99), (300, 63, *[0] * 65, 100)], "TL"),
        ("ros1", INNER, [(300, 64, *[0] * 66, 35), (300, 64, *[0] * 66, 63)], "TT"),
        ("ros1", INNER, [(300, 64, *[0] * 66, 64)], "L"),
        # On CDR, 3992 are left. An element has 16 with its padding; each length claims 14 less.
        ("ros2", INNER, [(250, 5), (250, 6), (250, 63), (250, 64)], "TTTL"),
        ("ros2", INNER, [(200, 205), (200, 206)], "TL"),
        # The NUL of a string counts, too.
        ("ros2", None, [(900, 392), (900, 393)], "TL"),
        ("ros1", None, [(900, 396), (900, 397)], "TL"),
    ],
)
def test_the_edge_of_what_lengths_may_claim(both, dialect, fields, words, statuses):
    kind = "string[]" if fields is None else (make(dialect, fields, "Inner"), "[]")
    made = both(make(dialect, {"all": kind}), most=4000, bus_bytes=8)
    head = b"\0\1\0\0" if dialect == "ros2" else b""
    packets = [head + b"".join(each.to_bytes(4, "little") for each in row) for row in words]
    made.compare(packets)
    names = {"T": "TRUNCATED", "L": "LENGTH"}
    found = [status for status, *_ in made.by_judge(packets)]
    assert found == [names[each] for each in statuses]


def test_text_that_is_no_table_is_refused(program, tmp_path, both):
    made = both(make("ros2", {"v": "string[]"}))
    right = made.table.text()
    for wrong in (
        "",
        right.replace("table", "tables"),
        right.replace("table 1 4 3", "table 1 4 9"),
        right.replace("run ", "ran "),
        right.replace("end\n", ""),
        right.replace("loop 0 4 0 0 ", "loop 0 4 0 "),
    ):
        assert wrong != right
        made.file.write_text(wrong)
        done = subprocess.run(
            [str(program), str(made.file)], input="", capture_output=True, text=True, timeout=60
        )
        assert done.returncode != 0 and done.stdout == "", wrong
