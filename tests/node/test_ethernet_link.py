"""The link with an Ethernet of its own: messages at the pins of a GMII, and its counters."""

from __future__ import annotations

from itertools import chain, repeat

import pytest
from amaranth.sim import Simulator

from firm_hdl.node import Node, read_description_text
from firm_hdl.node.links import EthernetLink
from firm_hdl.node.top import NodeTop, node_ports
from firm_hdl.rtlil import rtlil_of
from firm_hdl.sim.payloads import packet_beats
from tests.ethernet.bench import PREAMBLE, checked
from tests.node.samples import LIBRARY
from tests.node.traffic import frames_of, link_beats, some

scapy = pytest.importorskip("scapy.layers.inet")
ARP = pytest.importorskip("scapy.layers.l2").ARP

TEXT = """\
node: n
clock_mhz: 125
link:
  kind: udp
  memory_bytes: 512
  packets: 8
  ethernet: gmii
  mac: "02:00:00:00:00:01"
  address: 10.0.0.50/8
subscribe: {/a: {type: std_msgs/msg/String, memory_bytes: 256}}
"""
DESCRIPTION = read_description_text(TEXT, name="n.yaml", library=LIBRARY)
LINK, BUS = DESCRIPTION.link, DESCRIPTION.bus_bytes


def frame(data, *, port=LINK.port):
    """Return a datagram from the host as bytes at the pins."""
    packet = scapy.Ether(dst=LINK.mac, src="02:00:00:00:00:02")
    packet /= scapy.IP(src="10.0.0.7", dst="10.0.0.50") / scapy.UDP(sport=99, dport=port) / data
    whole = bytes(packet)
    return PREAMBLE + checked(whole + bytes(max(0, 60 - len(whole))))


@pytest.mark.parametrize("mhz", [pytest.param(125, marks=pytest.mark.thorough), 50])
def test_messages_pass_the_pins_both_ways_and_what_is_lost_is_counted(mhz):
    text = TEXT.replace("clock_mhz: 125", f"clock_mhz: {mhz}")
    link = EthernetLink(read_description_text(text, name="n.yaml", library=LIBRARY))
    down, up = some(2, 1), some(1, 2)
    answer = scapy.Ether(dst=LINK.mac, src="02:00:00:00:00:02") / ARP(
        op=2, hwsrc="02:00:00:00:00:02", psrc="10.0.0.7", pdst="10.0.0.50"
    )
    wires = [frame(data) for data in frames_of(down)]
    wires.insert(1, wires[0][:-1] + bytes([wires[0][-1] ^ 1]))
    wires += [frame(b"x", port=1), PREAMBLE + checked(bytes(answer) + bytes(18))]
    pins, received = link.gmii, link.received
    symbols = [pair for each in wires for pair in (*[(0, 0)] * 20, *((byte, 1) for byte in each))]
    beats, sent, counters = [], bytearray(), {}

    async def wire(ctx):
        # The clock of the PHY is half a cycle behind, with 125 MHz.
        for byte, valid in chain(symbols, repeat((0, 0))):
            ctx.set(pins.rxd, byte)
            ctx.set(pins.rx_dv, valid)
            await ctx.delay(4e-9)
            ctx.set(pins.rx_clk, 0)
            await ctx.delay(4e-9)
            if ctx.get(pins.tx_en):
                sent.append(ctx.get(pins.txd))
            ctx.set(pins.rx_clk, 1)

    async def node(ctx):
        await ctx.delay(8e-9 * (len(symbols) + 3))
        for beat in link_beats(up, BUS):
            ctx.set(link.sent.payload.as_value(), beat)
            ctx.set(link.sent.valid, 1)
            await ctx.tick().until(link.sent.ready)
        ctx.set(link.sent.valid, 0)
        await ctx.tick().repeat(350)
        for name in link.counters.shape().members:
            counters[name] = ctx.get(link.counters[name])

    async def watch(ctx):
        ctx.set(received.ready, 1)
        while True:
            _, _, valid, payload = await ctx.tick().sample(received.valid, received.payload)
            if valid:
                beats.append((payload.topic, payload.tag, payload.length, payload.beat.as_bits()))

    simulator = Simulator(link)
    simulator.add_clock(1e-6 / mhz)
    simulator.add_testbench(node)
    simulator.add_testbench(wire, background=True)
    simulator.add_testbench(watch, background=True)
    simulator.run()
    want = [
        (each.topic, each.tag, len(each.packet), beat)
        for each in down
        for beat in packet_beats(each.packet, BUS)
    ]
    assert [beat[:3] for beat in beats] == [beat[:3] for beat in want]
    packet = scapy.Ether(bytes(sent[8:-4]))
    assert (packet.dst, packet[scapy.IP].dst) == ("02:00:00:00:00:02", "10.0.0.7")
    assert (packet[scapy.UDP].sport, packet[scapy.UDP].dport) == (LINK.port, 99)
    assert bytes(packet[scapy.UDP].payload)[: packet[scapy.UDP].len - 8] == frames_of(up)[0]
    found = {name: count for name, count in counters.items() if count}
    assert found == {"passed": 2, "ethernet_damaged": 1, "ethernet_port": 1}


def test_a_participant_of_ros_2_has_the_pins_of_a_phy_too():
    text = TEXT.replace("kind: udp", "kind: rtps")
    node = Node(read_description_text(text, name="n.yaml", library=LIBRARY))
    names = {port.name: port.width for port in node_ports(node)}
    assert (names["gmii_rxd"], names["gmii_txd"], names["nonce"]) == (8, 8, 32)
    assert "udp_rx_data" not in names
    # The drivers of all its parts fit together.
    assert "\\gmii_rxd" in rtlil_of(NodeTop(node), name="n")
