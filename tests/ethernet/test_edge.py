"""The edge against scapy: what it sends, what it takes, and that nothing bad gets through."""

from __future__ import annotations

import logging

import pytest

logging.getLogger("scapy").setLevel(logging.ERROR)
scapy = pytest.importorskip("scapy.layers.inet")

from tests.depth import by_depth  # noqa: E402
from tests.ethernet.bench import (  # noqa: E402
    GROUP,
    GROUP_MAC,
    HOST,
    HOST_MAC,
    MAC,
    NODE,
    OTHER,
    OTHER_MAC,
    PREAMBLE,
    Datagram,
    Pause,
    checked,
    number,
    run,
    settings,
    wire,
)

Ether, IP, ICMP, UDP = (getattr(scapy, name) for name in ("Ether", "IP", "ICMP", "UDP"))
Raw = pytest.importorskip("scapy.packet").Raw
ARP = pytest.importorskip("scapy.layers.l2").ARP
BROADCAST = "ff:ff:ff:ff:ff:ff"


def arp(op=1, ip=HOST, mac=HOST_MAC, target=NODE, to=BROADCAST):
    return Ether(dst=to, src=mac) / ARP(op=op, hwsrc=mac, psrc=ip, pdst=target)


def ip(dst=NODE, src=HOST, to=MAC, **options):
    return Ether(dst=to, src=HOST_MAC) / IP(src=src, dst=dst, **options)


def payload(size):
    return bytes((7 * k + size) & 0xFF for k in range(size))


def udp(size, port=7411, **options):
    return ip(**options) / UDP(sport=5000, dport=port) / Raw(payload(size))


def echo(size, **options):
    return ip(**options) / ICMP(id=7, seq=size) / Raw(payload(size))


def come(*sizes, port=7411):
    return [(payload(size), number(HOST), 5000, port) for size in sizes]


def understood(frame):
    """Return a frame as scapy reads it, if scapy writes lengths, checksums and padding likewise."""
    packet = Ether(frame)
    bare = packet.copy()
    for layer, fields in ((IP, ("len", "chksum", "ihl")), (UDP, ("len", "chksum"))):
        if layer in bare:
            for name in fields:
                bare[layer].delfieldval(name)
    if ICMP in bare:
        bare[ICMP].delfieldval("chksum")
    assert bytes(bare) == frame
    assert len(frame) >= 60
    return packet


def carried(packet):
    """Return the payload of a datagram, without padding of Ethernet."""
    return bytes(packet[UDP].payload)[: packet[UDP].len - 8]


def test_datagrams_go_both_ways_and_an_echo_comes_back():
    steps = [wire(arp()), *(wire(udp(size)) for size in (1, 18, 19, 300))]
    steps += [Datagram(payload(size)) for size in (1, 11, 12, 13, 300)]
    steps += [wire(echo(size)) for size in (0, 1, 57)]
    seen = run(steps, after=700)
    answer, *datagrams, _, _, _ = map(understood, seen.frames)
    assert (answer[ARP].op, answer[ARP].psrc, answer[ARP].hwsrc) == (2, NODE, MAC)
    assert (answer[ARP].pdst, answer[ARP].hwdst, answer.dst) == (HOST, HOST_MAC, HOST_MAC)
    echoes = [p for p in map(understood, seen.frames) if ICMP in p]
    datagrams = [p for p in map(understood, seen.frames) if UDP in p]
    for size, packet in zip((1, 11, 12, 13, 300), datagrams, strict=True):
        assert carried(packet) == payload(size)
        assert (packet.dst, packet.src, packet[IP].dst, packet[IP].src) == (
            HOST_MAC,
            MAC,
            HOST,
            NODE,
        )
        assert (packet[UDP].sport, packet[UDP].dport) == (7400, 5000)
    for size, packet in zip((0, 1, 57), echoes, strict=True):
        assert (packet[ICMP].type, packet[ICMP].id, packet[ICMP].seq) == (0, 7, size)
        assert bytes(packet[ICMP].payload)[:size] == payload(size)
        assert (packet[IP].src, packet[IP].dst, packet[IP].len) == (NODE, HOST, size + 28)
    assert seen.datagrams == come(1, 18, 19, 300)
    assert not seen.drops


def changed(packet, place, value=None):
    """Return a packet's frame with another byte, and a right frame check sequence."""
    frame = bytearray(bytes(packet) + bytes(max(0, 60 - len(packet))))
    frame[place] = frame[place] ^ 1 if value is None else value
    return PREAMBLE + checked(bytes(frame))


def options(count):
    """Return `count` words of options: no operation."""
    return [scapy.IPOption(b"\1") for _ in range(4 * count)]


# Places in a frame: Ethernet has 14 bytes, IPv4 20, UDP 8.
BAD = [
    ("damaged", wire(udp(30))[:-1] + bytes([wire(udp(30))[-1] ^ 1])),
    ("damaged", [(byte, place == 30) for place, byte in enumerate(wire(udp(30)))]),
    ("damaged", b"\x55" * 6 + b"\x54" + wire(udp(30))[7:]),
    ("damaged", b"\x55" * 9),
    ("runt", PREAMBLE + checked(bytes(udp(17)))),
    ("runt", PREAMBLE + b"abc"),
    ("giant", PREAMBLE + checked(bytes(udp(30)) + bytes(1443))),
    ("other", wire(udp(30, to=OTHER_MAC))),
    ("other", wire(Ether(dst=MAC, src=HOST_MAC, type=0x86DD) / Raw(bytes(60)))),
    ("other", wire(udp(30, dst=OTHER))),
    ("other", wire(udp(30, to=BROADCAST))),
    ("other", wire(udp(30, dst=GROUP, to=GROUP_MAC))),
    ("other", wire(ip(proto=6) / Raw(bytes(30)))),
    ("other", wire(ip() / ICMP(type=0) / Raw(bytes(30)))),
    ("other", wire(echo(8, options=options(1)))),
    ("other", wire(arp(target=OTHER))),
    ("other", changed(arp(), 20, 8)),
    # The sender's address in hardware is a group's.
    ("other", changed(arp(), 22, 0x03)),
    ("other", wire(arp(mac=BROADCAST))),
    ("other", wire(udp(0))),
    ("malformed", changed(udp(30), 14, 0x55)),
    ("malformed", changed(udp(30), 14, 0x44)),
    ("malformed", changed(udp(30), 14, 0x40)),
    ("malformed", changed(udp(30), 24)),
    ("malformed", wire(udp(30, len=19))),
    ("malformed", wire(udp(30, len=59))),
    ("malformed", wire(udp(30, src="224.0.0.1"))),
    ("malformed", wire(udp(30, src=NODE))),
    ("checksum", changed(udp(30), 40)),
    ("checksum", changed(udp(30), 70)),
    ("checksum", wire(ip() / UDP(dport=7411, len=39) / Raw(payload(30)))),
    ("checksum", wire(ip() / UDP(dport=7411, len=37) / Raw(payload(30)))),
    ("checksum", changed(echo(30), 50)),
    ("port", wire(udp(30, port=7412))),
    # The network 0 is that of hosts without an address.
    ("malformed", wire(udp(30, src="0.1.2.3"))),
]


@pytest.mark.parametrize("memory_bytes", by_depth([0], [0, 4096]))
def test_bad_frames_leave_no_trace_but_a_count(memory_bytes):
    """After each of them comes a good one, as soon as Ethernet allows."""
    # Half of them are enough: `python -m lab.ethernet fuzz` tries hundreds of thousands.
    bad = by_depth(BAD[::2], BAD)
    steps, want = [], []
    for count, (_, frame) in enumerate(bad):
        steps += [frame, wire(udp(count + 1))]
        want += come(count + 1)
    seen = run(steps, settings(memory_bytes=memory_bytes), gap=12)
    assert seen.datagrams == want
    assert seen.frames == []
    for name in seen.drops:
        assert seen.drops[name] == sum(name == reason for reason, _ in bad), name
    assert sum(seen.drops.values()) == len(bad)


def test_good_frames_of_all_forms_pass_with_stalls_everywhere():
    no_checksum = udp(9)
    no_checksum[UDP].chksum = 0
    steps = [wire(arp(op=2, to=MAC)), PREAMBLE[-2:] + wire(udp(1))[8:]]
    steps += [wire(udp(20, options=options(count))) for count in (1, 10)]
    steps += [wire(no_checksum), wire(udp(120))]
    # Padding that is not 0, and a sum that is 0 only with its carry.
    steps += [PREAMBLE + checked(bytes(udp(3)) + b"\xff" * 40)]
    steps += [Datagram(payload(n)) for n in (1, 2, 3, 12, 40)]
    steps += [Datagram(b"\xff" * 20 + bytes([0x2D, 0x4F]))]
    unfit = [Datagram(b"short", length=6), Datagram(b"long", length=3)]
    unfit += by_depth([], [Datagram(bytes(1473))])
    steps += unfit
    steps += [Datagram(b"after")]
    seen = run(steps, holes=0.2, stalls=0.4, slow=0.2, after=900)
    assert seen.datagrams == come(1, 20, 20, 9, 120, 3)
    sent = [carried(packet) for packet in map(understood, seen.frames)]
    assert sent[:5] == [payload(n) for n in (1, 2, 3, 12, 40)] and sent[6:] == [b"after"]
    assert seen.drops == {"unfit": len(unfit)}


def test_a_frame_begins_before_its_datagram_has_ended():
    own = settings(memory_bytes=0, word_bytes=4, ahead_bytes=160)
    sizes = (5, 60, 290)
    steps = [wire(arp(op=2, to=MAC)), wire(udp(61))]
    for size in sizes:
        steps += [Datagram(payload(size)), Pause(400)]
    seen = run(steps, own)
    assert seen.datagrams == come(61) and not seen.drops
    assert [carried(packet) for packet in map(understood, seen.frames)] == [*map(payload, sizes)]
    ends = [cycle for what, cycle in seen.times if what == "datagram sent"]
    begins = [cycle for what, cycle in seen.times if what == "frame"]
    assert [b - e for b, e in zip(begins, ends, strict=True)] == [17, 15, -16]


def test_addresses_are_asked_for_and_forgotten():
    own = settings(tick_bits=15, gateway=number("192.168.1.1"))
    far = wire(arp(ip="192.168.1.1", mac=OTHER_MAC))
    steps = [
        # Nobody answers, so the first datagram is dropped after a while, and the next one at once.
        *(Datagram(payload(3), to="192.168.1.99"), Pause(700)),
        *(Datagram(payload(4), to="192.168.1.99"), Pause(100)),
        # A datagram waits for the answer. Beyond the network, the gateway is asked.
        *(Datagram(b"near"), Pause(100), wire(arp(op=2, to=MAC)), Pause(300)),
        *(Datagram(b"far", to="10.0.0.7"), Pause(100), far, Pause(300)),
        # A group needs no answer.
        *(Datagram(b"group", to=GROUP), Pause(200)),
    ]
    seen = run(steps, own, after=100)
    packets = list(map(understood, seen.frames))
    asked = [p[ARP].pdst for p in packets if ARP in p and p[ARP].op == 1]
    assert asked == ["192.168.1.99", HOST, "192.168.1.1"]
    assert all(p.dst == BROADCAST for p in packets if ARP in p and p[ARP].op == 1)
    sent = [
        (p.dst, p[IP].dst, bytes(p[UDP].payload)[: p[UDP].len - 8]) for p in packets if UDP in p
    ]
    assert sent == [
        (HOST_MAC, HOST, b"near"),
        (OTHER_MAC, "10.0.0.7", b"far"),
        (GROUP_MAC, GROUP, b"group"),
    ]
    assert seen.drops == {"unresolved": 2}


def fragments(size, ident, cut=24, src=HOST):
    """Return the frames of a datagram in fragments."""
    whole = ip(id=ident, src=src)[IP] / UDP(sport=5000, dport=7411) / Raw(payload(size))
    return [
        wire(Ether(dst=MAC, src=HOST_MAC) / part) for part in scapy.fragment(whole, fragsize=cut)
    ]


def test_fragments_in_order_become_datagrams_and_others_are_dropped():
    own = settings(memory_bytes=0, fragment_bytes=4096, tick_bits=8)
    a, b, c = fragments(60, 1), fragments(30, 1, src=OTHER), fragments(41, 2)
    wrong, lost, late = fragments(20, 3), fragments(60, 4), fragments(33, 5)
    damaged = fragments(90, 6)[0]
    damaged = damaged[:-1] + bytes([damaged[-1] ^ 1])
    # The checksum is that of all fragments.
    wrong[1] = changed(Ether(wrong[1][8:-4]), 35)
    steps = [
        *(a[0], damaged, b[0], wire(udp(5)), a[1], damaged, b[1], a[2], Pause(120)),
        # A new datagram takes the place of one that was not finished.
        *(*wrong, lost[0], lost[1], *c, lost[0], lost[2]),
        *(late[0], Pause(5 << 8), late[1]),
    ]
    seen = run(steps, own, after=150)
    assert sorted(seen.datagrams) == sorted(
        [*come(5, 60, 41), (payload(30), number(OTHER), 5000, 7411)]
    )
    # The end of the wrong one and of the lost one; the late one, and what came of it later.
    assert seen.drops == {"fragment": 4, "damaged": 2}
    assert seen.frames == []


def test_an_echo_in_fragments_is_answered_in_fragments():
    whole = (ip(id=9) / ICMP(id=7) / Raw(payload(50)))[IP]
    parts = scapy.fragment(IP(bytes(whole)), fragsize=24)
    steps = [wire(arp(op=2, to=MAC)), *(wire(Ether(dst=MAC, src=HOST_MAC) / p) for p in parts)]
    # What continues nothing is not answered, nor what another one sends in between.
    other = wire(ip(id=9, src=OTHER, frag=parts[1].frag, flags="MF") / Raw(payload(24)))
    steps = [*steps[:2], other, *steps[2:], steps[-1]]
    seen = run(steps, after=500)
    answers = [Ether(frame)[IP] for frame in seen.frames]
    assert [(p.frag, p.flags.MF) for p in answers] == [(p.frag, p.flags.MF) for p in parts]
    body = b"".join(bytes(p.payload)[: p.len - 20] for p in answers)
    assert body[:2] == b"\0\0" and body[4:] == bytes(whole.payload)[4:]
    assert scapy.checksum(body) == 0
    assert seen.drops == {"other": 2}


def test_what_is_shorter_than_its_header_leaves_no_trace_but_a_count():
    ports = (5000).to_bytes(2, "big") + (7411).to_bytes(2, "big")

    def cut(body, proto=17, **options):
        return wire(ip(proto=proto, id=3, **options) / Raw(body))

    steps = [
        wire(arp(op=2, to=MAC)),
        # It has no checksum, and names the length of the next one, which has none.
        *(cut(ports + b"\0\4\0\0"), cut(ports)),
        cut(ports + b"\0\6"),
        # Fragments of a datagram without a payload.
        *(cut(ports + b"\0\x08\0\0", flags="MF"), cut(b"", frag=1)),
        # An echo would have more bytes than came.
        cut(b"\x08\0", proto=1, flags="MF"),
        *(wire(udp(size)) for size in (1, 2, 3)),
        *fragments(60, 1),
    ]
    seen = run(steps, settings(fragment_bytes=4096))
    assert seen.datagrams == come(1, 2, 3, 60)
    assert seen.frames == []
    assert seen.drops == {"checksum": 3, "fragment": 1, "other": 1}


def test_groups_are_joined_and_queries_answered():
    igmp = pytest.importorskip("scapy.contrib.igmp").IGMP

    def query(group):
        whole = ip(dst="224.0.0.1", to="01:00:5e:00:00:01", ttl=1, options=[ALERT])
        return wire(whole / igmp(type=0x11, mrcode=1, gaddr=group))

    own = settings(groups=(number(GROUP),), tick_bits=8)
    group = wire(udp(3, dst=GROUP, to=GROUP_MAC))
    seen = run([Pause(380), query("0.0.0.0"), Pause(380), query("239.1.1.1"), group], own)
    for frame in seen.frames:
        packet = Ether(frame)
        assert (packet.dst, packet[IP].dst, packet[IP].src) == (GROUP_MAC, GROUP, NODE)
        assert (packet[IP].ttl, packet[IP].proto) == (1, 2)
        header, report = bytes(packet[IP])[:24], bytes(packet[IP])[24:32]
        assert header[20:] == bytes.fromhex("94040000") and scapy.checksum(header) == 0
        assert report[:1] + report[4:] == b"\x16" + bytes([239, 255, 0, 1])
        assert scapy.checksum(report) == 0
    assert len(seen.frames) == 2
    assert seen.datagrams == come(3)
    assert seen.drops == {"other": 1}


ALERT = scapy.IPOption_Router_Alert()


def test_fragments_may_come_slowly_one_after_the_other():
    own = settings(fragment_bytes=4096, tick_bits=8)
    steps = [part for each in fragments(80, 1) for part in (each, Pause(2 << 8))]
    seen = run(steps, own, after=150)
    assert seen.datagrams == come(80) and not +seen.drops
