"""What the ways to boards ask of the system: ports, buffers, and the settings of a line."""

from __future__ import annotations

import os
import pty
import re
import socket
import termios

import pytest

from firm_hdl.errors import UserError
from firm_hdl.node.boards import board_of
from firm_hdl.node.boards.bytestreams import ByteBoard
from firm_hdl.node.bytestream import write_frame
from tests.node.accelerators import echo_text
from tests.node.bridge.fakes import ECHO, LINE
from tests.node.samples import read


@pytest.fixture
def line():
    """Return the name of a serial line, and the file of its other end."""
    host, board = pty.openpty()
    yield os.ttyname(board), host
    os.close(host)
    os.close(board)


def option(board, level, name):
    with socket.socket(fileno=os.dup(board.fileno())) as own:
        return own.getsockopt(level, name)


def test_a_message_over_tcp_waits_for_no_other_and_little_is_held():
    with socket.create_server(("127.0.0.1", 0)) as server:
        board = board_of(f"tcp://127.0.0.1:{server.getsockname()[1]}", LINE)
        board.open()
        assert option(board, socket.IPPROTO_TCP, socket.TCP_NODELAY)
        # Linux doubles it, and would begin with 2.5 MB on the loopback interface.
        assert option(board, socket.SOL_SOCKET, socket.SO_SNDBUF) <= 2 << 16
        assert not os.get_blocking(board.fileno())
        board.close()


def test_datagrams_of_the_largest_size_are_received_whole():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as node:
        node.bind(("127.0.0.1", 0))
        board = board_of(f"udp://127.0.0.1:{node.getsockname()[1]}", ECHO)
        board.open()
        assert board.send([b"x"])
        _, host = node.recvfrom(9)
        datagram = bytes(range(251)) * 240
        node.sendto(datagram, host)
        assert board.receive() == [datagram]
        board.close()


@pytest.mark.parametrize(("baud", "speed"), [(9600, termios.B9600), (115_200, termios.B115200)])
def test_each_byte_passes_a_serial_line_as_it_is(line, baud, speed):
    board = board_of(f"serial://{line[0]}?baud={baud}", LINE)
    board.open()
    found_in, out, control, local, *speeds, characters = termios.tcgetattr(board.fileno())
    assert (found_in, out, local) == (0, 0, 0)
    # 8 data bits, read whatever the modem says; no parity, 1 stop bit, no flow control.
    kept = termios.CS8 | termios.CREAD | termios.CLOCAL
    assert control & (kept | termios.PARENB | termios.CSTOPB | termios.CRTSCTS) == kept
    assert speeds == [speed, speed]
    assert (characters[termios.VMIN], characters[termios.VTIME]) == (1, 0)
    assert board.bytes_per_second == baud / 10
    board.close()


def test_bytes_of_before_are_not_read(line):
    name, host = line
    os.write(host, b"abc\0")
    board = board_of(f"serial://{name}?baud=9600", LINE)
    board.open()
    assert board.receive() == [] and not board.counters.total()
    # What comes now is: a frame that is damaged.
    os.write(host, b"abc\0")
    assert board.receive() == [] and board.counters["damaged"] == 1
    board.close()


@pytest.mark.parametrize(
    ("link", "name", "found"),
    [
        ("{kind: uart, baud: 115200}", "serial:///dev/x", ("bytes_per_second", 11_520)),
        ("{kind: uart, baud: 115200}", "serial:///dev/x?baud=9600", ("bytes_per_second", 960)),
        ("{kind: udp, datagram_bytes: 512}", "udp://a:1", ("frame_bytes", 512)),
    ],
)
def test_what_a_name_does_not_say_is_that_of_the_link(link, name, found):
    board = board_of(name, read(echo_text(link=link)))
    assert getattr(board, found[0]) == found[1]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("udp://a:0", "'udp://a:0' has no port from 1 to 65535"),
        ("tcp://a:0", "'tcp://a:0' has no port from 1 to 65535"),
        ("serial:///dev/x?baud=0", "this system has no rate of 0 baud"),
        ("serial:///dev/x?baud=\N{SUPERSCRIPT TWO}", "has an option other than 'baud=RATE'"),
        ("serial:///dev/x?baud=", "has an option other than 'baud=RATE'"),
        ("serial:///dev/x?baud=" + "9" * 5000, "has an option other than 'baud=RATE'"),
        ("udp://[::1:99", "'udp://[::1:99' is no board: Invalid IPv6 URL"),
        ("tcp://[x]:1", "'tcp://[x]:1' is no board: "),
        ("serial://", "is not serial:///dev/DEVICE, with three '/'"),
        ("tcp://:1", "is not tcp://HOST:PORT"),
        ("udp://a:1?b=2", "is not udp://HOST:PORT"),
    ],
)
def test_a_name_with_a_value_that_cannot_be_is_refused(name, message):
    with pytest.raises(UserError, match=re.escape(message)):
        board_of(name, ECHO)


class Line(ByteBoard):
    """One that has its other end here, and takes frames of 100 bytes."""

    def __init__(self):
        super().__init__("line", 1 << 16, max_bytes=100)

    def _open(self):
        self.ours, theirs = socket.socketpair()
        theirs.setblocking(False)
        return theirs.detach()

    def hear(self, data):
        self.ours.sendall(data)
        return self.receive()

    def close(self):
        super().close()
        if hasattr(self, "ours"):
            self.ours.close()


def test_what_a_line_loses_is_counted_by_its_cause_also_after_it_is_opened_again():
    board = Line()
    large, damaged = write_frame(b"x" * 102), b"\0\5ab\0"
    for opened in range(1, 3):
        board.open()
        assert board.hear(large + write_frame(b"x" * 100) + damaged) == [b"x" * 100]
        assert board.hear(damaged + damaged + large) == []
        assert board.counters == {"large": 2 * opened, "damaged": 3 * opened}
    board.close()


class Full:
    """A socket that takes and gives so many datagrams."""

    def __init__(self, room):
        self.left, self.sent = room, []

    def send(self, frame):
        if len(self.sent) == self.left:
            raise BlockingIOError
        self.sent.append(frame)

    def recv(self, size):
        if not self.left:
            raise BlockingIOError
        self.left -= 1
        return b"x"

    def close(self):
        pass


@pytest.mark.parametrize(("room", "taken"), [(0, False), (1, False), (2, True), (3, True)])
def test_a_message_counts_as_sent_only_if_all_of_its_datagrams_had_room(room, taken):
    board = board_of("udp://127.0.0.1:9", ECHO)
    board._socket = own = Full(room)
    assert board.send([b"a", b"b"]) is taken
    assert own.sent == [b"a", b"b"][:room] and not board.counters.total()
