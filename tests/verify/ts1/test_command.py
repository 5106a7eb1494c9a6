"""TS1 as a test system with several distributions: each has a run of its own."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError, Diagnostic
from firm_hdl.verify.results.verdict import Failed, Passed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import Recorder
from firm_hdl.verify.ts1 import command
from firm_hdl.verify.ts1.command import Ts1
from tests.verify.ts1.test_told import Run


class Opened(Run):
    """A run that says when it begins and ends; there is none for ``foxy``."""

    said: list[str]

    def __init__(self, request):
        (self.distro,) = request.distros
        if self.distro == "foxy":
            raise DefinitionError([Diagnostic(message="there is no such folder")])
        super().__init__({"one": Passed(1)}, {"one": Failed((self.distro,))})

    def __enter__(self):
        self.said.append(f"{self.distro} begins")
        return self

    def __exit__(self, *error):
        self.said.append(f"{self.distro} ends")


@pytest.fixture
def said(monkeypatch):
    monkeypatch.setattr(command, "Ts1Run", Opened)
    Opened.said = []
    return Opened.said


def requests(*distros):
    return [Request(distros=(distro,)) for distro in distros]


def test_the_definitions_of_all_distributions_are_tested_and_judged(said, capsys):
    with Ts1(requests("noetic", "humble")) as system:
        names = ["p/msg/A0", "p/msg/A1", "p/msg/A0", "p/msg/A1"]
        assert [test.type for test in system.tests] == names
        found = system.run(Recorder())
        assert said == ["noetic begins", "humble begins"]
    assert sorted(said[2:]) == ["humble ends", "noetic ends"]
    assert [each.verdict for each in found] == [
        *(Passed(1), Failed(("one: noetic",)), Passed(1), Failed(("one: humble",)))
    ]
    assert capsys.readouterr().out.count("2 definitions, ") == 2


def test_a_run_that_cannot_begin_ends_those_that_have(said):
    system = Ts1(requests("noetic", "foxy", "humble"))
    with pytest.raises(DefinitionError, match="no such folder"):
        system.__enter__()
    assert said == ["noetic begins", "noetic ends"]
