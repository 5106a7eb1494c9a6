"""What a command passes on to its functions, and what it prints of their results."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from firm_hdl.cases.stimuli import stimuli
from firm_hdl.cli import main
from firm_hdl.errors import UserError
from firm_hdl.export.design import BuiltDesign
from firm_hdl.frontend import Library
from firm_hdl.identity.command import md5_lines
from firm_hdl.plan import build_plan
from firm_hdl.wire import lay_out
from tests.cli.test_cli import COMMAND, ENVIRONMENT
from tests.cli.test_declared import is_refused, parsed
from tests.frontend.recordings import make_recording
from tests.frontend.workspace import make_files

FILES = {
    "src/p/msg/A.msg": "uint8 a\nq/B b",
    "src/p/msg/Bad.msg": "uint8 a\nuint8 a",
    "src/p/msg/C.msg": "uint16 c",
    "more/q/msg/B.msg": "int16 b",
}
# Files of a user that made way for two generated ones, not in the order of their names.
KEPT = ("a.v", "vhdl/z.vhd")
TOLD = "".join(f"kept    there{os.sep}{name}, which you changed\n" for name in KEPT)


@pytest.fixture
def workdir(tmp_path, monkeypatch):
    monkeypatch.chdir(make_files(tmp_path, FILES))
    return tmp_path


# Limits of numbers, and their defaults; README.md and docs repeat some of them.
NUMBERS = {
    ("part", "fifo", "--memory-bytes"): (1, 65536, 1 << 20),
    ("part", "fifo", "--packets"): (1, 64, 4096),
    ("part", "gate", "--memory-bytes"): (1, 65536, 1 << 20),
    ("part", "crossing", "--beats"): (1, 16, 65536),
    ("part", "arbiter", "--inputs"): (1, 2, 64),
    ("part", "arbiter", "--side-bits"): (0, 0, 1024),
    ("part", "router", "--topics"): (1, 2, 64),
    ("part", "router", "--topic-bits"): (1, 16, 32),
    ("part", "router", "--side-bits"): (0, 0, 1024),
    ("node", "run", "--domain"): (0, None, 232),
    ("bench", "a/B", "--messages"): (1, 16, None),
    ("bench", "a/B", "--message-seed"): (0, 0, None),
}


@pytest.mark.parametrize("words", NUMBERS, ids=" ".join)
def test_numbers_are_accepted_up_to_both_limits(words, capsys):
    least, default, most = NUMBERS[words]
    *head, option = words
    head += {"gate": ["a/B"], "run": ["n.yaml"]}.get(words[1], [])
    name = option[2:].replace("-", "_")
    assert parsed(*head)[name] == default
    for number in (least, 1 << 40 if most is None else most):
        assert parsed(*head, f"{option}={number}")[name] == number
    for number in (least - 1, 1.5, "x", *([] if most is None else [most + 1])):
        assert is_refused(*head, f"{option}={number}")


def test_seconds_are_finite_and_above_zero(capsys):
    for text, number in (("0.25", 0.25), ("1e3", 1000.0), ("7", 7.0)):
        assert parsed("node", "run", "n.yaml", "--seconds", text)["seconds"] == number
    for text in ("0", "-1", "nan", "inf", "-inf", "", "x"):
        assert is_refused("node", "run", "n.yaml", f"--seconds={text}")


def test_choices_of_a_node_are_those_of_its_documentation(capsys):
    for option, values in (
        ("graph", ["ros2", "ros1", "rtps", "none"]),
        ("engine", ["auto", "verilator", "amaranth"]),
    ):
        for value in values:
            assert parsed("node", "run", "n.yaml", f"--{option}", value)[option] == value
        assert is_refused("node", "run", "n.yaml", f"--{option}", "other")


@pytest.mark.parametrize("command", ["md5", "hash", "proto", "metrics", "prove", "bench"])
def test_types_or_all_of_them_and_not_both(command, capsys):
    for words in ([], ["--all", "std_msgs/msg/Bool"]):
        with pytest.raises(SystemExit, match=r"^2$"):
            main([command, *words])
        out, err = capsys.readouterr()
        assert out == "" and err.endswith("error: name either types or --all\n")


@pytest.mark.parametrize("words", [["sh\0ow", "a/B"], ["show", "a/\0B"]])
def test_an_argument_with_a_nul_character_is_refused(words, capsys):
    with pytest.raises(SystemExit, match=r"^2$"):
        main(words)
    assert capsys.readouterr().err.endswith("error: an argument contains a NUL character\n")


@pytest.mark.parametrize("name", ["entity", "module", "2x", "a-b", "a b", ""])
def test_a_part_needs_a_name_that_is_one_in_vhdl_and_verilog(name, capsys):
    assert is_refused("part", "fifo", f"--name={name}")
    assert parsed("part", "fifo", "--name", "mine_2")["name"] == "mine_2"


def test_a_gate_gets_the_message_that_its_folders_define(workdir, monkeypatch):
    asked = []

    def make_part(kind, *, message, name, **given):
        asked.append((kind, message.name, given))
        raise UserError("enough")

    monkeypatch.setattr("firm_hdl.export.parts.make_part", make_part)
    words = ["--path", "src", "--depends", "more", "--wire", "ros1", "--bus-bytes", "4"]
    words += ["--max-message-bytes", "77", "--memory-bytes", "512", "--packets", "9"]
    assert main(["part", "gate", "p/A", *words, "--when-full", "drop"]) == 1
    given = {"wire": "ros1", "bus_bytes": 4, "max_message_bytes": 77}
    given |= {"memory_bytes": 512, "packets": 9, "when_full": "drop", "side_bits": 0}
    assert asked == [("gate", "p/msg/A", given)]


def test_a_node_is_built_with_its_options_and_summed_up(monkeypatch, capsys):
    asked = []
    monkeypatch.setattr("firm_hdl.node.read_description", lambda file, paths: (file, paths))
    monkeypatch.setattr("firm_hdl.node.summary.summary", lambda description: f"of {description}")

    def build_node(description, out, *, force, stimuli, datasheet, ip):
        asked.append((description, out, force, datasheet, ip))
        packets.extend(stimuli(message, plan))
        return BuiltDesign(folder=Path("there"), was_current=force, kept=KEPT)

    message, packets = Library("lyrical", []).message("std_msgs/msg/Bool"), []
    plan = build_plan(lay_out(message))
    monkeypatch.setattr("firm_hdl.node.build.build_node", build_node)
    assert main(["node", "build", "n.yaml"]) == 0
    assert capsys.readouterr().out == f"wrote   there\n{TOLD}of ('n.yaml', [])\n"
    options = ["--path", "a", "--out", "x", "--force", "--datasheet", "--ip", "vivado"]
    assert main(["node", "build", "n.yaml", *options]) == 0
    assert capsys.readouterr().out == f"current there\n{TOLD}of ('n.yaml', ['a'])\n"
    asked_first, asked_then = asked
    assert asked_first == (("n.yaml", []), "node_out", False, False, None)
    assert asked_then == (("n.yaml", ["a"]), "x", True, True, "vivado")
    assert packets == stimuli(message, plan) * 2


@pytest.mark.parametrize("command", ["md5", "hash", "proto", "metrics"])
def test_good_types_are_printed_before_the_error_of_another(workdir, capsys, command):
    words = ["--path", "src", *(["--distro", "noetic"] if command == "md5" else [])]
    assert main([command, "p/C", *words]) == 0
    good = capsys.readouterr().out
    assert main([command, "p/Bad", "p/C", *words]) == 1
    out, err = capsys.readouterr()
    assert out == good and len(out) > 5
    assert err.startswith("src/p/msg/Bad.msg:2:7: error: field 'a' is already declared in line 1\n")


def test_the_example_of_the_only_type_of_all_has_its_name(workdir, capsys):
    for name in ("A", "Bad"):
        (workdir / f"src/p/msg/{name}.msg").unlink()
    assert main(["proto", "p/C", "--path", "src"]) == 0
    text = capsys.readouterr().out
    assert main(["proto", "--all", "--path", "src"]) == 0
    assert capsys.readouterr().out == f"# p/msg/C\n{text}"


def test_all_of_a_recording_are_its_types(workdir, capsys):
    bag = make_recording(workdir, "bag")
    assert main(["md5", "--all", "--bag", str(bag)]) == 0
    names = [line.split()[-1] for line in capsys.readouterr().out.splitlines()]
    assert sorted(names) == ["my_msgs/Spot", "my_msgs/Wheel", "std_msgs/Header", "std_msgs/String"]
    library = Library("noetic", [])
    assert md5_lines(library, ["std_msgs/String"])[0][0].split()[-1] in names


def test_figures_of_all_are_those_of_the_folders(workdir, capsys):
    (workdir / "src/p/msg/Bad.msg").unlink()
    words = ["--path", "src", "--depends", "more", "--format", "csv", "--wire", "ros1"]
    assert main(["metrics", "--all", *words]) == 0
    rows = capsys.readouterr().out.splitlines()
    named = {name for row in rows for name in row.split(",") if name.count("/") == 2}
    assert named == {"p/msg/A", "p/msg/C"}
    assert all(",ros1," in row for row in rows[1:])


def test_a_process_without_standard_streams_runs(monkeypatch):
    monkeypatch.setattr(sys, "stdout", None)
    monkeypatch.setattr(sys, "stderr", None)
    assert main(["show", "std_msgs/msg/Bool"]) == 0
    assert main(["show", "std_msgs/msg/Bol"]) == 1


def test_a_terminal_without_a_character_gets_its_code(workdir, monkeypatch):
    (workdir / "src/p/msg/C.msg").write_text("uint16 c  # 1 µm\n", encoding="utf-8")
    here = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(here, encoding="ascii"))
    assert main(["show", "p/C", "--path", "src"]) == 0
    assert here.getvalue() == b"uint16 c  # 1 \\xb5m\n"


@pytest.mark.parametrize("words", [["--help"], ["show", "std_msgs/msg/Bool"]])
def test_a_full_disk_is_no_traceback(words):
    if not os.path.exists("/dev/full"):
        pytest.skip("there is no full device here")
    # Without a buffer, argparse itself ignores that its help cannot be written.
    environment = {**ENVIRONMENT, "PYTHONUNBUFFERED": ""}
    with open("/dev/full", "wb") as full:
        done = subprocess.run(
            [*COMMAND, *words], stdout=full, stderr=subprocess.PIPE, env=environment, check=False
        )
    assert (done.returncode, done.stderr) == (1, b"error: No space left on device\n")
