"""What a participant that closes does with those that wait for it."""

from __future__ import annotations

import logging
import threading

import pytest

from firm_hdl.rtps import HistoryFullError, Participant, Qos
from tests.rtps.test_participant import OPTIONS, TOPIC, TYPE, wait

HOUR = 3600.0


@pytest.fixture
def pair():
    with Participant(**OPTIONS) as one, Participant(**OPTIONS) as two:
        yield one, two


def started(work):
    """Run a function in a thread; return a list that gets its result, or its error."""
    found = []

    def run():
        try:
            found.append(work())
        except Exception as error:
            found.append(error)

    threading.Thread(target=run, daemon=True).start()
    return found


def test_nobody_waits_longer_than_a_participant_is_open(pair, monkeypatch):
    one, two = pair
    writer = one.writer(TOPIC, TYPE, Qos(depth=0, max_samples=1))
    two.reader(TOPIC, TYPE, lambda sample: None, Qos(depth=0))
    assert writer.wait_for_match()
    # Nothing is acknowledged any more, so the first sample takes all room.
    monkeypatch.setattr(two._core, "receive", lambda datagram, now: None)
    writer.write(b"1234")
    waiting = [
        started(lambda: writer.write(b"1234", timeout=HOUR)),
        started(lambda: writer.wait_for_acknowledgments(HOUR)),
        started(lambda: writer.wait_for_match(2, HOUR)),
    ]
    one.close()
    assert wait(lambda: all(waiting))
    (failed,), *others = waiting
    assert isinstance(failed, HistoryFullError) and others == [[False], [False]]


def test_a_callback_may_close_its_participant(pair, caplog):
    one, two = pair
    writer = one.writer(TOPIC, TYPE)
    two.reader(TOPIC, TYPE, lambda sample: two.close())
    assert writer.wait_for_match()
    with caplog.at_level(logging.ERROR, "firm_hdl.rtps"):
        writer.write(b"1234")
        assert wait(lambda: not two._thread.is_alive())
    assert not caplog.records


def test_a_participant_that_has_left_says_nothing_more(pair):
    one, two = pair
    writer, reader = one.writer(TOPIC, TYPE), one.reader(TOPIC, TYPE, lambda sample: None)
    two.reader(TOPIC, TYPE, lambda sample: None)
    assert writer.wait_for_match()
    one.close()
    sent = one.counters["sent"]
    for each in (writer, reader):
        each.close()
    one.close()
    assert one.counters["sent"] == sent > 0 and not one._core.outbox
