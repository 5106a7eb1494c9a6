"""What ROS's own readers are asked in their process, and what becomes of the answers.

The process is a fake, so no reader of ROS is needed.
"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.oracles.oracle import Accepted, NotJudged, Refused

FILES = {
    "p/msg/A.msg": "int8 x\n",
    "p/srv/S.srv": "int8 x\n---\n",
    "p/action/Do.action": "---\n---\n---\n",
    "p/msg/I.idl": "module p { module msg { struct I { long x; }; }; };\n",
    "p/srv/T.idl": "module p { module srv { struct T_Request { long x; }; }; };\n",
}


@pytest.fixture
def asked(court, monkeypatch):
    """Return a function that asks an oracle whose process gives the same answer to all requests."""

    def ask(name, answer, *types, distro="lyrical", before=None):
        requests = []
        kind, universe = ORACLES[name], court(distro, FILES).universe
        far = SimpleNamespace(ask=lambda request: requests.append(request) or answer)
        monkeypatch.setattr(kind, "_worker", far)
        cases = [replace(each, before=before) for each in universe.select(types)]
        return list(kind(universe).judge(cases)), requests

    return ask


@pytest.mark.parametrize("name", ["genmsg", "rosidl_adapter", "rosidl_parser-4.9"])
def test_a_definition_is_asked_for_by_its_file(asked, name):
    distro = "noetic" if name == "genmsg" else "lyrical"
    answers, requests = asked(name, {"refused": 7}, "p/A", "p/S", "p/Do", distro=distro)
    assert answers == [Refused("7")] * 3
    common = {
        "oracle": name.partition("-")[0],
        "package": "p",
        "text": None,
        "has_events": distro == "lyrical",
    }
    assert requests == [
        {**common, "kind": "msg", "name": "A", "file": "A.msg"},
        {**common, "kind": "srv", "name": "S", "file": "S.srv"},
        {**common, "kind": "action", "name": "Do", "file": "Do.action"},
    ]


@pytest.mark.parametrize(("distro", "has_events"), [("humble", False), ("iron", True)])
def test_a_changed_definition_is_sent_as_a_text(asked, distro, has_events):
    (answer,), (request,) = asked(
        "rosidl_parser", {"failed": "it slept"}, "p/A", distro=distro, before="int16 y\n"
    )
    assert answer == NotJudged("it slept")
    assert (request["text"], request["has_events"]) == ("int8 x\n", has_events)


def test_a_definition_that_was_changed_to_nothing_is_sent_too(asked, court, monkeypatch):
    kind, requests = ORACLES["genmsg"], []
    far = SimpleNamespace(ask=lambda request: requests.append(request["text"]) or {"facts": {}})
    monkeypatch.setattr(kind, "_worker", far)
    universe = court("noetic", FILES).universe
    (case,) = universe.select(["p/A"])
    (answer,) = kind(universe).judge([replace(case, text="", before=case.text)])
    assert (answer, requests) == (Accepted({}), [""])


ONE, OTHER = {"fields": []}, {"fields": [{"name": "x", "type": "int8"}]}


@pytest.mark.parametrize(
    ("name", "type_", "written", "expected", "names"),
    [
        # A message of IDL is named by its file. The name in the text is a fact of its own.
        ("rosidl_parser", "p/I", {"q/idl/B": ONE}, {"p/msg/I": ONE}, ["q/idl/B"]),
        ("rosidl_parser-4.6", "p/I", {"p/msg/I": ONE}, {"p/msg/I": ONE}, ["p/msg/I"]),
        # The parts of a service have names of their own, which are kept.
        ("rosidl_parser", "p/T", {"b": ONE, "a": OTHER}, {"b": ONE, "a": OTHER}, None),
        ("rosidl_parser", "p/I", {}, {}, None),
        # In other languages, the file is the only one that has the name.
        ("rosidl_parser", "p/A", {"q/idl/B": ONE}, {"q/idl/B": ONE}, None),
        ("rosidl_adapter", "p/A", {"q/idl/B": ONE}, {"q/idl/B": ONE}, None),
    ],
)
def test_a_message_of_idl_is_named_by_its_file(asked, name, type_, written, expected, names):
    (answer,), _ = asked(name, {"facts": {"structure": {**written}, "hash": {"h": 1}}}, type_)
    found = dict(answer.facts)
    assert found.pop("names", None) == names
    assert found == {"structure": expected, "hash": {"h": 1}}
    assert list(found["structure"]) == list(expected)


@pytest.mark.parametrize("answer", [{"refused": "no"}, {"failed": "it slept"}])
def test_an_answer_without_facts_is_left_alone(asked, answer):
    (found,), _ = asked("rosidl_parser", answer, "p/I")
    assert found == (Refused("no") if "refused" in answer else NotJudged("it slept"))


def test_the_adapter_writes_char_as_uint8_in_idl_alone(court):
    universe = court("lyrical", FILES).universe
    message, idl = universe.select(["p/A", "p/I"])
    for name, kind in ORACLES.items():
        alike = {"char": "uint8"} if name.startswith("rosidl_parser") else {}
        assert (kind(universe).alike(message), kind(universe).alike(idl)) == (alike, {})


def test_a_process_is_closed_only_if_it_was_asked(court, monkeypatch):
    closed = []
    far = SimpleNamespace(close=lambda: closed.append("closed"), versions={"genmsg": "0.6"})
    far.cpu_seconds, far.missing = 1.5, None
    monkeypatch.setattr("firm_hdl.verify.ts1.oracles.debian._shared_worker", lambda *_: far)
    oracle = ORACLES["genmsg"](court("noetic", FILES).universe)
    oracle.close()
    assert closed == []
    assert (oracle.version(), oracle.cpu_seconds(), oracle.missing()) == ("0.6", 1.5, None)
    oracle.close()
    assert closed == ["closed"]
    # A version that the process does not tell is unknown.
    assert ORACLES["rosidl_adapter"](oracle.universe).version() == ""
