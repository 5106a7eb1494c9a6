"""The checkers of the fuzzer: what a right circuit does passes, and each other thing breaks a rule.

The circuit is a script: lines that say what it offers, and what of that is taken.
"""

from __future__ import annotations

import subprocess

import pytest

from firm_hdl.fuzz.table import table_of
from tests.fuzz.programs import compiled
from tests.strategies import make

# Reads `PACKET number hex`, `offer output words`, `cycle`, `take output words`, `beat last`,
# `counters words`, `reset`, `end` and `state`, and writes what the checker says.
MAIN = r"""
#include <fstream>
#include <iostream>
#include <sstream>

struct Script : Circuit {
    void set_clock(bool) override {}
    void evaluate() override {}
};

int main(int, char** argv) {
    std::ifstream text(argv[1]);
    const Table table = read_table(text);
    Script circuit;
    circuit.bus_bytes = table.bus_bytes;
    circuit.kind = static_cast<CircuitKind>(std::stoi(argv[2]));
    circuit.drops = std::stoi(argv[3]);
    circuit.memory_bytes = std::stoi(argv[4]);
    circuit.memory_packets = std::stoi(argv[5]);
    const int data = 1 + (table.bus_bytes + 3) / 4;
    if (circuit.kind == CircuitKind::Deserializer) {
        for (const Leaf& leaf : table.leaves)
            circuit.outputs.push_back({leaf.name, nullptr, 1 + leaf.words()});
        circuit.outputs.push_back({"status", nullptr, 2});
    } else if (circuit.kind == CircuitKind::Loop) {
        circuit.outputs = {{"packets_out", nullptr, data + (table.bus_bytes + 31) / 32},
                           {"status", nullptr, 2}, {"serializer_status", nullptr, 2}};
    } else {
        circuit.outputs = {{"packets_out", nullptr, data + 2}, {"status", nullptr, 2}};
    }
    Judge judge(table);
    uint32_t counters[9] = {};
    circuit.counters = counters;
    const auto checker = make_checker(circuit, table);
    try {
        std::string line, what, packet;
        while (std::getline(std::cin, line)) {
            std::istringstream in(line);
            in >> what;
            uint32_t number = 0, word = 0;
            std::vector<uint32_t> words;
            if (what != "cycle" && what != "counters") in >> number;
            if (what == "PACKET") {
                auto sent = std::make_shared<Sent>();
                sent->number = number;
                in >> packet;
                for (size_t at = 0; at < packet.size() && packet != "-"; at += 2)
                    sent->bytes.push_back(std::stoi(packet.substr(at, 2), nullptr, 16));
                const size_t bus = table.bus_bytes;
                sent->beats = std::max<size_t>(1, (sent->bytes.size() + bus - 1) / bus);
                judge.judge(sent->bytes, sent->expected);
                checker->sent(sent);
                continue;
            }
            while (in >> word) words.push_back(word);
            words.resize(100);
            if (what == "offer") checker->offered(number, words.data());
            if (what == "take") checker->taken(number, words.data());
            if (what == "cycle") checker->offered_all();
            if (what == "beat") checker->beat_taken(number);
            if (what == "counters") std::copy(words.begin(), words.begin() + 9, counters);
            if (what == "reset") std::cout << "lost " << checker->reset() << "\n";
            if (what == "end") checker->at_end();
            if (what == "state")
                std::cout << (checker->is_done() ? "done" : "busy") << " progress "
                          << checker->progress() << " oldest " << checker->oldest()
                          << " budget " << checker->budget() << " transfers "
                          << checker->tally.transfers << "\n";
        }
    } catch (const Broken& broken) {
        std::cout << broken.what() << "|" << broken.packet << "|" << broken.expected << "|"
                  << broken.came << "\n";
    }
}
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    parts = ("checker", "gate_checker", "judge", "table")
    return compiled(tmp_path_factory.mktemp("checkers"), MAIN, *parts)


KINDS = {"deserializer": 0, "loop": 1, "gate": 2}


@pytest.fixture
def play(program, tmp_path):
    """Let a checker see a script; return the lines that it says."""

    def played(kind, lines, message, bus_bytes=4, drops=False, memory_bytes=64, memory_packets=4):
        made = table_of(message, wire="ros1", bus_bytes=bus_bytes, max_message_bytes=300)
        (tmp_path / "table.txt").write_text(made.text())
        options = (KINDS[kind], int(drops), memory_bytes, memory_packets)
        said = subprocess.run(
            [program, tmp_path / "table.txt", *map(str, options)],
            input="".join(f"{line}\n" for line in lines),
            capture_output=True,
            text=True,
            check=True,
            timeout=30,
        )
        return said.stdout.splitlines()

    return played


def words(data: bytes) -> str:
    """Return bytes as numbers of 32 bits."""
    data += bytes(-len(data) % 4)
    return " ".join(str(int.from_bytes(data[n : n + 4], "little")) for n in range(0, len(data), 4))


# A number, and a text of six letters: four transfers, and a status.
MESSAGE = make("ros1", {"a": "uint8", "s": "string"})
PACKET = bytes.fromhex("07 06000000") + b"abcdef"
A, LENGTH, ITEMS, STATUS = range(4)
RIGHT = [
    *(f"offer {A} 0 7", "cycle", f"take {A}"),
    *(f"offer {LENGTH} 0 6", "cycle", f"take {LENGTH}"),
    *(f"offer {ITEMS} 0 {words(b'abcd')}", "cycle", f"take {ITEMS}"),
    *(f"offer {ITEMS} 1 {words(b'ef')}", "cycle", f"take {ITEMS}"),
    *(f"offer {STATUS} 0 0", "cycle", f"take {STATUS}"),
]


def sent(number, packet=PACKET):
    return f"PACKET {number} {packet.hex() or '-'}"


def test_a_right_deserializer_passes(play):
    lines = [sent(5), "state", *RIGHT, "state", sent(6), "state", *RIGHT, "state"]
    # Cycles: 64, three for each of 3 beats and 4 transfers, and one for each of 11 bytes that come
    # and that a serializer writes. Without a packet, only what may take long anyway.
    budget = 64 + 3 * (3 + 4) + 11 + 11
    assert play("deserializer", lines, MESSAGE) == [
        f"busy progress 0 oldest 5 budget {budget} transfers 0",
        # Progress is a status, and a packet that is complete.
        "done progress 2 oldest 5 budget 128 transfers 5",
        f"busy progress 2 oldest 6 budget {budget} transfers 5",
        "done progress 4 oldest 6 budget 128 transfers 10",
    ]


def test_a_packet_is_complete_with_its_last_transfer_and_the_first_ones_come_first(play):
    budget = 64 + 3 * (3 + 4) + 11
    early = [
        "state",
        "offer 0 0 7",
        "offer 1 0 6",
        f"offer 2 0 {words(b'abcd')}",
        "cycle",
        "take 2",
    ]
    early += [f"offer 2 1 {words(b'ef')}", "offer 3 0 0", "cycle", "take 3", "state"]
    # The second packet waits for the leaves of the first one, too.
    late = ["take 0", "take 1", "state", "take 2", "state"]
    assert play("deserializer", [sent(5), sent(6), *early, *late], MESSAGE) == [
        f"busy progress 0 oldest 5 budget {budget + 11} transfers 0",
        f"busy progress 1 oldest 5 budget {budget + 2 * 11} transfers 2",
        f"busy progress 1 oldest 5 budget {budget + 2 * 11} transfers 4",
        f"busy progress 2 oldest 6 budget {budget + 11} transfers 5",
    ]


def test_a_leaf_may_be_ahead_by_a_packet(play):
    """The number of the second packet is taken before the length of the first."""
    lines = [sent(5), sent(6), *RIGHT[:3], "offer 1 0 6", *RIGHT[6:], "offer 0 0 7", "cycle"]
    lines += ["take 0", "state", "take 1", "state"]
    first, second = play("deserializer", lines, MESSAGE)
    assert first.startswith("busy progress 1 oldest 5 ") and first.endswith(" transfers 5")
    assert second.startswith("busy progress 2 oldest 6 ") and second.endswith(" transfers 6")


def test_what_was_cut_has_the_time_to_be_written_as_a_whole(play):
    budget = 64 + 3 * (2 + 4) + 7 + 11
    assert play("deserializer", [sent(0, PACKET[:7]), "state"], MESSAGE) == [
        f"busy progress 0 oldest 0 budget {budget} transfers 0"
    ]


@pytest.mark.parametrize(
    ("at", "line", "broken"),
    [
        (0, "offer 0 0 8", "a wrong value on a|6|0x00000007|0x00000008"),
        (0, "offer 0 1 7", "a wrong value on a|6|0x00000007|0x00000007 last"),
        (3, "offer 1 0 5", "a wrong value on s.length|6|0x00000006|0x00000005"),
        (6, f"offer 2 1 {words(b'abcd')}", "|6|0x64636261|0x64636261 last"),
        (9, f"offer 2 0 {words(b'ef')}", "|6|0x00006665 last|0x00006665"),
        # Items that there are not are 0.
        (9, f"offer 2 1 {words(b'efg')}", "|6|0x00006665 last|0x00676665 last"),
        (12, "offer 3 0 2", "a wrong value on status|6|OK|TRAILING"),
        (0, "offer 1 0 6", "leaves do not become valid in wire order|6|transfer 5|transfer 6"),
        (12, "offer 0 0 7", "an extra transfer on a|6|nothing|0x0000000700000000"),
    ],
)
def test_what_a_deserializer_may_not_do(play, at, line, broken):
    second = [*RIGHT[:at], line, *RIGHT[at + 1 :]]
    (said,) = play("deserializer", [sent(5), *RIGHT, sent(6), *second], MESSAGE)
    assert said.endswith(broken)


def test_an_extra_transfer_belongs_to_the_last_packet(play):
    """Its episode can be repeated; there is none of a packet that was not sent."""
    (said,) = play("deserializer", [sent(255), *RIGHT, "offer 1 0 6"], MESSAGE)
    assert said == "an extra transfer on s.length|255|nothing|0x0000000600000000"


def test_what_becomes_valid_in_the_same_cycle_has_no_order(play):
    lines = [sent(0), "offer 3 0 0", f"offer 2 0 {words(b'abcd')}", "offer 1 0 6", "offer 0 0 7"]
    # The second transfer of items is missing before the status.
    assert play("deserializer", [*lines[:1], *lines[3:], "cycle"], MESSAGE) == []
    (said,) = play("deserializer", [*lines, "cycle"], MESSAGE)
    assert said == "leaves do not become valid in wire order|0|transfer 3|transfer 4"


def test_a_reset_loses_what_is_inside_and_begins_anew(play):
    lines = [sent(5), *RIGHT, sent(6), sent(7), *RIGHT[:3], "reset", "reset", "state"]
    lines += [sent(7), *RIGHT[:-1], "state", RIGHT[-1], "state"]
    # A packet that has its status is not lost.
    lines += [sent(8), "offer 3 0 0", "take 3", "reset"]
    first, again, empty, almost, done, judged = play("deserializer", lines, MESSAGE)
    assert almost.startswith("busy progress 2 oldest 7 ") and judged == "lost 0"
    assert [first, again, empty, done] == [
        "lost 2",
        "lost 0",
        "done progress 2 oldest 7 budget 128 transfers 6",
        "done progress 4 oldest 7 budget 128 transfers 11",
    ]


BACK, STATUS_IN, STATUS_OUT = range(3)
LOOPED = [
    *(f"offer {BACK} 0 {words(PACKET[:4])} 15", f"take {BACK}"),
    *(f"offer {BACK} 0 {words(PACKET[4:8])} 15", f"take {BACK}"),
    # The last lane may be anything.
    *(f"offer {BACK} 1 {words(PACKET[8:] + b'?')} 7", f"take {BACK}"),
    *(f"offer {STATUS_IN} 0 0", f"take {STATUS_IN}"),
    *(f"offer {STATUS_OUT} 0 0", f"take {STATUS_OUT}"),
]


@pytest.mark.parametrize(
    ("at", "line", "broken"),
    [
        (
            0,
            f"offer 0 1 {words(PACKET[:4])} 15",
            "a wrong beat 0 on packets_out|5|07060000 flags 0",
        ),
        (
            0,
            f"offer 0 2 {words(PACKET[:4])} 15",
            "a wrong beat 0 on packets_out|5|07060000 flags 0",
        ),
        (0, f"offer 0 0 {words(PACKET[:4])} 7", "a wrong beat 0 on packets_out|5|07060000 flags 0"),
        (
            2,
            f"offer 0 0 {words(PACKET[:4])} 15",
            "a wrong beat 1 on packets_out|5|00616263 flags 0",
        ),
        (4, f"offer 0 0 {words(PACKET[8:])} 7", "a wrong beat 2 on packets_out|5|646566 flags 1"),
        (4, f"offer 0 1 {words(PACKET[8:])} 15", "a wrong beat 2 on packets_out|5|646566 flags 1"),
        (4, f"offer 0 1 {words(PACKET[8:])} 3", "a wrong beat 2 on packets_out|5|646566 flags 1"),
        (4, f"offer 0 1 {words(b'deg')} 7", "a wrong beat 2 on packets_out|5|646566 flags 1"),
        (6, "offer 1 0 1", "a wrong value on status|5|OK|TRUNCATED"),
        (8, "offer 2 0 1", "a wrong value on serializer_status|5|OK|TRUNCATED"),
        (10, f"offer 0 0 {words(PACKET[:4])} 15", "an extra transfer on packets_out|5|nothing"),
    ],
)
def test_what_a_loop_may_not_do(play, at, line, broken):
    assert play("loop", [sent(5), *LOOPED, "state"], MESSAGE) == [
        "done progress 2 oldest 5 budget 128 transfers 5"
    ]
    (said,) = play("loop", [sent(5), *LOOPED[:at], line], MESSAGE)
    assert said.startswith(broken)


def test_a_loop_writes_zeros_for_what_was_cut_and_calls_only_the_input_wrong(play):
    """The packet ends in its text, and what comes back is as long as its length says."""
    cut = sent(0, PACKET[:7])
    zeros = PACKET[:7] + bytes(4)
    right = [f"offer 0 0 {words(zeros[:4])} 15", "take 0", f"offer 0 0 {words(zeros[4:8])} 15"]
    right += ["take 0", "offer 0 1 0 7", "offer 1 0 1", "offer 2 0 0"]
    assert play("loop", [cut, *right], MESSAGE) == []
    for line, broken in (
        (f"offer 0 1 {words(zeros[:4])} 15", "a wrong beat 0 on packets_out|0|07060000 flags 0|"),
        ("offer 1 0 0", "a wrong value on status|0|TRUNCATED|OK"),
        ("offer 2 0 1", "a wrong value on serializer_status|0|OK|TRUNCATED"),
    ):
        (said,) = play("loop", [cut, line], MESSAGE)
        assert said.startswith(broken)


@pytest.mark.parametrize("size", [31, 32, 33, 40, 63, 64])
def test_each_lane_of_a_wide_bus_has_a_bit(play, size):
    packet = bytes([7, size - 5, 0, 0, 0]) + b"x" * (size - 5)
    keep = (1 << size) - 1
    right = f"{keep & 0xFFFF_FFFF} {keep >> 32}"
    data = words(packet + b"?" * (64 - size))
    assert play("loop", [sent(0, packet), f"offer 0 1 {data} {right}"], MESSAGE, 64) == []
    for bit in {0, size - 1, min(size, 63), 63}:
        wrong = keep ^ 1 << bit
        line = f"offer 0 1 {data} {wrong & 0xFFFF_FFFF} {wrong >> 32}"
        (said,) = play("loop", [sent(0, packet), line], MESSAGE, 64)
        assert said.startswith("a wrong beat 0 on packets_out|0|")


@pytest.mark.parametrize("bus_bytes", [1, 2])
def test_a_narrow_bus_has_its_lanes_in_one_word(play, bus_bytes):
    message = make("ros1", {"a": "uint8"})
    assert play("loop", [sent(0, b"\7"), "offer 0 1 7 1"], message, bus_bytes) == []
    for wrong in ("0 1 8 1", "0 1 7 0", "0 0 7 1"):
        (said,) = play("loop", [sent(0, b"\7"), f"offer {wrong}"], message, bus_bytes)
        assert said.startswith("a wrong beat 0 on packets_out|0|07 flags 1|")


def test_a_message_without_bytes_comes_back_as_one_empty_beat(play):
    nothing = make("ros1", {})
    assert play("loop", [sent(0, b""), "offer 0 1 99 0", "take 0"], nothing) == []
    (said,) = play("loop", [sent(0, b""), "offer 0 1 99 1"], nothing)
    assert said.startswith("a wrong beat 0 on packets_out|0|(empty) flags 1|0x")


def gate(*, data=PACKET, size=11, counts=(4, 4, 3), status=0):
    """Return what a gate does with `PACKET`: it comes, has a status, and leaves."""
    lines = ["beat 0", "beat 0", "beat 1", f"offer 1 0 {status}", f"take 1 0 {status}"]
    for number, count in enumerate(counts):
        beat = f"0 {int(number == 2)} {words(data[4 * number :][:4])} {count} {size}"
        lines += [f"offer {beat}", f"take {beat}"]
    return lines


def test_a_right_gate_passes_and_counts_since_its_reset(play):
    lines = [sent(5), *gate(), "counters 1", "end", "reset", "counters 0", "end"]
    lines += [sent(6), *gate(), sent(7), "state", *gate(), "state", "counters 2", "end"]
    busy, *done = play("gate", lines, MESSAGE)[1:]
    assert busy.startswith("busy progress 2 oldest 7 ")
    assert len(done) == 1 and done[0].startswith("done progress 3 oldest 7 ")


WHOLE = PACKET.hex()


@pytest.mark.parametrize(
    ("lines", "broken"),
    [
        (gate(data=PACKET[:-1] + b"?"), f"a wrong packet on packets_out|5|{WHOLE}|07060000"),
        (gate(size=12), f"a wrong packet on packets_out|5|{WHOLE}|{WHOLE}, size 12"),
        (gate(counts=(4, 4, 2)), f"a wrong packet on packets_out|5|{WHOLE}|{WHOLE[:-2]}, size 11"),
        (gate(counts=(4, 3, 3)), "a wrong size or count on packets_out|5|size 11, full beats|"),
        ([*gate()[:-1], "take 0 1 0 3 10"], "a wrong size or count on packets_out|5|size 11, full"),
        (gate(status=1), "a wrong value on status|5|OK|TRUNCATED"),
        # It has room for the packet, so it is not full, and none waits.
        (gate(status=8), "a wrong value on status|5|OK|FULL"),
        (gate(status=10), "a wrong value on status|5|OK|OVERRUN"),
        ([*gate(), "offer 1 0 0"], "an extra transfer on status|5|nothing|OK"),
        ([*gate(), "offer 0 0 0 4 4"], "a packet leaves before it has come|5|nothing|a beat"),
        (["beat 0", "beat 0", "offer 0 0 0 4 11"], "a packet leaves before it has come|5|nothing|"),
        ([*gate(), "counters 2", "end"], "a wrong counter of OK|5|1|2"),
        ([*gate(), "counters 1 0 0 0 0 0 0 0 1", "end"], "a wrong counter of OVERRUN|5|0|1"),
    ],
)
@pytest.mark.parametrize("drops", [False, True])
def test_what_a_gate_may_not_do(play, drops, lines, broken):
    (said,) = play("gate", [sent(5), *lines], MESSAGE, drops=drops)
    assert said.startswith(broken)


@pytest.mark.parametrize(
    ("status", "memory_bytes", "drops", "is_right"),
    [
        # A packet of 11 bytes in 3 beats is large, or finds no room for a beat beside its own.
        *[(9, 10, False, True), (9, 11, False, False), (0, 10, False, False), (0, 11, False, True)],
        *[(8, 16, True, True), (8, 20, True, False), (8, 16, False, False)],
    ],
)
def test_a_gate_has_a_reason_to_refuse(play, status, memory_bytes, drops, is_right):
    lines = [sent(5), *gate(status=status)[:5]]
    said = play("gate", lines, MESSAGE, drops=drops, memory_bytes=memory_bytes)
    assert (said == []) is is_right
