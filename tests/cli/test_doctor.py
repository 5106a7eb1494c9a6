"""The command ``doctor``, and completion in a shell."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.test_cli import ENVIRONMENT

# A machine without ROS and with few programs.
BARE = {
    "FIRM_HDL_ROS2_WHEELS": "/none",
    "GHDL": "/none/ghdl",
    "AMENT_PREFIX_PATH": "",
    "ROS_PACKAGE_PATH": "",
    "CXX": "/none/g++",
}


def doctor(*words, **environment):
    return subprocess.check_output(
        [sys.executable, "-m", "firm_hdl", "doctor", *words],
        env={**ENVIRONMENT, **BARE, **environment},
        text=True,
    )


def test_the_doctor_says_what_is_here_and_how_to_get_the_rest(tmp_path):
    program = tmp_path / "iverilog"
    program.write_text("#!/bin/sh\necho 'Icarus Verilog version 99.9'\n")
    program.chmod(0o755)
    shutil.copy(program, tmp_path / "vvp")
    python = tmp_path / "python3"
    python.write_text("#!/bin/sh\necho 3.1\n")
    python.chmod(0o755)
    found = json.loads(doctor("--json", PATH=str(tmp_path), FIRM_HDL_ROS_PYTHON=str(python)))
    assert (found["command"], found["errors"]) == ("doctor", [])
    assert Path(found["documentation"]).read_text().startswith("# ")
    items = {each["name"]: each for each in found["items"]}
    assert items["Icarus Verilog"]["version"] == "version 99.9"
    assert "'/none/ghdl'" in items["GHDL"]["how"]
    assert "'/none/g++'" in items["C++ compiler"]["how"]
    assert items["nextpnr-ecp5 and ecppack"]["enables"].endswith("boards with ECP5")
    assert "apt install openfpgaloader" in items["openFPGALoader"]["how"]
    assert "apt install python3-genmsg" in items["genmsg"]["how"]
    assert "make oracles-ros2" in items["rosidl_parser-4.9"]["how"]
    assert "which is Python 3.1, and firm-hdl runs in" in items["rospy"]["how"]
    assert items["rtps"]["is_here"] and items["firm-hdl"]["is_here"]
    for each in found["items"]:
        assert each["is_here"] == (each["version"] is not None)
        assert each["enables"] and (each["is_here"] or each["how"])


@pytest.mark.thorough
def test_the_doctor_finds_rospy_outside_of_the_environment(tmp_path):
    (tmp_path / "rospy.py").write_text("")
    python = tmp_path / "python3"
    python.write_text(f'#!/bin/sh\nPYTHONPATH={tmp_path} exec {sys.executable} "$@"\n')
    python.chmod(0o755)
    text = doctor(FIRM_HDL_ROS_PYTHON=str(python))
    assert f"{python} -m venv --system-site-packages DIR" in text


def in_bash(script):
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    command = ["bash", "--norc", "-c", script]
    return subprocess.check_output(command, env={**ENVIRONMENT, "PATH": path}, text=True)


def completed(code, *words):
    """What bash completes, after some code was run."""
    line = " ".join(words)
    return in_bash(
        f"{code}\nCOMP_WORDS=({line}) COMP_CWORD={len(words) - 1} COMP_LINE='{line}' COMP_TYPE=9\n"
        f'COMP_POINT={len(line)}; _python_argcomplete firm-hdl; echo "${{COMPREPLY[*]}}"\n'
    ).split()


def test_bash_completes_commands_options_and_types():
    code = in_bash("firm-hdl --print-completion bash")
    assert completed(code, "firm-hdl", "bu") == ["build"]
    board = completed(code, "firm-hdl", "node", "build", "n.yaml", "--board", "ulx3s-1")
    assert board == ["ulx3s-12f"]
    words = completed(code, "firm-hdl", "build", "--with", "systemverilog,")
    assert "systemverilog,all" in words
    types = completed(code, "firm-hdl", "info", "--distro", "noetic", "sensor_msgs/Im")
    assert types == ["sensor_msgs/Image", "sensor_msgs/Imu"]
