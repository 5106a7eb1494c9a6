"""The ways to boards: names, sockets, serial lines; what they lose, and how they end."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import pty
import random
import re
import select
import socket
import sys
import termios
import threading
import time
import tty

import pytest

from firm_hdl.errors import UserError
from firm_hdl.node.boards import BoardError, board_of
from firm_hdl.node.boards.bytestreams import ByteBoard, SerialBoard, TcpBoard
from firm_hdl.node.boards.udp import UdpBoard
from firm_hdl.node.boards.zynq import ZynqBoard
from firm_hdl.node.bytestream import ByteStreamReader, write_frame
from tests.node.accelerators import echo_text
from tests.node.bridge.fakes import ECHO, HEARD, LINE, FakeGraph, FakeNode, bridge_of, run_until
from tests.node.samples import read

MEMORY = read(echo_text(link="{kind: axi_dma, buffer_bytes: 4096}"))
TEXTS = [b"%d" % n * (n % 300) for n in range(200)]


class UdpNode(threading.Thread):
    """A `FakeNode`, or another one, behind a UDP socket."""

    def __init__(self, port=0, node=None):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        # All messages of a test fit, in case that this thread does not run while they are sent.
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.bind(("127.0.0.1", port))
        self.socket.settimeout(0.05)
        self.port = self.socket.getsockname()[1]
        self.node, self.ends = node or FakeNode(), False
        self.start()

    def run(self):
        while not self.ends:
            with contextlib.suppress(TimeoutError):
                frame, peer = self.socket.recvfrom(1 << 16)
                for answer in self.node.take(frame):
                    self.socket.sendto(answer, peer)
        self.socket.close()

    def stop(self):
        self.ends = True
        self.join()


class ByteNode(threading.Thread):
    """A `FakeNode` behind a file descriptor that carries bytes, of which some are changed."""

    def __init__(self, file, flips=0.0, node=None):
        super().__init__(daemon=True)
        self.file, self.flips, self.random = file, flips, random.Random(1)
        self.node, self.reader, self.ends = node or FakeNode(), ByteStreamReader(), False
        self.flipped = 0
        self.start()

    def run(self):
        while not self.ends:
            if not select.select([self.file], [], [], 0.05)[0]:
                continue
            try:
                data = os.read(self.file, 4096)
            except OSError:
                return
            if not data:
                return
            for frame in self.reader.feed(self._damaged(data)):
                for answer in self.node.take(frame):
                    os.write(self.file, self._damaged(write_frame(answer)))

    def _damaged(self, data):
        out = bytearray(data)
        for at in range(len(out)):
            if self.random.random() < self.flips:
                out[at] ^= 1 << self.random.randrange(8)
                self.flipped += 1
        return bytes(out)

    def stop(self):
        self.ends = True
        self.join()


@pytest.fixture
def serial():
    """Return the path of a pty, and what serves its other side with `ByteNode`."""
    master, slave = pty.openpty()
    tty.setraw(master)
    nodes = []

    def serve(**options):
        nodes.append(ByteNode(master, **options))
        return nodes[-1]

    yield f"serial://{os.ttyname(slave)}?baud=1000000", serve
    for node in nodes:
        node.stop()
    os.close(slave)
    with contextlib.suppress(OSError):
        os.close(master)


def exchange(board, texts, description=ECHO, seconds=20):
    """Send texts through a board; return the bridge and what came back, at most for some time."""
    graph = FakeGraph()
    made, said = bridge_of(board, graph, description)
    assert run_until(made, lambda: graph.opened), said
    for text in texts:
        graph.say(HEARD, text)
        made.step(time.monotonic())
    run_until(made, lambda: len(graph.got) == len(texts), seconds)
    return made, [packet for _, packet in graph.got], said


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("udp://127.0.0.1:99", UdpBoard),
        ("udp://board.local", UdpBoard),
        ("tcp://[::1]:7411", TcpBoard),
        ("serial:///dev/ttyUSB0", SerialBoard),
        ("serial:///dev/ttyUSB0?baud=9600", SerialBoard),
        ("zynq://uio0/udmabuf0", ZynqBoard),
        ("zynq://dma/axi-dma.buf", ZynqBoard),
    ],
)
def test_names_of_boards(name, kind):
    links = {UdpBoard: (ECHO, 1472), ZynqBoard: (MEMORY, 4096)}
    description, frame_bytes = links.get(kind, (LINE, None))
    board = board_of(name, description)
    assert type(board) is kind and board.name == name
    assert board.frame_bytes == frame_bytes


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("simm", "'simm' is no board; boards are sim, udp://"),
        ("http://a:1", "is no board"),
        ("udp://", "is not udp://HOST:PORT"),
        ("tcp://a", "'tcp://a' needs a port, such as tcp://a:7411"),
        ("tcp://a:99999", "has no port from 1 to 65535"),
        ("udp://a:1/b", "is not udp://HOST:PORT"),
        ("serial://dev/tty", "with three '/'"),
        ("serial:///dev/x?speed=1", "has an option other than 'baud=RATE'"),
        ("serial:///dev/x?baud=12345", "this system has no rate of 12345 baud; it has 9600, "),
        ("udp://a:0", "'udp://a:0' has no port from 1 to 65535"),
        ("tcp://a:0", "'tcp://a:0' has no port from 1 to 65535"),
        ("serial:///dev/x?baud=0", "this system has no rate of 0 baud"),
        ("serial:///dev/x?baud=\N{SUPERSCRIPT TWO}", "has an option other than 'baud=RATE'"),
        ("serial:///dev/x?baud=", "has an option other than 'baud=RATE'"),
        ("serial:///dev/x?baud=" + "9" * 5000, "has an option other than 'baud=RATE'"),
        ("udp://[::1:99", "'udp://[::1:99' is no board: Invalid IPv6 URL"),
        ("tcp://[x]:1", "'tcp://[x]:1' is no board: "),
        ("tcp://:1", "is not tcp://HOST:PORT"),
        ("udp://a:1?b=2", "is not udp://HOST:PORT"),
        ("zynq://uio0", "is not zynq://UIO/BUFFER, such as zynq://uio0/udmabuf0"),
        ("zynq:///udmabuf0", "is not zynq://UIO/BUFFER"),
        ("zynq://uio0/../mem", "is not zynq://UIO/BUFFER"),
        ("zynq://uio0/..", "is not zynq://UIO/BUFFER"),
        ("zynq://uio0/udmabuf0?a=1", "is not zynq://UIO/BUFFER"),
    ],
)
def test_wrong_names_of_boards(name, message):
    with pytest.raises(UserError, match=re.escape(message)):
        board_of(name, ECHO)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("udp://a", "udp"),
        ("tcp://a:1", "uart"),
        ("serial:///dev/x", "uart"),
        ("zynq://uio0/udmabuf0", "axi_dma"),
    ],
)
@pytest.mark.parametrize("link", ["stream", "axi_dma", "udp", "uart"])
def test_a_board_of_another_link_is_refused(name, kind, link):
    if link == kind:
        board_of(name, read(echo_text(link=link)))
        return
    message = f"^'{name}' is a board whose link is '{kind}', and the link of 'echo' is '{link}', "
    with pytest.raises(UserError, match=message):
        board_of(name, read(echo_text(link=link)))


def test_the_link_says_the_port_of_a_board():
    assert board_of("udp://a", read(echo_text(link="{kind: udp, port: 99}")))._address == ("a", 99)


def test_a_simulated_board_needs_an_accelerator():
    text = "node: n\nsubscribe:\n  /a: {type: std_msgs/msg/Bool}\ndistro: jazzy\n"
    with pytest.raises(UserError, match="a simulated board needs an 'accelerator'"):
        board_of("sim", read(text))


def test_a_board_behind_udp_and_its_restart():
    node = UdpNode()
    made, got, said = exchange(board_of(f"udp://127.0.0.1:{node.port}", ECHO), TEXTS)
    assert got == TEXTS and not made.side.on_the_way
    node.stop()
    # The next request finds nobody, which is no error.
    run_until(made, lambda: made.board.counters["unreachable"])
    node = UdpNode(node.port)
    assert run_until(made, lambda: made.side.restarts == 1 and made.side.is_ready), said
    made.graph.say(HEARD, b"again")
    assert run_until(made, lambda: made.graph.got[-1][1] == b"again")
    made.close()
    node.stop()


@pytest.mark.parametrize("starts_again", [False, True])
def test_messages_wait_for_a_board_that_nobody_listens_for(starts_again):
    node = UdpNode()
    made, got, said = exchange(board_of(f"udp://127.0.0.1:{node.port}", ECHO), TEXTS[:3])
    assert got == TEXTS[:3]
    node.stop()
    # The system says of the first one that nobody listens, and the others wait.
    waiting = [b"sent", b"waits 1", b"waits 2"]
    made.graph.say(HEARD, *waiting)
    for _ in range(3):
        made.step(time.monotonic())
    assert made.counters.to_board["/heard"] <= 4 and not made.counters.dropped
    node = UdpNode(node.port, FakeNode() if starts_again else node.node)
    assert run_until(made, lambda: made.graph.got[-1][1] == waiting[-1], 5), said
    assert [packet for _, packet in made.graph.got][-2:] == waiting[1:]
    assert made.side.is_ready and made.side.restarts == starts_again
    made.close()
    node.stop()


def test_a_host_without_a_name_is_an_error_that_may_pass():
    with pytest.raises(BoardError, match=r"cannot reach udp://no\.such\.host\.invalid:1"):
        board_of("udp://no.such.host.invalid:1", ECHO).open()


def test_a_board_behind_tcp_and_its_restart():
    with socket.create_server(("127.0.0.1", 0)) as server:
        board = board_of(f"tcp://127.0.0.1:{server.getsockname()[1]}", LINE)
        accepted, nodes = [], []

        def accept():
            for _ in range(2):
                accepted.append(server.accept()[0])
                nodes.append(ByteNode(accepted[-1].fileno()))

        threading.Thread(target=accept, daemon=True).start()
        made, got, said = exchange(board, TEXTS)
        assert got == TEXTS and not made.side.on_the_way
        accepted[0].shutdown(socket.SHUT_RDWR)
        assert run_until(made, lambda: len(nodes) == 2 and made.side.is_ready), said
        assert "the other side has closed; trying again" in "".join(said)
        made.graph.say(HEARD, b"again")
        assert run_until(made, lambda: made.graph.got[-1][1] == b"again")
        made.close()
        # A thread that reads would read what has the number of a closed file next.
        for node, connection in zip(nodes, accepted, strict=True):
            node.stop()
            connection.close()


def test_a_board_behind_a_serial_line(serial):
    """So many bytes have room at once, if the line should stand still."""
    name, serve = serial
    serve()
    made, got, _ = exchange(board_of(name, LINE), TEXTS[:100])
    made.close()
    assert got == TEXTS[:100] and not made.side.on_the_way


def test_flipped_bits_of_a_serial_line_lose_messages_and_change_none(serial):
    name, serve = serial
    node = serve(flips=0.01)
    texts = [b"%d." % n for n in range(300)]
    # Not all come back.
    made, got, _ = exchange(board_of(name, LINE), texts, seconds=0.7)
    made.close()
    assert node.flipped > 100 and 30 < len(got) < 300
    # In order, each at most once, and none that was not sent.
    assert got == [text for text in texts if text in set(got)]
    assert made.side.on_the_way["damaged"] > 10


def test_a_serial_line_that_ends(serial):
    name, serve = serial
    node = serve()
    made, _, said = exchange(board_of(name, LINE), [])
    node.stop()
    # Ends the pty; the fixture closes the file.
    os.dup2(os.open(os.devnull, os.O_RDWR), node.file)
    assert run_until(made, lambda: not made.side.is_ready), said
    assert "serial:///dev/pts/" in said[-1] and said[-1].endswith("; trying again")
    made.close()


def test_a_file_is_no_serial_line(tmp_path):
    path = tmp_path / "file"
    path.write_text("")
    with pytest.raises(BoardError, match="is no serial device"):
        board_of(f"serial://{path}", LINE).open()
    with pytest.raises(BoardError, match="cannot open '/dev/no-such-tty': No such file"):
        board_of("serial:///dev/no-such-tty", LINE).open()
    with pytest.raises(BoardError, match="is no serial device"):
        board_of("serial:///dev/null", LINE).open()


def full(board):
    """Send frames while there is room; return how many bytes wait."""
    while board.has_room and len(board._waiting) < 1 << 20:
        assert board.send([b"x" * 100])
    return len(board._waiting)


@pytest.mark.parametrize("baud", [9600, 115_200, 1_000_000])
def test_a_twentieth_of_a_second_of_a_line_may_wait(serial, baud):
    name, _ = serial
    board = board_of(name.replace("1000000", str(baud)), LINE)
    board.open()
    # Nobody reads the other end of the pty, whose 4 KiB are not counted.
    assert 0 <= full(board) - baud / 10 / 20 < 200
    # One message always has room, however large it is.
    board.open()
    assert board.has_room and board.send([b"x" * 300_000])
    assert not board.has_room and board.waits_to_send
    board.close()


def test_what_a_driver_holds_takes_room(serial, monkeypatch):
    name, _ = serial
    board = board_of(name.replace("1000000", "9600"), LINE)
    board.open()
    for held, has_room in [(0, True), (47, True), (48, False), (4096, False)]:
        monkeypatch.setattr(fcntl, "ioctl", lambda *_, held=held: held.to_bytes(4, sys.byteorder))
        assert board.has_room == has_room

    def fail(*_):
        raise OSError

    monkeypatch.setattr(fcntl, "ioctl", fail)
    assert board.has_room
    board.close()


def test_a_connection_has_little_room_for_a_slow_peer():
    with socket.create_server(("127.0.0.1", 0)) as server:
        board = board_of(f"tcp://127.0.0.1:{server.getsockname()[1]}", LINE)
        board.open()
        with server.accept()[0]:
            assert 0 <= full(board) - 65_536 < 200
            board.close()


@pytest.mark.parametrize("room", [None, 1 << 20])
def test_a_slow_line_loses_messages_and_names_them(serial, room):
    """The twin has so much room that nothing is lost: commands would come 10 s late."""
    name, serve = serial
    board = board_of(name, LINE)
    node = serve()
    made, _, _ = exchange(board, [])
    # The node reads no more, and the line stands still.
    node.stop()
    if room:
        board._room_bytes = room
    made.graph.say(HEARD, *(b"x" * 100 for _ in range(600)))
    assert run_until(made, lambda: made._queue.oldest() is None)
    sent, dropped = made.counters.to_board["/heard"], made.counters.dropped
    assert sent + dropped["/heard", "board full"] == 600
    assert (len(board._waiting) / board.bytes_per_second < 0.06) == (room is None)
    # Nothing of it arrived, as far as the bridge can know.
    made.close()
    assert dropped["/heard", "unconfirmed"] == sent


@pytest.mark.parametrize(
    ("number", "passes"),
    [
        (errno.ECONNREFUSED, True),
        (errno.EHOSTUNREACH, True),
        (errno.ENETUNREACH, True),
        (errno.EHOSTDOWN, True),
        (errno.EBADF, False),
        (errno.EMSGSIZE, False),
    ],
)
@pytest.mark.parametrize("sends", [False, True])
def test_what_a_network_says_of_one_datagram_ends_no_board(number, passes, sends):
    class Socket:
        def send(self, frame):
            raise OSError(number, "no")

        recv = send

        def close(self):
            pass

    board = board_of("udp://127.0.0.1:9", ECHO)
    board._socket = Socket()
    work = (lambda: board.send([b"x"])) if sends else board.receive
    if passes:
        # Of a refusal, a datagram before is the reason.
        assert bool(work()) == (sends and number == errno.ECONNREFUSED)
        assert board.counters["unreachable"] == (1 if sends else 256)
    else:
        with pytest.raises(BoardError, match=r"^udp://127\.0\.0\.1:9: no$"):
            work()


def test_bytes_of_before_are_not_sent_to_a_board_that_is_opened_again():
    opened = []

    class Slow(ByteBoard):
        def _open(self):
            self.ours, theirs = socket.socketpair()
            opened.append(self.ours)
            self.ours.setblocking(False)
            theirs.setblocking(False)
            self.ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)
            return theirs.detach()

    board = Slow("slow", 1 << 20)
    board.open()
    frame = bytes(range(1, 200))
    while not board.waits_to_send:
        board.send([frame] * 1000)
    board.ours.send(write_frame(b"half")[:-3])
    board.receive()
    board.open()
    assert not board.waits_to_send and board.has_room
    board.send([b"first"])
    assert board.ours.recv(1 << 16) == write_frame(b"first")
    # Neither is half a frame of before part of the next one.
    board.ours.send(write_frame(b"whole"))
    assert board.receive() == [b"whole"] and not +board.counters
    board.close()
    for each in opened:
        each.close()


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
    assert own.sent == [b"a", b"b"][:room]
    own.left = room
    assert board.receive() == [b"x"] * room and not board.counters.total()
