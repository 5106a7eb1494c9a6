"""Options: the names they accept, what follows from them, and the command that repeats a test."""

from __future__ import annotations

import shlex
import subprocess
import sys

import pytest

from firm_hdl.verify.references.clients import CLIENTS, WRITERS
from firm_hdl.verify.run import SYSTEMS
from firm_hdl.verify.simulators.programs import SIMULATORS
from firm_hdl.verify.systems import options as choices
from firm_hdl.verify.systems.options import Request, command_again
from firm_hdl.verify.ts1.oracles import ORACLES


@pytest.mark.parametrize(
    ("given", "named", "shares"),
    [
        ({}, False, True),
        ({"types": ("p/A",)}, True, False),
        ({"node": "node.yaml"}, True, True),
        ({"bags": ("run.bag",)}, False, False),
        ({"share_circuits": False}, False, False),
        ({"types": ("p/A",), "share_circuits": True}, True, True),
    ],
)
def test_what_is_named_has_to_be_judged_and_simulated(given, named, shares):
    request = Request(**given)
    assert (request.is_named, request.shares_circuits) == (named, shares)


def test_the_command_is_one_that_a_shell_reads_back():
    options = {"path": ("a b", "c"), "seed": 0, "wire": None, "no_stalls": True, "broken": False}
    text = command_again("p/A", "p/It's", **options)
    assert shlex.split(text) == [
        *("firm-hdl", "verify", "--path", "a b", "--path", "c", "--seed", "0", "--no-stalls"),
        *("p/A", "p/It's"),
    ]


def test_each_name_is_that_of_something():
    assert tuple(SYSTEMS) == choices.SYSTEM_NAMES
    assert tuple(ORACLES) == choices.ORACLE_NAMES
    assert tuple(SIMULATORS) == choices.SIMULATOR_NAMES
    assert tuple(CLIENTS) == choices.CLIENT_NAMES
    assert tuple(WRITERS) == choices.WRITER_NAMES


def test_a_type_that_no_wire_can_carry_is_refused_before_much_is_imported(tmp_path):
    package = tmp_path / "p"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>p</name></package>")
    for level in range(4):
        element = f"L{level + 1}" if level < 3 else "uint8"
        text = "".join(f"{element} f{n}\n" for n in range(100))
        (package / "msg" / f"L{level}.msg").write_text(text)
    # Modules stay imported, so a process for all commands sees what any of them imports.
    script = (
        "import sys\nfrom firm_hdl.cli import main\n"
        "for command in sys.argv[2:]:\n"
        "    print('asked:', command, file=sys.stderr)\n"
        "    status = main([*command.split(), '--path', sys.argv[1], 'p/L0'])\n"
        "    print(status, *sorted({'amaranth', 'numpy', 'jinja2'} & set(sys.modules)))\n"
    )
    commands = ("build", "info", "verify", "verify --systems ts1,ts2,ts3,bench")
    done = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path), *commands],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    for command, said in zip(commands, done.stderr.split("asked: ")[1:], strict=True):
        assert said.startswith(f"{command}\n")
        assert "p/msg/L0 has 100000000 fields" in said, command
    assert done.stdout == "1\n" * len(commands)
