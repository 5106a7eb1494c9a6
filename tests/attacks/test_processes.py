"""Attacks that need their own process: on its streams, by signals, and on its memory."""

from __future__ import annotations

import json
import os
import re
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer

import firm_hdl
from tests.attacks.test_attacks import INTERNAL_ERROR
from tests.frontend.workspace import make_files
from tests.recordings.bombs import BOMBS

ROOT = Path(firm_hdl.__file__).parent.parent
START = "import sys; from firm_hdl.cli import main; sys.exit(main())"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}
MOST_SECONDS = 120


def run(*arguments, memory=None, shell="", cwd=None):
    """Run the command in a process; `shell` has redirections or a pipe of a shell."""

    def limit() -> None:
        if memory is not None:
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))

    command = [sys.executable, "-c", START, *arguments]
    if shell:
        command = ["sh", "-c", f'"$@" {shell}', "sh", *command]
    return subprocess.run(
        command,
        env=ENVIRONMENT,
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=MOST_SECONDS,
        preexec_fn=limit,
        check=False,
    )


SHELLS = [">&-", "2>&-", ">&- 2>&-", "| head -c 1", ">/dev/full", "2>/dev/full", "<&-"]


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("arguments", "shell"),
    [
        *((["--help"], shell) for shell in SHELLS),
        (["list"], "| head -c 1"),
        (["list"], ">/dev/full"),
        (["list"], ">&-"),
        (["show", "nothing/msg/Here"], "2>&-"),
    ],
)
def test_streams_that_are_closed_or_full_are_no_traceback(arguments, shell):
    done = run(*arguments, shell=shell)
    assert not INTERNAL_ERROR.search(done.stderr), done.stderr
    assert "Exception ignored" not in done.stderr
    assert done.returncode in (0, 1)


@pytest.mark.parametrize("module", ["firm_hdl.terminal", "firm_hdl.cli.table", "rosbags"])
def test_interrupt_while_it_starts_is_no_traceback(module):
    # Ctrl-C while a module is being imported.
    hook = (
        "import os, signal, sys\n"
        "def look(event, arguments):\n"
        f"    if event == 'import' and arguments[0] == {module!r}:\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.addaudithook(look)\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", hook + START, "list"],
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
        timeout=MOST_SECONDS,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "interrupted\n")


# Runs command lines one by one; prints status and output of each, and the memory used so far.
MEASURED = """
import contextlib, io, json, resource, sys
from firm_hdl.cli import main
for line in json.loads(sys.argv[1]):
    out, error = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        status = main(line)
    # Its `ru_maxrss` is not less than that of the process of pytest, which it comes from.
    with open("/proc/self/status") as status_file:
        (own,) = (int(each.split()[1]) for each in status_file if each.startswith("VmHWM:"))
    kib = max(own, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
    print(json.dumps([line[0], status, out.getvalue() + error.getvalue(), kib]))
"""
LAID_OUT = (
    "p/msg/T0 has 100000000000000 fields when all messages in it are written out, and at most "
)
EXPLODES = {
    "show": "p/msg/T3 is shown in 2398979690 characters, which is more than 67108864",
    "proto": "p/msg/T3 has an example of 2598969490 characters, which is more than 268435456",
    "metrics": " 100000000000000 ",
    "list": "p/msg/T0\n",
    "hash": "RIHS01_",
    "info": LAID_OUT,
    "plan": LAID_OUT,
    "build": LAID_OUT,
    "verify": LAID_OUT,
}


def exploding():
    """Make eight types, each with 100 fields of the next."""
    texts = {f"T{n}": "".join(f"T{n + 1} f{i}\n" for i in range(100)) for n in range(7)}
    return {**texts, "T7": "float64 x\n"}


def explode(place, source, name, commands, before=""):
    lines = [
        [command, *([] if command == "list" else [name]), source, str(place)]
        + (["--systems", "ts1,ts2,ts3,bench"] if command == "verify" and source == "--path" else [])
        for command in commands
    ]
    done = subprocess.run(
        [sys.executable, "-c", before + MEASURED, json.dumps(lines)],
        env=ENVIRONMENT,
        cwd=place.parent,
        capture_output=True,
        text=True,
        timeout=MOST_SECONDS,
        check=True,
    )
    return [json.loads(line) for line in done.stdout.splitlines()]


@pytest.mark.parametrize("source", ["--path", pytest.param("--bag", marks=pytest.mark.thorough)])
def test_exploding_types_are_refused_with_count_and_limit_in_little_memory(tmp_path, source):
    texts = exploding()
    if source == "--path":
        place = make_files(tmp_path / "in", {f"p/msg/{n}.msg": t for n, t in texts.items()})
    else:
        place = tmp_path / "in"
        bar = "=" * 80
        sections = [f"{bar}\nMSG: p/{name}\n{text}" for name, text in texts.items()]
        with Writer(place, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            text, hashed = texts["T0"] + "".join(sections[1:]), "RIHS01_" + "0" * 64
            writer.add_connection("/t", "p/msg/T0", msgdef=text, rihs01=hashed)
    found = explode(place, source, "p/T0", EXPLODES)
    assert [command for command, *_ in found] == list(EXPLODES)
    for command, status, text, kib in found:
        assert EXPLODES[command] in text, (command, text)
        assert len(text.splitlines()) == 1 or command in ("metrics", "list"), (command, text)
        assert status == (command not in ("metrics", "list", "hash")), command
        assert kib < 200 * 1024, command


@pytest.mark.thorough
def test_used_memory_shows_in_the_measurement(tmp_path):
    place = make_files(tmp_path / "in", {"p/msg/A.msg": "int8 x\n"})
    ((*_, much),) = explode(place, "--path", "p/A", ["plan"], "hog = b'x' * (200 << 20)\n")
    assert much > 200 * 1024


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "form",
    [
        pytest.param("mcap of zstd", marks=pytest.mark.thorough),
        "mcap of many chunks",
        "compressed database",
    ],
)
def test_recordings_that_expand_are_refused_in_little_memory_and_on_little_disk(tmp_path, form):
    bomb = BOMBS[form](tmp_path, 1 << 30)
    done = run("list", "--bag", str(bomb), memory=1 << 30, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (1, "")
    reason = r"it (expands to|has a chunk of) more than \d+ bytes\n\Z"
    assert re.search(reason, done.stderr), done.stderr


def test_nothing_but_the_standard_library_is_imported_for_help():
    script = (
        "import sys\nfrom firm_hdl.cli import main\n"
        "try:\n    main([sys.argv[1]])\nexcept SystemExit:\n    pass\n"
        "print(sorted({name.partition('.')[0] for name in sys.modules}), file=sys.stderr)\n"
    )
    for argument in ("--help", "--version"):
        done = subprocess.run(
            [sys.executable, "-c", script, argument],
            env=ENVIRONMENT,
            capture_output=True,
            text=True,
            timeout=MOST_SECONDS,
            check=True,
        )
        for name in ("amaranth", "rosbags", "numpy", "yaml", "lark"):
            assert f"'{name}'" not in done.stderr
    assert done.stdout == f"firm-hdl {firm_hdl.__version__}\n"
