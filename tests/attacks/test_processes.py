"""Attacks that need a process of their own: its streams, its signals, its memory."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest

import firm_hdl
from tests.attacks.test_attacks import PYTHON
from tests.frontend.bombs import BOMBS
from tests.frontend.workspace import make_files

ROOT = Path(firm_hdl.__file__).parent.parent
START = "import sys; from firm_hdl.cli import main; sys.exit(main())"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}
MOST_SECONDS = 120


def run(*arguments, memory=None, shell="", cwd=None):
    """Run the command in a process; `shell` is what a shell does with it."""

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
    assert not PYTHON.search(done.stderr), done.stderr
    assert "Exception ignored" not in done.stderr
    assert done.returncode in (0, 1)


@pytest.mark.parametrize("module", ["firm_hdl.terminal", "firm_hdl.commands", "rosbags"])
def test_interrupt_while_it_starts_is_no_traceback(module):
    # As if somebody pressed Ctrl-C while a module is being imported.
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


def test_yosys_without_memory_says_how_much_it_needs(tmp_path):
    done = run("build", "std_msgs/msg/Bool", memory=3 << 30, cwd=tmp_path)
    assert done.returncode == 1
    assert "Yosys ran out of memory; it sets 4.1 GB of address space aside" in done.stderr
    assert not PYTHON.search(done.stderr), done.stderr
    assert not list(tmp_path.rglob("*.v"))


def test_what_explodes_is_refused_in_little_memory(tmp_path):
    files = {f"p/msg/T{n}.msg": "".join(f"T{n + 1} f{i}\n" for i in range(100)) for n in range(7)}
    make_files(tmp_path, {**files, "p/msg/T7.msg": "float64 x\n"})
    for command in ("show", "plan"):
        done = run(command, "p/T0", "--path", str(tmp_path), memory=1 << 30)
        assert done.returncode == 1
        assert done.stderr.startswith("error: p/msg/T"), done.stderr


@pytest.mark.parametrize("form", ["mcap of zstd", "mcap of many chunks", "compressed database"])
def test_recordings_that_expand_are_refused_in_little_memory_and_on_little_disk(tmp_path, form):
    bomb = BOMBS[form](tmp_path, 1 << 30)
    done = run("list", "--bag", str(bomb), memory=1 << 30, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.endswith("bytes come out of it when it is decompressed\n"), done.stderr


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
