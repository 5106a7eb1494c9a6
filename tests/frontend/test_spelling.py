"""The ways in which people write the name of a type, and files in place of names."""

from __future__ import annotations

import os

import pytest

from firm_hdl.cli import main
from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from firm_hdl.frontend.spelling import spelled
from tests.frontend.workspace import make_files

FILES = {
    "ws/folder/package.xml": "<package><name>named</name></package>",
    "ws/folder/msg/A.msg": "uint8 a",
    "ws/folder/msg/deep/B.msg": "A a",
    "ws/plain/srv/S.srv": "---\n",
    "ws/plain/msg/S.msg": "uint8 s",
    "ws/plain/msg/I.idl": "module plain { module msg { struct I { int16 i; }; }; };",
    "ws/plain/msg/Lost.srv": "---\n",
    "ws/loose/L.msg": "uint8 l",
    "old/plain/msg/S.msg": "uint16 old",
}


@pytest.fixture
def workdir(tmp_path, monkeypatch):
    monkeypatch.chdir(make_files(tmp_path, FILES))
    return tmp_path


@pytest.mark.parametrize(
    "name",
    [
        "sensor_msgs.msg.Imu",
        "sensor_msgs::msg::Imu",
        "sensor_msgs/Imu",
        "sensor_msgs/msg/Imu.msg",
        "sensor_msgs/Imu.h",
        "sensor_msgs.msg._imu.Imu",
        "sensor_msgs::msg::dds_::Imu_",
        "sensor_msgs__msg__Imu",
    ],
)
@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_every_spelling_is_taken(name, distro):
    library = Library(distro)
    assert library.message(name) is library.interface(name) is library.message("sensor_msgs/Imu")


@pytest.mark.parametrize("text", ["sensor_msgs.msg", "Imu", "a//b", "a/b/", "src/p/msg/A.msg"])
def test_what_is_no_name_stays(text):
    assert spelled(text) == text


@pytest.mark.parametrize(
    "name", ["sensor_msgs/msg/IMU", "Sensor_Msgs.Msg.imu", "imu", "SENSOR_MSGS/MSG/IMU"]
)
def test_mistakes_of_case_are_answered_with_the_right_name(name):
    with pytest.raises(DefinitionError, match=r"; did you mean 'sensor_msgs/msg/Imu'\?$"):
        Library("lyrical").message(name)


def test_parts_of_services_are_taken_as_in_programs(workdir):
    for name in ("plain.srv.S.Request", "plain::srv::S::Request"):
        assert Library("lyrical", ["ws"]).message(name).name == "plain/srv/S_Request"


def test_the_name_of_a_package_is_answered_with_its_types():
    with pytest.raises(DefinitionError) as caught:
        Library("lyrical").message("std_msgs")
    assert str(caught.value) == (
        "error: 'std_msgs' is a package, and not the name of a type, which is 'package/msg/Name'; "
        "did you mean 'std_msgs/msg/Bool', 'std_msgs/msg/Byte' or 'std_msgs/msg/ByteMultiArray'?"
    )


def test_names_of_python_modules_are_answered_with_those_of_types():
    with pytest.raises(DefinitionError, match="did you mean 'sensor_msgs/msg/PointCloud2'"):
        Library("lyrical").message("sensor_msgs/msg/point_cloud2.hpp")


def test_a_name_that_two_types_have_is_refused_in_ros_2(workdir):
    with pytest.raises(DefinitionError, match="'plain/S' can be 'plain/msg/S' or 'plain/srv/S'"):
        Library("lyrical", ["ws"]).interface("plain/S")
    assert Library("lyrical", ["ws"]).message("plain/S").name == "plain/msg/S"
    assert Library("noetic", ["ws"]).interface("plain/S").name == "plain/S"


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("ws/folder/msg/A.msg", "named/msg/A"),
        ("ws/folder/msg/deep/B.msg", "named/msg/B"),
        ("ws/plain/srv/S.srv", "plain/srv/S"),
        ("ws/plain/msg/I.idl", "plain/msg/I"),
    ],
)
def test_a_file_is_taken_in_place_of_a_name(workdir, capsys, monkeypatch, file, name):
    assert main(["hash", name, "--path", "ws"]) == 0
    hashed = capsys.readouterr().out
    for text in (file, os.path.abspath(file)):
        assert main(["hash", text]) == 0
        assert capsys.readouterr().out == hashed
    monkeypatch.chdir(os.path.dirname(file))
    assert main(["hash", os.path.basename(file)]) == 0
    assert capsys.readouterr().out == hashed


def test_the_package_of_a_file_comes_before_other_folders(workdir, capsys):
    assert main(["show", "old/plain/msg/S.msg", "--path", "ws"]) == 0
    assert capsys.readouterr().out == "uint16 old\n"


@pytest.mark.parametrize(
    ("files", "message"),
    [
        (["ws/loose/L.msg"], "'ws/loose/L.msg' is in no package of ROS: its folder has to be"),
        (["ws/folder/msg/a.msg"], "there is no file 'ws/folder/msg/a.msg'; did you mean 'ws/fol"),
        (
            ["nowhere/at/all/msg/A.msg"],
            "there is no file 'nowhere/at/all/msg/A.msg', and no folder",
        ),
        (["ws/plain/msg/Lost.srv"], "is in a folder 'msg', whose files end in .msg or .idl"),
        (["ws/plain/msg/S.msg", "old/plain/msg/S.msg"], "package 'plain' is in 'ws/plain' and in"),
        (["ws/folder"], "'ws/folder' is a folder: name it with --path, and one of its types"),
    ],
)
def test_a_file_that_is_no_type_is_refused(workdir, capsys, files, message):
    assert main(["hash", *files]) == 1
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("error: ") and message in err
