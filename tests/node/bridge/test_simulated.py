# amaranth: UnusedElaboratable=no
"""A node in simulation as a board: real gateware behind the bridge."""

from __future__ import annotations

import struct

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import open_library
from firm_hdl.node import read_description_text
from firm_hdl.node.boards import BoardError, simulated
from firm_hdl.node.boards.simulated import SimulatedBoard
from firm_hdl.node.bridge import session
from firm_hdl.sim.fast import SimulationError
from tests.depth import THOROUGH, by_depth
from tests.node.accelerators import echo_text
from tests.node.bridge.fakes import FakeGraph, bridge_of, run_until
from tests.node.samples import read
from tests.node.test_node import string
from tests.node.traffic import packets_of


@pytest.mark.parametrize("link", by_depth(["udp"], ["udp", "stream", "uart"]))
def test_messages_and_calls_go_through_gateware(link):
    """The link is that of the description; a simulated board replaces it, and may be killed."""
    description = read(echo_text(link=link))
    heard, _, _, cal = description.topics
    graph = FakeGraph()
    board = SimulatedBoard(description, engine="amaranth")
    made, said = bridge_of(board, graph, description)
    try:
        assert run_until(made, lambda: graph.opened, 60), said
        if THOROUGH:
            board._simulation.close()
            assert run_until(made, lambda: made.side.restarts == 1 and made.side.is_ready, 60), said
            assert "The simulation is closed; trying again" in "".join(said)
        texts = [f"text {number}" * (number % 3) for number in range(4)]
        graph.say(heard, *(string(text) for text in texts))
        # What the gate refuses does not come back.
        graph.say(heard, string("bad")[:-1])
        (request,) = packets_of(cal.store("in").message, 1, most=200)
        assert run_until(made, lambda: len(graph.got) == 8, 60)
        graph.on_message(cal, request, "caller")
        assert run_until(made, lambda: graph.answers or graph.abandoned, 60)
    finally:
        # The board also confirms at the end what has arrived.
        made.run(seconds=0)
    assert [packet for name, packet in graph.got if name == "/said"] == [
        string(text) for text in texts
    ]
    stamps = [struct.unpack("<4xiI", p)[0] for name, p in graph.got if name == "/stamp"]
    # The clock of the node was set before the graph was joined, or soon after.
    assert len(stamps) == 4 and stamps == sorted(stamps)
    assert not made.counters.dropped and not made.side.on_the_way
    # Slow as it is, all counters were read.
    assert made.side.has_read_last
    assert [(each.owner, value) for each, value in made.side.drops()] == [("/heard", 1)]


NAMES = """\
node: names
distro: noetic
accelerator: tests.live.nodes:Echo
subscribe:
  /heard: {type: own_msgs/Names, memory_bytes: 8192}
publish:
  /said: {type: own_msgs/Names, memory_bytes: 8192}
"""


@pytest.mark.thorough
@pytest.mark.parametrize(
    "stalls", [simulated._STALLS, pytest.param((), marks=pytest.mark.thorough)]
)
def test_many_short_parts_do_not_overrun_a_gate(stalls, monkeypatch, tmp_path):
    """Each beat has two names, and a parser takes one per cycle. The twin's link is full."""
    monkeypatch.setattr(simulated, "_STALLS", stalls)
    monkeypatch.setattr(session, "ROUND_SECONDS", 0.1)
    # A small backlog for the parser, which a short message overruns.
    monkeypatch.setattr("firm_hdl.gateware.packets.gate.BACKLOG_BEATS", 65)
    definition = tmp_path / "own_msgs" / "msg" / "Names.msg"
    definition.parent.mkdir(parents=True)
    definition.write_text("string[] names\n")
    library = open_library("noetic", [str(tmp_path)], ())
    description = read_description_text(NAMES, library=library)
    graph = FakeGraph()
    board = SimulatedBoard(description, engine="amaranth")
    made, said = bridge_of(board, graph, description)
    count = 300
    packet = struct.pack("<I", count) + bytes(4 * count)
    try:
        assert run_until(made, lambda: graph.opened, 60), said
        graph.say(description.topics[0], packet)
        assert run_until(made, lambda: graph.got or made.side.drops(), 300)
    finally:
        made.close()
    if stalls:
        assert graph.got == [("/said", packet)]
    else:
        assert [(each.name, value) for each, value in made.side.drops()] == [("overrun", 1)]


def test_mistakes_of_an_accelerator_are_errors_of_the_user():
    text = echo_text().replace("accelerators:Echo", "accelerators:Exploding")
    with pytest.raises(DefinitionError, match="no such gain"):
        SimulatedBoard(read(text), engine="amaranth").open()


def test_a_board_that_is_not_open_is_an_error():
    board = SimulatedBoard(read(echo_text()), engine="amaranth")
    for use in (board.receive, board.fileno, lambda: board.send([b""])):
        with pytest.raises(BoardError, match="the simulation is closed"):
            use()


class _EndedSimulation:
    """A simulation whose engine was killed as soon as it ran."""

    def _fail(self, *_):
        raise SimulationError("The simulation ended: killed")

    def _do(self, *_):
        return

    send_packets = receive_packets = fileno = restart = _fail
    stall = go_live = close = _do


def test_a_simulation_that_ended_is_an_error_whatever_is_asked_of_it(monkeypatch):
    board = SimulatedBoard(read(echo_text()))
    monkeypatch.setattr(board, "_start", _EndedSimulation)
    board.open()
    for use in (board.receive, board.fileno, lambda: board.send([b""]), board.open):
        with pytest.raises(BoardError, match=r"^The simulation ended: killed$"):
            use()
