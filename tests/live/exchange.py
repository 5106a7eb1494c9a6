"""``python -m tests.live.exchange``: what a node and rclpy say to each other, as a diagram.

The example is built, and runs with rclpy of Kilted in a network of its own, where all datagrams are
captured. The diagram of ``docs/explanation/participant.md`` is from here.
"""

from __future__ import annotations

import socket
import struct
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import (
    PUBLICATIONS_READER,
    PUBLICATIONS_WRITER,
    SPDP_READER,
    SPDP_WRITER,
    SUBSCRIPTIONS_READER,
    SUBSCRIPTIONS_WRITER,
)
from firm_hdl.rtps.wire.submessages import AckNack, Data, Gap, Heartbeat, InfoDestination
from tests.live.boards import build_board
from tests.live.network import leave_network
from tests.live.peer import Peer

_PORTS = ("7400", "7510", "7511")
_NODE = 7510
_OUTGOING = 4
_ENDPOINTS = {
    PUBLICATIONS_READER,
    PUBLICATIONS_WRITER,
    SUBSCRIPTIONS_READER,
    SUBSCRIPTIONS_WRITER,
}
_TRIP = {"type": "string", "to": "/text_in", "back": "/text_out", "count": 1, "period": 0}


def main(*programs: Path) -> None:
    """Print the diagram, of a program that was built, or else of the example."""
    with tempfile.TemporaryDirectory() as name:
        program = programs[0] if programs else build_board(Path(name), "rtps")
        leave_network()
        capture = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(0x0800))
        capture.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)
        capture.bind(("lo", 0))
        board = subprocess.Popen([program, "127.0.0.1", "1000000", *_PORTS])
        try:
            with Peer("kilted", "trip", topics=[_TRIP]) as peer:
                assert peer.next(90) == {"begins": True}
                assert peer.result(60)["numbers"] == [[0]]
        finally:
            board.kill()
            board.wait()
        capture.setblocking(False)
        print("\n".join(_diagram(list(_datagrams(capture)))))


def _datagrams(capture: socket.socket) -> Iterator[tuple[bool, bytes]]:
    """Yield whether the node sent a datagram, and its payload; those between peers are left out."""
    while True:
        try:
            frame, (_, _, kind, *_) = capture.recvfrom(65536)
        except BlockingIOError:
            return
        source, target = struct.unpack_from(">HH", frame, 14 + 20)
        ports = {int(port) for port in _PORTS}
        if kind != _OUTGOING and frame[23] == socket.IPPROTO_UDP and {source, target} & ports:
            yield source == _NODE, frame[14 + 28 :]


def _diagram(datagrams: list[tuple[bool, bytes]]) -> Iterator[str]:
    """Yield a line for datagrams of the same content that follow each other."""
    node = next(data[8:20] for is_ours, data in datagrams if is_ours)
    told = [
        (is_ours, what, len(data))
        for is_ours, data in datagrams
        if (what := _content(data, data[20:].startswith(bytes([InfoDestination.KIND])), node))
    ]
    yield f"{'node':36}{'rclpy':>36}"
    for (is_ours, what), group in groupby(told, key=lambda each: each[:2]):
        sizes = [size for *_, size in group]
        least, most = min(sizes), max(sizes)
        text = f"{what}, {len(sizes)} x" if len(sizes) > 1 else what
        text += f", {least} bytes" if least == most else f", {least} to {most} bytes"
        yield (
            f"|{f' {text} '.center(68, '-')}>|" if is_ours else f"|<{f' {text} '.center(68, '-')}|"
        )


def _content(data: bytes, is_addressed: bool, node: bytes) -> str:
    """Say what a datagram has, if the node or its peer is meant."""
    receiver = data[24:36] if is_addressed else node
    try:
        found = message.read(data, receiver).received
    except ValueError:
        return ""
    words = []
    for each in found:
        one = each.submessage
        if not isinstance(one, Data | Heartbeat | AckNack | Gap):
            continue
        kind = type(one).__name__.upper()
        if one.writer == SPDP_WRITER or one.reader == SPDP_READER:
            words.append(f"{kind} participant")
            continue
        what = "endpoint" if {one.writer, one.reader} & _ENDPOINTS else "message"
        words.append(f"{kind} {what}")
    return " + ".join(words)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
