"""The description of a node that loops types: its text, and the loops that are tested."""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.verify.board.description import (
    chosen_loops,
    described_board,
    loop_text,
)
from firm_hdl.verify.systems.options import Request
from tests.frontend.workspace import make_files
from tests.verify.board.fakes import BOTH, STRING, described

NODE = """\
node: n
distro: jazzy
accelerator: firm_hdl.node.loop:Loop
subscribe: {/a: {type: mine/msg/A}}
publish: {/b: {type: mine/msg/A}}
"""
REQUEST = Request(distros=("lyrical",), widths=(4,))


def test_each_type_comes_in_once_and_goes_out_once_in_the_order_of_names():
    names = ["q/srv/Ask_Request", "p/B", "p/msg/A", "p/B"]
    text = loop_text(names, "jazzy", paths=["/a/b", "/a"], folder="/a/c", bus_bytes=4)
    assert text.splitlines()[1:] == [
        "node: loopback",
        "distro: jazzy",
        'paths: ["../b", ".."]',
        "bus_bytes: 4",
        "clock_mhz: 100",
        "link: {kind: udp}",
        "accelerator: firm_hdl.node.loop:Loop",
        "subscribe:",
        "  /loopback/in/p/B: {type: p/B}",
        "  /loopback/in/p/A: {type: p/msg/A}",
        "  /loopback/in/q/Ask_Request: {type: q/srv/Ask_Request}",
        "publish:",
        "  /loopback/out/p/B: {type: p/B}",
        "  /loopback/out/p/A: {type: p/msg/A}",
        "  /loopback/out/q/Ask_Request: {type: q/srv/Ask_Request}",
    ]
    assert "paths" not in loop_text(names, "jazzy")


@pytest.mark.parametrize(
    ("board", "link"),
    [
        (None, "{kind: udp}"),
        ("udp://a", "{kind: udp}"),
        ("udp://a:99", "{kind: udp, port: 99}"),
        # That the name of a board is wrong is told where it is opened.
        ("udp://a:99999", "{kind: udp}"),
        ("udp://[a", "stream"),
        ("tcp://a:99", "uart"),
        ("serial:///dev/a?baud=9600&baud=115200", "{kind: uart, baud: 115200}"),
        ("zynq://uio0/udmabuf0", "axi_dma"),
        ("serial:///dev/a?baud=fast", "uart"),
        ("serial:///dev/a?baud=\N{SUPERSCRIPT TWO}", "uart"),
        ("sim", "stream"),
    ],
)
def test_the_link_is_that_of_the_board(board, link):
    assert f"link: {link}" in loop_text([STRING], "lyrical", board=board).splitlines()


def test_types_of_a_given_node_are_in_the_folders_of_the_request(tmp_path):
    make_files(tmp_path, {"mine/msg/A.msg": "int8 x\n", "node.yaml": NODE})
    request = replace(REQUEST, node=str(tmp_path / "node.yaml"), paths=(str(tmp_path),))
    ((came, goes),) = described_board(request, ()).loops()
    assert (came.name, goes.name) == ("/a", "/b")
    with pytest.raises(DefinitionError):
        described_board(replace(request, paths=()), ())


def test_a_type_that_is_named_needs_a_loop():
    node = described(*BOTH)
    assert chosen_loops(node, ()) == node.loops()
    assert chosen_loops(node, ["std_msgs/String"]) == chosen_loops(node, [STRING])
    with pytest.raises(UserError, match=r"has no loop of std_msgs/Char$"):
        chosen_loops(node, [STRING, "std_msgs/msg/Char"])
