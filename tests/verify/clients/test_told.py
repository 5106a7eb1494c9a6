"""The printed results of contests: the first differences in full, the others as counts."""

from __future__ import annotations

from collections import Counter
from types import SimpleNamespace

import pytest

from firm_hdl.verify.clients import command
from firm_hdl.verify.clients.finding import Finding
from firm_hdl.verify.clients.judge import LibraryResult
from firm_hdl.verify.references.client import ClientMissingError, Refusal
from firm_hdl.verify.results.verdict import Failed, NotJudged, Passed
from firm_hdl.verify.systems.options import Request

OPTIONS = SimpleNamespace(libraries=("mine", "yours"))


def again(options, distro, name, library):
    return f"{library} {name} {distro}"


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """Replace shrinking, so that each difference stays as it is."""
    monkeypatch.setattr(command, "command_of", again)
    monkeypatch.setattr(command, "shrunk", lambda finding, again: finding)
    monkeypatch.setattr(command, "comparison_of", lambda *_: SimpleNamespace(again=None))
    monkeypatch.setattr(command, "described", lambda finding: [f"    small {finding.what}"])


def trial(name, *whats, library="mine", obstacle=None, **more):
    findings = [SimpleNamespace(what=what, wire="cdr") for what in whats]
    task = SimpleNamespace(distro="lyrical", name=name)
    fields = {"library": library, "type": name, "findings": findings, "obstacle": obstacle, **more}
    return task, SimpleNamespace(**fields)


def printed_differences(*trials):
    return "\n".join(command._differences(trials, OPTIONS)).splitlines()


def named(name, what, library="mine"):
    return [f"DIFFERS {library}, {what}: {name} (lyrical)", f"    again: {library} {name} lyrical"]


def detailed(name, what, library="mine"):
    head, again = named(name, what, library)
    return [head, f"    small {what}", again]


@pytest.mark.parametrize("count", [1, 5, 6, 8])
def test_the_first_of_a_kind_is_printed_in_full_and_five_by_name(count):
    trials = [trial(f"T{n}", "encode") for n in reversed(range(count))]
    names = [line for n in range(1, min(count, 5)) for line in named(f"T{n}", "encode")]
    more = [f"DIFFERS mine, encode: and {count - 5} more types"] if count > 5 else []
    assert printed_differences(*trials) == [*detailed("T0", "encode"), *names, *more]


def test_kinds_and_libraries_are_counted_apart():
    lines = printed_differences(
        trial("B", "encode", "decode"), trial("A", "decode", library="yours")
    )
    assert lines == [
        *detailed("B", "encode"),
        *detailed("B", "decode"),
        *detailed("A", "decode", "yours"),
    ]


def test_five_kinds_for_each_library_are_printed_in_full():
    lines = printed_differences(trial("A", *(f"kind{n:02}" for n in range(12))))
    assert [line for line in lines if "small" in line] == [
        f"    small kind{n:02}" for n in range(10)
    ]
    assert lines[-2:] == named("A", "kind11")


def test_libraries_that_could_not_be_asked_follow_the_differences():
    failed = trial("A", obstacle=Failed(("it crashed", "and more")))
    silent = trial("B", obstacle=NotJudged("nobody"))
    assert printed_differences(failed, silent, trial("C", "encode")) == [
        *detailed("C", "encode"),
        "FAIL mine: A (lyrical): it crashed",
    ]


def test_the_smallest_case_is_found_by_the_questions_of_its_own_wire(monkeypatch):
    asked = []

    def comparison_of(result, wire):
        return SimpleNamespace(again=(result.library, result.type, wire))

    monkeypatch.setattr(command, "comparison_of", comparison_of)
    monkeypatch.setattr(command, "shrunk", lambda finding, again: asked.append(again) or finding)
    task, result = trial("A", "encode", "decode", library="yours")
    result.findings[1].wire = "ros1"
    # The command has the name that the user gave; the result has that of the type.
    result.type = "p/A"
    lines = printed_differences((task, result))
    assert asked == [("yours", "p/A", "cdr"), ("yours", "p/A", "ros1")]
    assert lines == [
        "DIFFERS yours, encode: p/A (lyrical)", "    small encode", "    again: yours A lyrical",
        "DIFFERS yours, decode: p/A (lyrical)", "    small decode", "    again: yours A lyrical",
    ]  # fmt: skip


def summary(*trials):
    versions = {"mine": "1.0", "yours": "2"}
    return list(command._summary(trials, OPTIONS, versions))


def judged(verdict, library="mine", comparisons=0, **known):
    return SimpleNamespace(
        library=library, verdict=verdict, comparisons=comparisons, known=Counter(known)
    )


def test_each_library_has_a_row_with_its_verdicts():
    head, mine, yours = summary(
        judged(Passed(3), comparisons=3),
        judged(Passed(4), comparisons=4),
        judged(Failed(("no",)), comparisons=5),
        judged(Passed(1), "yours", 9),
    )
    assert head.split() == ["types", "agree", "known", "differ", "not", "judged", "comparisons"]
    assert mine.split() == ["mine", "1.0", "2", "0", "1", "0", "12"]
    assert yours.split() == ["yours", "2", "1", "0", "0", "0", "9"]
    assert len(head) == len(mine) == len(yours)


def test_known_differences_and_reasons_are_counted():
    reasons = [judged(NotJudged(f"reason {n}")) for n in range(7) for _ in range(7 - n)]
    lines = summary(*reasons, judged(Passed(1), b=2, a=1), judged(Passed(1), a=1))[3:]
    assert lines == [
        "known, mine: a: 2",
        "known, mine: b: 2",
        *(f"not judged, mine: reason {n}: {7 - n}" for n in range(5)),
        "not judged, mine: other reasons: 3",
    ]
    assert summary(*reasons[:22])[3:] == [
        f"not judged, mine: reason {n}: {7 - n}" for n in range(4)
    ]
    # Those of each library are its own, in the order in which the libraries were named.
    both = [judged(NotJudged(why), name, k=2) for why, name in (("one", "yours"), ("two", "mine"))]
    assert summary(*both)[3:] == [
        "known, mine: k: 2",
        "not judged, mine: two: 1",
        "known, yours: k: 2",
        "not judged, yours: one: 1",
    ]


def test_a_difference_is_described_completely(make_message, monkeypatch):
    monkeypatch.undo()
    given = {
        "library": "mine", "reference": "yours", "wire": "cdr", "value": {"a": 1},
        "message": make_message("uint8 a"),
    }  # fmt: skip
    read = Finding(what="decode", packet=b"\1\2", expected={"a": 1}, got={"a": 2}, **given)
    lines = command.described(read)
    assert lines[0] == "    uint8 a"
    assert [line.partition(":")[0].strip() for line in lines[1:]] == [
        "value", "packet", "yours", "mine"
    ]  # fmt: skip
    assert "    packet: 0102" in lines
    odd = Finding(what="cut-1", packet=b"\1", expected=Refusal("no"), got={}, **given)
    assert command.described(odd)[-3:] == [
        "    packet: 01", "    yours: refuses: no", "    mine: {}"
    ]  # fmt: skip
    none = Finding(what="decode", packet=b"", expected=b"\7", got=b"", **given)
    assert command.described(none)[-3:] == [
        "    packet: no bytes", "    yours: 07", "    mine: no bytes"
    ]  # fmt: skip
    written = Finding(what="encode", packet=b"\1", expected=b"\7", got=[1], **given)
    assert not any("packet" in line for line in command.described(written))
    assert command.described(written)[-1] == "    mine: [1]"
    # The packet of an unusual value is not that which differs, either.
    odd = Finding(what="encode bound", packet=b"\1", expected=b"", got=b"\1", **given)
    assert not any("packet" in line for line in command.described(odd))


@pytest.mark.parametrize(
    ("text", "answer", "said"),
    [
        ("", {}, "a message without fields"),
        ("uint8[2] a", {"a": [1, 2]}, "a: [1, 2]"),
        # None of these is a value of its type.
        ("uint8 a", {"b": 1}, "{'b': 1}"),
        ("uint8 a", None, "None"),
        ("uint8 a", [], "[]"),
        ("float32 a", {"a": "x"}, "{'a': 'x'}"),
    ],
)
def test_answers_are_shown_whatever_they_are(make_message, monkeypatch, text, answer, said):
    monkeypatch.undo()
    finding = SimpleNamespace(message=make_message(text))
    assert command._answer(finding, answer) == said


def test_of_a_long_difference_the_start_is_described(make_message, monkeypatch):
    monkeypatch.undo()
    finding = Finding(
        library="mine", reference="yours", wire="cdr", what="decode",
        message=make_message("uint8[] a"), value={"a": [7] * 400}, packet=b"\1" * 201,
        expected=b"\2" * 200, got=b"\3" * 201,
    )  # fmt: skip
    value, *others = command.described(finding)[1:]
    assert value.startswith("    value: a: [7, 7, ") and value.endswith(" characters)")
    assert others == [
        f"    packet: {'01' * 200}... (402 characters)",
        f"    yours: {'02' * 200}",
        f"    mine: {'03' * 200}... (402 characters)",
    ]


def test_long_answers_are_cut():
    most = command.MOST_CHARACTERS
    assert command.clipped("x" * most, most) == "x" * most
    assert command.clipped("x" * (most + 1), most) == f"{'x' * most}... ({most + 1} characters)"


def test_each_library_is_told_its_judge_on_each_wire_that_it_has():
    names = ("genpy", "rosbags", "cyclonedds", "fastcdr", "fastcdr-2.3")
    versions = {name: f"{number}.0" for number, name in enumerate(names)}
    options = SimpleNamespace(libraries=("genpy", "rosbags", "cyclonedds"))
    lines = command._judges(["ros1", "cdr"], options, versions, {}, names)
    assert list(lines) == [
        "genpy 0.0 on ros1: judged by rosbags 1.0",
        "rosbags 1.0 on ros1: judged by genpy 0.0",
        "rosbags 1.0 on cdr: judged by fastcdr 3.0",
        "cyclonedds 2.0 on cdr: judged by fastcdr 3.0",
    ]
    missing = {"fastcdr": "no Fast CDR", "fastcdr-2.2": "none either"}
    lines = command._judges(["cdr"], options, versions, missing, names[:3])
    assert list(lines) == [
        "fastcdr, which is ROS's own on cdr, is not installed: no Fast CDR",
        "rosbags 1.0 on cdr: judged by no reference",
        "cyclonedds 2.0 on cdr: judged by rosbags 1.0",
    ]


OF_ROS1, OF_CDR = ["rosbags", "genpy"], ["rosbags", "fastcdr", "fastcdr-2.2", "fastcdr-2.3"]


@pytest.mark.parametrize(
    ("distros", "wire", "references"),
    [
        (["lyrical", "humble"], None, OF_CDR),
        (["noetic"], None, OF_ROS1),
        (["lyrical", "noetic"], None, [*OF_ROS1, *OF_CDR[1:]]),
        (["noetic"], "cdr", OF_CDR),
    ],
)
def test_references_of_all_wires_are_looked_for(monkeypatch, capsys, distros, wire, references):
    asked, given, ended = [], [], []

    def find_clients(names):
        asked.extend(names)
        return {name: "1" for name in names if name != "genpy"}, {"genpy": "no genpy"}

    def judge_types(tasks, options, installed):
        given.append(installed)
        for task in tasks:
            yield task, [
                LibraryResult(
                    library="cyclonedds", reference="x", type="T", comparisons=1, answers=1,
                    is_asked=task.distro != "noetic",
                )
            ]  # fmt: skip

    monkeypatch.setattr(command, "find_clients", find_clients)
    monkeypatch.setattr(command, "judge_types", judge_types)
    monkeypatch.setattr(command, "close_clients", lambda: ended.append(True))
    tasks = [SimpleNamespace(distro=name, name="T", same=(name,)) for name in distros]
    found = command.run_sut(tasks, Request(libraries=("cyclonedds",), wire=wire))
    assert asked == ["cyclonedds", *references] and ended == [True]
    assert given == [tuple(name for name in references if name != "genpy")]
    assert [each.what for each in found] == [
        f"T ({name}), cyclonedds" for name in distros if name != "noetic"
    ]
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1].startswith(f"{len(tasks)} types, ") and lines[-1].endswith(" 0 differ")
    with pytest.raises(ClientMissingError, match=r"^no genpy$"):
        command.run_sut(tasks, Request(libraries=("cyclonedds", "genpy")))
    # A library that judges others is looked for once, even if it is judged itself.
    asked.clear()
    command.run_sut(tasks[:1], Request(libraries=("fastcdr", "rosbags"), wire="cdr"))
    assert asked == ["fastcdr", "rosbags", "fastcdr-2.2", "fastcdr-2.3"]


def test_each_library_has_a_verdict_on_each_type(monkeypatch, capsys):
    def judge_types(tasks, options, installed):
        for task in tasks:
            yield (
                task,
                [
                    LibraryResult(library="genpy", reference="x", type=task.name, unknown=2),
                    LibraryResult(
                        library="rosbags", reference="x", type=task.name, comparisons=3, answers=1
                    ),
                ],
            )

    monkeypatch.setattr(command, "find_clients", lambda names: (dict.fromkeys(names, "1"), {}))
    monkeypatch.setattr(command, "judge_types", judge_types)
    monkeypatch.setattr(command, "close_clients", lambda: None)
    tasks = [
        SimpleNamespace(distro="foxy", name="A", same=("foxy", "iron")),
        SimpleNamespace(distro="noetic", name="B", same=("noetic",)),
    ]
    found = command.run_sut(tasks, Request(libraries=("genpy", "rosbags")))
    failed = Failed(("2 differences",))
    assert [(each.what, each.verdict) for each in found] == [
        ("A (foxy, iron), genpy", failed),
        ("A (foxy, iron), rosbags", Passed(3)),
        ("B (noetic), genpy", failed),
        ("B (noetic), rosbags", Passed(3)),
    ]
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith("2 types, ") and last.endswith(" s, 2 differ")
