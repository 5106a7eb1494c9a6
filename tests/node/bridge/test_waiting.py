"""What a bridge keeps in mind: the queue, the requests under way, and the times of retries."""

from __future__ import annotations

from firm_hdl.node.bridge.waiting import Call, Calls, MessageQueue, Retry, Waiting
from tests.node.bridge.fakes import CAL, HEARD


def waiting(packet, at=0.0):
    return Waiting(HEARD, packet, None, at)


def test_what_is_taken_makes_room():
    queue = MessageQueue(10)
    for number in range(100):
        assert queue.put(waiting(b"x" * 6, number)) and queue.put(waiting(b"y" * 4, number))
        assert not queue.put(waiting(b"z"))
        assert queue.oldest() == number
        assert [queue.take().packet for _ in range(2)] == [b"x" * 6, b"y" * 4]
    assert queue.take() is None and queue.oldest() is None


def test_the_oldest_is_the_one_that_is_taken_next():
    queue = MessageQueue(10)
    for at in (1.0, 2.0, 3.0):
        queue.put(waiting(b"x", at))
    found = []
    while (oldest := queue.oldest()) is not None:
        taken = queue.take()
        assert taken is not None
        found.append((oldest, taken.at))
    assert found == [(1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]


def test_only_what_came_before_a_time_is_taken():
    queue = MessageQueue(10)
    queue.put(waiting(b"x", 1.0))
    assert queue.take(before=1.0) is None
    taken = queue.take(before=1.5)
    assert taken is not None and taken.packet == b"x"


def test_a_response_is_for_a_request_of_its_own_service():
    calls = Calls(3)
    tags = [calls.next_tag() for _ in range(3)]
    assert len(set(tags)) == 3
    made = [Call(CAL, name, until) for name, until in (("a", 1.0), ("b", 2.0), ("c", 3.0))]
    for tag, call in zip(tags, made, strict=True):
        assert not calls.is_full
        calls.add(tag, call)
    assert calls.is_full
    # The tag is right, and the service is another one: the request still waits.
    assert calls.answered(tags[1], HEARD) is None
    assert calls.answered(max(tags) + 1, CAL) is None
    assert len(calls) == 3
    assert calls.answered(tags[1], CAL) is made[1]
    assert calls.answered(tags[1], CAL) is None
    assert list(calls.ended(1.0)) == []
    assert list(calls.ended(1.5)) == [made[0]]
    assert list(calls.ended()) == [made[2]] and not len(calls)


def test_tags_fit_into_their_field():
    calls = Calls(3)
    calls._tag = (1 << 32) - 2
    assert [calls.next_tag() for _ in range(3)] == [(1 << 32) - 1, 0, 1]


def test_pauses_double_up_to_the_longest_and_begin_again():
    retry = Retry(0.5, 3.0)
    assert retry.at == 0.0
    assert [retry.failed(10.0, "gone") for _ in range(2)] == [True, False]
    assert retry.at == 11.0
    assert retry.failed(10.0, "other") and retry.at == 12.0
    for _ in range(3):
        retry.failed(10.0, "other")
        assert retry.at == 13.0
    retry.worked()
    assert retry.failed(20.0, "other") and retry.at == 20.5
