"""The packets of the fuzzer: good ones, what varies in them, and each kind of damage."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from itertools import pairwise

import pytest

from firm_hdl.fuzz.table import table_of
from firm_hdl.plan import build_plan
from firm_hdl.plan.interpret import decode
from firm_hdl.wire import lay_out
from tests.fuzz.programs import compiled
from tests.strategies import make

# Writes good packets with the places and values of their lengths, then the same ones with their
# damage, and then the cuts with some numbers.
MAIN = r"""
#include <fstream>
#include <iostream>

void show(const Bytes& bytes) {
    static const char DIGITS[] = "0123456789abcdef";
    for (uint8_t each : bytes) std::cout << DIGITS[each >> 4] << DIGITS[each & 15];
    std::cout << "|";
}

int main(int argc, char** argv) {
    std::ifstream text(argv[1]);
    const Table table = read_table(text);
    Writer writer(table);
    Damager damager(table, 5);
    for (int seed = 0; seed < std::stoi(argv[2]); ++seed) {
        Random one(seed), two(seed);
        // The first number decides the kind of damage, and the packet follows.
        one.next();
        const Written good = writer.write(one);
        Damage kind;
        const Bytes damaged = damager.damaged(two, kind);
        show(good.bytes);
        // The next packet, whose end a splice takes.
        show(writer.write(one).bytes);
        for (const LengthAt& each : good.lengths) std::cout << each.at << " " << each.value << " ";
        std::cout << "|" << DAMAGE_NAMES[static_cast<int>(kind)] << "|";
        show(damaged);
        std::cout << "\n";
    }
    for (int n = 3; n < argc; ++n) show(damager.cut(std::stoull(argv[n])));
    std::cout << "\n";
}
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    return compiled(tmp_path_factory.mktemp("packets"), MAIN, "packets", "table")


@dataclass(frozen=True, slots=True, kw_only=True)
class Packet:
    """A good packet and the next one, its lengths as (place, value), and what became of it."""

    good: bytes
    other: bytes
    lengths: list[tuple[int, int]]
    kind: str
    damaged: bytes


@pytest.fixture
def written(program, tmp_path):
    """Return packets of a type, and cuts with some numbers."""

    def write(message, count=400, cuts=(), bus_bytes=4, most=300):
        made = table_of(message, wire=message.wire, bus_bytes=bus_bytes, max_message_bytes=most)
        (tmp_path / "table.txt").write_text(made.text())
        command = [program, tmp_path / "table.txt", *map(str, (count, *cuts))]
        said = subprocess.run(command, capture_output=True, text=True, check=True, timeout=30)
        *lines, last = said.stdout.splitlines()
        packets = []
        for good, other, lengths, kind, damaged, _ in (line.split("|") for line in lines):
            numbers = [int(word) for word in lengths.split()]
            packets.append(
                Packet(
                    good=bytes.fromhex(good),
                    other=bytes.fromhex(other),
                    lengths=list(zip(numbers[::2], numbers[1::2], strict=True)),
                    kind=kind,
                    damaged=bytes.fromhex(damaged),
                )
            )
        return packets, [bytes.fromhex(each) for each in last.split("|")[:-1]]

    return write


def message_of(dialect):
    """Return a type with a field of each kind."""
    empty = make(dialect, {}, "Empty")
    inner = make(dialect, {"x": "uint8", "names": "string[]", "none": empty, "t": "int16"}, "Inner")
    fields = {
        "a": "uint8",
        "d": "float64",
        "f": "bool[3]",
        "s": "string",
        "n": "uint16[]",
        # Without an item there is no padding before one.
        "g": "float64[]",
        "all": (inner, "[]"),
        "two": (inner, "[2]"),
        "e": "int32[2]",
    }
    return make(dialect, fields | ({"w": "wstring<=3"} if dialect == "ros2" else {}))


@pytest.mark.parametrize("dialect", ["ros1", "ros2"])
def test_packets_are_good_and_lengths_are_where_they_are_said_to_be(written, dialect):
    message = message_of(dialect)
    packets, _ = written(message)
    plan = build_plan(lay_out(message), bus_bytes=4, max_message_bytes=300)
    assert {decode(plan, each.good).status for each in packets} == {"OK"}
    for each in packets:
        for at, value in each.lengths:
            assert int.from_bytes(each.good[at : at + 4], "little") == value
        # A text, two lists of numbers, messages, of which each has a list of texts, and wide text.
        texts = [value for _, value in each.lengths]
        assert len(texts) >= 4 + 2 + (dialect == "ros2")
        assert [at for at, _ in each.lengths] == sorted({at for at, _ in each.lengths})
    assert len({each.good for each in packets}) > 300


def test_whatever_a_sender_may_choose_varies(written):
    packets = [each.good for each in written(make("ros2", {"a": "uint8", "s": "string"}))[0]]
    # Options, the padding before the length, and up to three bytes behind the message.
    assert {each[:2] for each in packets} == {b"\0\1"}
    options = [each[2:4] for each in packets]
    assert 100 < options.count(b"\0\0") < 300 and len(set(options)) > 100
    for at in (5, 6, 7):
        padding = [each[at] for each in packets]
        assert 100 < padding.count(0) < 300 and len(set(padding)) > 50
    lengths = [int.from_bytes(each[8:12], "little") for each in packets]
    # An empty text has a NUL, or none.
    assert {0, 1, 2, 3} <= set(lengths)
    behind = [len(each) - 12 - length for each, length in zip(packets, lengths, strict=True)]
    assert set(behind) == {0, 1, 2, 3} and behind.count(0) > 200
    # Numbers with no bit, one bit and all bits are frequent.
    first = [each[4] for each in packets]
    assert all(20 < first.count(number) < 100 for number in (0, 1, 255))


def test_ros1_has_no_padding_and_nothing_behind_a_message(written):
    packets, _ = written(make("ros1", {"a": "uint8", "s": "string"}))
    assert all(len(each.good) == 5 + each.lengths[0][1] for each in packets)
    assert {each.lengths[0][0] for each in packets} == {1}


@pytest.mark.parametrize(
    ("kind", "most", "always"),
    [
        # The limit of 300 bytes: 4 of the header, and 4 of the length.
        ("uint8[]", 292, {0, 1, 2, 292}),
        ("uint16[]", 146, {0, 1, 2, 146}),
        ("uint8[<=70]", 70, {0, 1, 2, 70}),
        ("uint8[<=5]", 5, {0, 1, 2, 3, 4, 5}),
        # With a NUL.
        ("string", 292, {0, 1, 2, 292}),
        ("string<=5", 6, {0, 1, 2, 3, 4, 5, 6}),
        ("wstring<=2", 2, {0, 1, 2}),
    ],
)
def test_lengths_reach_their_limit_and_do_not_exceed_it(written, kind, most, always):
    packets, _ = written(make("ros2", {"v": kind}), count=1500)
    values = [each.lengths[0][1] for each in packets]
    assert max(values) == most and always <= set(values)
    # The limit is not left to chance, and a bound that is small is frequent.
    assert values.count(most) > 10
    assert (values.count(most) > 450) is (most <= 6)


def test_most_packets_are_short_and_some_are_long(written):
    """A packet that has its bytes gets at most one item more for each further field."""
    message = make("ros2", {f"x{number}": "uint64[]" for number in range(8)})
    sizes = sorted(len(each.good) for each in written(message, most=5000)[0])
    assert sizes[len(sizes) // 2] < 230 and sizes[-1] > 1000


def is_prefix(one, two):
    return two[: len(one)] == one


def changed(one, two):
    return [n for n, (a, b) in enumerate(zip(one, two, strict=True)) if a != b]


def check_cut(good, bad, each):
    assert is_prefix(bad, good)


def check_splice(good, bad, each):
    ends = [n for n in range(len(bad) + 1) if is_prefix(bad[:n], good)]
    assert any(each.other.endswith(bad[n:]) for n in ends)


def check_flip(good, bad, each):
    flips = sum((a ^ b).bit_count() for a, b in zip(good, bad, strict=True))
    assert flips <= 8


def check_length(good, bad, each):
    places = {at + n for at, _ in each.lengths for n in range(4)}
    assert set(changed(good[: len(bad)], bad)) <= places
    assert len(bad) >= each.lengths[0][0] + 4


def check_header(good, bad, each):
    assert is_prefix(bad[2:], good[2:]) and (len(bad) <= 4 or len(bad) == len(good))


def check_trailing(good, bad, each):
    assert is_prefix(good, bad) and 1 <= len(bad) - len(good) <= 150


def check_empty(good, bad, each):
    assert bad == b""


def check_insert(good, bad, each):
    assert any(bad[:n] + bad[n + 1 :] == good for n in range(len(bad)))


def check_erase(good, bad, each):
    check_insert(bad, good, each)


def check_rubbish(good, bad, each):
    assert len(bad) < 80 and (len(bad) < 2 or bad[:2] == b"\0\1")


CHECKS = {
    "cut anywhere": check_cut,
    "splice": check_splice,
    "flip": check_flip,
    "length": check_length,
    "header": check_header,
    "trailing": check_trailing,
    "empty": check_empty,
    "insert": check_insert,
    "erase": check_erase,
    "rubbish": check_rubbish,
}


def test_each_kind_of_damage_does_what_its_name_says(written):
    packets, _ = written(message_of("ros2"), count=1500)
    by_kind = {kind: [each for each in packets if each.kind == kind] for kind in CHECKS}
    assert sum(map(len, by_kind.values())) == len(packets)
    for kind, some in by_kind.items():
        assert len(some) > 50
        for each in some:
            CHECKS[kind](each.good, each.damaged, each)
        assert sum(each.good != each.damaged for each in some) > len(some) * 3 // 4, kind
    # What has no length, no header or no byte gets another damage.
    plain = {each.kind for each in written(make("ros1", {"a": "uint8"}))[0]}
    assert plain == CHECKS.keys() - {"length", "header"}
    nothing = {each.kind for each in written(make("ros1", {}))[0]}
    assert nothing == plain - {"flip", "erase"}


def damaged(written, kind, fields, count=3000):
    return [each for each in written(make("ros2", fields), count)[0] if each.kind == kind]


def test_cuts_and_flips_and_what_trails_reach_both_of_their_ends(written):
    packets, _ = written(make("ros2", {"a": "uint32"}), count=1500)
    short = [each for each in packets if len(each.good) == 8]
    assert {len(each.damaged) for each in short if each.kind == "cut anywhere"} == set(range(9))
    flips = [
        sum((a ^ b).bit_count() for a, b in zip(each.good, each.damaged, strict=True))
        for each in packets
        if each.kind == "flip"
    ]
    assert {1, 2, 3, 4, 5, 6, 7, 8} <= set(flips)
    more = [len(each.damaged) - len(each.good) for each in packets if each.kind == "trailing"]
    assert set(range(1, 10)) <= set(more) and max(more) > 100
    # A byte is inserted at the front and behind the last one, too; so it is with those erased.
    some = [each for each in short if each.kind in ("insert", "erase")]
    assert any(each.damaged[1:] == each.good for each in some)
    assert any(each.damaged[:-1] == each.good for each in some)
    assert any(each.good[1:] == each.damaged for each in some)
    assert any(each.good[:-1] == each.damaged for each in some)


def test_a_header_is_any_two_bytes_or_one_that_is_known(written):
    some = damaged(written, "header", {"a": "uint8"}, count=6000)
    heads = [each.damaged[:2] for each in some if len(each.damaged) > 4]
    # The representations have the numbers 0 to 11.
    known = {head[1] for head in heads if head[0] == 0 and head[1] < 12}
    assert known == set(range(12)) and len({head[0] for head in heads}) > 20
    assert len({head[1] for head in heads}) > 30
    assert {len(each.damaged) for each in some if len(each.damaged) <= 4} == set(range(5))


def test_a_length_gets_each_number_that_is_next_to_something(written):
    """The bound is 9 with the NUL, and the limit is the same."""
    found, cut = set(), 0
    for each in damaged(written, "length", {"s": "string<=8"}):
        number = int.from_bytes(each.damaged[4:8], "little")
        found.add(number)
        cut += len(each.damaged) < len(each.good)
        assert each.damaged[:4] == each.good[:4]
    assert found == {*range(11), 0x8000_0000, 0xFFFF_FFFF} and cut > 10
    # A bound may be above the limit, and the limit of a text counts the NUL.
    for kind, near in (("uint8[<=5000]", {292, 293, 5000, 5001}), ("string", {292, 293})):
        some = damaged(written, "length", {"v": kind})
        numbers = [int.from_bytes(each.damaged[4:8], "little") for each in some]
        assert all(numbers.count(each) > 20 for each in near)
    limited = damaged(written, "length", {"v": "uint8[]"})
    found = {int.from_bytes(each.damaged[4:8], "little") for each in limited}
    assert {0, 1, 292, 293, 0x8000_0000, 0xFFFF_FFFF} <= found
    near = {int.from_bytes(e.damaged[4:8], "little") - e.lengths[0][1] for e in limited}
    assert {-1, 1} <= near


def test_several_lengths_of_a_packet_are_damaged_at_once(written):
    some = damaged(written, "length", {"a": "string", "b": "string", "c": "string"})
    counts = set()
    for each in some:
        places = {at for at, _ in each.lengths if each.good[at : at + 4] != each.damaged[at:][:4]}
        # What was cut is no other number.
        counts.add(len({at for at in places if at + 4 <= len(each.damaged)}))
    assert {1, 2, 3} <= counts


def test_lists_inside_lists_are_short_and_those_behind_them_are_not(written):
    inner = make("ros2", {"x": "uint8[]"}, "Inner")
    message = make("ros2", {"all": (inner, "[]"), "last": "uint8[]"})
    packets = [each for each in written(message)[0] if len(each.lengths) > 2]
    assert max(value for each in packets for _, value in each.lengths[1:-1]) == 5
    assert max(each.lengths[-1][1] for each in packets) > 5


def test_cuts_with_consecutive_numbers_are_those_of_one_packet_after_the_other(written):
    numbers = list(range(200))
    _, cuts = written(make("ros2", {"s": "string"}), count=0, cuts=[*numbers, 3, 150, 0])
    assert len(cuts) == 203 and cuts[0] == b""
    whole = []
    for one, two in pairwise(cuts[:200]):
        if two == b"":
            whole.append(one)
        else:
            assert len(two) == len(one) + 1 and is_prefix(one, two)
    # The last of the cuts of a packet is the packet; each is another one, and all are good.
    assert len(set(whole)) == len(whole) >= 3
    plan = build_plan(lay_out(make("ros2", {"s": "string"})), bus_bytes=4, max_message_bytes=300)
    assert {decode(plan, each).status for each in whole} == {"OK"}
    # A number means the same cut again, whatever was asked for before.
    assert cuts[200:] == [cuts[3], cuts[150], cuts[0]]
