"""Error messages for users: each wrong file in ``errors/`` is next to its whole message.

``errors/<dialect>`` is a folder of packages; beside ``Name.msg``, ``Name.srv``, ``Name.action``
or ``Name.idl``, ``Name.err`` has the error of loading that type.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library

ERRORS = Path(__file__).parent / "errors"
CASES = sorted(
    path.relative_to(ERRORS)
    for kind in ("msg", "srv", "action")
    for ending in (kind, "idl")
    for path in ERRORS.glob(f"*/*/{kind}/*.{ending}")
)


@pytest.mark.parametrize("case", CASES, ids=str)
def test_wrong_definition_gets_exactly_this_message(case, monkeypatch):
    monkeypatch.chdir(ERRORS)
    dialect, package, kind, file = case.parts
    library = Library("noetic" if dialect == "ros1" else "lyrical", [dialect])
    with pytest.raises(DefinitionError) as error:
        library.interface(f"{package}/{kind}/{Path(file).stem}")
    want = (ERRORS / case).with_suffix(".err").read_text(encoding="utf-8")
    assert f"{error.value}\n" == want


def test_there_are_cases():
    assert len(CASES) > 40
    assert len(list(ERRORS.rglob("*.err"))) == len(CASES)


def test_cycle_is_reported_the_same_when_its_types_were_asked_for_before(monkeypatch):
    monkeypatch.chdir(ERRORS)
    library = Library("noetic", ["ros1"])
    messages = []
    for name in ("CycleA", "CycleA", "CycleC"):
        with pytest.raises(DefinitionError) as error:
            library.message(f"bad_msgs/{name}")
        messages.append(str(error.value))
    assert messages[0] == messages[1] == messages[2]
