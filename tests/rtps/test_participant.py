"""Participants and nodes with sockets, on the loopback interface and without multicast."""

from __future__ import annotations

import logging
import os
import socket
import threading
import time
from concurrent.futures import Future
from contextlib import ExitStack

import pytest

from firm_hdl.rtps import (
    ClosedError,
    Durability,
    HistoryFullError,
    Participant,
    Qos,
    SampleIdentity,
    TransportError,
)
from firm_hdl.rtps.ros import Context, Node, graph
from firm_hdl.rtps.ros.graph import GraphInfo, NodeInfo

# A domain that no other test has, nor one that runs at the same time, so that nobody else comes in.
DOMAIN = 160 + os.getpid() % 60
OPTIONS = {"domain": DOMAIN, "interface": "127.0.0.1", "peers": ("127.0.0.1",), "multicast": False}
TOPIC, TYPE = "rt/t", "p::msg::dds_::T_"
STRING = "std_msgs/msg/String"


@pytest.fixture
def pair():
    with Participant(**OPTIONS) as one, Participant(**OPTIONS) as two:
        yield one, two


def wait(condition):
    end = time.monotonic() + 20
    while not condition() and time.monotonic() < end:
        time.sleep(0.002)
    return condition()


def test_samples_between_two_participants(pair):
    one, two = pair
    got, matches = [], []
    writer = one.writer(TOPIC, TYPE, Qos(depth=0), on_match=lambda *args: matches.append(args))
    reader = two.reader(TOPIC, TYPE, got.append, Qos(depth=0))
    assert writer.wait_for_match() and reader.wait_for_match()
    sent = [number.to_bytes(4, "big") * size for number, size in enumerate((1, 400, 250_000, 2))]
    before = time.time_ns()
    assert [writer.write(each) for each in sent] == [1, 2, 3, 4]
    assert writer.wait_for_acknowledgments()
    assert wait(lambda: len(got) == 4)
    assert [each.payload for each in got] == sent
    assert {each.writer for each in got} == {writer.guid}
    assert before <= got[0].source_timestamp <= time.time_ns()
    assert reader.lost == 0
    reader.close()
    assert wait(lambda: len(matches) == 2)
    assert [(remote.guid, came) for remote, came in matches] == [
        (reader.guid, True),
        (reader.guid, False),
    ]
    assert one.counters["malformed"] == two.counters["malformed"] == 0


def test_a_callback_may_write_and_may_fail(pair, caplog):
    one, two = pair
    back = []

    def answer(sample):
        answers.write(sample.payload + b"!")
        raise RuntimeError("an error of the user")

    answers = two.writer("rt/back", TYPE)
    two.reader(TOPIC, TYPE, answer)
    writer = one.writer(TOPIC, TYPE)
    one.reader("rt/back", TYPE, back.append)
    assert writer.wait_for_match() and answers.wait_for_match()
    with caplog.at_level(logging.ERROR, "firm_hdl.rtps"):
        writer.write(b"...one")
        writer.write(b"...two")
        assert wait(lambda: len(back) == 2)
        assert wait(lambda: len(caplog.records) == 2)
    assert [each.payload for each in back] == [b"...one!", b"...two!"]
    assert "an error of the user" in caplog.text


def test_a_callback_waits_for_room(pair):
    one, two = pair
    back = []
    keep = Qos(depth=0, max_samples=20)
    answers = two.writer("rt/back", TYPE, keep)
    two.reader(TOPIC, TYPE, lambda sample: answers.write(sample.payload, timeout=10), keep)
    writer = one.writer(TOPIC, TYPE, keep)
    one.reader("rt/back", TYPE, back.append, keep)
    assert writer.wait_for_match() and answers.wait_for_match()
    sent = [number.to_bytes(4, "big") for number in range(300)]
    for each in sent:
        writer.write(each, timeout=10)
    assert wait(lambda: len(back) == 300)
    assert [each.payload for each in back] == sent


def test_a_callback_cannot_wait_for_what_comes_after_it(pair, caplog):
    one, two = pair
    writer = one.writer(TOPIC, TYPE)
    reader = two.reader(TOPIC, TYPE, lambda sample: reader.wait_for_match(2))
    assert writer.wait_for_match()
    with caplog.at_level(logging.ERROR, "firm_hdl.rtps"):
        writer.write(b"1234")
        assert wait(lambda: caplog.records)
    assert "a callback cannot wait for what comes after it" in caplog.text


def test_waiting_ends_when_all_is_there_and_not_before(pair, monkeypatch):
    one, two = pair
    writer, got = one.writer(TOPIC, TYPE), []
    two.reader(TOPIC, TYPE, got.append)
    assert writer.wait_for_match() and not writer.wait_for_match(2, timeout=0.01)
    second = two.reader(TOPIC, TYPE, got.append)
    assert writer.wait_for_match(2) and len(writer.matched) == 2
    monkeypatch.setattr(two._core, "receive", lambda *_: None)
    writer.write(b"1234")
    assert not writer.wait_for_acknowledgments(timeout=0.01)
    monkeypatch.undo()
    assert writer.wait_for_acknowledgments() and wait(lambda: len(got) == 2)
    second.close()
    assert wait(lambda: len(writer.matched) == 1)


def test_all_participants_of_a_host_find_each_other_without_multicast():
    """Of which there may be 120; most peers try the first five alone."""
    with ExitStack() as stack:
        options = {"domain": DOMAIN, "interface": "127.0.0.1", "multicast": False}
        made = [stack.enter_context(Participant(**options)) for _ in range(9)]
        assert wait(lambda: all(len(each.peers) == 8 for each in made))


def test_writes_of_several_threads(pair):
    one, two = pair
    got = []
    writer = one.writer(TOPIC, TYPE, Qos(depth=0))
    two.reader(TOPIC, TYPE, got.append, Qos(depth=0))
    assert writer.wait_for_match()

    def write(thread):
        for number in range(100):
            writer.write(bytes([thread, number, 0, 0]), timeout=10)

    threads = [threading.Thread(target=write, args=(each,)) for each in range(4)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert wait(lambda: len(got) == 400)
    for thread in range(4):
        numbers = [each.payload[1] for each in got if each.payload[0] == thread]
        assert numbers == list(range(100))


def test_a_full_history_is_reported_after_a_wait(pair):
    one, two = pair
    writer = one.writer(TOPIC, TYPE, Qos(depth=0, max_samples=100))
    stuck = threading.Event()
    two.reader(TOPIC, TYPE, lambda sample: stuck.wait(20), Qos(depth=0))
    assert writer.wait_for_match()
    try:
        with pytest.raises(HistoryFullError):
            for _ in range(2000):
                writer.write(bytes(8), timeout=0.01)
    finally:
        stuck.set()
    assert writer.wait_for_acknowledgments(20)


def test_nothing_is_written_by_what_is_closed(pair):
    one, two = pair
    got = []
    first, second = one.writer(TOPIC, TYPE), one.writer(TOPIC, TYPE)
    two.reader(TOPIC, TYPE, got.append)
    assert first.wait_for_match() and second.wait_for_match()
    first.close()
    with pytest.raises(ClosedError, match=r"^the writer is closed$"):
        first.write(b"abcd")
    one.close()
    for use in (
        lambda: second.write(b"abcd"),
        lambda: one.writer(TOPIC, TYPE),
        lambda: one.reader(TOPIC, TYPE, print),
    ):
        with pytest.raises(ClosedError, match=r"^the participant is closed$"):
            use()
    node = Node("one", **OPTIONS)
    node.close()
    with pytest.raises(ClosedError, match=r"^the node 'one' is closed$"):
        node.publisher("chatter", STRING)
    assert got == []


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ((TOPIC, TYPE, 10), TypeError, r"^qos is a Qos, not 10: Qos\(depth=10\) is one with"),
        ((TOPIC, TYPE, "reliable"), TypeError, r"^qos is a Qos, not 'reliable'$"),
        ((TOPIC, TYPE, Qos(durability=Durability.TRANSIENT)), ValueError, " is TRANSIENT$"),
        ((5, TYPE), TypeError, r"^the name of a topic is a str, not 5$"),
        (("", TYPE), ValueError, r"^the name of a topic has from 1 to 256 bytes, not 0$"),
        ((TOPIC, "\N{EURO SIGN}" * 86), ValueError, r"^the name of a type .*, not 258$"),
    ],
)
def test_what_no_endpoint_can_be_made_of(pair, arguments, error, message):
    one, _ = pair
    with pytest.raises(error, match=message):
        one.writer(*arguments)
    topic, type_name, *qos = arguments
    with pytest.raises(error, match=message):
        one.reader(topic, type_name, print, *qos)
    with pytest.raises(TypeError, match=r"^on_sample is called with each sample, so it cannot be"):
        one.reader(TOPIC, TYPE, Qos())
    assert one._core._sedp.locals == {}


NO_SAMPLES = [
    (("text",), TypeError, "^a sample is bytes, not str$"),
    ((None,), TypeError, "^a sample is bytes, not NoneType$"),
    ((5,), TypeError, "^a sample is bytes, not int$"),
    (
        (b"",),
        ValueError,
        "^a sample has at least the 4 bytes of .* 67108864 bytes; this one has 0$",
    ),
    ((b"\0\1\0",), ValueError, "; this one has 3$"),
    ((bytes((64 << 20) + 1),), ValueError, "; this one has 67108865$"),
    ((b"abcd", 5), TypeError, "^a sample is related to a SampleIdentity, not to 5$"),
    ((b"abcd", None, "soon"), ValueError, "soon"),
]


def test_what_is_no_sample_is_not_written(pair):
    writer = pair[0].writer(TOPIC, TYPE)
    for arguments, error, message in NO_SAMPLES:
        with pytest.raises(error, match=message):
            writer.write(*arguments)
    assert writer.write(bytearray(b"abcd")) == 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"depth": "10"}, "^depth is of type int, and is '10'$"),
        ({"depth": True}, "^depth is of type int, and is True$"),
        ({"reliability": 1}, "^reliability is of type Reliability, and is 1$"),
        ({"durability": "volatile"}, "^durability is of type Durability, and is 'volatile'$"),
    ],
)
def test_policies_that_are_none(options, message):
    with pytest.raises(TypeError, match=message):
        Qos(**options)


def test_a_fault_of_ours_does_not_end_the_participant(pair, caplog, monkeypatch):
    one, two = pair
    writer = one.writer(TOPIC, TYPE)
    got = []
    two.reader(TOPIC, TYPE, got.append)
    assert writer.wait_for_match()
    receive = two._core.receive

    def fail_once(*_):
        monkeypatch.undo()
        raise KeyError("a fault")

    monkeypatch.setattr(two._core, "receive", fail_once)
    with caplog.at_level(logging.ERROR, "firm_hdl.rtps"):
        writer.write(b"1234")
        assert wait(lambda: got)
    assert two._core.receive == receive
    assert two.counters["failed"] == 1
    assert "a fault of firm-hdl, with the datagram 52545053" in caplog.text


def test_all_datagrams_that_wait_are_received(pair):
    _, two = pair
    before = two.counters["malformed"]
    with two._lock, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
        for _ in range(8):
            peer.sendto(b"RTPS", two._transport.user)
    assert wait(lambda: two.counters["malformed"] == before + 8)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        (
            {"name": "\N{EURO SIGN}" * 86},
            ValueError,
            "participant has from 0 to 256 bytes, not 258$",
        ),
        ({"name": None}, TypeError, "^the name of a participant is a str, not None$"),
        ({"user_data": bytes(4097)}, ValueError, "^user data has at most 4096 bytes, not 4097$"),
        ({"user_data": "text"}, TypeError, "^user data is bytes, not 'text'$"),
    ],
)
def test_what_peers_would_refuse_is_not_announced(options, error, message):
    """Limits are those of bytes: a peer refuses all that is announced beside what is too long."""
    with pytest.raises(error, match=message):
        Participant(**OPTIONS, **options)
    with Participant(**OPTIONS, name="\u0101" * 128, user_data=bytes(4096)) as made:
        assert len(made._core.settings.own.name.encode()) == 256


def test_an_address_of_another_host():
    with pytest.raises(TransportError, match=r"^no sockets on 203\.0\.113\.7: "):
        Participant(DOMAIN, interface="203.0.113.7")
    with pytest.raises(ValueError, match=r"^Domain must be from 0 to 232, not 233$"):
        Participant(233, interface="127.0.0.1")


def test_nodes_topics_and_services():
    got = []
    with Node("one", "/ns", **OPTIONS) as one, Node("two", **OPTIONS) as two:
        one.publisher("chatter", STRING, type_hash="RIHS01_12")
        two.subscription("/ns/chatter", STRING, got.append)
        two.service("/go", "std_srvs/srv/SetBool", lambda request: request + b"!")
        client = one.client("/go", "std_srvs/srv/SetBool")
        assert [client.call(bytes([n] * 4)) for n in range(20)] == [
            bytes([n] * 4) + b"!" for n in range(20)
        ]
        assert two.context.wait_for_node("one")
        nodes = {(each.namespace, each.name): each for each in two.context.nodes()}
        assert set(nodes) == {("/", "two"), ("/ns", "one")}
        assert wait(lambda: two.context.topics() == {"/ns/chatter": {STRING}})
        assert two.context.type_hashes("/ns/chatter") == {"RIHS01_12"}
        assert two.context.type_hashes("/chatter") == set()
        assert len(nodes["/ns", "one"].writers) == 2


def test_what_a_node_announces():
    with Node("one", **OPTIONS) as node, Participant(**OPTIONS) as other:
        node.publisher("chatter", STRING)
        assert wait(lambda: other.peers)
        (peer,) = other.peers
        assert (peer.user_data, peer.name) == (b"enclave=/;", "/")
        # Announcements to a host go to the first five participants there.
        ports = [address.port for address in other._core.settings.targets]
        assert ports == [7410 + 250 * DOMAIN + 2 * number for number in range(5)]
        # A late reader gets the newest description of the nodes alone.
        got = []
        reader = other.reader(graph.TOPIC, graph.TYPE, got.append, graph.QOS)
        assert reader.wait_for_match()
        assert wait(lambda: got)
        time.sleep(0.2)
        assert [len(GraphInfo.decode(each.payload).nodes[0].writers) for each in got] == [1]


def test_a_client_that_names_no_reader_of_replies():
    with Node("one", **OPTIONS) as node, Participant(**OPTIONS) as board:
        node.service("/go", "std_srvs/srv/SetBool", lambda request: request + b"!")
        got = []
        kind = "std_srvs::srv::dds_::SetBool"
        requests = board.writer("rq/goRequest", f"{kind}_Request_")
        replies = board.reader("rr/goReply", f"{kind}_Response_", got.append)
        assert requests.wait_for_match() and replies.wait_for_match()
        assert wait(lambda: node._writers[0].matched)
        number = requests.write(b"go...")
        assert wait(lambda: got)
        assert got[0].payload == b"go...!"
        assert got[0].related == SampleIdentity(requests.guid, number)


def test_calls_without_a_server():
    with Node("one", **OPTIONS) as node:
        client = node.client("/nobody", "std_srvs/srv/SetBool")
        with pytest.raises(TimeoutError, match=r"^no server in 0\.05 s$"):
            client.call(b"", timeout=0.05)


def test_a_server_that_does_not_answer_in_time():
    late = threading.Event()

    def handle(request):
        late.wait(20)
        return request

    with Node("one", **OPTIONS) as one, Node("two", **OPTIONS) as two:
        two.service("/go", "std_srvs/srv/SetBool", handle)
        client = one.client("/go", "std_srvs/srv/SetBool")
        assert client.wait_for_service()
        with pytest.raises(TimeoutError, match=r"^no reply in 0\.2 s$"):
            client.call(b"late", timeout=0.2)
        late.set()
        # The late reply is for nobody.
        assert client.call(b"next") == b"next"


def test_replies_that_come_later_from_another_thread():
    waiting = []

    def handle(request):
        waiting.append((request, Future()))
        return waiting[-1][1]

    with Node("one", **OPTIONS) as one, Node("two", **OPTIONS) as two:
        two.service("/go", "std_srvs/srv/SetBool", handle)
        client = one.client("/go", "std_srvs/srv/SetBool")
        assert client.wait_for_service()
        calls = [client.call_async(bytes([n] * 4)) for n in range(4)]
        assert wait(lambda: len(waiting) == 4)
        # In any order; a request that is given up, or fails, gets none.
        waiting[3][1].cancel()
        waiting[2][1].set_exception(ValueError("broken"))
        for request, future in reversed(waiting[:2]):
            future.set_result(request + b"!")
        assert [call.result(20) for call in calls[:2]] == [b"\0\0\0\0!", b"\1\1\1\1!"]
        assert not calls[2].done() and not calls[3].done()


def test_nodes_of_one_participant_hear_each_other():
    got, matches = [], []
    with Context(**OPTIONS) as context:
        first, second = Node("first", context=context), Node("second", context=context)
        durable = Qos(durability=Durability.TRANSIENT_LOCAL, depth=2)
        chatter = first.publisher(
            "chatter", STRING, durable, on_match=lambda remote, came: matches.append(came)
        )
        for number in range(3):
            chatter.write(b"%04d" % number)
        late = second.subscription("chatter", STRING, got.append, durable)
        # A late reader gets the history; one whose policies do not fit gets nothing.
        second.subscription("/chatter", STRING, got.append, Qos(depth=1))
        assert wait(lambda: len(got) == 2)
        chatter.write(b"last")
        assert wait(lambda: len(got) == 4)
        assert [each.payload for each in got] == [b"0001", b"0002", b"last", b"last"]
        assert [each.sequence_number for each in got] == [2, 3, 4, 4]
        assert {each.guid.prefix for each in chatter.matched} == {context.participant.prefix}
        second.service("go", "std_srvs/srv/SetBool", lambda request: request + b"!")
        assert first.client("/go", "std_srvs/srv/SetBool").call(b"abcd") == b"abcd!"
        assert {each.name for each in context.nodes()} == {"first", "second"}
        assert len(context.nodes()) == 2
        late.close()
        assert wait(lambda: matches == [True, True, False])
        second.close()
        assert wait(lambda: not chatter.matched)


def test_a_reply_goes_only_to_the_reader_that_asked():
    """Whose history of ten replies is not filled by those that are for others."""
    with Node("board", **OPTIONS) as board, Node("one", **OPTIONS) as one:
        board.service("go", "std_srvs/srv/SetBool", lambda request: request)
        with Participant(**OPTIONS) as other:
            overheard = []
            replies = other.reader(
                "rr/goReply", "std_srvs::srv::dds_::SetBool_Response_", overheard.append
            )
            assert replies.wait_for_match()
            client = one.client("go", "std_srvs/srv/SetBool")
            for number in range(50):
                assert client.call(b"%04d" % number) == b"%04d" % number
            # What is not for it is no loss.
            assert overheard == [] and replies.lost == 0


def test_nodes_that_share_a_participant():
    with Context(**OPTIONS) as context, Node("watcher", **OPTIONS) as watcher:
        first, second = Node("first", context=context), Node("second", context=context)
        with pytest.raises(ValueError, match=r"^there is a node 'first' in '/' already$"):
            Node("first", context=context)
        assert watcher.context.wait_for_node("first") and watcher.context.wait_for_node("second")
        first.close()
        assert wait(
            lambda: {each.name for each in watcher.context.nodes()} == {"second", "watcher"}
        )
        second.close()
        Node("first", context=context)


@pytest.mark.parametrize(
    ("name", "namespace"), [("a b", "/"), ("", "/"), ("a" * 256, "/"), ("a", "/b__c"), ("a", "1")]
)
def test_names_of_nodes_that_are_none(name, namespace):
    with pytest.raises(ValueError, match="is no name of a"):
        Node(name, namespace, **OPTIONS)


def test_nodes_of_a_participant_that_leaves_are_gone():
    with Node("stays", **OPTIONS) as stays:
        with Context(**OPTIONS) as context:
            context.update(NodeInfo(name="goes", namespace="/"))
            assert stays.context.wait_for_node("goes")
            # It does not say that its nodes are gone: it leaves with them.
        assert wait(lambda: {each.name for each in stays.context.nodes()} == {"stays"})


def test_topics_of_others_than_ros_are_none():
    with Context(**OPTIONS) as context, Participant(**OPTIONS) as other:
        other.writer("rt/foreign", "some::Type")
        other.writer("foreign", TYPE)
        other.writer("rt/ours", "p::msg::dds_::T_")
        assert wait(lambda: len(list(context.participant.remotes(True))) == 3)
        assert context.topics() == {"/ours": {"p/msg/T"}}
