"""The command: exact messages, exit statuses, and never a traceback."""

from __future__ import annotations

import gc
import importlib
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import firm_hdl
from firm_hdl.cases.stimuli import stimuli
from firm_hdl.cli import main
from firm_hdl.plan import build_plan, to_yaml
from firm_hdl.program.table import program_text
from firm_hdl.wire import lay_out
from tests.depth import THOROUGH

ROOT = Path(firm_hdl.__file__).parent.parent
COMMAND = [sys.executable, "-c", "import sys; from firm_hdl.cli import main; sys.exit(main())"]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}


@pytest.fixture
def workdir(tmp_path, monkeypatch):
    """An empty working directory."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(text: str, name: str = "Bad", package: str = "my_msgs") -> None:
    folder = Path("src") / package / "msg"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.msg").write_text(text)


WRONG = {
    "type": (
        "uint8 a\nQuat orientation\n",
        ":2:1: error: type 'Quat' is not defined in package 'my_msgs'\nQuat orientation\n^^^^\n",
    ),
    "package": (
        "geometry_msg/Point p\n",
        ":1:1: error: package 'geometry_msg' is not found; did you mean 'geometry_msgs/Point'?\n"
        "geometry_msg/Point p\n"
        "^^^^^^^^^^^^^^^^^^\n",
    ),
    "cycle": (
        "Bad[] more\n",
        ":1:1: error: type 'my_msgs/msg/Bad' contains itself: my_msgs/msg/Bad -> my_msgs/msg/Bad\n"
        "Bad[] more\n"
        "^^^^^\n",
    ),
    "name": (
        "uint8 twoWords\n",
        ":1:7: error: 'twoWords' is not a legal field name: lower-case letters, digits and single "
        "underscores, a letter first and no underscore last\n"
        "uint8 twoWords\n"
        "      ^^^^^^^^\n",
    ),
    "constant": (
        "uint8 MAX=256\n",
        ":1:11: error: the value of uint8 must be in 0..255\nuint8 MAX=256\n          ^^^\n",
    ),
    "duplicate": (
        "uint8 a\nuint16 a\n",
        ":2:8: error: field 'a' is already declared in line 1\nuint16 a\n       ^\n",
    ),
    "bound": (
        "uint8[<=0] a\n",
        ":1:9: error: the bound of a sequence must be at least 1, not 0\nuint8[<=0] a\n        ^\n",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_definition_has_an_exact_error_and_writes_nothing(workdir, capsys, case):
    text, message = WRONG[case]
    write(text)
    status = main(["build", "std_msgs/msg/Bool", "my_msgs/msg/Bad", "--path", "src"])
    out, err = capsys.readouterr()
    assert (status, out) == (1, "")
    assert err == f"src/my_msgs/msg/Bad.msg{message}"
    assert sorted(path.name for path in workdir.iterdir()) == ["src"]


def test_wrong_definition_keeps_earlier_output(workdir, capsys):
    write("uint8 a\n")
    arguments = ["build", "my_msgs/msg/Bad", "--path", "src"]
    if THOROUGH:
        assert main(arguments) == 0
    else:  # What a build would have written, without the time that it takes.
        folder = workdir / "vhdl_out" / "lyrical" / "my_msgs_msg_Bad_cdr_8"
        folder.mkdir(parents=True)
        (folder / "manifest.json").write_text("{}")
    before = {path: path.stat().st_mtime_ns for path in (workdir / "vhdl_out").rglob("*")}
    assert before
    write("uint8 a\nuint8 a\n")
    assert main(arguments) == 1
    assert before == {path: path.stat().st_mtime_ns for path in (workdir / "vhdl_out").rglob("*")}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ["show", "sensor_msgs/msg/Imux"],
            "error: type 'Imux' is not defined in package 'sensor_msgs'; "
            "did you mean 'sensor_msgs/msg/Imu'?\n",
        ),
        (
            ["plan", "sensor_msg/msg/Imu"],
            "error: package 'sensor_msg' is not found; did you mean 'sensor_msgs/msg/Imu'?\n",
        ),
        (
            ["info", "Imu"],
            "error: 'Imu' is not the name of a type, which is 'package/msg/Name'; "
            "did you mean 'sensor_msgs/msg/Imu'?\n",
        ),
        (
            ["info", "example_interfaces/msg/Bool"],
            "error: package 'example_interfaces' is not found; this ROS package does not come with "
            "firm-hdl: name a folder that has it with --path (in a node: 'paths'), or source the "
            "setup file of an installation that does\n",
        ),
        (["list", "--path", "nowhere"], "error: 'nowhere' is not a folder\n"),
        (
            ["build", "sensor_msgs/msg/Imu", "--max-message-bytes", "20"],
            "error: sensor_msgs/msg/Imu: Maximum message size must be from 312 bytes, the least "
            "that a sensor_msgs/msg/Imu has, to 4294967295, not 20\n",
        ),
    ],
)
def test_impossible_requests_exit_1(workdir, capsys, arguments, message):
    assert main(arguments) == 1
    assert capsys.readouterr() == ("", message)
    assert list(workdir.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "the following arguments are required: COMMAND"),
        (["build"], "the following arguments are required: TYPE"),
        (["built", "x"], "; did you mean 'build'?"),
        (["node", "bild", "n"], "; did you mean 'build'?"),
        (["part", "Gate", "a/b"], "; did you mean 'gate'?"),
        (["build", "a/b", "--bus_byts=4"], "--bus_byts=4; did you mean '--bus-bytes'?"),
        (["list", "--Pth", "src"], "firm-hdl list: error: unrecognized arguments: --Pth src; did"),
        (["verify", "a/b", "--engine", "Verilator"], "; did you mean 'verilator'?"),
        (["plan", "a/b", "--wire", "ros2"], "; did you mean 'cdr'?"),
        (["list", "--distro", "Humble"], "; did you mean 'humble'?"),
        (["list", "--distro", "rolling"], "the types of rolling change any day: take 'lyrical'"),
        (["list", "--distro", "galactic"], "do not come with firm-hdl: take 'humble', the next"),
        (["--distro", "humble", "list"], "--distro: options come after the command"),
        (["build", "a/b", "--bus-bytes", "3"], "3 (choose from 1, 2, 4, 8, 16, 32, 64)\n"),
        (["metrics", "a/b", "--json", "--format", "csv"], "--json and --format csv exclude each"),
        (["build", "a/b", "--distro", "melodic"], "argument --distro: invalid choice: 'melodic'"),
        (["plan", "a/b", "--wire", "json"], "argument --wire: invalid choice: 'json'"),
        (
            ["plan", "a/b", "--max-message-bytes", "0"],
            "argument --max-message-bytes: must be from 1 to 4294967295, not 0",
        ),
        (["build", "a/b", "--jobs", "0"], "argument --jobs: must be at least 1, not 0"),
        (["part", "fifo", "--packets", "0"], "argument --packets: must be from 1 to 4096, not 0"),
        (["part", "fifo", "--name", "2x"], "--name: '2x' is not a name in VHDL and Verilog"),
        (["node", "run", "n", "--seconds", "0"], "--seconds: must be above 0, not 0"),
        (["node", "run", "n", "--seconds", "s"], "--seconds: 's' is not a number"),
        (["node", "run", "n", "--domain", "233"], "--domain: must be from 0 to 232, not 233"),
        (
            ["plan", "a/b", "--max-message-bytes", "much"],
            "argument --max-message-bytes: 'much' is not a number",
        ),
    ],
)
def test_wrong_calls_exit_2(workdir, capsys, arguments, message):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    out, err = capsys.readouterr()
    assert (caught.value.code, out) == (2, "")
    assert err.startswith("usage: firm-hdl")
    assert message in err


def test_build_prints_its_results(workdir, capsys):
    arguments = ["build", "geometry_msgs/msg/Twist", "--out", "gen", "--bus-bytes", "4"]
    assert main([*arguments, "--with", "tools"]) == 0
    out, err = capsys.readouterr()
    folder = os.path.join("gen", "lyrical", "geometry_msgs_msg_Twist_cdr_4", "")
    figures = (
        "geometry_msgs/msg/Twist (CDR, as in ROS 2) on a bus of 4 bytes per clock cycle\n"
        "    every packet: 52 bytes in 13 beats (words of the bus) and 13 clock cycles\n"
        "    clock that keeps up with a full line   100 Mbit/s     1 Gbit/s    10 Gbit/s\n"
        "        of these packets                      3.1 MHz     31.2 MHz    312.5 MHz\n"
    )
    script = Path(folder, "vhdl", "run_ghdl.sh")
    assert (out.startswith(f"wrote   {folder}\n{figures}next: {script} runs "), err) == (True, "")
    assert script.exists() and out.count("\n") == 6
    message = firm_hdl.load_message("geometry_msgs/msg/Twist")
    packets = stimuli(message, build_plan(lay_out(message), bus_bytes=4))
    text = Path(folder, "vhdl", "stimuli.txt").read_text()
    assert text.endswith("\n".join(["", *(packet.hex() for packet in packets), ""]))
    assert main([*arguments, "--with", "tools"]) == 0
    assert capsys.readouterr() == (out.replace("wrote  ", "current"), "")
    # A file that is outdated, and that the user changed, is left and told.
    Path(folder, "waivers.vlt").write_text("mine")
    assert main(arguments) == 0
    kept = f"wrote   {folder}\nkept    {folder}waivers.vlt, which you changed\n"
    assert capsys.readouterr() == (out.replace(f"wrote   {folder}\n", kept), "")
    assert main(["info", *arguments[1:2], "--bus-bytes", "4"]) == 0
    out, err = capsys.readouterr()
    recovery = (
        "    after a damaged packet: ready within 16 cycles (0.16 us at 100 MHz); the longest "
        "legal packet takes 13\n"
    )
    assert out.startswith(f"{figures}{recovery}    deserializer on ECP5 ")
    assert out.splitlines()[-1].startswith("next: firm-hdl build") and out.count("\n") == 8
    assert err == ""


def test_list_and_show(workdir, capsys):
    write("float32 way  # [m]\nstd_msgs/Bool is_open\n", "Mine")
    assert main(["list", "--path", "src"]) == 0
    names = capsys.readouterr().out.splitlines()
    assert names == sorted(names)
    assert {"my_msgs/msg/Mine", "sensor_msgs/msg/Imu"} <= {*names}
    assert main(["show", "my_msgs/msg/Mine", "--path", "src"]) == 0
    assert capsys.readouterr() == ("float32 way  # [m]\nstd_msgs/Bool is_open\n\tbool data\n", "")


def test_plan_is_printed_as_yaml(workdir, capsys):
    options = ["--distro", "noetic", "--bus-bytes", "16", "--max-message-bytes", "0x400"]
    assert main(["plan", "sensor_msgs/Imu", *options]) == 0
    message = firm_hdl.load_message("sensor_msgs/Imu", distro="noetic")
    plan = build_plan(lay_out(message), bus_bytes=16, max_message_bytes=1024)
    assert capsys.readouterr().out == to_yaml(plan)
    assert main(["plan", "sensor_msgs/Imu", *options, "--program"]) == 0
    assert capsys.readouterr().out == program_text(plan)


def test_services_and_actions_stand_for_all_their_messages(workdir, capsys):
    for name, text in {"srv/Ask.srv": "int8 a\n---\n", "action/Go.action": "---\n---\n"}.items():
        path = Path("src/my_msgs", name)
        path.parent.mkdir(parents=True)
        path.write_text(text)
    options = ["--distro", "humble", "--path", "src"]
    assert main(["list", *options]) == 0
    assert {"my_msgs/srv/Ask", "my_msgs/action/Go"} <= {*capsys.readouterr().out.splitlines()}
    assert main(["show", "my_msgs/srv/Ask", *options]) == 0
    assert capsys.readouterr().out == "int8 a\n---\n"
    library = firm_hdl.Library("humble", ["src"])
    for name in ("my_msgs/srv/Ask", "my_msgs/action/Go"):
        messages = library.interface(name).messages
        assert main(["plan", name, *options]) == 0
        plans = [to_yaml(build_plan(lay_out(message))) for message in messages]
        assert capsys.readouterr().out.split("---\n") == plans
        assert main(["info", name, *options]) == 0
        lines = capsys.readouterr().out.splitlines()
        heads = [line.split(" (CDR")[0] for line in lines if not line.startswith(" ")]
        assert heads.pop().startswith("next: ")
        assert heads == [message.name for message in messages]
    assert (
        main(["build", "my_msgs/srv/Ask", "my_msgs/srv/Ask_Request", "--jobs", "1", *options]) == 0
    )
    folders = sorted(path.name for path in Path("vhdl_out/humble").iterdir())
    assert folders == [f"my_msgs_srv_Ask_{part}_cdr_8" for part in ("Request", "Response")]
    assert main(["build", "my_msgs/srv/Aks", *options]) == 1
    assert capsys.readouterr().err == (
        "error: type 'Aks' is not defined in package 'my_msgs'; did you mean 'my_msgs/srv/Ask'?\n"
    )


def test_version(capsys):
    with pytest.raises(SystemExit) as caught:
        main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out == f"firm-hdl {firm_hdl.__version__}\n"
    command = [sys.executable, "-m", "firm_hdl", "--version"]
    assert subprocess.check_output(command, text=True) == f"firm-hdl {firm_hdl.__version__}\n"


def test_out_that_is_a_file_exits_1(workdir, capsys):
    (workdir / "out").write_text("not a folder")
    assert main(["build", "std_msgs/msg/Bool", "--out", "out"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error: 'out")
    assert err.count("\n") == 1
    assert (workdir / "out").read_text() == "not a folder"


# It builds before it fails, as the test above does.
@pytest.mark.thorough
@pytest.mark.skipif(os.name != "posix", reason="uses a folder that even root cannot write to")
def test_out_that_cannot_be_written_exits_1(workdir, capsys):
    assert main(["build", "std_msgs/msg/Bool", "--out", "/proc/self/out"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error: '/proc/self/out")
    assert err.count("\n") == 1


def test_reader_that_goes_away_is_no_traceback():
    command = [*COMMAND, "list"]
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "wb") as pipe:
        done = subprocess.run(
            command, stdout=pipe, stderr=subprocess.PIPE, env=ENVIRONMENT, check=False
        )
    assert (done.returncode, done.stderr) == (1, b"")


@pytest.mark.parametrize(
    "calls",
    [
        pytest.param(0, marks=pytest.mark.thorough),
        pytest.param(1, marks=pytest.mark.thorough),
        pytest.param(2, marks=pytest.mark.thorough),
        3,
    ],
)
def test_build_that_is_interrupted_leaves_whole_folders(workdir, capsys, monkeypatch, calls):
    # Each type takes two calls, one for each direction; the interrupt comes in one of them.
    module = importlib.import_module("firm_hdl.export.verilog.backend")
    left = iter(range(calls))
    convert = module.convert

    def interrupted(*args: Any, **options: Any) -> str:
        if next(left, None) is None:
            raise KeyboardInterrupt
        return convert(*args, **options)

    monkeypatch.setattr(module, "convert", interrupted)
    assert main(["build", "std_msgs/msg/Bool", "std_msgs/msg/Char", "--jobs", "1"]) == 130
    assert capsys.readouterr().err == "interrupted\n"
    assert [path.name for path in workdir.glob("vhdl_out/lyrical/*")] == [
        "std_msgs_msg_Bool_cdr_8"
    ] * (calls // 2)
    for path in workdir.glob("vhdl_out/lyrical/*"):
        listed = json.loads((path / "manifest.json").read_text())["files"]
        found = {each.relative_to(path).as_posix() for each in path.rglob("*") if each.is_file()}
        assert found == {*listed, "manifest.json"}
    assert not list(workdir.glob("vhdl_out/lyrical/.*"))
    # Converters that were not elaborated warn when they are collected.
    gc.collect(1)
