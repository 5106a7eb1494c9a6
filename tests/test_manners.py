# amaranth: UnusedElaboratable=no
"""Commands with several types, and with arguments that are not types."""

from __future__ import annotations

import re

import pytest

from firm_hdl import (
    Deserializer,
    MessageSignature,
    PacketSignature,
    RecordReader,
    Serializer,
    load_message,
)
from firm_hdl.cli import main
from tests.frontend.workspace import make_files

FILES = {
    "own/p/msg/A.msg": "q/B b\n",
    "own/p/msg/C.msg": "int8 c\n",
    "own/p/msg/Bad.msg": "int33 x\n",
    "others/q/msg/B.msg": "int8 b\n",
}


@pytest.fixture
def workdir(tmp_path, monkeypatch):
    monkeypatch.chdir(make_files(tmp_path, FILES))
    for name in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.mark.parametrize("command", ["md5", "hash", "proto"])
@pytest.mark.usefixtures("workdir")
def test_all_covers_the_folders_without_dependencies(command, capsys):
    assert main([command, "--all", "--path", "own", "--depends", "others"]) == 1
    out, err = capsys.readouterr()
    assert re.findall(r"p/(?:msg/)?(\w+)", out) == ["A", "C"]
    assert "q/" not in out and "std_msgs" not in out
    assert "int33" in err
    assert main([command, "--all", "--path", "own"]) == 1
    assert "q/B" in capsys.readouterr().err


@pytest.mark.usefixtures("workdir")
def test_verify_goes_on_after_a_type_that_cannot_be_used(capsys):
    ts2 = ["--systems", "ts2", "--jobs", "1"]
    assert main(["verify", "p/Bad", "p/C", "--path", "own", *ts2]) == 1
    out, err = capsys.readouterr()
    assert "int33" in err
    assert "1 of    1 plans are sound" in out
    assert main(["verify", "std_msgs/msg/Bool", "std_msgs/msg/Boool", *ts2]) == 1
    out, err = capsys.readouterr()
    assert "no distribution has std_msgs/msg/Boool" in err
    assert "1 plans are sound" in out
    depends = ["--depends", "others"]
    assert main(["verify", "--all", "--path", "own", *depends, *ts2]) == 1
    out, err = capsys.readouterr()
    assert "2 of    2 plans are sound" in out


@pytest.mark.parametrize("command", ["plan", "info", "show", "build"])
@pytest.mark.usefixtures("workdir")
def test_dependencies_of_a_type_are_found(command, capsys):
    assert main([command, "p/A", "--path", "own"]) == 1
    assert main([command, "p/A", "--path", "own", "--depends", "others"]) == 0
    assert capsys.readouterr().err.count("error") == 1


def test_info_names_the_hardest_packet_and_long_arrays_if_there_are_any(capsys):
    types = ["geometry_msgs/msg/PolygonInstance", "sensor_msgs/msg/Image"]
    assert main(["info", "--bus-bytes", "16", *types]) == 0
    polygon, image = capsys.readouterr().out.split("sensor_msgs/msg/Image")
    assert "of the hardest packets that were tried (28 bytes, 2 beats, 3 cycles) " in polygon
    assert "of long strings or arrays" not in polygon
    assert "of long strings or arrays " in image


BOOL = load_message("std_msgs/msg/Bool")


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (
            lambda: Deserializer("sensor_msgs/msg/Imu"),
            TypeError,
            "Message must be a Message, as load_message gives it, not 'sensor_msgs/msg/Imu'",
        ),
        (
            lambda: MessageSignature(None, 8),
            TypeError,
            "Message must be a Message, as load_message gives it, not None",
        ),
        (
            lambda: Serializer(BOOL, bus_bytes=True),
            TypeError,
            "Bus width must be an integer, not True",
        ),
        (
            lambda: RecordReader(BOOL, bus_bytes=8.0),
            TypeError,
            "Bus width must be an integer, not 8.0",
        ),
        (
            lambda: PacketSignature(3),
            ValueError,
            "Bus width must be one of 1, 2, 4, 8, 16, 32, 64 bytes, not 3",
        ),
        (
            lambda: PacketSignature("8"),
            TypeError,
            "Bus width must be an integer, not '8'",
        ),
        (
            lambda: Deserializer(BOOL, max_message_bytes="1"),
            TypeError,
            "Maximum message size must be an integer, not '1'",
        ),
    ],
)
def test_constructors_check_their_arguments(make, error, message):
    with pytest.raises(error, match=f"^{re.escape(message)}$"):
        make()
