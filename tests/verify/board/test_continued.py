"""Results of a board: with which options another run goes on with them."""

from __future__ import annotations

import pytest

from firm_hdl.verify.board.system import Boards
from firm_hdl.verify.systems.options import Request
from tests.node.bridge.fakes import FakeBoard
from tests.verify.board.fakes import STRING, LoopNode, described


def options_of(description, **given):
    """Return the options of a run, which the results of another run must share to go on."""
    request = Request(**{"board": "fake", **given})
    return Boards(description, request, FakeBoard(LoopNode(description))).options


def test_results_are_not_continued_with_another_node(tmp_path):
    definition = tmp_path / "own_msgs" / "msg" / "A.msg"
    definition.parent.mkdir(parents=True)
    found = []
    for line in ("uint8 a\n", "uint16 a\n", "uint8 a\n"):
        definition.write_text(line)
        found.append(options_of(described("own_msgs/msg/A", paths=[str(tmp_path)])))
    assert found[0] == found[2]
    # Neither the request nor the text of the description names the field.
    assert [key for key in found[0] if found[0][key] != found[1][key]] == ["fingerprint"]


@pytest.mark.parametrize(
    ("given", "key"),
    [
        ({"board": "other"}, "board"),
        # Of a board that is simulated, see below.
        ({"engine": "amaranth"}, None),
        ({"node": "node.yaml"}, "node"),
        ({"seed": 1}, "seed"),
        ({"most_cases": 5}, "cases"),
        ({"broken": False}, "broken"),
        ({"references": ()}, "references"),
        ({"references": ("rosbags",)}, "references"),
        # They determine no case.
        ({"silent_seconds": 1.0}, None),
        ({"jobs": 3}, None),
    ],
)
def test_results_are_continued_with_the_same_cases_only(given, key):
    description = described(STRING)
    usual, other = options_of(description), options_of(description, **given)
    assert [each for each in usual if usual[each] != other[each]] == ([key] if key else [])
    assert usual.keys() == other.keys()
