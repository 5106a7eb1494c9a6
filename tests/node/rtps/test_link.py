"""The link among participants of the host: discovery, both ways, losses."""

from __future__ import annotations

import time
from firm_hdl.rtps import Qos
from firm_hdl.rtps.events import Arrived
from firm_hdl.rtps.ros import names
from tests.node.rtps.wires import Wires, core_of, description_of

STRING = names.type_name("std_msgs/msg/String")


def payloads(wires, core):
    return [each.sample.payload for each in wires.events[core] if isinstance(each, Arrived)]


def test_samples_go_both_ways():
    core = core_of(1)
    wires = Wires(description_of(), core)
    reader = core.add_reader("rt/said", STRING, Qos(), b"", 0.0)
    writer = core.add_writer("rt/heard", STRING, Qos(), b"", 0.0)
    messages = [b"\0\1\0\0" + bytes(range(n)) for n in range(1, 7)]

    def script():
        t=time.time()
        yield from wires.until(lambda: core.matched(writer.guid) and core.matched(reader.guid))
        print("matched", wires.now, time.time()-t)
        yield from wires.until(lambda: wires.counters["passed"] == 0 and False, 0.01) if False else iter(())
        for _ in range(100): yield
        for n, each in enumerate(messages):
            core.write(writer, each, wires.now, n)
        yield from wires.until(lambda: len(wires.received) == len(messages))
        print("in", wires.now, time.time()-t)
        wires.to_send.extend((2, 0, each) for each in messages)
        yield from wires.until(lambda: len(payloads(wires, core)) == len(messages))
        yield from wires.until(lambda: reader_done())
        print("out", wires.now, time.time()-t)

    def reader_done():
        return True

    wires.run(script())
    assert [each for *_, each in wires.received] == messages
    print(wires.counters, [len(b) for _,b in wires.sent])
