"""Newer releases of rosidl than Debian's: event messages, and ROS's own type hashes."""

from __future__ import annotations

import pytest

from firm_hdl.frontend import Library
from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.ros2_wheels import RELEASES
from firm_hdl.verify.ts1 import facts
from firm_hdl.verify.ts1.judge import judge
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.oracles.oracle import Accepted
from tests.verify.judged import assert_known

PARSERS = [f"rosidl_parser-{release.rosidl}" for release in RELEASES]
ADAPTERS = [f"rosidl_adapter-{release.rosidl}" for release in RELEASES]
FILES = {
    "p/msg/A.msg": "char c 7\nwstring<=5[<=3] names\nint8 N=0x10\nq/B[] bs\nstd_msgs/Header h\n",
    "p/msg/Empty.msg": "",
    "p/srv/S.srv": "int8 a 3\n---\nq/B b\n",
    "p/action/Do.action": "int8 g\n---\n---\nq/B f\n",
    "p/msg/I.idl": "module p { module msg { struct I { wchar w; sequence<char, 3> cs; }; }; };",
    "p/msg/Odd.idl": "module other { module idl { struct Odd { long x; p::msg::I i; }; }; };",
    "q/msg/B.msg": "float32 x 1.5\n",
}
# The hashes of rosidl_generator_type_description 4.6.6 and 4.9.5, after ``RIHS01_``.
HASHES = {
    "p/msg/A": "d76639cf2c33b33aedddcba570b4246bd66ad63a43d44bc11349274dfad02cdb",
    "p/msg/Empty": "bab64e8def664f6934378948fdbc689bb938b4c8bffd316c1dfff75c4f742d73",
    "p/srv/S": "b8937807870f42dfe616f8eaaa2b1a33e82f21d2ad0f7d28fab00ded32d0bbe3",
    "p/action/Do": "95a0f35669bea707ade662a0caad1555f4526803c0bfe166d8d62f84b8726223",
    "p/msg/I": "f5a65117007fcd130e5aaa5e8ee1424edc2d7a221c90eb64a0c7976662d6d2e3",
    "q/msg/B": "47e422b3964ead04f5e0e30ced3ef5ab18713c4d799840f2af1115784a03e810",
}
TYPES = ["p/A", "p/Empty", "p/S", "p/Do", "p/I", "q/B"]


def outcomes(here, oracle, read=lambda case: None):
    found = {
        case.full_name: judge(here.universe, here.oracle(oracle), case, read(case))
        for case in here.universe.select(TYPES)
    }
    return {name: each.verdict for name, each in found.items() if each is not None}


@pytest.mark.parametrize("oracle", [*ADAPTERS, *PARSERS])
def test_newer_rosidl_and_we_agree(court, oracle):
    found = outcomes(court("lyrical", FILES), oracle)
    assert len(found) == len(TYPES) - ("adapter" in oracle)
    assert {type(verdict).__name__ for verdict in found.values()} == {"Passed"}


@pytest.mark.parametrize("oracle", PARSERS)
def test_events_of_services_are_judged(court, oracle):
    here = court("lyrical", FILES)
    answer = here.answer(oracle, "p/S")
    assert isinstance(answer, Accepted)
    fields = answer.facts["structure"]["p/srv/S_Event"]["fields"]
    assert [(each["name"], each["type"]) for each in fields] == [
        ("info", "service_msgs/msg/ServiceEventInfo"),
        ("request", "p/srv/S_Request[<=1]"),
        ("response", "p/srv/S_Response[<=1]"),
    ]
    assert "p/action/Do_GetResult_Event" in here.answer(oracle, "p/Do").facts["structure"]
    # Must-fail twin: services as in humble.
    humble = Library("humble", [here.universe.folder])
    found = outcomes(here, oracle, read=lambda case: humble.interface(case.spelled_name))
    wrong = next(text for text in found["p/srv/S"].failures if "S_Event" in text)
    assert wrong.startswith("structure/p/srv/S_Event: firm-hdl has none; oracle")


@pytest.mark.parametrize("oracle", PARSERS)
def test_hashes_are_those_of_ros(court, oracle):
    here = court("lyrical", FILES)
    for type_, (name, digits) in zip(TYPES, HASHES.items(), strict=True):
        assert here.answer(oracle, type_).facts["hash"][name] == f"RIHS01_{digits}"
    hashes = here.answer(oracle, "p/Do").facts["hash"]
    assert all(each.startswith("RIHS01_") for each in hashes.values())
    assert set(hashes) == {
        "p/action/Do",
        *(f"p/action/Do_{part}" for part in ("Goal", "Result", "Feedback", "FeedbackMessage")),
        *(
            f"p/action/Do_{service}{part}"
            for service in ("SendGoal", "GetResult")
            for part in ("", "_Request", "_Response", "_Event")
        ),
    }
    assert set(here.answer(oracle, "p/S").facts["hash"]) == {
        "p/srv/S",
        *(f"p/srv/S_{part}" for part in ("Request", "Response", "Event")),
    }


@pytest.mark.parametrize("oracle", PARSERS)
def test_a_wrong_hash_of_any_part_is_a_difference(court, oracle, monkeypatch):
    right = facts.type_hash
    monkeypatch.setattr(
        facts, "type_hash", lambda each: right(each)[: -("_Event" in each.name) or None]
    )
    found = outcomes(court("lyrical", FILES), oracle)
    assert {name for name, verdict in found.items() if isinstance(verdict, Failed)} == {
        "p/srv/S",
        "p/action/Do",
    }
    assert [text.partition(":")[0] for text in found["p/srv/S"].failures] == ["hash/p/srv/S_Event"]


@pytest.mark.parametrize("oracle", PARSERS)
def test_a_message_of_idl_is_hashed_by_the_name_of_its_file(court, oracle):
    here = court("lyrical", FILES)
    assert_known(here.outcome(oracle, "p/Odd"), "idl-names")
    assert list(here.answer(oracle, "p/Odd").facts["hash"]) == ["p/msg/Odd"]


def test_the_newest_rosidl_refuses_arrays_of_sequences_as_we_do(court):
    text = "module p { module msg { typedef sequence<long> L; struct A { L x[3]; }; }; };"
    here = court("lyrical", {"p/msg/A.idl": text})
    assert here.outcome(PARSERS[-1], "p/A").is_refused
    assert_known(here.outcome(PARSERS[0], "p/A"), "idl-lists-of-lists")


@pytest.mark.parametrize("name", [*ADAPTERS, *PARSERS])
def test_a_release_that_is_not_installed_is_missing(court, name, monkeypatch, tmp_path):
    monkeypatch.setenv("FIRM_HDL_ROS2_WHEELS", str(tmp_path / "none"))
    universe = court("lyrical", {}).universe
    why = ORACLES[name](universe).missing()
    assert "No such file" in why and "make oracles-ros2" in why
