"""No text of a definition and no file name can control the terminal."""

from __future__ import annotations

import fcntl
import io
import os
import pty
import struct
import subprocess
import sys
import termios
from contextlib import suppress
from pathlib import Path

import pytest

from firm_hdl.cli import main
from firm_hdl.errors import Diagnostic, Source, Span
from firm_hdl.terminal import printable, printable_streams

CONTROL_CHARACTERS = [
    chr(code) for code in (*range(32), 127, *range(128, 160)) if chr(code) not in "\t\n"
]


def test_control_characters_are_escaped_and_letters_are_not():
    # Separators of lines and paragraphs, and all that changes the direction of writing.
    others = [*range(0x2028, 0x202F), *range(0x2066, 0x206A)]
    for character in (*CONTROL_CHARACTERS, *map(chr, others)):
        assert printable(f"a{character}b") == f"a{ascii(character)[1:-1]}b"
    for text in (
        "\u2027\u202f\u2065\u206a",
        "grün 雪 \N{SNOWFLAKE} שלום\t\n",
        "caf\u0065\u0301",
        "\U0001f916",
    ):
        assert printable(text) == text


def package(folder: Path, name: str, text: str) -> Path:
    here = folder / "my_msgs" / "msg"
    here.mkdir(parents=True)
    (here.parent / "package.xml").write_text("<package format='3'><name>my_msgs</name></package>")
    (here / f"{name}.msg").write_text(text, encoding="utf-8", newline="")
    return folder


@pytest.mark.parametrize("character", ["\x1b", "\x07", "\x9b", "\x08", "\u202e"])
def test_no_command_prints_control_characters(tmp_path, capsys, character):
    bad = f"{character}[2J"
    folder = package(tmp_path / f"x{bad}y", "Wheel", f"# grün{bad}\nint8 a # b{bad}\n")
    output = ""
    for command in ("show", "proto", "hash", "info", "plan", "list"):
        types = [] if command == "list" else ["my_msgs/msg/Wheel"]
        assert main([command, *types, "--path", str(folder)]) == 0
        output += "".join(capsys.readouterr())
    assert "grün" in output
    (folder / "my_msgs" / "msg" / "Wheel.msg").write_text(f"int8 a{bad}\nint9 b # é{bad}\n")
    for types in (["my_msgs/msg/Wheel"], [f"my_msgs/msg/{bad}"], ["my_msgs/msg/Whee"]):
        assert main(["show", *types, "--path", str(folder)]) == 1
        output += "".join(capsys.readouterr())
    assert main(["show", "a/msg/B", "--path", str(tmp_path / bad)]) == 1
    with pytest.raises(SystemExit):
        main([bad])
    output += "".join(capsys.readouterr())
    assert ascii(character)[1:-1] in output
    assert not {*output} & {*CONTROL_CHARACTERS, "\u202e"}


def test_streams_are_restored_afterwards(capsys):
    before = sys.stdout, sys.stderr
    with printable_streams():
        print("\x1b[2J")
        print("\rbar \x1b[2J", file=sys.stderr)
        print("\x1b[A\x1b[2J", end="", file=sys.stderr)
        print("\rno bar\x1b[A", end="")
        # A carriage return moves the cursor only where a text of standard error starts with it.
        print("a\rb", file=sys.stderr)
        sys.stdout.writelines(["\x07\n"])
    assert (sys.stdout, sys.stderr) == before
    assert capsys.readouterr() == (
        "\\x1b[2J\n\\rno bar\\x1b[A\\x07\n",
        "\rbar \\x1b[2J\n\\x1b[A\\x1b[2Ja\\rb\n",
    )


def test_streams_are_restored_after_an_error():
    before = sys.stdout, sys.stderr
    with pytest.raises(KeyError), printable_streams():
        raise KeyError
    assert (sys.stdout, sys.stderr) == before


def test_caret_stands_below_the_marked_text():
    source = Source(name="a\x1bb.msg", text="\x1b\tint9 b\x07 c")
    span = Span(source=source, start=2, end=9)
    assert str(Diagnostic(message="no\x1b", span=span)).splitlines() == [
        "a\\x1bb.msg:1:3: error: no\\x1b",
        "\\x1b\tint9 b\\x07 c",
        "    \t^^^^^^^^^^",
    ]


def on_terminal(code, **streams):
    """What a program shows on a terminal of 80 columns."""
    here, there = pty.openpty()
    fcntl.ioctl(there, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    streams = {"stdout": there, "stderr": there, **streams}
    subprocess.run([sys.executable, "-c", code], **streams, check=True)
    os.close(there)
    output = ""
    with io.FileIO(here) as terminal, suppress(OSError):
        # Reading after the other side has closed raises an error.
        while part := terminal.read(4096):
            output += part.decode()
    return output


PROGRESS = """
import time
from firm_hdl import terminal
terminal.SECONDS_UNTIL_SHOWN = terminal.SECONDS_BETWEEN = 0.01
with terminal.printable_streams(), terminal.progress("build"):
    time.sleep(0.5)
    terminal.stage("more\x1b", 0, 4)
    terminal.stage("more\x1b", 3, 4)
    time.sleep(0.5)
    print("a line")
"""


def test_what_takes_long_is_told_on_a_terminal_and_gives_way_to_what_is_printed():
    output = on_terminal(PROGRESS)
    assert (
        output.startswith("\rbuild, 0 s")
        and "\rmore\\x1b: 3 of 4, " in output
        and " s left" in output
    )
    before, line, after = output.partition("a line\r\n")
    assert line and before.endswith(" \r")
    # What was shown after it was taken away, too.
    assert not after or after.endswith(" \r")


def test_what_takes_long_is_not_told_in_a_file_or_beside_a_pipe():
    done = subprocess.run([sys.executable, "-c", PROGRESS], capture_output=True, check=True)
    assert (done.stdout, done.stderr) == (b"a line\n", b"")
    assert on_terminal(PROGRESS, stdout=subprocess.PIPE) == ""
