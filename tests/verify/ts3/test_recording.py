"""The selected messages of a recording, and their bytes."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.tasks import TypeUnderTest, UnknownTypeError
from firm_hdl.verify.ts3.replay import Selection, collect_recorded, replay, select, topics_of
from firm_hdl.verify.ts3.task import as_test
from tests.recordings.files import Channel, write_mcap
from tests.tools import need
from tests.verify.judged import assert_passed
from tests.verify.robot import FORMATS, robot, write

STRING = "std_msgs/msg/String"
EVERYTHING = 1 << 30


def chosen(selection: Selection) -> list[tuple[str, int]]:
    return [(each.topic, each.number) for each in selection.messages]


def counted(path: Path, sizes: dict[str, list[int]]) -> Path:
    """Record messages of given sizes on topics, in order on each topic."""
    messages = [
        (topic, STRING, number * 100 + index, bytes([number]) * size)
        for index, (topic, each) in enumerate(sizes.items())
        for number, size in enumerate(each)
    ]
    return write(path, "mcap", sorted(messages, key=lambda each: each[2]))


@pytest.mark.parametrize("form", FORMATS)
def test_bytes_are_those_that_were_recorded(tmp_path: Path, form: str) -> None:
    messages = robot(form)
    bag = str(write(tmp_path / "run", form, messages))
    name = "my_msgs/msg/Wheels"
    recorded = name.replace("msg/", "") if form.startswith("bag") else name
    topics = [place for place in topics_of(bag) if place[1].type == recorded]
    found = select(topics, most=100, longest=EVERYTHING)
    want = [each for each in messages if each[1] == name]
    assert [(m.topic, name, m.nanoseconds, m.data) for m in found.messages] == want
    assert [m.number for m in found.messages] == [*range(6)]
    assert (found.total, found.topics, found.too_long, found.sparse) == (6, 1, (), False)


def test_messages_are_spread_evenly_over_the_recording(tmp_path: Path) -> None:
    topics = topics_of(str(counted(tmp_path / "run", {"/a": [5] * 101})))
    assert [n for _, n in chosen(select(topics, most=5, longest=9))] == [0, 25, 50, 75, 100]
    assert [n for _, n in chosen(select(topics, most=2, longest=9))] == [0, 100]
    assert [n for _, n in chosen(select(topics, most=1, longest=9))] == [0]
    assert len(chosen(select(topics, most=500, longest=9))) == 101


def test_short_topics_leave_their_share_to_others(tmp_path: Path) -> None:
    topics = topics_of(str(counted(tmp_path / "run", {"/a": [5] * 50, "/b": [5], "/c": [5] * 50})))
    found = chosen(select(topics, most=11, longest=9))
    assert [sum(t == topic for t, _ in found) for topic in ("/a", "/b", "/c")] == [5, 1, 5]


def test_long_messages_are_known_before_any_is_selected(tmp_path: Path) -> None:
    topics = topics_of(str(counted(tmp_path / "run", {"/a": [9, 1, 9, 2, 12]})))
    found = select(topics, most=10, longest=5)
    assert (chosen(found), found.too_long, found.total) == ([("/a", 1), ("/a", 3)], (9, 9, 12), 5)
    # The limit itself is not too long.
    limit = select(topics, most=10, longest=9)
    assert ([n for _, n in chosen(limit)], limit.too_long) == ([0, 1, 2, 3], (12,))
    nothing = select(topics, most=10, longest=0)
    assert (chosen(nothing), len(nothing.too_long)) == ([], 5)


def test_all_together_have_so_many_bytes_at_most(tmp_path: Path) -> None:
    topics = topics_of(str(counted(tmp_path / "run", {"/a": [100] * 50})))
    found = select(topics, most=50, longest=EVERYTHING, most_bytes=1000)
    assert [n for _, n in chosen(found)] == [0, 5, 10, 16, 21, 27, 32, 38, 43, 49]
    assert found.sparse
    assert not select(topics, most=10, longest=EVERYTHING, most_bytes=1000).sparse
    sizes = topics_of(str(counted(tmp_path / "other", {"/a": [300, 200, 400]})))
    one = select(sizes, most=3, longest=EVERYTHING, most_bytes=100)
    assert chosen(one) == [("/a", 1)] and one.sparse
    # The only message is all of them, however long it is.
    alone = topics_of(str(counted(tmp_path / "alone", {"/a": [300]})))
    assert not select(alone, most=3, longest=EVERYTHING, most_bytes=100).sparse


def test_topics_of_the_same_name_in_several_recordings_are_apart(tmp_path: Path) -> None:
    one = str(counted(tmp_path / "one", {"/a": [5] * 3, "/b": [6] * 2}))
    two = str(counted(tmp_path / "two", {"/a": [7] * 4}))
    topics = [*topics_of(one), *topics_of(two)]
    found = select(topics, most=100, longest=9)
    assert [(m.bag, m.topic, m.number, len(m.data)) for m in found.messages] == [
        *((one, "/a", 0, 5), (one, "/b", 0, 6), (one, "/a", 1, 5), (one, "/b", 1, 6)),
        *((one, "/a", 2, 5), (two, "/a", 0, 7), (two, "/a", 1, 7), (two, "/a", 2, 7)),
        (two, "/a", 3, 7),
    ]
    assert (found.total, found.topics, found.too_long) == (9, 3, ())
    few = select(topics, most=3, longest=9)
    assert [(m.bag, m.topic, m.number) for m in few.messages] == [
        *((one, "/a", 0), (one, "/b", 0), (two, "/a", 0)),
    ]
    short = select(topics, most=100, longest=5)
    assert len(short.messages) == 3 and sorted(short.too_long) == [6, 6, 7, 7, 7, 7]
    # Topics that were not asked for do not count.
    alone = select(topics_of(two), most=100, longest=9)
    assert (alone.total, alone.topics, len(alone.messages)) == (4, 1, 4)


def test_messages_are_numbered_by_their_times(tmp_path: Path) -> None:
    times = (30, 10, 20, 1 << 63, 10)
    messages = tuple((time, bytes([number])) for number, time in enumerate(times))
    path = write_mcap(tmp_path / "run.mcap", Channel(topic="/a", messages=messages))
    found = select(topics_of(str(path)), most=9, longest=9)
    assert [(m.number, m.nanoseconds, m.data[0]) for m in found.messages] == [
        (0, 10, 1), (1, 10, 4), (2, 20, 2), (3, 30, 0), (4, 1 << 63, 3),
    ]  # fmt: skip


def test_types_of_all_recordings_are_found_once(tmp_path: Path) -> None:
    one = str(counted(tmp_path / "one", {"/a": [5], "/b": [5]}))
    two = str(write(tmp_path / "two", "mcap", [], [("/c", "std_msgs/msg/Bool")]))

    def names(*given: str) -> list[str]:
        found = collect_recorded(None, given, [one, two], wire=None, problems={})
        assert all(task.same == (task.distro,) == ("lyrical",) for task in found)
        return [task.name for task in found]

    assert names() == [STRING, "std_msgs/msg/Bool"]
    assert names("std_msgs/String", STRING) == [STRING]
    three = str(write(tmp_path / "three", "mcap", robot("mcap", 1)))
    # One of two has a definition, as a part of the other, and no topic.
    wheels = ("my_msgs/msg/Wheels", "my_msgs/msg/Wheel")
    with pytest.raises(UnknownTypeError, match=r"^There is no topic of my_msgs/msg/Wheel, only"):
        collect_recorded(None, wheels, [three], wire=None, problems={})


def test_file_that_is_cut_is_refused(tmp_path: Path) -> None:
    bag = write(tmp_path / "run", "bag", robot("bag"))
    topics = topics_of(str(bag))
    data = bag.read_bytes()
    # The index refers to a place that has no messages.
    at = data.index(b"tick ")
    bag.write_bytes(data[:100] + b"\xff" * (at - 100) + data[at:])
    with pytest.raises(DefinitionError, match="cannot be read as a recording: "):
        select(topics, most=100, longest=EVERYTHING)


def test_file_of_another_library_is_replayed(tmp_path: Path) -> None:
    need("mcap-ros2-support", "here" if find_spec("mcap_ros2") else None)
    from mcap_ros2.writer import Writer

    text = (
        "std_msgs/Header header\nfloat64[] values\nstring<=5 name\n"
        + "=" * 80
        + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
        + "=" * 80
        + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
    )
    with (tmp_path / "own.mcap").open("wb") as file:
        writer = Writer(file)
        schema = writer.register_msgdef("own_msgs/msg/Values", text)
        for number in range(7):
            header = {"stamp": {"sec": -number, "nanosec": 5}, "frame_id": "f" * number}
            values = {"header": header, "values": [0.5] * number, "name": "abc"[: number % 4]}
            writer.write_message("/values", schema, values, log_time=number)
        writer.finish()
    options = CaseOptions(bags=(str(tmp_path / "own.mcap"),), stalled=False)
    task = TypeUnderTest(distro="lyrical", name="own_msgs/msg/Values", same=("lyrical",))
    result = replay(options, as_test(task, options))
    assert_passed(result)
    assert result.note.startswith("7 of 7 messages of 1 topic replayed")
