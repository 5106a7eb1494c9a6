"""Names, the graph and services of ROS 2."""

from __future__ import annotations

from concurrent.futures import Future
from types import SimpleNamespace

import numpy as np
import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from firm_hdl.rtps import Guid, Sample, SampleIdentity
from firm_hdl.rtps.ros import names, services
from firm_hdl.rtps.ros.graph import GraphInfo, NodeInfo
from firm_hdl.rtps.ros.services import Client, Service
from firm_hdl.rtps.wire.octets import MalformedError

GUIDS = [Guid(bytes(range(12)), entity) for entity in (0x1C1, 0x103, 0x204, 0x304)]
INFO = GraphInfo(
    participant=GUIDS[0],
    nodes=(
        NodeInfo(name="talker", namespace="/", writers=(GUIDS[1],)),
        NodeInfo(name="n", namespace="/robot/arm", readers=(GUIDS[2], GUIDS[3])),
    ),
)


@pytest.mark.parametrize(
    ("name", "full"),
    [
        ("chatter", "/ns/chatter"),
        ("/chatter", "/chatter"),
        ("~/chatter", "/ns/node/chatter"),
        ("~", "/ns/node"),
        ("a/b_1", "/ns/a/b_1"),
        ("_action/send_goal", "/ns/_action/send_goal"),
    ],
)
def test_names_are_expanded(name, full):
    assert names.expanded(name, "node", "/ns") == full
    # The namespace of most nodes is the root.
    assert names.expanded(name, "node", "/") == full.removeprefix("/ns")


@pytest.mark.parametrize("name", ["", "/", "a//b", "a/", "1a", "a b", "a__b", "a-b", "~a", "é"])
def test_names_that_are_none(name):
    with pytest.raises(ValueError, match=r"^'.*' is no name of a topic or service$"):
        names.expanded(name, "node", "/")


def test_names_on_the_wire():
    assert names.topic("/ns/chatter") == "rt/ns/chatter"
    assert names.request_topic("/ns/go") == "rq/ns/goRequest"
    assert names.reply_topic("/ns/go") == "rr/ns/goReply"
    assert names.type_name("std_msgs/msg/String") == "std_msgs::msg::dds_::String_"
    assert names.type_name("a_b/srv/Go", "_Request") == "a_b::srv::dds_::Go_Request_"
    assert names.demangled_type("std_msgs::msg::dds_::String_") == "std_msgs/msg/String"
    assert names.demangled_type("std_msgs::String") is None
    for kind in ("msg", "srv", "action"):
        assert names.demangled_type(names.type_name(f"a/{kind}/B")) == f"a/{kind}/B"
    assert names.demangled_topic("rt/ns/chatter") == "/ns/chatter"
    assert names.demangled_topic("rq/goRequest") is None
    for bad in ("String", "std_msgs/String", "Std/msg/String", "std_msgs/msg/1s"):
        with pytest.raises(ValueError, match="is no type of ROS 2"):
            names.type_name(bad)


def test_type_hashes():
    data = names.user_data("RIHS01_00ff")
    assert data == b"typehash=RIHS01_00ff;"
    assert names.type_hash_of(b"a=b;" + data) == "RIHS01_00ff"
    assert names.type_hash_of(b"nottypehash=1;") is None
    assert names.user_data(None) == b""


@pytest.mark.parametrize(
    "text",
    ["", "0f", "RIHS01_", "RIHS01_00ff;a=b", "RIHS01_00FF", "RIHS_0f", "RIHS\u0660\u0661_00"],
)
def test_what_is_no_type_hash_is_announced_nowhere(text):
    with pytest.raises(ValueError, match=rf"^'{text}' is no type hash of ROS 2$"):
        names.user_data(text)


@pytest.mark.parametrize("gid_bytes", [16, 24])
def test_the_graph_is_what_rosbags_writes(gid_bytes):
    store = get_typestore(Stores.EMPTY)
    package = "rmw_dds_common/msg"
    store.register(get_types_from_msg(f"uint8[{gid_bytes}] data", f"{package}/Gid"))
    node = "string node_namespace\nstring node_name\nGid[] readers\nGid[] writers"
    store.register(get_types_from_msg(node, f"{package}/NodeEntitiesInfo"))
    whole = "Gid gid\nNodeEntitiesInfo[] nodes"
    store.register(get_types_from_msg(whole, f"{package}/ParticipantEntitiesInfo"))
    types = store.types

    def gids(guids):
        made = types[f"{package}/Gid"]
        padded = (bytes(each).ljust(gid_bytes, b"\0") for each in guids)
        return [made(data=np.frombuffer(each, np.uint8)) for each in padded]

    message = types[f"{package}/ParticipantEntitiesInfo"](
        gid=gids([INFO.participant])[0],
        nodes=[
            types[f"{package}/NodeEntitiesInfo"](
                node_namespace=each.namespace,
                node_name=each.name,
                readers=gids(each.readers),
                writers=gids(each.writers),
            )
            for each in INFO.nodes
        ],
    )
    for little in (True, False):
        name = f"{package}/ParticipantEntitiesInfo"
        theirs = bytes(store.serialize_cdr(message, name, little_endian=little))
        assert GraphInfo.decode(theirs) == INFO
        if little:
            assert INFO.encode(gid_bytes).rstrip(b"\0") == theirs.rstrip(b"\0")
    for size in range(len(theirs)):
        try:
            part = GraphInfo.decode(theirs[:size])
        except MalformedError:
            continue
        # Cut within the zeros of its first GID, a sample is one without nodes.
        assert gid_bytes == 24 and size in range(24, 28) and part.nodes == ()


def test_graphs_are_limited():
    """4,096 nodes, and no more behind them than padding."""
    head = b"\0\1\0\0" + bytes(GUIDS[0])
    node = bytes.fromhex("02000000 2f000000 02000000 6e000000 00000000 00000000")
    for count, known in ((1, True), (4096, True), (4097, False)):
        payload = head + count.to_bytes(4, "little") + node * count
        for rest, good in ((b"", True), (bytes(3), True), (bytes(4), False)):
            if known and good:
                assert len(GraphInfo.decode(payload + rest).nodes) == count
                continue
            with pytest.raises(MalformedError, match=r"^no graph in \d+ bytes$"):
                GraphInfo.decode(payload + rest)


def endpoint_of(prefix, entity=0x103):
    """An endpoint with the name that others know, matched with nobody."""
    return SimpleNamespace(guid=Guid(bytes([prefix]) * 12, entity), matched=(), write=lambda *_: 7)


def test_a_server_has_both_topics_in_one_participant():
    client = Client(None)
    requests, replies = endpoint_of(1), endpoint_of(1, 0x104)
    client.open(requests, replies)
    for of_requests, of_replies, ready in (
        ((), (), False),
        ((2,), (), False),
        ((), (2,), False),
        # Half a server each.
        ((2,), (3,), False),
        ((2, 3), (4, 3), True),
    ):
        requests.matched = tuple(map(endpoint_of, of_requests))
        replies.matched = tuple(map(endpoint_of, of_replies))
        assert client._ready() is ready


@pytest.mark.parametrize("names_reader", [False, True])
def test_a_reply_names_the_writer_of_its_request_or_the_reader_of_replies(names_reader):
    client = Client(None)
    requests, replies = endpoint_of(1), endpoint_of(1, 0x104)
    client.open(requests, replies)
    future = client.call_async(b"?")

    def reply(writer, number):
        related = SampleIdentity(writer, number)
        sample = Sample(payload=b"!", writer=GUIDS[0], sequence_number=1, related=related)
        client.on_reply(sample)

    own = (replies if names_reader else requests).guid
    reply(own, 6)
    reply(endpoint_of(2).guid, 7)
    assert not future.done()
    reply(own, 7)
    assert future.result(0) == b"!"


class Replies:
    """A writer of replies, which writes down what it sends, and to whom."""

    def __init__(self):
        self.matched, self.sent = (), []

    def write(self, reply, identity, to):
        self.sent.append((reply, identity, tuple(to)))


def reader(guid):
    return SimpleNamespace(guid=guid)


def request(number, related=None, writer=GUIDS[1]):
    payload = b"%d" % number
    return Sample(payload=payload, writer=writer, sequence_number=number, related=related)


def serving(handler=lambda payload: payload):
    service, replies = Service(handler), Replies()
    service.replies = replies
    return service, replies


# A reader of replies, as a request names it: of its number, only the writer knows.
READER = SampleIdentity(GUIDS[3], -1 << 32)


def test_a_reply_has_the_name_of_its_request_and_goes_to_the_reader_that_asked():
    service, replies = serving()
    beside, elsewhere = GUIDS[2], Guid(bytes(12), 0x204)
    replies.matched = tuple(map(reader, (elsewhere, beside, READER.writer)))
    service.on_request(request(5, READER))
    assert replies.sent == [(b"5", SampleIdentity(READER.writer, 5), (READER.writer,))]
    # A client that names no reader has one in its own participant.
    replies.sent.clear()
    nobody = SampleIdentity(Guid(bytes(12), 0), 9)
    for number, related in ((3, None), (4, nobody)):
        service.on_request(request(number, related))
    assert replies.sent == [
        (b"%d" % number, SampleIdentity(GUIDS[1], number), (beside, READER.writer))
        for number in (3, 4)
    ]


def test_a_reply_waits_for_its_reader():
    service, replies = serving()
    service.on_request(request(1, READER))
    service.on_match(reader(GUIDS[2]), True)
    assert replies.sent == []
    replies.matched = (reader(READER.writer),)
    for _ in range(2):
        service.on_match(reader(READER.writer), True)
        assert replies.sent == [(b"1", SampleIdentity(READER.writer, 1), (READER.writer,))]


def test_a_reply_does_not_wait_for_ever(monkeypatch):
    monkeypatch.setattr(services, "_PATIENCE", -1.0)
    service, replies = serving()
    service.on_request(request(1, READER))
    replies.matched = (reader(READER.writer),)
    service.on_match(reader(READER.writer), True)
    assert replies.sent == [] and service.dropped == 1


@pytest.mark.parametrize(("size", "count"), [(4, 5000), (1 << 18, 500)])
def test_a_flood_of_requests_leaves_the_replies_of_others_alone(size, count):
    """Whose readers nobody knows; 64 MiB of their replies may wait at most."""
    service, replies = serving(lambda payload: payload.ljust(size))
    service.on_request(request(1, READER))
    for number in range(count):
        guid = Guid(bytes(11) + bytes([number % 20]), number << 8 | 0x04)
        service.on_request(request(2, SampleIdentity(guid, number), Guid(guid.prefix, 0x103)))
    prefixes = {READER.writer.prefix, *(bytes(11) + bytes([number]) for number in range(20))}
    waiting = [r.payload for prefix in prefixes for r in service._waiting.of(prefix)]
    assert len(waiting) <= 1024 and sum(map(len, waiting)) <= 64 << 20
    assert service.dropped == count + 1 - len(waiting)
    replies.matched = (reader(READER.writer),)
    service.on_match(reader(READER.writer), True)
    assert [identity.sequence_number for _, identity, _ in replies.sent] == [1]


def test_a_flood_of_requests_leaves_open_requests_of_others_alone():
    """The oldest of those who ask most are given up."""
    futures = []

    def handle(payload):
        futures.append(Future())
        return futures[-1]

    service, replies = serving(handle)
    replies.matched = (reader(READER.writer),)
    service.on_request(request(1, READER))
    for number in range(3000):
        service.on_request(request(number, writer=Guid(bytes([number % 7]) * 12, 0x103)))
    assert sum(not each.done() for each in futures) <= 1024
    assert service.dropped == sum(each.cancelled() for each in futures)
    assert futures[-1].cancel() and not futures[0].done()
    futures[0].set_result(b"good")
    assert [reply for reply, _, _ in replies.sent] == [b"good"]


def test_a_reply_is_sent_if_its_reader_comes_while_it_is_put_aside():
    class Late(Replies):
        """Replies whose reader comes between the first look at the readers and the next one."""

        def __getattribute__(self, name):
            if name == "matched":
                found, self.readers = self.readers, (reader(READER.writer),)
                return found
            return super().__getattribute__(name)

    service = Service(lambda payload: payload)
    replies = Late()
    replies.readers = ()
    service.replies = replies
    service.on_request(request(1, READER))
    assert [reply for reply, _, _ in replies.sent] == [b"1"]


def test_calls_that_are_given_up_are_forgotten():
    client = Client(SimpleNamespace(wait_until=lambda condition, timeout: True))
    client.open(endpoint_of(1), endpoint_of(1, 0x104))
    client.call_async(b"?").cancel()
    assert not client._pending
    with pytest.raises(TimeoutError, match=r"^no reply in 0\.001 s$"):
        client.call(b"?", timeout=0.001)
    assert not client._pending


def test_replies_of_futures(caplog):
    futures = [Future() for _ in range(3)]
    service, replies = serving(lambda payload: futures[int(payload)])
    replies.matched = (reader(GUIDS[2]),)
    for number in range(3):
        service.on_request(request(number))
    futures[0].cancel()
    assert replies.sent == [] and not caplog.records
    futures[1].set_exception(ValueError("no"))
    assert replies.sent == [] and [each.message for each in caplog.records] == ["a service failed"]
    futures[2].set_result(b"!")
    assert replies.sent == [(b"!", SampleIdentity(GUIDS[1], 2), (GUIDS[2],))]
