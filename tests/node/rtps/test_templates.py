"""Templates, played by the circuit, against what the host's participant writes."""

from __future__ import annotations

from dataclasses import replace

from amaranth.sim import Simulator

from firm_hdl.node.rtps.endpoints import own_of
from firm_hdl.node.rtps.templates import HEAD_BYTES, Job, templates_of
from firm_hdl.node.rtps.transmitter import Transmitter
from firm_hdl.rtps.wire import message
from firm_hdl.rtps.wire.guid import SPDP_READER, SPDP_WRITER, Guid, SampleIdentity
from firm_hdl.rtps.wire.parameters import ParameterList, identity
from firm_hdl.rtps.wire.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    InfoDestination,
    NackFrag,
    NumberSet,
)
from tests.node.rtps.wires import description_of

OWN, PEER = bytes(range(0x10, 0x1C)), bytes(range(0x20, 0x2C))
RELATED = Guid(PEER, 0x1404)
PAYLOAD = b"\0\1\0\0five!"
READER, WRITER = 0x0000_1404, 0x0000_0203
FIELD_VALUES = {
    "own": OWN,
    "peer": PEER,
    "reader": READER.to_bytes(4, "big"),
    "writer": WRITER.to_bytes(4, "big"),
    "number": (9).to_bytes(4, "little"),
    "first": (2).to_bytes(4, "little"),
    "last": (9).to_bytes(4, "little"),
    "count": (0x01020304).to_bytes(4, "little"),
    "bits": (2).to_bytes(4, "little"),
    "bitmap": (3 << 30).to_bytes(4, "little"),
    "flags": b"\0\1\0\0",
    "related": bytes(RELATED),
    "related_number": (7).to_bytes(4, "little"),
}


def played(templates, job):
    """Return a datagram of the circuit."""
    transmitter = Transmitter(templates, 16, 7410)
    order, out = transmitter.order, transmitter.datagrams
    got = bytearray()

    async def bench(ctx):
        for name in FIELD_VALUES:
            ctx.set(order.fields[name], int.from_bytes(FIELD_VALUES[name], "little"))
        ctx.set(order.fields.size, (HEAD_BYTES.get(job, 0) + 12) << 16)
        ctx.set(order.start, templates.starts[job])
        # The payload lies across the end of the memory.
        ctx.set(order.mask, 15)
        ctx.set(order.at, 12)
        ctx.set(order.payload_bytes, len(PAYLOAD))
        ctx.set(transmitter.starts, 1)
        await ctx.tick()
        ctx.set(transmitter.starts, 0)
        cycles = 0
        while True:
            cycles += 1
            ctx.set(out.ready, cycles % 3 != 0)
            if ctx.get(transmitter.reads):
                place = (ctx.get(transmitter.read_at) - 12) % 16
                word = (PAYLOAD + bytes(8))[place : place + 4]
            if ctx.get(out.valid) and cycles % 3 != 0:
                got.extend(ctx.get(out.payload.data).to_bytes(4, "little"))
                if ctx.get(out.payload.last):
                    return
            was_read = ctx.get(transmitter.reads)
            await ctx.tick()
            if was_read:
                ctx.set(transmitter.word, int.from_bytes(word, "little"))

    simulator = Simulator(transmitter)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    return bytes(got)


def test_the_circuit_writes_what_the_host_does():
    description = description_of()
    templates, own = templates_of(description), own_of(description, OWN)
    ends = {"reader": READER, "writer": WRITER}
    heartbeat = Heartbeat(**ends, first=2, last=9, count=0x01020304)
    inline = ParameterList(tuple(identity(SampleIdentity(RELATED, 7))))
    padded = PAYLOAD + bytes(-len(PAYLOAD) % 4)
    reply = Data(**ends, sequence_number=9, payload=padded, inline=inline)
    announcement = Data(
        reader=SPDP_READER,
        writer=SPDP_WRITER,
        sequence_number=1,
        payload=own.participant.encode(),
    )
    gap = Gap(**ends, start=2, numbers=NumberSet(9))
    # A DATA_FRAG has its number in `first`, and the size of the sample in `last`.
    part = DataFrag(
        **ends,
        sequence_number=9,
        first=2,
        count=1,
        fragment_bytes=1024,
        sample_bytes=9,
        payload=padded,
        inline=inline,
    )
    has = AckNack(**ends, missing=NumberSet(9), count=0x01020304, final=True)
    lacks = NackFrag(**ends, sequence_number=9, missing=NumberSet(2, (2, 3)), count=0x01020304)
    asks = replace(has, missing=NumberSet(9, (9, 10)), final=False)
    to = InfoDestination(PEER)
    for job, wanted in (
        (Job.ACKNACK, (to, replace(has, final=False))),
        (Job.ACKNACK_MISSING, (to, asks)),
        (Job.ANNOUNCE, (announcement,)),
        (Job.HEARTBEAT, (to, heartbeat)),
        (Job.GAP, (to, gap)),
        (Job.REPLY, (to, reply, heartbeat)),
        (Job.REPLY_FRAGMENT, (to, part)),
        (Job.NACK_FRAG, (to, has, lacks)),
    ):
        assert played(templates, job) == message.write(OWN, wanted), job


def test_endpoints_and_the_graph_are_announced_in_the_order_of_topics():
    description = description_of()
    templates, own = templates_of(description), own_of(description, OWN)
    topics = [each.data.topic for each in (*own.writers, *own.readers)]
    assert topics == ["ros_discovery_info", "rt/said", "rt/heard"]
    for number, each in enumerate((*own.writers, *own.readers)):
        assert each.data.encode() in played(templates, templates.writers + number)
    assert own.graph in played(templates, templates.graph)
