"""The stages of TS3, one by one: oracle, confirmation, golden model, and what is simulated."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

import firm_hdl.verify.ts3.acceptance as acceptance
from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.damage import stalls_for
from firm_hdl.cases.oracle import RosbagsOracle
from firm_hdl.cases.wide_oracle import WideOracle
from firm_hdl.frontend import Library
from firm_hdl.verify import Options, Result, accept
from firm_hdl.verify.results.verdict import NotJudged

STRING = "std_msgs/msg/String"
BARE = bytes.fromhex("00010000 00000000")


@pytest.mark.parametrize(
    ("given", "distro", "stand_in"),
    [
        ({}, "lyrical", True),
        # What a user or a recording defines is judged by its own definition.
        ({"paths": ("p",)}, None, True),
        ({"bags": ("b",)}, None, False),
        ({"paths": ("p",), "bags": ("b",)}, None, False),
        ({"references": ("genpy",)}, "lyrical", False),
    ],
)
def test_the_oracle_of_a_type(monkeypatch, given, distro, stand_in):
    message, asked = Library("lyrical").message(STRING), []

    def judge_of(message, distro, *, stand_in):
        asked.append((message, distro, stand_in))
        return SimpleNamespace(note="a note")

    def library_of(*where):
        assert where == ("lyrical", Options(**given))
        return Library("lyrical")

    monkeypatch.setattr(acceptance, "library_of", library_of)
    monkeypatch.setattr(acceptance, "judge_of", judge_of)
    monkeypatch.setattr(acceptance, "may_stand_in", lambda message, references: not references)
    ran = []
    result = acceptance.measured("lyrical", STRING, Options(**given), lambda *all: ran.append(all))
    assert asked == [(message, distro, stand_in)]
    assert len(ran) == 1 and result.note == "a note" and result.failures == []


@pytest.mark.parametrize(
    ("error", "obstacle", "failures"),
    [
        (NotJudgedError("it is odd"), NotJudged("it is odd"), []),
        (NotJudgedError(), NotJudged("NotJudgedError"), []),
        (RuntimeError("it broke"), None, ["before", "RuntimeError: it broke"]),
    ],
)
def test_what_ends_a_test_is_in_its_result(error, obstacle, failures):
    def run(message, judge, options, result):
        result.failures += failures[:1]
        raise error

    result = acceptance.measured("lyrical", STRING, Options(), run)
    assert (result.obstacle, result.failures) == (obstacle, failures)
    assert result.cpu_seconds > 0


WIDE = WideOracle.__new__(WideOracle)
PLAIN = RosbagsOracle.__new__(RosbagsOracle)


@pytest.mark.parametrize(
    ("oracle", "references", "found", "failures", "obstacle"),
    [
        (PLAIN, None, {"by": ("genpy",)}, [], None),
        (PLAIN, None, {"failures": ("one", "two")}, ["one", "two"], None),
        # Only a library that was named has to be able to write the type.
        (PLAIN, None, {"unable": {"genpy": "no wire", "mcap": "no type"}}, [], None),
        (PLAIN, (), {"unable": {"genpy": "no wire"}}, [], None),
        (
            PLAIN,
            ("genpy", "mcap"),
            {"unable": {"genpy": "no wire", "mcap": "no type"}},
            [],
            NotJudged("no wire; no type"),
        ),
        (PLAIN, ("genpy",), {"by": ("genpy",)}, [], None),
        # Without rosbags, one of the libraries that have wide text has to confirm it.
        (WIDE, None, {"by": ("genpy", "fastcdr")}, [], None),
        (
            WIDE,
            None,
            {"by": ("genpy", "mcap")},
            ["fastcdr could not write wide text, which rosbags has not"],
            None,
        ),
    ],
)
def test_what_other_libraries_say_is_added(
    monkeypatch, oracle, references, found, failures, obstacle
):
    cases = [object()]
    nothing = {"by": (), "known": ("a key",), "failures": (), "unable": {}}

    def confirm(*given):
        assert given == ("message", "cdr", cases, references)
        return SimpleNamespace(**nothing | found)

    monkeypatch.setattr(acceptance, "confirm", confirm)
    result = Result(distro="lyrical", name=STRING, failures=["before"])
    options = Options(references=references)
    acceptance.confirm_cases("message", "cdr", cases, options, result, oracle)
    assert result.failures == ["before", *failures]
    assert (result.written_by, result.known) == (found.get("by", ()), ("a key",))
    assert result.obstacle == obstacle


def test_the_golden_model_has_to_read_a_bare_string(monkeypatch):
    """No library writes a string without its NUL, but other senders do."""
    original, asked = acceptance.decode, []

    def decode(plan, packet):
        asked.append(packet)
        # Of another packet, it reads another status.
        return original(plan, packet[:-1] if packet == BARE else packet)

    options = Options(simulated=False, references=())
    right = accept("lyrical", STRING, options)
    monkeypatch.setattr(acceptance, "decode", decode)
    (failure,) = accept("lyrical", STRING, options).failures
    assert failure.startswith("golden model, case ") and failure.endswith(": status TRUNCATED")
    # The packet of each case counts, and the bare one.
    assert asked.count(BARE) == 1 and right.judged == len(asked) == right.cases + 1


class Sent:
    """In place of a circuit: what was sent to it, and nothing comes back."""

    def __init__(self, made):
        self.runs = []
        made.append(self)

    def send(self, where, packets, stalls):
        self.runs.append((where, list(packets), stalls))

    def interrupt(self, packets):
        self.runs.append(("interrupted", list(packets), None))

    def crosscheck(self):
        self.runs.append(("replayed", [], None))


@pytest.fixture
def sent(monkeypatch):
    """A function that returns what is sent for a type, with its result and its packets."""
    circuits, golden = [], []

    def check(self, cases, bare):
        golden.append([*(case.sent for case in cases), *(packet for _, packet in bare)])
        return original(self, cases, bare)

    original = acceptance.Acceptance.check_golden_model
    monkeypatch.setattr(acceptance, "Circuit", lambda *given: Sent(circuits))
    monkeypatch.setattr(acceptance.Acceptance, "check_golden_model", check)

    def of(name=STRING, **options):
        result = accept("lyrical", name, Options(references=(), **options))
        assert result.failures == []
        return circuits[-1].runs, result, golden[-1]

    return of


def test_all_packets_are_sent_and_the_stalled_ones_after_an_interruption(sent):
    runs, result, packets = sent(seed=5)
    assert packets[-1] == BARE and result.note == ""
    cases = packets[:-1]
    assert [(where.partition(",")[0], given) for where, given, _ in runs[:3]] == [
        ("hardware", packets),
        ("interrupted", cases),
        ("hardware", cases),
    ]
    stalls = stalls_for(f"5/{STRING}")
    assert (runs[0][2], runs[2][2]) == (None, stalls)
    assert runs[2][0] == f"hardware, {stalls}"
    where, damaged, others = runs[3]
    assert where.startswith("hardware, broken packets, Stalls(") and others is not None
    assert set(damaged[1::2]) <= set(cases)
    assert [where for where, *_ in runs[4:]] == ["replayed"]


@pytest.mark.parametrize("has_bare", [True, False])
def test_a_part_of_the_packets_is_sent_if_all_are_too_much_work(monkeypatch, sent, has_bare):
    asked = []

    def packets_to_simulate(plan, packets, taken):
        asked.append((packets, taken))
        return [0, 2, *[len(packets) - 1] * has_bare]

    _, whole, packets = sent()
    monkeypatch.setattr(acceptance, "packets_to_simulate", packets_to_simulate)
    runs, result, _ = sent()
    ((given, taken),) = asked
    assert given == packets and len(taken) == len(packets)
    count = 2 + has_bare
    assert result.note == f"simulated in part: {count} of {len(packets)} packets"
    two = [packets[0], packets[2]]
    assert runs[0][1] == [*two, *[BARE] * has_bare]
    assert runs[1][1] == runs[2][1] == two
    assert set(runs[3][1][1::2]) <= set(two)
    # Decisions count only if what takes them is simulated.
    left = whole.coverage.possible - len(result.coverage.missing)
    assert result.coverage.taken == left < whole.coverage.taken
    # Whoever asks for some cases gets them.
    assert len(sent(most_cases=5)[0][0][1]) == len(sent(most_cases=5)[2])


@pytest.mark.parametrize("some", [True, False])
def test_large_types_are_stalled_and_damaged_less(monkeypatch, sent, some):
    monkeypatch.setattr(acceptance, "is_large", lambda plan, cases: True)
    monkeypatch.setattr(acceptance, "cases_to_disturb", lambda plan, cases: cases[1:2] * some)
    runs, result, packets = sent()
    assert runs[0][1] == packets
    if some:
        assert [given for _, given, _ in runs[1:3]] == [[packets[1]]] * 2
        assert result.note == "" and runs[3][1][1] == packets[1]
    else:
        assert [where for where, *_ in runs] == ["hardware", "replayed"]
        assert result.note == "neither stalled nor damaged"


def test_damage_and_stalls_follow_from_the_seed_and_the_type(monkeypatch, sent):
    original, asked = acceptance.broken_packets, []

    def broken_packets(plan, sample, rng):
        asked.append(([case.sent for case in sample], rng.getstate()[1][:3]))
        return original(plan, sample, rng)

    monkeypatch.setattr(acceptance, "broken_packets", broken_packets)
    monkeypatch.setattr(acceptance, "DAMAGES", [None] * 3)
    damaged = []
    for seed, name in ((1, STRING), (1, STRING), (2, STRING), (1, "std_msgs/msg/UInt8MultiArray")):
        runs, _, packets = sent(name, seed=seed, most_cases=9)
        damaged.append(runs[3])
        # The intact packet is sent behind the damaged one.
        assert asked[-1][0] == packets[:9:3] == runs[3][1][1::2]
    assert damaged[0] == damaged[1] != damaged[2]
    states = [state for _, state in asked]
    assert states[0] == states[1] and len(set(states)) == 3
    # What is not stalled in other runs is not stalled here, either.
    assert sent(stalled=False)[0][1][::2] == ("hardware, broken packets, None", None)
