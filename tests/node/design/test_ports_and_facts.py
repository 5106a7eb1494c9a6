# amaranth: UnusedElaboratable=no
"""The ports of a node's top level, and what its design is told apart by."""

from __future__ import annotations

import hashlib
from types import SimpleNamespace

import pytest

from firm_hdl.node import Node
from firm_hdl.node import build as node_build
from firm_hdl.node.benches import link_script
from firm_hdl.node.build import build_node
from firm_hdl.node.top import node_ports
from tests.node.samples import read

SIGNED = """\
node: tiny
distro: jazzy
bus_bytes: 4
subscribe:
  /low: {type: std_msgs/msg/Int16}
publish:
  /high: {type: std_msgs/msg/UInt8}
  /nothing: {type: std_msgs/msg/Empty}
"""
OUT, IN = "out", "in"
# Name, direction, bits, and whether the number has a sign, as in docs/reference/node.md.
STREAM = [
    ("s_axis_tdata", IN, 32, False),
    ("s_axis_tkeep", IN, 4, False),
    ("s_axis_tlast", IN, 1, False),
    ("s_axis_tvalid", IN, 1, False),
    ("s_axis_tready", OUT, 1, False),
    ("m_axis_tdata", OUT, 32, False),
    ("m_axis_tkeep", OUT, 4, False),
    ("m_axis_tlast", OUT, 1, False),
    ("m_axis_tvalid", OUT, 1, False),
    ("m_axis_tready", IN, 1, False),
    ("m_axis_tdest", OUT, 16, False),
]
MESSAGES = [
    ("subscribe_low_data_data", OUT, 16, True),
    ("subscribe_low_data_valid", OUT, 1, False),
    ("subscribe_low_data_ready", IN, 1, False),
    ("publish_high_data_data", IN, 8, False),
    ("publish_high_data_valid", IN, 1, False),
    ("publish_high_data_ready", OUT, 1, False),
]
CLOCK = [("aclk", IN, 1, False), ("aresetn", IN, 1, False)]


def ports_of(description):
    return {
        port.name: (port.name, port.direction, port.width, port.signed)
        for port in node_ports(Node(description))
    }


def test_ports_of_a_stream_have_their_directions_and_widths():
    found = ports_of(read(SIGNED))
    wanted = [*CLOCK, *STREAM, *MESSAGES]
    assert [found.get(each[0]) for each in wanted] == wanted
    # All others are those of a message without fields, the time and counters; no port is empty.
    others = [name for name, port in found.items() if port not in wanted]
    assert {name.partition("_")[0] for name in others} == {"publish", "time", "counters"}
    assert {name for name in others if name.startswith("publish")} == {
        f"publish_nothing_structure_needs_at_least_one_member_{part}"
        for part in ("data", "valid", "ready")
    }
    assert all(port[2] > 0 for port in found.values())


def test_a_uart_has_two_ports():
    found = ports_of(read(SIGNED, link="uart"))
    assert {name: port[1:3] for name, port in found.items() if name.startswith("uart")} == {
        "uart_rx": (IN, 1),
        "uart_tx": (OUT, 1),
    }
    assert not any("axis" in name for name in found)


@pytest.fixture
def given(monkeypatch):
    """What :func:`build_node` asks to be written; nothing is, and no circuit is made."""
    asked = []

    def write_design(folder, **options):
        asked.append(SimpleNamespace(folder=folder, **options))

    monkeypatch.setattr(node_build, "write_design", write_design)
    monkeypatch.setattr(node_build.rtlil, "rtlil_of", lambda *_, **__: "circuit")
    return asked


def test_a_design_is_current_only_with_the_same_frames(given, tmp_path):
    description = read(SIGNED)
    for packets in ([], [b"\0\1\0\0\7\0"]):
        build_node(description, tmp_path, stimuli=lambda *_, found=packets: found)
        script = link_script(description, lambda *_, found=packets: found, has_accelerator=False)
        digest = hashlib.sha256(script.text.encode()).hexdigest()
        assert digest in str(given[-1].inputs)
    assert given[0].inputs != given[1].inputs
    build_node(read(SIGNED, link="uart"), tmp_path)
    assert "'frames_sha256': None" in str(given[-1].inputs)


@pytest.mark.parametrize("force", [False, True])
def test_a_folder_is_written_again_only_if_that_is_asked_for(force, given, tmp_path):
    build_node(read(SIGNED), tmp_path, force=force)
    assert (given[0].force, given[0].folder) == (force, tmp_path / "tiny")
