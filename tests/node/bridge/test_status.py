"""What people see of a bridge: its line of figures, and its account, letter by letter."""

from __future__ import annotations

import io
from collections import Counter
from types import SimpleNamespace

import pytest

from firm_hdl.node.bridge import command
from firm_hdl.node.bridge.command import StatusPrinter, account, status_line
from firm_hdl.node.bridge.counters import BridgeCounters
from tests.node.bridge.fakes import ECHO


class Screen(io.StringIO):
    """A terminal or a file, and what was written since it was read."""

    def __init__(self, is_terminal):
        super().__init__()
        self.isatty = lambda: is_terminal

    def read_new(self):
        text = self.getvalue()
        self.seek(0)
        self.truncate()
        return text


@pytest.fixture
def clock(monkeypatch):
    made = SimpleNamespace(now=100.0)
    monkeypatch.setattr(command, "time", SimpleNamespace(monotonic=lambda: made.now))
    return made


def bridge_with(graph=(), drops=(), **side):
    """Return what is read of a bridge that has just begun: losses, and changes of its board."""
    found = {
        "is_ready": True,
        "was_ready": True,
        "restarts": 0,
        "on_the_way": Counter(),
        "drops": lambda: list(drops),
        "session": None,
        "has_read_last": True,
    }
    return SimpleNamespace(
        description=ECHO,
        counters=BridgeCounters(),
        graph=SimpleNamespace(counters=Counter(dict(graph))),
        side=SimpleNamespace(**found | side),
    )


def register(owner, part, name):
    return SimpleNamespace(owner=owner, part=part, name=name)


def line(to_board, to_graph):
    return f"echo, ready, to board {to_board}/s, to graph {to_graph}/s, dropped 0"


def test_rates_on_a_terminal_are_replaced_each_time(clock):
    screen, bridge = Screen(True), bridge_with()
    bridge.counters.to_board["/heard"] = 1000
    shown = StatusPrinter(screen)
    shown.show(bridge)
    # What passed before the first line is no rate.
    assert screen.read_new() == line(0, 0)
    bridge.counters.to_board["/heard"] += 30
    bridge.counters.to_graph["/said"] += 1
    bridge.counters.to_graph["/stamp"] += 11
    clock.now += 2.0
    shown.show(bridge)
    assert screen.read_new() == "\r" + line(15, 6)
    clock.now += 1.0
    shown.show(bridge)
    # A shorter line hides the end of a longer one.
    assert screen.read_new() == "\r" + line(0, 0).ljust(len(line(15, 6)))
    shown.report("it is gone")
    assert screen.read_new() == "\r" + "it is gone".ljust(len(line(0, 0))) + "\n"
    shown.report("it is back")
    assert screen.read_new() == "it is back\n"


def test_rates_elsewhere_are_lines_of_their_own_now_and_then(clock):
    screen, bridge = Screen(False), bridge_with()
    shown, seconds = StatusPrinter(screen), []
    for second in range(31):
        bridge.counters.to_board["/heard"] += 4
        shown.show(bridge)
        if text := screen.read_new():
            seconds.append(second)
            assert text == line(0 if len(seconds) == 1 else 4, 0) + "\n"
        clock.now += 1.0
    assert seconds == [10, 20, 30]
    shown.report("it is gone")
    assert screen.read_new() == "it is gone\n"


@pytest.mark.parametrize("is_terminal", [False, True])
def test_a_quiet_one_says_only_what_happens(clock, is_terminal):
    screen = Screen(is_terminal)
    shown = StatusPrinter(screen, quiet=True)
    clock.now += 60.0
    shown.show(bridge_with())
    shown.report("it is gone")
    assert screen.read_new() == "it is gone\n"


def test_the_line_has_what_is_known():
    session = SimpleNamespace(latency=0.00123, offset_ns=-45_678.0)
    bridge = bridge_with(
        session=session,
        on_the_way=Counter(lost=1),
        graph={"lost": 20},
        drops=[(register("/a", "in", "full"), 300)],
    )
    bridge.counters.drop("/a", "no board", 4000)
    assert status_line(bridge, (12.4, 0.6)) == (
        "echo, ready, to board 12/s, to graph 1/s, dropped 4321, round trip 1.23 ms, clock -46 us"
    )
    session.offset_ns = 1500.0
    assert status_line(bridge, (0, 0)).endswith("clock +2 us")
    bridge.side.is_ready, bridge.side.session = False, None
    assert status_line(bridge, (0, 0)) == (
        "echo, waits for the board, to board 0/s, to graph 0/s, dropped 4321"
    )


def test_the_account_names_all_losses_with_their_places():
    bridge = bridge_with(
        on_the_way=Counter(lost=2, cut=1),
        graph={"no line": 3, "fine": 0},
        drops=[(register("/a", "in", "full"), 4), (register("link", "link", "late"), 5)],
        restarts=6,
    )
    bridge.counters.to_board.update({"/heard": 12_345, "/cal": 7})
    bridge.counters.to_graph.update({"/said": 1_234_567_890})
    bridge.counters.drop("/heard", "no board", 8)
    bridge.counters.drop("/cal", "unanswered", 9)
    bridge.counters.drop("/cal", "queue full", 0)
    assert list(account(bridge)) == [
        "topic              to board    to graph",
        "/heard  subscribe     12345           0",
        "/said   publish           0  1234567890",
        "/stamp  publish           0           0",
        "/cal    serve             7           0",
        "dropped: 9 of /cal: unanswered",
        "dropped: 8 of /heard: no board",
        "dropped: 2 on the way from the board: lost",
        "dropped: 3 in the graph: no line",
        "dropped: 4 on the board, /a in: full",
        "seen: 1 on the way from the board: cut",
        "seen: 5 on the board, link link: late",
        "the board was started again or lost 6 times",
    ]


NEVER = "the board has never answered"
ONCE = "the board was started again or lost 1 times"
LOST = "the board was started again or lost 2 times"
UNREAD = "not all counters on the board could be read at the end"


@pytest.mark.parametrize(
    ("was_ready", "is_ready", "restarts", "has_read_last", "said"),
    [
        (False, False, 0, False, [NEVER]),
        # It was tried again and again.
        (False, False, 2, False, [NEVER]),
        (True, True, 0, True, []),
        (True, True, 0, False, [UNREAD]),
        (True, True, 1, True, [ONCE]),
        (True, False, 2, True, [LOST]),
        (True, False, 2, False, [LOST, UNREAD]),
    ],
)
def test_the_account_says_how_it_was_with_the_board(
    was_ready, is_ready, restarts, has_read_last, said
):
    bridge = bridge_with(
        was_ready=was_ready, is_ready=is_ready, restarts=restarts, has_read_last=has_read_last
    )
    assert [each for each in account(bridge) if each.startswith(("the ", "not "))] == said
