"""The program that calls Fast CDR: when it is compiled, where it is kept, and how it is asked.

Neither a compiler nor Fast CDR is needed: scripts of this test take their places.
"""

from __future__ import annotations

import stat
import sys
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from firm_hdl.jobs.processes import ToolError
from firm_hdl.model import IDL_PRIMITIVES, Field, Message, Sequence, String, idl_primitives
from firm_hdl.verify.references import fastcdr as module
from firm_hdl.verify.references.client import ClientDiedError, Refusal, UnsupportedError
from firm_hdl.verify.ros2_wheels import Release
from tests.strategies import make

COMPILER = """#!/bin/sh
echo "$@" >> {folder}/calls
case " $* " in *" -E "*) cat {folder}/macros; exit 0;; esac
while [ "$1" != -o ]; do shift; done
echo program > "$2"
"""
MACROS = """#define __VERSION__ "12.2.0"
#define OTHER 1
#define FASTCDR_VERSION_STR "1.0.24"
"""


def executable(file, text):
    file.write_text(text)
    file.chmod(stat.S_IRWXU)
    return file


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a compiler that only notes how it is called."""
    monkeypatch.setenv("CXX", str(executable(tmp_path / "c++", COMPILER.format(folder=tmp_path))))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "macros").write_text(MACROS)
    return tmp_path


def compilations(folder):
    return [line for line in (folder / "calls").read_text().splitlines() if "-E " not in line]


def test_the_program_is_compiled_once_and_kept(folder):
    program = module._compiled(None)
    assert program.parent == folder / "cache" / "firm-hdl" / "programs"
    assert program.read_text() == "program\n"
    assert module._compiled(None) == program
    (call,) = compilations(folder)
    assert call.startswith("-std=c++14 -O1 -o ") and call.endswith("fastcdr_worker.cpp -lfastcdr")
    # Nothing else is left beside it.
    assert list(program.parent.iterdir()) == [program]


def test_another_version_source_or_compiler_makes_another_program(folder, monkeypatch):
    programs = [module._compiled(None)]
    for old, new in (("1.0.24", "1.0.25"), ("12.2.0", "13.1.0")):
        (folder / "macros").write_text((folder / "macros").read_text().replace(old, new))
        programs.append(module._compiled(None))
    # The source has the same name, and other content.
    (folder / module._SOURCE.name).write_bytes(module._SOURCE.read_bytes() + b"\n")
    monkeypatch.setattr(module, "_SOURCE", folder / module._SOURCE.name)
    programs.append(module._compiled(None))
    other = executable(folder / "clang++", (folder / "c++").read_text())
    monkeypatch.setenv("CXX", str(other))
    programs.append(module._compiled(None))
    assert len({*programs}) == len(compilations(folder)) == 5
    # Macros without a version do not count, nor does their order.
    lines = [*(folder / "macros").read_text().splitlines(), "#define MORE 2"]
    (folder / "macros").write_text("\n".join(reversed(lines)))
    assert module._compiled(None) == programs[-1]


def test_a_release_is_compiled_with_its_own_headers_and_library(folder, monkeypatch):
    monkeypatch.setenv("FIRM_HDL_ROS2_WHEELS", str(folder))
    release = Release(name="mine", rosidl="5.0", fastcdr="9.9")
    (folder / "mine" / "include" / "fastcdr").mkdir(parents=True)
    # The system has the headers, but this release has none.
    with pytest.raises(ToolError, match=r"^Fast CDR 9\.9 is not installed \(make oracles-ros2"):
        module._compiled(release)
    (folder / "mine" / "include" / "fastcdr" / "Cdr.h").touch()
    system, own = module._compiled(None), module._compiled(release)
    assert system != own
    call = compilations(folder)[-1]
    home = folder / "mine"
    assert f" -I{home}/include -o " in call
    assert call.endswith(f"-L{home}/lib -lfastcdr -Wl,-rpath,{home}/lib")
    found = (folder / "calls").read_text().splitlines()[-2]
    assert found.startswith(f"-I{home}/include -E -dM -include fastcdr/Cdr.h")


@pytest.mark.parametrize("macros", ["", '#define __VERSION__ "12.2.0"\n'])
def test_without_the_headers_nothing_is_compiled(folder, macros):
    (folder / "macros").write_text(macros)
    with pytest.raises(ToolError, match=r"^Fast CDR's headers are not installed \(Debian"):
        module._compiled(None)
    assert not compilations(folder)


def test_a_compiler_that_writes_nothing_has_failed(folder):
    (folder / "c++").write_text(COMPILER.format(folder=folder).replace("echo program", ": no"))
    executable(folder / "c++", (folder / "c++").read_text().replace('> "$2"', ""))
    with pytest.raises(ToolError, match="did not write program"):
        module._compiled(None)
    assert list((folder / "cache" / "firm-hdl" / "programs").iterdir()) == []


# The program itself.

PROGRAM = """#!{python}
import os, struct, sys

def item(data, refused=0):
    return struct.pack("<BI", refused, len(data)) + data

def say(answer):
    sys.stdout.buffer.write(struct.pack("<I", len(answer)) + answer)
    sys.stdout.buffer.flush()

say(item(b"1.2.3"))
types = []
while size := sys.stdin.buffer.read(4):
    request = sys.stdin.buffer.read(struct.unpack("<I", size)[0])
    if request[:1] == b"T":
        types.append(request[1:])
        say(b"")
        continue
    count, at, answers = struct.unpack_from("<I", request, 1)[0], 5, []
    for _ in range(count):
        size = struct.unpack_from("<I", request, at)[0]
        data, at = request[at + 4 : at + 4 + size], at + 4 + size
        if data == b"die":
            os._exit(1)
        answers.append(item(b"it is n\\xff", 1) if data == b"no" else
                       item(request[:1] + data + b" " + b"|".join(types)))
    assert at == len(request)
    say(b"".join(answers))
"""


@pytest.fixture
def program(tmp_path):
    """A program that answers with what it was asked, and with all types that it has got."""
    file = executable(tmp_path / "program", PROGRAM.format(python=sys.executable))
    with closing(module._Program(Path(file))) as found:
        yield found


def test_all_is_asked_at_once_and_types_are_sent_when_they_change(program):
    assert program.version == "1.2.3"
    assert program.ask("a\n", b"E", [b"x", b"", b"yz"]) == [b"Ex a\n", b"E a\n", b"Eyz a\n"]
    assert program.ask("a\n", b"D", [b"x"]) == [b"Dx a\n"]
    assert program.ask("b\n", b"D", [b"x"]) == [b"Dx a\n|b\n"]
    assert program.ask("a\n", b"D", [b"x"]) == [b"Dx a\n|b\n|a\n"]
    assert program.ask("a\n", b"D", []) == []
    first, refused, last = program.ask("a\n", b"E", [b"x", b"no", b"y"])
    assert (first[:2], last[:2]) == (b"Ex", b"Ey")
    assert isinstance(refused, Refusal) and str(refused) == "it is n\N{REPLACEMENT CHARACTER}"


def test_a_program_that_dies_is_started_again_and_gets_its_types_again(program):
    first = program._process
    assert program.ask("a\n", b"E", [b"x"]) == [b"Ex a\n"]
    with pytest.raises(ClientDiedError, match=r"^the program that calls Fast CDR died$"):
        program.ask("a\n", b"E", [b"die"])
    assert first.returncode is not None
    assert program.ask("a\n", b"E", [b"x"]) == [b"Ex a\n"]
    program.close()
    assert program._process is None
    program.close()


@pytest.mark.parametrize("text", ["exit 0", "printf '\\3\\0\\0\\0abc'", "printf '\\1'"])
def test_a_program_that_does_not_say_what_it_is_cannot_be_used(tmp_path, text):
    file = executable(tmp_path / "program", f"#!/bin/sh\n{text}\n")
    with pytest.raises(ToolError, match="does not say what it is"):
        module._Program(file)


def test_types_are_described_with_the_types_that_they_need(make_message):
    message = make_message(
        "B b\nbool t\nbyte[3] y\nstring<=4 s\nwstring[] w\nB[<=5] many\nfloat32 f\nfloat64[2] d\n"
        "C c\n",
        B="int8 a\nuint16 b\nint32 c\nuint64 d\nchar e\n",
        C="",
    )
    *needed, own = module._described(message).splitlines()
    numbers = {text: number for number, text in enumerate(needed)}
    assert set(numbers) == {"b H i Q B", ""}
    b, c = numbers["b H i Q B"], numbers[""]
    assert own == f"m{b} ? a3:B t s0:w s5:m{b} f a2:d m{c}"


def test_wide_characters_are_of_one_size(monkeypatch):
    two = idl_primitives(2)["wchar"]
    fields = (Field(name="s", type=String()), Field(name="w", type=Sequence(element=two)))
    message = Message(name="p/msg/W", dialect="ros2", fields=fields)
    assert module._described(message) == "t s0:W\n"
    for kind, size in ((module.FastCdr, 4), *((newer, 2) for newer in module.NEWER)):
        assert kind.wchar_bytes == size
        monkeypatch.setattr(kind, "_program", None)
        if size == 2:
            assert kind().open(message, "cdr") is not None
            continue
        with pytest.raises(UnsupportedError, match="of 4 bytes, not 2"):
            kind().open(message, "cdr")
    assert [kind.name for kind in module.NEWER] == ["fastcdr-2.2", "fastcdr-2.3"]


def test_numbers_that_fast_cdr_is_not_asked_about():
    long_double = IDL_PRIMITIVES["long double"]
    with pytest.raises(UnsupportedError, match="is not asked about long double"):
        module._integer(long_double)
    # A number is not asked about because of its size, but because of what it is.
    half = replace(IDL_PRIMITIVES["float32"], name="float16", bytes=2)
    for kind in (long_double, half, IDL_PRIMITIVES["bool"], IDL_PRIMITIVES["float64"]):
        with pytest.raises(UnsupportedError, match=f"is not asked about {kind.name}$"):
            module._integer(kind)
    assert module._described(make("ros2", {"a": "uint8"})) == "B\n"
