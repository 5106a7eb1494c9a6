"""Client libraries beside converters: only libraries with correct results get figures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from firm_hdl.bench import BenchError
from firm_hdl.bench.cycles import Stated, stated_messages
from firm_hdl.export.build import plan_of
from firm_hdl.frontend import load_message
from firm_hdl.jobs import ProgramMissingError
from firm_hdl.model import (
    PRIMITIVES,
    Array,
    Dialect,
    Field,
    FieldType,
    Message,
    Sequence,
    String,
)
from firm_hdl.wire import Wire
from lab.bench.software import python, run
from lab.bench.software.__main__ import main
from lab.bench.software.fastcdr import fastcdr_versions, time_fastcdr
from lab.bench.software.python import genpy_versions, time_genpy, time_rosbags
from lab.bench.software.sample import Sample, Timed
from lab.bench.software.timing import best_ns
from tests.tools import need


def sample_of(message: Message, wire: Wire | None = None, count: int = 5) -> Sample:
    plan = plan_of(message, wire or message.wire, 8, 1 << 20)
    packets = stated_messages(plan, message, Stated(count=count))[1]
    return Sample(message=message, wire=wire or message.wire, packets=tuple(packets))


def everything(dialect: Dialect) -> Message:
    """A type with every kind of field."""
    prefix = "p/msg/" if dialect == "ros2" else "p/"
    numbers = dict(PRIMITIVES[dialect])
    fields = (Field(name="x", type=numbers["uint16"]), Field(name="class", type=String()))
    inner = Message(name=prefix + "In", dialect=dialect, fields=fields)
    empty = Message(name=prefix + "Nothing", dialect=dialect, fields=())
    items: list[FieldType] = [*numbers.values(), String(), inner, empty]
    shapes: list[Callable[[FieldType], FieldType]] = [lambda kind: kind]
    shapes += [lambda kind: Array(element=kind, count=3), lambda kind: Sequence(element=kind)]
    if dialect == "ros2":
        items.append(String(wide=True))
        shapes.append(lambda kind: Sequence(element=kind, bound=5))
    kinds = [shape(kind) for kind in items for shape in shapes]
    return Message(
        name=prefix + "All",
        dialect=dialect,
        fields=tuple(Field(name=f"f{n}", type=kind) for n, kind in enumerate(kinds)),
    )


@pytest.fixture
def cpp() -> None:
    """Fast CDR and a compiler, or the test is skipped."""
    try:
        fastcdr_versions()
    except ProgramMissingError as error:
        need(str(error), None)


@pytest.fixture
def ros1() -> None:
    """A Python with genpy, or the test is skipped."""
    try:
        genpy_versions()
    except ProgramMissingError as error:
        need(str(error), None)


def damaged(sample: Sample, at: int, value: int) -> Sample:
    packets = list(sample.packets)
    packets[-1] = packets[-1][:at] + bytes([value]) + packets[-1][at + 1 :]
    return replace(sample, packets=tuple(packets))


@pytest.mark.thorough
@pytest.mark.usefixtures("cpp")
def test_fast_cdr_has_every_kind_of_field() -> None:
    # Long enough for a coarse clock of processor time.
    found = time_fastcdr(sample_of(everything("ros2")), 1, 0.02)
    assert found.deserialize > 0 and found.serialize > 0
    assert (found.of("deserializer"), found.of("serializer")) == (
        found.deserialize,
        found.serialize,
    )
    assert time_fastcdr(sample_of(everything("ros1"), "cdr"), 1, 0.02).serialize > 0


PADDED = Message(
    name="p/msg/Padded",
    dialect="ros2",
    fields=(
        Field(name="a", type=PRIMITIVES["ros2"]["bool"]),
        Field(name="b", type=PRIMITIVES["ros2"]["uint32"]),
    ),
)


@pytest.mark.thorough
@pytest.mark.usefixtures("cpp")
def test_fast_cdr_without_the_same_bytes_has_no_figure() -> None:
    # This byte is padding, which is written as zero.
    with pytest.raises(BenchError, match=r"(?s)^Fast CDR, p/msg/Padded: read: .* 07 .*written:"):
        time_fastcdr(damaged(sample_of(PADDED), 6, 7), 1, 0.0)
    short = replace(sample_of(PADDED), packets=(b"\0\1\0\0\1",))
    with pytest.raises(BenchError, match="Fast CDR refuses a packet"):
        time_fastcdr(short, 1, 0.0)


@pytest.fixture
def time_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(python, "best_ns", lambda work, items: best_ns(work, items, 1, 0.02))


@pytest.mark.usefixtures("time_once")
def test_rosbags_is_timed_and_checked() -> None:
    for message in (PADDED, load_message("sensor_msgs/Imu", distro="noetic")):
        found = time_rosbags(sample_of(message))
        assert found.deserialize > 0 and found.serialize > 0
    with pytest.raises(BenchError, match=r"^rosbags reads a packet of p/msg/Padded and writes"):
        time_rosbags(damaged(sample_of(PADDED), 6, 7))


@pytest.mark.thorough
@pytest.mark.usefixtures("ros1")
def test_genpy_is_timed_and_checked() -> None:
    message = load_message("std_msgs/Bool", distro="noetic")
    found = time_genpy(sample_of(message, count=1))
    assert found.deserialize > 0 and found.serialize > 0
    with pytest.raises(BenchError, match=r"^genpy, std_msgs/Bool: what it writes is not"):
        time_genpy(damaged(sample_of(message, count=1), 0, 2))
    with pytest.raises(BenchError, match=r"^genpy failed: "):
        time_genpy(replace(sample_of(message), packets=(b"",)))


def test_the_command_prints_both(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def none(sample: Sample) -> Timed:
        raise ProgramMissingError("it is not here")

    monkeypatch.setattr(
        run,
        "LIBRARIES",
        {"rosbags": lambda sample: Timed(deserialize=520.0, serialize=52.0), "genpy": none},
    )
    assert main(["geometry_msgs/msg/Twist", "--jobs", "1"]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[2].split() == [
        *("geometry_msgs/msg/Twist", "cdr", "deserializer", "52"),
        # Seven beats of 6.4 ns.
        *("520", "(0.800)", "45", "(9.29)"),
    ]
    assert out[3].split()[4:] == ["52", "(8.00)", "45", "(9.29)"]
    assert out[4] == "    genpy: it is not here"
