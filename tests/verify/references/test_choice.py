"""Which libraries may confirm bytes, which of them are there, and who is needed for wide text."""

from __future__ import annotations

import pytest

from firm_hdl.verify.references import choice
from firm_hdl.verify.references.choice import (
    WIDE_REFERENCES,
    WRITERS,
    find_clients,
    find_references,
    may_stand_in,
    usable_references,
)
from firm_hdl.verify.references.client import ClientMissingError
from firm_hdl.verify.references.clients import REFERENCES

OF_CDR = ["fastcdr", "fastcdr-2.2", "fastcdr-2.3", "cyclonedds"]


class Named:
    def __init__(self, name, missing):
        self.name, self._missing = name, missing

    def missing(self):
        return f"no {self.name}" if self._missing else None

    def version(self):
        assert not self._missing
        return f"{self.name} 1"


@pytest.fixture
def without(monkeypatch):
    """A function that pretends that only some libraries are missing."""

    def set_missing(*names):
        monkeypatch.setattr(choice, "client", lambda name: Named(name, name in names))

    set_missing()
    return set_missing


def test_these_libraries_may_confirm():
    wires = {name: sorted(kinds) for name, kinds in WRITERS.items()}
    assert wires == {"genpy": ["ros1"], **{name: ["cdr"] for name in OF_CDR}}
    assert list(WIDE_REFERENCES) == OF_CDR[:3]
    # ROS's own first, its newest release next, and rosbags last.
    assert REFERENCES == {
        "ros1": ("genpy", "rosbags"),
        "cdr": ("fastcdr", "fastcdr-2.3", "fastcdr-2.2", "rosbags"),
    }


def test_each_library_has_its_version_or_its_reason(without, monkeypatch):
    closed = []
    monkeypatch.setattr(choice, "close_clients", lambda: closed.append(True))
    without("genpy", "rosbags")
    versions, missing = find_clients(["genpy", "fastcdr", "rosbags", "cyclonedds"])
    assert versions == {"fastcdr": "fastcdr 1", "cyclonedds": "cyclonedds 1"}
    assert missing == {"genpy": "no genpy", "rosbags": "no rosbags"}
    assert closed == [True]


def test_those_that_are_wanted_and_installed_are_used(without):
    assert usable_references() == ("genpy", *OF_CDR)
    # The order is that of reports, and a library that may not confirm is not used.
    assert usable_references(["rosbags", "cyclonedds", "fastcdr"]) == ("fastcdr", "cyclonedds")
    assert usable_references([]) == ()
    without("fastcdr", "genpy")
    assert usable_references() == tuple(OF_CDR[1:])
    assert usable_references(["fastcdr"]) == ()


def test_a_library_without_wide_text_is_not_enough_for_it(without, make_message):
    wide = make_message("B b\n", B="wstring<=3[] w\n")
    assert may_stand_in(wide) and not may_stand_in(make_message("string s\n"))
    assert may_stand_in(wide, ["fastcdr-2.3"])
    assert not may_stand_in(wide, ["cyclonedds"]) and not may_stand_in(wide, [])
    without("fastcdr", "fastcdr-2.2")
    assert may_stand_in(wide) and not may_stand_in(wide, ["fastcdr", "cyclonedds"])
    without(*OF_CDR[:3])
    assert not may_stand_in(wide)


def test_only_libraries_of_the_wires_are_reported(without):
    assert find_references(None, ["ros1", "cdr"]) == []
    without("genpy", "cyclonedds")
    genpy, cyclonedds = (
        f"{name} does not confirm bytes: no {name}" for name in ("genpy", "cyclonedds")
    )
    assert find_references(None, ["ros1", "cdr"]) == [genpy, cyclonedds]
    assert find_references(None, ["cdr"]) == [cyclonedds]
    assert find_references(None, ["ros1"]) == [genpy]
    assert find_references(None, []) == []


def test_a_library_that_is_wanted_by_name_must_be_there(without):
    without("genpy", "cyclonedds")
    assert find_references(["fastcdr"], ["cdr"]) == []
    assert find_references([], ["cdr"]) == []
    with pytest.raises(ClientMissingError, match=r"^no cyclonedds$"):
        find_references(["fastcdr", "cyclonedds", "genpy"], ["cdr"])
