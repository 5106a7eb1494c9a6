"""Arguments of each command: their names, their defaults, and their limits.

The table repeats the promises of the documentation by hand. A new option must be added to it.
"""

from __future__ import annotations

import argparse
from functools import cache

import pytest

from firm_hdl.cli import _parser, main, parser_of_all
from firm_hdl.cli.table import COMMANDS
from firm_hdl.errors import UserError
from firm_hdl.export.options import EXTRAS

ORIGINS = {"distro": None, "path": [], "bag": [], "depends": []}
PLAN = {"wire": None, "bus_bytes": 8, "max_message_bytes": 16 << 20}
# For each command: its required arguments, and all values that the parser gives for them.
DEFAULTS = {
    "build": (
        ["a/B"],
        {**ORIGINS, **PLAN, "types": ["a/B"], "out": "vhdl_out"}
        | {"ports": "records", "extras": frozenset(), "force": False, "jobs": None}
        | {"datasheet": False, "registers": False, "ip": None, "leaf_ports": None},
    ),
    "list": ([], {**ORIGINS, "only_path": False, "as_json": False}),
    "show": (["a/B"], {**ORIGINS, "type": "a/B"}),
    "plan": (["a/B"], {**ORIGINS, **PLAN, "type": "a/B", "program": False}),
    "info": (["a/B"], {**ORIGINS, **PLAN, "types": ["a/B"], "as_json": False}),
    "part": (
        ["gate", "a/B"],
        {**ORIGINS, **PLAN, "kind": "gate", "type": "a/B", "name": None, "force": False}
        | {"memory_bytes": 65536, "packets": 64, "when_full": "wait", "side_bits": 0}
        | {"out": "parts_out"},
    ),
    "node": (
        ["run", "n.yaml"],
        {"action": "run", "file": "n.yaml", "path": []}
        | {"board": "sim", "graph": None, "domain": None, "interface": None}
        | {"seconds": None, "engine": "auto", "quiet": False, "wave": None, "phc": None},
    ),
    "board": (
        ["init", "kria"],
        {**ORIGINS, "action": "init", "board": "kria", "file": None, "out": None},
    ),
    "doctor": ([], {"as_json": False}),
    "md5": ([], {**ORIGINS, "types": [], "all": False}),
    "hash": ([], {**ORIGINS, "types": [], "all": False}),
    "proto": ([], {**ORIGINS, "types": [], "all": False, "no_quotes": False}),
    "metrics": (
        [],
        {**ORIGINS, "types": [], "all": False, "format": None, "wire": None, "as_json": False},
    ),
    "verify": (
        [],
        {"types": [], "all": False, "distro": None, "path": [], "depends": [], "bag": []}
        | {"systems": None, "wire": None, "bus_bytes": None, "seed": 0, "jobs": None}
        | {"oracle": [], "golden": None, "simulator": "python", "cases": None}
        | {"stalls": True, "broken": True, "share_circuits": None, "vcd": None}
        | {"max_message_bytes": None, "sut": [], "reference": [], "results": None}
        | {"report": None, "board": None, "node": None}
        | {"write_node": None, "engine": "auto", "silent_seconds": None, "as_json": False},
    ),
    "report": (
        ["r.jsonl"],
        {"results": ["r.jsonl"], "out": None, "format": None, "title": "Verification of firm-hdl"},
    ),
    "prove": (
        [],
        {**ORIGINS, **PLAN, "types": [], "all": False, "jobs": None, "timeout": 300},
    ),
    "bench": (
        [],
        {
            **ORIGINS,
            "types": [],
            "all": False,
            "jobs": None,
            "wire": None,
            "bus_bytes": None,
            "direction": None,
            "device": "ecp5",
            "seeds": [1, 2, 3],
            "mapping": "",
            "messages": 16,
            "message_seed": 0,
            "json": None,
            "compare": None,
            "threshold": 2.0,
            "cache": None,
        },
    ),
    "golden": (
        ["check", "plans"],
        {**ORIGINS, **PLAN, "do": "check", "folder": "plans", "types": []},
    ),
    "cover": (
        [],
        {**ORIGINS, **PLAN, "types": [], "out": None, "check": None},
    ),
}
INTERNAL = ("command", "run", "refuse", "usage_error", "default_of", "version")


@cache
def parser_of(command):
    """Return the parser, which knows the arguments of one command."""
    return _parser([command])


def parsed(*words):
    given = vars(parser_of(words[0]).parse_args(words))
    assert callable(given["run"])
    return {
        name: list(value) if isinstance(value, tuple) else value
        for name, value in given.items()
        if name not in INTERNAL
    }


def is_refused(*words):
    with pytest.raises(SystemExit) as caught:
        parser_of(words[0]).parse_args(words)
    return caught.value.code == 2


def test_other_actions_of_a_node_have_these_defaults():
    info = {"action": "info", "file": "n.yaml", "path": []}
    assert parsed("node", "info", "n.yaml") == {**info, "as_json": False, "members": False}
    new = {**info, "action": "new", "language": None, "ports": None}
    assert parsed("node", "new", "n.yaml") == new
    build = {**info, "action": "build", "out": "node_out", "force": False, "datasheet": False}
    assert parsed("node", "build", "n.yaml") == {
        **build,
        "sim": False,
        "engine": "auto",
        "target": None,
        "ip": None,
    }
    assert is_refused("node", "info", "n.yaml", "--board", "sim")


def test_every_command_is_in_the_table():
    assert {*DEFAULTS} == {*COMMANDS}


@pytest.mark.parametrize("command", DEFAULTS)
def test_arguments_have_these_defaults(command):
    words, expected = DEFAULTS[command]
    assert parsed(command, *words) == expected


PARTS = {
    "fifo": ({"bus_bytes": 8, "memory_bytes": 65536, "packets": 64, "when_full": "wait"}, []),
    "width": ({"in_bytes": 2, "out_bytes": 4}, ["--in-bytes", "2", "--out-bytes", "4"]),
    "crossing": ({"bus_bytes": 8, "beats": 16}, []),
    "arbiter": ({"bus_bytes": 8, "inputs": 2}, []),
    "router": ({"bus_bytes": 8, "topics": 2, "topic_bits": 16}, []),
}
PARTS = {kind: (numbers | {"side_bits": 0}, needed) for kind, (numbers, needed) in PARTS.items()}
OTHERS = {"when_full": "drop", "bus_bytes": 4, "in_bytes": 8, "out_bytes": 1}


@pytest.mark.parametrize("kind", PARTS)
def test_every_option_of_a_part_reaches_its_component(kind, monkeypatch):
    defaults, needed = PARTS[kind]
    asked = []

    def make_part(kind, *, message, name, **given):
        asked.append((kind, name, given))
        raise UserError("enough")

    monkeypatch.setattr("firm_hdl.export.parts.make_part", make_part)
    assert main(["part", kind, *needed]) == 1
    changed = {name: OTHERS.get(name, 7) for name in defaults}
    options = [f"--{name.replace('_', '-')}={value}" for name, value in changed.items()]
    assert main(["part", kind, *needed, *options, "--name", "mine"]) == 1
    assert asked == [(kind, None, defaults), (kind, "mine", changed)]


@pytest.mark.parametrize("kind", PARTS)
def test_a_part_of_any_packets_has_no_origins_of_types(kind, capsys):
    defaults, needed = PARTS[kind]
    others = {"kind": kind, "name": None, "out": "parts_out", "force": False}
    assert parsed("part", kind, *needed) == {**defaults, **others}
    for option in ("--distro=noetic", "--path=x", "--bag=x", "--depends=x"):
        assert is_refused("part", kind, *needed, option)
        assert is_refused("part", option, kind, *needed)
    assert is_refused("part", "--path=x", "gate", "a/B")


@pytest.mark.parametrize("command", [name for name, (words, _) in DEFAULTS.items() if words])
def test_required_arguments_are_required(command, capsys):
    assert is_refused(command, *DEFAULTS[command][0][:-1])
    assert "required" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["--window-words", "2"], ["--window-words=1"], ["--window"]])
@pytest.mark.parametrize("command", ["build", "plan", "info"])
def test_an_option_that_is_gone_is_refused_with_the_reason(command, words, capsys):
    assert is_refused(*words_of(command, *words))
    err = capsys.readouterr().err
    assert f"{command}: error: argument --window-words: there is no such option any more: " in err
    assert "--window-words" not in err.partition("error: ")[0]
    assert is_refused("prove", *words)


@pytest.mark.parametrize("command", ["list", "show", "plan"])
def test_one_argument_too_many_is_refused(command, capsys):
    assert is_refused(command, *DEFAULTS[command][0], "more")


def commands_with(option):
    return [name for name, (_, expected) in DEFAULTS.items() if option in expected]


def words_of(command, *more):
    return [command, *DEFAULTS[command][0], *more]


@pytest.mark.parametrize("option", ["path", "bag", "depends"])
def test_options_of_origins_accumulate(option):
    for command in commands_with(option):
        given = parsed(*words_of(command, f"--{option}", "x", f"--{option}", "y"))
        assert given[option] == ["x", "y"]


def test_folders_exclude_recordings(capsys):
    for command in commands_with("bag"):
        if command != "verify":
            assert is_refused(*words_of(command, "--path", "x", "--bag", "y"))
    assert is_refused("cover", "--out", "x", "--check", "y")


@pytest.mark.parametrize(
    ("option", "good", "bad"),
    [
        ("wire", ["ros1", "cdr"], ["ROS1", ""]),
        ("distro", "noetic foxy humble iron jazzy kilted lyrical".split(), ["rolling"]),
        ("bus_bytes", ["1", "2", "4", "8", "16", "32", "64"], ["0", "3", "128", "-8"]),
        ("max_message_bytes", ["1", str((1 << 32) - 1)], ["0", str(1 << 32), "-1", "", "1.5"]),
        ("jobs", ["1", "1000"], ["0", "-1", "x"]),
        ("timeout", ["1", "9999999"], ["0", "-1"]),
        ("cases", ["1", "1000000"], ["0", "-1"]),
        ("ports", ["records", "flat"], ["vectors"]),
        ("format", [], ["xml"]),
        ("simulator", ["python", "ghdl", "iverilog", "verilator"], ["vcs"]),
        ("systems", ["ts1", "ts1,ts2,ts3"], ["ts9", ""]),
        ("seed", ["0", "12345"], ["x"]),
    ],
)
def test_limits_of_options(option, good, bad, capsys):
    commands = commands_with(option)
    if option == "max_message_bytes":
        commands.remove("verify")
    assert commands
    for command in commands:
        for text in good:
            given = parsed(*words_of(command, f"--{option.replace('_', '-')}", text))[option]
            given = given[-1] if isinstance(given, list) and option != "systems" else given
            expected = text.split(",") if option == "systems" else text
            assert given == (int(text) if text.isdecimal() else expected)
        for text in bad:
            assert is_refused(*words_of(command, f"--{option.replace('_', '-')}={text}"))


def test_an_extra_that_does_not_exist_is_named(capsys):
    assert is_refused("build", "a/B", "--with", "tools,tool")
    said = "'tool' is not one of systemverilog, tools, documents, all"
    assert said in capsys.readouterr().err


def test_messages_of_a_recording_have_a_limit_of_their_own(capsys):
    for number in (1, (1 << 31) - 1):
        assert parsed("verify", "--max-message-bytes", str(number))["max_message_bytes"] == number
    for number in (0, 1 << 31):
        assert is_refused("verify", "--max-message-bytes", str(number))


@pytest.mark.parametrize(
    ("words", "name", "value"),
    [
        (["md5", "--all"], "all", True),
        (["proto", "--no-quotes"], "no_quotes", True),
        (["build", "a/B", "--force"], "force", True),
        (["build", "a/B", "--with", "tools,documents"], "extras", {"tools", "documents"}),
        (["build", "a/B", "--with", "all"], "extras", {*EXTRAS}),
        (["metrics", "--format", "json"], "format", "json"),
        (["metrics", "--format", "csv"], "format", "csv"),
        (["report", "a", "b", "--format", "md"], "results", ["a", "b"]),
        (["verify", "--no-stalls"], "stalls", False),
        (["verify", "--no-broken"], "broken", False),
        (["verify", "--share-circuits"], "share_circuits", True),
        (["verify", "--no-share-circuits"], "share_circuits", False),
        (["verify", "--bus-bytes", "4", "--bus-bytes", "8"], "bus_bytes", [4, 8]),
        (["verify", "--distro", "noetic", "--distro", "foxy"], "distro", ["noetic", "foxy"]),
        (["golden", "add", "plans", "a/B", "c/D"], "types", ["a/B", "c/D"]),
        (["plan", "a/B", "--max-message-bytes", "0x10"], "max_message_bytes", 16),
    ],
)
def test_options_set_their_values(words, name, value):
    assert parsed(*words)[name] == value


def test_help_says_which_types_all_are(capsys):
    which = "all types; with --path, all in those folders; with --bag, all in the recordings"
    for command in ("md5", "hash", "proto"):
        with pytest.raises(SystemExit):
            main([command, "--help"])
        assert which in " ".join(capsys.readouterr().out.split())


def test_commands_that_are_not_called_are_not_loaded():
    parser = _parser(["--version", "list", "show"])
    (group,) = [each for each in parser._actions if isinstance(each, argparse._SubParsersAction)]
    known = {name: len(sub._actions) > 1 for name, sub in group.choices.items()}
    assert [name for name, is_known in known.items() if is_known] == ["list"]


def test_the_reference_has_the_arguments_of_all_commands():
    parser = parser_of_all()
    (group,) = [each for each in parser._actions if isinstance(each, argparse._SubParsersAction)]
    assert all(len(sub._actions) > 1 for sub in group.choices.values())
