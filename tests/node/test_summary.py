"""The warnings of a node's summary: what its link and its memories cannot carry."""

from __future__ import annotations

import pytest

from firm_hdl.node.capacity import bytes_on_link
from firm_hdl.node.frame import HEADER_BYTES
from firm_hdl.node.summary import area_of, facts_of, summary
from tests.node.samples import read

BEYOND = """\
node: n
link: {kind: KIND}
clock_mhz: 2
subscribe:
  /a: {type: geometry_msgs/msg/Twist, rate_hz: 200}
  /b: {type: geometry_msgs/msg/Twist, rate_hz: 300000}
  /c: {type: std_msgs/msg/String, memory_bytes: 64}
publish:
  /d: {type: builtin_interfaces/msg/Time, rate_hz: 1}
serve:
  /e: {type: robot_msgs/srv/Calibrate, memory_bytes: 64}
"""


@pytest.mark.parametrize(
    ("kind", "link"),
    [
        # Frames have a header of 16 bytes, and on a line 7 bytes more.
        ("uart, baud: 100000", "22,515,000 bytes/s to the node, and the link carries 10,000 (100"),
        ("udp", "20,413,600 bytes/s to the node, and the link carries 2,000,000 (1 bytes per"),
        ("udp, data_bytes: 16", ""),
        ("stream", "20,413,600 bytes/s to the node, and the link carries 16,000,000 (8 bytes"),
    ],
)
def test_what_a_node_cannot_carry_is_a_warning(kind, link):
    found = summary(read(BEYOND.replace("KIND", kind))).splitlines()
    warnings = [line.removeprefix("warning: ") for line in found if line.startswith("warning: ")]
    assert warnings.pop(0) == "/b: a rate of 300000 Hz needs a clock of 2.1 MHz"
    if link:
        assert f"/a at 200 Hz, /b at 300000 Hz: at least {link}" in warnings.pop(0)
    assert warnings == [
        "/e (out): a message has up to 76 bytes, and the memory has room for 64; larger ones are "
        "dropped",
        "larger messages are dropped, and the types set no limit: /c over 64 bytes, /e (in) over "
        "64 bytes",
    ]


def test_a_message_without_bytes_takes_a_frame_too():
    for kind in ("udp, datagram_bytes: 32", "stream"):
        description = read(BEYOND.replace("KIND", kind))
        assert bytes_on_link(description, 0) == HEADER_BYTES
        frames = 2 if "udp" in kind else 1
        assert bytes_on_link(description, 17) == 17 + frames * HEADER_BYTES


def test_a_memory_of_the_link_limits_what_comes():
    link = "{kind: udp, memory_bytes: 64}"
    text = summary(read(BEYOND, link=link))
    assert "/a: a message has up to 52 bytes, and the link has room for 48" in text
    assert "/c over 48 bytes" in text
    # A message has 65,536 frames at most.
    few = "{kind: udp, datagram_bytes: 32}"
    large = "node: n\nsubscribe: {/a: {type: std_msgs/msg/String, memory_bytes: 4194304}}\n"
    assert "/a over 1048576 bytes" in summary(read(large, link=few))


def test_a_participant_has_ports_and_sends_what_its_memory_holds():
    text = """
node: echo
link: {kind: rtps, address: 10.0.0.9, domain: 1, participant: 2, static_peers: [10.0.0.1]}
subscribe:
  /heard: {type: std_msgs/msg/String, memory_bytes: 4096, max_message_bytes: 1300}
  /small: {type: std_msgs/msg/String, memory_bytes: 4096, max_message_bytes: 1280}
publish:
  /said: {type: std_msgs/msg/String}
"""
    found = summary(read(text))
    # Gates, the FIFO and the history, the link; and one topic puts samples together.
    assert f"memory for packets: {2 * 4096 + 2 * 16384 + 16384 + 2048} bytes" in found
    assert "static_peers 10.0.0.1" in found
    assert "discovery_multicast 7650, discovery 7664, user 7665" in found
    assert "/said over 16384 bytes" in found


def test_the_area_of_a_whole_node_is_near_that_of_its_synthesis():
    text = """
node: echo
clock_mhz: 125
link: {kind: rtps, ethernet: rgmii, mac: "02:00:00:00:00:50", address: 10.0.0.9/24}
accelerator: firm_hdl.node.loop:Loop
subscribe:
  /a: {type: std_msgs/msg/String}
  /b: {type: geometry_msgs/msg/Twist}
publish:
  /c: {type: std_msgs/msg/String}
  /d: {type: geometry_msgs/msg/Twist}
"""
    description = read(text)
    area = area_of(facts_of(description))
    # The synthesis had 14,292 and 12,826, with an earlier participant of 6,894 and 3,961.
    assert area["lut"] == pytest.approx(14292 + 80, rel=0.03)
    assert area["ff"] == pytest.approx(12826 - 365, rel=0.03)
    assert f"estimated, without the accelerator: {area['lut']} LUT" in summary(description)
    # Of a datagram's template: a reply has two parameters of 28 bytes, and a sentinel.
    assert "costs 92 bytes of headers per reader, and a response 152\n" in summary(description)
    assert bytes_on_link(description, 100) == 100 + 152 + 3
    # Of a bus of 16 bytes, no converter was measured.
    wide = facts_of(read(f"bus_bytes: 16\n{text.replace('accelerator', '# ')}"))
    assert area_of(wide)["without"] == ", without parts that were not measured"
    assert area_of(wide)["lut"] > 10_000


@pytest.mark.parametrize("clock", [50, 99.2, 125, 400])
def test_a_clock_above_the_estimate_is_a_warning(clock):
    link = '{kind: KIND, ethernet: rgmii, mac: "02:00:00:00:00:50", address: 10.0.0.9/24}'
    text = "node: n\nclock_mhz: CLOCK\nsubscribe: {/a: {type: std_msgs/msg/Char}}\n"
    text = text.replace("CLOCK", str(clock))
    # Ethernet has the clock of its PHY, which is slower than the one of the other parts.
    for kind, mhz, part in (("rtps", 99.2, "link"), ("udp", 160, "core")):
        found = summary(read(text, link=link.replace("KIND", kind)))
        assert f"{mhz} MHz in its slowest part ({part})" in found
        warning = (
            f"warning: the clock of {clock} MHz is above the {mhz} MHz that are estimated for the "
            f"slowest part ({part}) on ECP5 LFE5U-45F-8: lower clock_mhz (25 at least, with "
            "Ethernet), or use a faster device"
        )
        assert (warning in found.splitlines()) == (clock > mhz)
