"""A simulated board without its simulation: what it makes, and how it fails."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from firm_hdl.errors import UserError
from firm_hdl.node.boards import BoardError, simulated
from firm_hdl.node.boards.simulated import SimulatedBoard
from firm_hdl.sim.fast import BuildError, SimulationError
from tests.node.bridge.fakes import ECHO

STREAMS = [("link.frames_in", True), ("link.frames_out", False), ("io.a", False), ("io.b", True)]


class Simulation:
    """What a board asks of its simulation; `fails` by the name of a call."""

    def __init__(self, node, **options):
        self.node, self.options, self.calls, self.fails = node, options, [], {}
        self.engine = "some"

    def __getattr__(self, name):
        def call(*arguments):
            if name in self.fails:
                raise self.fails[name]
            self.calls.append((name, *arguments))
            return {"fileno": 7, "receive_packets": [b"x"]}.get(name)

        return call


@pytest.fixture
def made(monkeypatch):
    """Return the simulations that were made."""
    found = []

    def simulation(node, **options):
        found.append(Simulation(node, **options))
        return found[-1]

    monkeypatch.setattr(simulated, "FastSimulation", simulation)
    monkeypatch.setattr(simulated, "Node", lambda *given: given)
    streams = [SimpleNamespace(name=name, is_input=is_input) for name, is_input in STREAMS]
    monkeypatch.setattr(simulated, "ports_of", lambda node: SimpleNamespace(streams=streams))
    return found


def test_a_simulation_is_that_of_the_design_with_frames_at_its_link(made):
    board = SimulatedBoard(ECHO, engine="amaranth")
    assert board.engine == ""
    board.open()
    (simulation,) = made
    description, accelerator = simulation.node
    assert description.link.kind == "stream" and accelerator is None
    assert description.topics == ECHO.topics and description.accelerator == ECHO.accelerator
    assert simulation.options["engine"] == "amaranth" and board.engine == "some"
    # Nobody reads what comes out elsewhere.
    assert simulation.options["ignored"] == ["io.a"]
    (stalled, stalls), *_ = [each[1:] for each in simulation.calls if each[0] == "stall"]
    assert stalled == "link.frames_in" and sum(stalls) * 2 == len(stalls)


def test_another_accelerator_is_made_of_the_description(made):
    board = SimulatedBoard(ECHO, accelerator=lambda description: ("made of", description))
    board.open()
    description, accelerator = made[0].node
    assert accelerator == ("made of", description)


def test_a_board_that_is_opened_again_is_not_built_again(made):
    board = SimulatedBoard(ECHO)
    board.open()
    board.close()
    made[0].calls.clear()
    board.open()
    assert len(made) == 1
    assert [name for name, *_ in made[0].calls] == ["restart", "stall", "go_live"]


def test_frames_go_in_and_out(made):
    board = SimulatedBoard(ECHO)
    board.open()
    made[0].calls.clear()
    assert board.send([b"a", b"b"]) and board.receive() == [b"x"] and board.fileno() == 7
    assert made[0].calls == [
        ("send_packets", "link.frames_in", [b"a", b"b"]),
        ("receive_packets", "link.frames_out"),
        ("fileno",),
    ]


USES = [lambda board: board.send([b"a"]), lambda board: board.receive(), lambda b: b.fileno()]


@pytest.mark.parametrize("use", USES)
def test_a_closed_one_takes_and_gives_nothing(made, use):
    board = SimulatedBoard(ECHO)
    with pytest.raises(BoardError, match=r"^the simulation is closed$"):
        use(board)
    board.open()
    use(board)
    board.close()
    assert made[0].calls[-1] == ("close",)
    with pytest.raises(BoardError, match=r"^the simulation is closed$"):
        use(board)


@pytest.mark.parametrize("use", USES)
def test_a_simulation_that_ends_is_a_board_that_is_gone(made, use):
    board = SimulatedBoard(ECHO)
    board.open()
    made[0].fails = dict.fromkeys(
        ("send_packets", "receive_packets", "fileno"), SimulationError("it ended")
    )
    with pytest.raises(BoardError, match=r"^it ended$"):
        use(board)


@pytest.mark.parametrize(
    ("error", "found"), [(BuildError("no compiler"), UserError), (SimulationError("x"), BoardError)]
)
def test_only_a_design_that_cannot_be_built_is_never_tried_again(made, error, found):
    board = SimulatedBoard(ECHO)
    board.open()
    board.close()
    made[0].fails["go_live"] = error
    with pytest.raises(found, match=rf"^{error}$"):
        board.open()
    # It has not been opened.
    with pytest.raises(BoardError, match=r"^the simulation is closed$"):
        board.receive()
