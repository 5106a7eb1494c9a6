"""Our end of the socket to an engine: messages in parts, the last words, and interruptions."""

from __future__ import annotations

import socket
import threading
from types import SimpleNamespace

import pytest

from firm_hdl.sim.fast import SimulationError, channel, protocol
from firm_hdl.sim.fast.channel import Channel
from firm_hdl.sim.fast.protocol import Answer

VALUES = protocol.message(Answer.VALUES, b"abc")
FAILED = protocol.message(Answer.FAILED, b"it is broken")


@pytest.fixture
def ends():
    """A channel, and the engine's end of its socket."""
    own, other = socket.socketpair()
    with own, other:
        yield Channel(own), other


def test_a_message_may_come_in_parts(ends):
    here, there = ends
    assert here.receive(0.0) == []
    there.sendall(VALUES[:4])
    assert here.receive(0.0) == []
    # Without a limit, the whole message is waited for.
    later = threading.Timer(0.05, lambda: there.sendall(VALUES[4:] + VALUES + VALUES[:1]))
    later.start()
    assert here.receive(None) == [(Answer.VALUES, b"abc")] * 2
    later.join()
    there.sendall(VALUES[1:])
    assert here.receive(0.0) == [(Answer.VALUES, b"abc")]


@pytest.mark.parametrize("call", ["receive", "send"])
@pytest.mark.parametrize(
    ("words", "message"),
    [
        (FAILED, "^it is broken$"),
        (VALUES + FAILED, "^it is broken$"),
        (b"", "^The simulation ended: its socket was closed$"),
        (FAILED[:-1], "^The simulation ended: its socket was closed$"),
    ],
    ids=["an error", "a message and an error", "nothing", "half an error"],
)
def test_the_last_words_of_an_engine_are_its_error(ends, call, words, message):
    here, there = ends
    there.sendall(words)
    there.close()
    with pytest.raises(SimulationError, match=message):
        if call == "receive":
            here.receive(None)
            here.receive(None)
        else:
            here.send(b"x" * 10)
            here.send(b"x" * 10)
    for use in (lambda: here.send(b"x"), lambda: here.receive(0.0), here.fileno):
        with pytest.raises(SimulationError, match=r"^The simulation is closed$"):
            use()


def test_an_interrupted_call_to_send_closes_the_socket(ends, monkeypatch):
    here, _ = ends

    def interrupted(*given):
        raise KeyboardInterrupt

    monkeypatch.setattr(channel, "select", SimpleNamespace(select=interrupted))
    with pytest.raises(KeyboardInterrupt):
        here.send(b"x")
    with pytest.raises(SimulationError, match="is closed"):
        here.send(b"x")


def test_a_socket_that_has_nothing_to_read_after_all_is_no_end(ends, monkeypatch):
    here, there = ends
    always = SimpleNamespace(select=lambda read, write, other, seconds=None: (read, write, other))
    monkeypatch.setattr(channel, "select", always)
    assert here.receive(0.0) == []
    here.send(b"hello")
    assert there.recv(9) == b"hello"
