"""Which reference judges a library on a type, on which wire, and with which values."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from firm_hdl.cases import NotJudgedError
from firm_hdl.verify.clients import run as module
from firm_hdl.verify.clients.judge import LibraryResult
from firm_hdl.verify.clients.run import judge_type, judge_types
from firm_hdl.verify.results.verdict import Failed, NotJudged
from firm_hdl.verify.systems.options import Request
from tests.frontend.workspace import make_files

BOOL = "std_msgs/msg/Bool"
INSTALLED = ("genpy", "rosbags", "fastcdr", "fastcdr-2.3")
OPTIONS = Request(libraries=("firm-hdl",), most_cases=2, seed=5)


@pytest.fixture
def asked(monkeypatch):
    """Comparisons that are asked for; `obstacles` has what is in the way, by reference."""
    found = SimpleNamespace(calls=[], obstacles={}, values=[])

    class Comparison:
        def __init__(self, library, reference, wire):
            self.library, self.reference, self.wire = library, reference, wire

        def judge(self, message, values):
            names = self.library.name, self.reference.name
            found.calls.append((*names, self.wire, message.name))
            found.values.append(values)
            return LibraryResult(
                library=names[0],
                reference=names[1],
                type=message.name,
                comparisons=1,
                answers=1,
                obstacle=found.obstacles.get(names[1]),
            )

    wires = {"mcap-ros1": {"ros1"}, "cyclonedds": {"cdr"}}
    monkeypatch.setattr(module, "LibraryComparison", Comparison)
    monkeypatch.setattr(
        module,
        "client",
        lambda name: SimpleNamespace(name=name, wires=wires.get(name, {"ros1", "cdr"})),
    )
    return found


@pytest.mark.parametrize(
    ("distro", "wire", "reference", "used"),
    [
        ("lyrical", None, "fastcdr", "cdr"),
        ("lyrical", "cdr", "fastcdr", "cdr"),
        ("lyrical", "ros1", "genpy", "ros1"),
        ("noetic", None, "genpy", "ros1"),
        ("noetic", "cdr", "fastcdr", "cdr"),
    ],
)
def test_the_wire_is_that_of_the_type_or_another_one(asked, distro, wire, reference, used):
    (result,) = judge_type(distro, BOOL, replace(OPTIONS, wire=wire), INSTALLED)
    name = "std_msgs/Bool" if distro == "noetic" else BOOL
    assert asked.calls == [("firm-hdl", reference, used, name)]
    assert result.reference == reference


def test_the_first_reference_that_has_the_type_judges(asked):
    asked.obstacles = {"fastcdr": NotJudged("no wstring"), "fastcdr-2.3": Failed(("it died",))}
    (result,) = judge_type("lyrical", BOOL, OPTIONS, INSTALLED)
    assert [call[1] for call in asked.calls] == ["fastcdr", "fastcdr-2.3"]
    assert result.verdict == Failed(("it died",))
    asked.obstacles["fastcdr-2.3"] = NotJudged("no bound")
    (result,) = judge_type("lyrical", BOOL, OPTIONS, INSTALLED)
    assert result.reference == "rosbags" and result.verdict.name == "passed"
    # The first reason is given if none of them has the type.
    asked.obstacles["rosbags"] = NotJudged("no type")
    (result,) = judge_type("lyrical", BOOL, OPTIONS, INSTALLED)
    assert (result.reference, result.verdict) == ("fastcdr", NotJudged("no wstring"))
    (result,) = judge_type("lyrical", BOOL, OPTIONS, ("genpy",))
    assert result.verdict == NotJudged("no reference for cdr is installed")


@pytest.mark.parametrize("is_named", [False, True])
def test_a_library_without_the_wire_counts_only_if_wires_were_named(asked, is_named):
    libraries = ("mcap-ros1", "cyclonedds", "rosbags")
    options = replace(OPTIONS, libraries=libraries)
    options = replace(options, wire="cdr") if is_named else options
    results = judge_type("lyrical", BOOL, options, INSTALLED)
    assert [result.library for result in results] == list(libraries)
    assert [result.is_asked for result in results] == [is_named, True, True]
    # All libraries get the same values.
    assert len(asked.values) == 3 and asked.values[0] is asked.values[1] is asked.values[2]


def test_values_follow_from_the_options(asked, tmp_path, monkeypatch):
    def values(**more):
        asked.values.clear()
        judge_type("lyrical", "std_msgs/msg/String", replace(OPTIONS, **more), INSTALLED)
        return asked.values[0]

    assert values() == values() != values(seed=6)
    assert (
        len(values()) == 2 and len(values(most_cases=4)) == 4 and len(values(most_cases=None)) > 8
    )
    assert values(most_cases=4)[:2] == values()
    # A user's type may have the name of another one of the distribution.
    make_files(tmp_path, {"std_msgs/msg/String.msg": "uint8 own\n"})
    own = values(paths=(str(tmp_path),))
    assert [list(value) for value in own] == [["own"]] * 2
    wide = make_files(tmp_path / "wide", {"p/msg/W.msg": "wstring w\n"})
    asked.values.clear()
    judge_type("lyrical", "p/msg/W", replace(OPTIONS, paths=(str(wide),)), INSTALLED)
    assert asked.values[0][0].keys() == {"w"}


@pytest.mark.parametrize("error", [NotJudgedError("rosbags has none"), ValueError("too deep")])
def test_a_type_without_values_is_not_judged_by_any_library(asked, monkeypatch, error):
    def refuse(*given, **more):
        raise error

    monkeypatch.setattr(module, "judge_of", refuse)
    results = judge_type("lyrical", BOOL, replace(OPTIONS, libraries=("a", "b")), INSTALLED)
    assert [(each.library, each.type, each.verdict) for each in results] == [
        (name, BOOL, NotJudged(str(error))) for name in ("a", "b")
    ]
    (missing,) = judge_type("lyrical", "p/msg/None", OPTIONS, INSTALLED)
    assert isinstance(missing.verdict, NotJudged) and not asked.calls


def test_an_error_of_our_own_ends_the_run(monkeypatch):
    tasks = [SimpleNamespace(distro="lyrical", name=name) for name in ("p/A", "p/B", "p/C")]

    def in_processes(work, given, jobs):
        assert (work, jobs) == (module.judge_type, 3)
        assert [arguments for _, arguments in given] == [
            ("lyrical", task.name, options, INSTALLED) for task in tasks
        ]
        yield tasks[0], ["result"]
        yield tasks[1], KeyError("gone")

    options = replace(OPTIONS, jobs=3)
    monkeypatch.setattr(module, "in_processes", in_processes)
    found = judge_types(tasks, options, INSTALLED)
    assert next(found) == (tasks[0], ["result"])
    with pytest.raises(KeyError, match="gone"):
        next(found)
