"""Replay: recordings pass unchanged; faults of recordings and of firm-hdl are found."""

from __future__ import annotations

import sqlite3
import struct
from contextlib import closing

import pytest

import firm_hdl.verify.ts3.circuit as circuit
from firm_hdl.cases.oracle import RosbagsOracle
from firm_hdl.cli import main
from firm_hdl.gateware import Deserializer, Serializer
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts3.replay import replay
from firm_hdl.verify.ts3.task import as_test
from tests.frontend.recordings import make_old_db3
from tests.frontend.workspace import make_files
from tests.recordings.files import Channel, write_db3, write_mcap
from tests.verify.judged import assert_passed
from tests.verify.robot import FORMATS, robot, write
from tests.verify.ts3.test_acceptance import BadByte, BadLeaf

pytestmark = pytest.mark.usefixtures("same_circuit")

STRING = "std_msgs/msg/String"
TEXT = bytes.fromhex("00010000 04000000 61626300")


def run(capsys, *arguments):
    """Run the command in this process; return its status and what it printed."""
    status = main(["verify", "--jobs", "1", *map(str, arguments)])
    return status, capsys.readouterr()


def strings(tmp_path, *packets, name=STRING, topic="/text", form="mcap"):
    """Record packets of a type."""
    messages = [(topic, name, 10**9 + number, data) for number, data in enumerate(packets)]
    return write(tmp_path / "run", form, messages)


def replayed(bag, name=STRING, distro="lyrical", **options):
    given = CaseOptions(bags=(str(bag),), **options)
    task = TypeUnderTest(distro=distro, name=name, same=(distro,))
    return replay(given, as_test(task, given))


def test_events_are_replayed_and_topics_that_cannot_be_are_named(capsys, tmp_path):
    event = struct.pack("<I", 256) + struct.pack(
        "<B3xiI16s4xqI4xqqI", 1, 5, 6, bytes(range(16)), 7, 1, 2, 3, 0
    )
    assert len(event) == 72
    bag = write_db3(
        tmp_path / "run.db3",
        # rosbag2 names the definition by the service.
        Channel(
            topic="/add/_service_event",
            type="p/srv/Add_Event",
            schema="p/srv/Add",
            text="int64 a\nint64 b\n---\nint64 sum\n",
            messages=((1, event),),
        ),
        Channel(topic="/scene", type="foxglove.SceneUpdate", language="protobuf", text=b"\xff"),
        Channel(topic="/s", messages=((2, TEXT),)),
        Channel(topic="/json", wire="json", messages=((3, b"{}"),)),
    )
    status, output = run(capsys, "--bag", bag)
    assert (status, output.err) == (0, "")
    assert (
        f"note: '{bag}' has a topic of type 'foxglove.SceneUpdate', but not its definition: it is "
        "in 'protobuf', and only ros2msg and ros2idl are read\n"
    ) in output.out
    assert "p/srv/Add_Event (jazzy): 1 of 1 messages of 1 topic replayed\n" in output.out
    assert (
        "std_msgs/msg/String (jazzy): 1 of 1 messages of 1 topic replayed; /json left out: its "
        "messages are in 'json', not in cdr\n"
    ) in output.out


def test_types_that_a_recording_lacks_come_from_a_distribution_and_a_folder(capsys, tmp_path):
    bag = make_old_db3(tmp_path / "old.db3", [STRING, "p/msg/A", "p/msg/B"])
    with closing(sqlite3.connect(bag)) as database, database:
        rows = [(1, 1, TEXT), (2, 2, TEXT), (3, 3, TEXT)]
        database.executemany(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", rows
        )
    folder = make_files(tmp_path / "p", {"msg/A.msg": "string text\n"})
    given = ["--distro", "humble", "--depends", folder]
    status, output = run(capsys, "--bag", bag, *given)
    assert (status, output.err) == (0, "")
    assert "type 'p/msg/B', but not its definition: none was recorded" in output.out
    assert "humble      2 of    2 types pass" in output.out
    # What repeats a test names the folder, too.
    command = replayed(bag, "p/msg/B", "humble", depends=(str(folder),)).command
    assert command.startswith(f"firm-hdl verify --distro humble --depends {folder} --bag {bag} ")
    status, output = run(capsys, "--bag", bag, *given, "p/msg/B")
    assert status == 1 and "name a folder that has it with --depends" in output.err


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.sampled(8)
def test_recordings_pass(capsys, tmp_path, form):
    messages = robot(form, 4)
    # rosbags reads compressed recordings; one circuit is enough to check that they are read.
    only = [] if form in ("bag", "mcap") else ["std_msgs/String"]
    bag = write(tmp_path / "run", form, messages, [("/never", "std_msgs/msg/Bool")])
    status, output = run(capsys, "--bag", bag, *only)
    assert status == 0 and output.err == ""
    ros1 = form.startswith("bag")
    distro, infix = ("noetic", "") if ros1 else ("lyrical", "msg/")
    assert f"note: std_msgs/{infix}String ({distro}): 4 of 4 messages of 1 topic replayed\n" in (
        output.out
    )
    assert f"{distro:8} {1 if only else 4:4} of {1 if only else 4:4} types pass" in output.out
    if not only:
        scans = f"note: sensor_msgs/{infix}LaserScan ({distro}): 6 of 6 messages of 2 topics"
        assert scans in output.out
        silent = f"std_msgs/{infix}Bool ({distro}), ts3, 8-byte bus"
        assert f"not judged: {silent}: no messages of it" in output.out


class InvertedBit(BadLeaf):
    """Inverts a bit of the string."""

    def fault(self, m):
        port, inner = self.message.data.items, self.inner.message.data.items
        m.d.comb += port.payload.data[0].eq(inner.payload.data[0] ^ 1)


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("which", "fault", "output"),
    [
        ("Serializer", BadByte, "hardware: packet 0 of 2 differs at byte 15: "),
        ("Deserializer", InvertedBit, "hardware: leaf data.items, transfer 0 of 2: "),
    ],
)
def test_faults_in_hardware_are_found(capsys, monkeypatch, tmp_path, which, fault, output):
    original = {"Serializer": Serializer, "Deserializer": Deserializer}[which]
    made = lambda message, **options: fault(original(message, **options))  # noqa: E731
    monkeypatch.setattr(circuit, which, made)
    whole = TEXT[:4] + b"\x08\0\0\0abcdefg\0"
    bag = strings(tmp_path, whole, whole)
    status, printed = run(capsys, "--bag", bag, "--cases", "5")
    assert status == 1
    assert f"FAIL {STRING} (lyrical)\n" in printed.out
    (line,) = [each for each in printed.out.splitlines() if output in each and "Stalls" not in each]
    assert line.endswith("(/text message 0 at 1.000000000)")
    assert (
        f"again: firm-hdl verify --distro lyrical --bag {bag} --bus-bytes 8 --seed 0 --cases 5 "
        f"{STRING}\n"
    ) in printed.out


def test_oracle_that_reads_another_byte_disagrees(monkeypatch, tmp_path):
    original = RosbagsOracle.read

    def read(self, packet, name, wire):
        return original(self, packet.replace(b"b", b"B"), name, wire)

    monkeypatch.setattr(RosbagsOracle, "read", read)
    result = replayed(strings(tmp_path, TEXT))
    # Both models and the circuit give the content of the packet.
    assert any(each.startswith("golden model, /text message 0") for each in result.failures)
    assert any(each.startswith("hardware: leaf data.items") for each in result.failures)
    # The packet that rosbags writes would differ, too.
    assert any(each.startswith("hardware: packet 0 of 1 differs") for each in result.failures)


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("packet", "kind"),
    [
        (TEXT[:3] + b"\2" + TEXT[4:], "with option bits"),
        (TEXT + b"xyz", "with bytes after the message"),
        (TEXT[:2] + b"\0\3" + TEXT[4:] + b"\0\0\0", "with option bits, bytes after the message"),
        (b"\0\0\0\0\0\0\0\4abc\0", "in big-endian CDR, which get the status ENCAPSULATION"),
        (b"\0\3" + TEXT[2:], "in a parameter list, which get the status ENCAPSULATION"),
        (b"\1\1" + TEXT[2:], "in the representation 0101, which get the status ENCAPSULATION"),
        (TEXT[:9] + b"\xff" + TEXT[10:], "with text that is not UTF-8, which rosbags read"),
        (bytes.fromhex("00010000 00000000"), "that rosbags reads only as a serializer writes them"),
    ],
)
def test_other_forms_are_counted_and_named(tmp_path, packet, kind):
    result = replayed(strings(tmp_path, TEXT, packet, TEXT, packet))
    assert_passed(result)
    count, _, text = result.note.partition("; ")
    assert count == "4 of 4 messages of 1 topic replayed"
    assert text.startswith(f"2 {kind}")
    assert text.endswith("(first: /text message 1 at 1.000000001)")


@pytest.mark.parametrize(
    ("form", "packet", "output"),
    [
        ("mcap", TEXT[:-2], "its 10 bytes do not fit the definition: status TRUNCATED; rosbags "),
        ("mcap", TEXT + b"\0" * 4, "its 16 bytes do not fit the definition: status TRAILING; "),
        ("mcap", TEXT[:-1] + b"d", "its 12 bytes do not fit the definition: status STRING; "),
        ("mcap", b"", "its 0 bytes do not fit the definition: status TRUNCATED; rosbags says: "),
        ("bag", TEXT[4:-2], "its 6 bytes do not fit the definition: status TRUNCATED; "),
        ("bag", b"\0\0\0\0\0", "its 5 bytes do not fit the definition: status TRAILING; "),
    ],
)
def test_message_that_does_not_fit_is_named(capsys, tmp_path, form, packet, output):
    good = TEXT if form == "mcap" else b"\3\0\0\0abc"
    status, printed = run(capsys, "--bag", strings(tmp_path, good, packet, good, form=form))
    assert status == 1
    # Only that message: the circuit reports it, and continues with the next.
    assert printed.out.count("    /text message ") == 1
    assert f"    /text message 1 at 1.000000001: {output}" in printed.out
    assert "hardware" not in printed.out


def test_bound_that_is_exceeded_is_named_though_rosbags_reads_it(tmp_path):
    name = "my_msgs/msg/Wheels"
    (packet,) = [each[3] for each in robot("mcap", 1) if each[1] == name]
    long = _with_mode(packet, b"too long a mode")
    result = replayed(strings(tmp_path, packet, long, name=name), name)
    (failure,) = result.failures
    assert failure.startswith("/text message 1 at 1.000000001: ")
    assert failure.endswith("do not fit the definition: status LENGTH; rosbags reads it")


def _with_mode(packet, mode):
    """Replace the string of the first message, which has one character, by a longer one."""
    at = packet.index(b"\3\0\0\0" + "ä".encode() + b"\0")
    body = packet[:at] + struct.pack("<I", len(mode) + 1) + mode + b"\0"
    return body + b"\0" * (-len(body) % 4) + b"\0\0\0\0"


def test_topics_with_another_definition_are_left_out(tmp_path):
    one, other = ({"topic_type_hash": f"RIHS01_{number}"} for number in (1, 2))
    bag = write_mcap(
        tmp_path / "run.mcap",
        Channel(topic="/a", metadata=one, messages=((1, TEXT),)),
        Channel(topic="/b", metadata=other, messages=((2, b"other"),)),
    )
    result = replayed(bag)
    assert_passed(result)
    assert result.note == (
        "1 of 1 messages of 1 topic replayed; /b left out: its definition is another one (RIHS01_2)"
    )


def test_long_messages_are_left_out_and_counted(tmp_path):
    long = TEXT[:4] + struct.pack("<I", 201) + b"x" * 200 + b"\0"
    bag = strings(tmp_path, TEXT, long, TEXT)
    assert replayed(bag, longest=100).note == (
        "2 of 3 messages of 1 topic replayed; 1 left out, of more than 100 bytes (up to 209): "
        "--max-message-bytes N takes longer ones"
    )
    result = replayed(strings_again(tmp_path, long), longest=100)
    assert result.verdict == NotJudged(
        "all of its 1 messages have more than 100 bytes; --max-message-bytes N takes longer ones"
    )


def strings_again(tmp_path, *packets):
    (tmp_path / "again").mkdir()
    return strings(tmp_path / "again", *packets)


def test_unusable_recordings_are_an_error(capsys, tmp_path):
    bag = strings(tmp_path, TEXT)
    missing = tmp_path / "none.bag"
    assert run(capsys, "--bag", missing)[1].err == (
        f"error: '{missing}' cannot be read: No such file or directory\n"
    )
    old = make_old_db3(tmp_path / "old.db3", [STRING])
    status, output = run(capsys, "--bag", old)
    assert status == 1 and output.out == ""
    assert output.err.startswith(f"error: '{old}' has no definitions of its types")
    status, output = run(capsys, "--bag", bag, "std_msgs/Bool")
    assert status == 1 and output.err.startswith("error: type 'Bool' is not defined in package")
    status, output = run(capsys, "--bag", bag, "--wire", "ros1")
    assert status == 1 and output.err == f"error: '{bag}' has messages of cdr, not of ros1\n"
    status, output = run(capsys, "--bag", bag, "--distro", "noetic")
    assert status == 1 and "is a recording of ROS 2, and noetic is ROS 1" in output.err


def test_recording_that_is_damaged_fails_its_types(capsys, tmp_path):
    (file,) = strings(tmp_path, *[TEXT] * 50, form="db3").glob("*.db3")
    alone = tmp_path / "alone.db3"
    alone.write_bytes(file.read_bytes())
    assert run(capsys, "--bag", alone)[0] == 0
    data = bytearray(file.read_bytes())
    at = data.index(TEXT)
    data[at - 40 :] = b"\xff" * (len(data) - at + 40)
    alone.write_bytes(data)
    status, output = run(capsys, "--bag", alone)
    assert status == 1
    assert "cannot be read as a recording: " in output.out + output.err


def test_a_partly_unreadable_message_is_judged_by_its_readable_parts(monkeypatch, tmp_path):
    latin = TEXT[:9] + b"\xff" + TEXT[10:]
    bag = strings(tmp_path, latin)
    assert not replayed(bag).failures
    original = RosbagsOracle.read

    def read(self, packet, name, wire):
        return original(self, packet.replace(b"c\0", b"C\0"), name, wire)

    # Besides the string that is not UTF-8, rosbags reads a wrong letter.
    monkeypatch.setattr(RosbagsOracle, "read", read)
    (failure,) = replayed(bag).failures
    assert "its 12 bytes do not fit the definition: status OK; rosbags says: " in failure


def test_floats_that_python_does_not_keep_pass(tmp_path):
    packets = [b"\0\1\0\0" + struct.pack("<I", bits) for bits in (0x7F800001, 0x7FC00001, 1)]
    bag = strings(tmp_path, *packets, name="std_msgs/msg/Float32")
    result = replayed(bag, "std_msgs/msg/Float32")
    assert_passed(result)
    # Some versions of Python keep such values, others do not.
    assert "signalling" in result.note or result.note == "3 of 3 messages of 1 topic replayed"
