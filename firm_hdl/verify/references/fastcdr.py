"""eProsima Fast CDR, which writes and reads the messages of ROS 2's default middleware.

``fastcdr_worker.cpp`` receives the description of a type, and calls the library for each field of
the type. So no code is compiled for a type. The program is compiled for each release of Fast CDR
when it is first needed, and kept in the user's cache folder. Debian has the Fast CDR of ROS 2
humble. Newer releases come from PyPI, and the names of their clients end in their versions.
"""

from __future__ import annotations

import os
import struct
import subprocess
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import ClassVar

from firm_hdl.cases.values import Plain, packed, unpacked
from firm_hdl.jobs.caches import kept_program
from firm_hdl.jobs.processes import ToolError, hang_up, made_by, run_tool, start_program
from firm_hdl.jobs.programs import ProgramMissingError, find_compiler
from firm_hdl.model import Array, FieldType, Message, Primitive, String, closure
from firm_hdl.model import Sequence as SequenceType
from firm_hdl.verify.references.client import (
    Client,
    ClientDiedError,
    Codec,
    Refusal,
    UnsupportedError,
)
from firm_hdl.verify.ros2_wheels import RELEASES, Release
from firm_hdl.wire import Wire

__all__ = ["NEWER", "FastCdr"]

_SOURCE = Path(__file__).with_name("fastcdr_worker.cpp")
_HOW = "(Debian, Ubuntu: apt install g++ libfastcdr-dev)"
_CODES = {"bool": "?", "float32": "f", "float64": "d", "wchar": "W"}


class FastCdr(Client):
    """Fast CDR as ROS 2's type support calls it."""

    name: ClassVar[str] = "fastcdr"
    wires: ClassVar = frozenset({"cdr"})
    byte_orders = ("little", "big")
    may_confirm = True
    # The ROS release whose environment has the library; `None`: the system has it.
    release: ClassVar[Release | None] = None
    wchar_bytes: ClassVar[int] = 4  # How many bytes the library writes for a wide character.

    @cached_property
    def _program(self) -> _Program:
        return _Program(_compiled(self.release))

    @cached_property
    def _why_not(self) -> str | None:
        try:
            _ = self._program
        except ToolError as error:
            return str(error)
        return None

    def missing(self) -> str | None:
        return self._why_not

    def version(self) -> str:
        return self._program.version

    def open(self, message: Message, wire: Wire) -> Codec:
        types = _described(message)
        for size in _wchar_sizes(message) - {self.wchar_bytes}:
            raise UnsupportedError(
                f"{self.name} has wide characters of {self.wchar_bytes} bytes, not {size}"
            )
        return _FastCdrCodec(self._program, message, types)

    def close(self) -> None:
        if "_program" in self.__dict__:
            self._program.close()
            del self._program


class _FastCdrCodec(Codec):
    def __init__(self, program: _Program, message: Message, types: str):
        self._program = program
        self._message = message
        self._types = types

    def encode_all(self, values: Sequence[Plain]) -> list[bytes | Refusal]:
        items = [packed(self._message, value) for value in values]
        return self._program.ask(self._types, b"E", items)

    def decode_all(self, packets: Sequence[bytes]) -> list[Plain | Refusal]:
        answers = self._program.ask(self._types, b"D", packets)
        return [
            each if isinstance(each, Refusal) else unpacked(self._message, each) for each in answers
        ]


def _newer() -> Iterator[type[FastCdr]]:
    for release in RELEASES:
        members = {
            "__doc__": FastCdr.__doc__,
            "name": f"fastcdr-{release.fastcdr}",
            "release": release,
            "wchar_bytes": 2,
        }
        yield type(f"FastCdr_{release.name}", (FastCdr,), members)


NEWER = tuple(_newer())
"""Clients for the releases that PyPI has, oldest first."""


def _wchar_sizes(message: Message) -> set[int]:
    kinds = [item.element_type for each in closure([message]) for item in each.fields]
    return {kind.bytes for kind in kinds if isinstance(kind, Primitive) and kind.name == "wchar"}


def _described(message: Message) -> str:
    """Describe a type in the form that the program reads."""
    kinds = closure([message])
    lines = {kind.name: number for number, kind in enumerate(kinds)}

    def word(kind: FieldType) -> str:
        match kind:
            case Message():
                return f"m{lines[kind.name]}"
            case String(wide=wide):
                return "w" if wide else "t"
            case Array():
                return f"a{kind.count}:{word(kind.element)}"
            case SequenceType():
                return f"s{kind.bound or 0}:{word(kind.element)}"
            case Primitive():
                return _CODES.get(kind.name) or _integer(kind)

    return "".join(" ".join(word(item.type) for item in kind.fields) + "\n" for kind in kinds)


def _integer(kind: Primitive) -> str:
    code = {1: "b", 2: "h", 4: "i", 8: "q"}.get(kind.bytes)
    if code is None or kind.kind != "int":
        raise UnsupportedError(f"fastcdr is not asked about {kind.name}")
    return code if kind.signed else code.upper()


class _Program:
    """The running program, which is started again after it died."""

    def __init__(self, file: Path):
        self._file = file
        self._process: subprocess.Popen[bytes] | None = None
        self._types = ""
        self.version = ""
        self._start()

    def _start(self) -> None:
        # The program ends at the end of its input, and not on Ctrl-C.
        self._process = start_program([str(self._file)], stdin=subprocess.PIPE)
        self._types = ""
        try:
            self.version = str(_text(self._read()))
        except (struct.error, ValueError):
            self.close()
            raise ToolError("the program that calls Fast CDR does not say what it is") from None

    def ask(self, types: str, what: bytes, items: Sequence[bytes]) -> list[bytes | Refusal]:
        """Ask for all items at once."""
        try:
            if self._process is None:
                self._start()
            if types != self._types:
                list(self._exchange(b"T" + types.encode("ascii")))
                self._types = types
            sized = b"".join(struct.pack("<I", len(item)) + item for item in items)
            answers = list(self._exchange(what + struct.pack("<I", len(items)) + sized))
        except (OSError, ToolError, struct.error):
            self.close()
            raise ClientDiedError("the program that calls Fast CDR died") from None
        return answers

    def _exchange(self, request: bytes) -> Iterator[bytes | Refusal]:
        assert self._process is not None and self._process.stdin is not None
        self._process.stdin.write(struct.pack("<I", len(request)) + request)
        self._process.stdin.flush()
        return _items(self._read())

    def _read(self) -> bytes:
        assert self._process is not None and self._process.stdout is not None
        (size,) = struct.unpack("<I", self._process.stdout.read(4))
        return self._process.stdout.read(size)

    def close(self) -> None:
        if self._process is None:
            return
        process, self._process = self._process, None
        # Kill the program at once: it needs no clean-up, and would not see the end of its input
        # if a forked process holds the input open.
        hang_up(process)


def _items(answer: bytes) -> Iterator[bytes | Refusal]:
    at = 0
    while at < len(answer):
        refused, size = struct.unpack_from("<BI", answer, at)
        at += 5 + size
        data = answer[at - size : at]
        yield Refusal(data.decode("utf-8", "replace")) if refused else data


def _text(answer: bytes) -> str:
    (item,) = _items(answer)
    return item.decode() if isinstance(item, bytes) else ""


def _compiled(release: Release | None) -> Path:
    """Return the program; compile it if it is not in the cache.

    * `release`: the ROS release whose Fast CDR is used; `None`: that of the system.

    Raises `ToolError` if the program cannot be compiled; the text says what is missing and how to
    install it.
    """
    try:
        compiler = find_compiler("Fast CDR")
    except ProgramMissingError as error:
        raise ToolError(str(error)) from None
    how = _HOW if release is None else release.how
    where: list[str] = []
    link = ["-lfastcdr"]
    if release is not None:
        home = os.path.abspath(release.folder)
        where = [f"-I{home}/include"]
        link = [f"-L{home}/lib", *link, f"-Wl,-rpath,{home}/lib"]
        if not os.path.exists(f"{home}/include/fastcdr/Cdr.h"):
            # The compiler might find headers of another version in the system.
            raise ToolError(f"Fast CDR {release.fastcdr} is not installed {how}")
    found = _found_headers([*compiler, *where])
    if "FASTCDR" not in found:
        raise ToolError(f"Fast CDR's headers are not installed {how}")
    command = [*compiler, "-std=c++14", "-O1", *where]

    def compiled(folder: Path) -> Path:
        program = folder / "program"
        run_tool([*command, "-o", str(program), str(_SOURCE), *link], folder)
        return made_by(command[0], program)

    return kept_program(
        "fastcdr", [_SOURCE.read_text(encoding="utf-8"), *command, *link, found], compiled
    )


def _found_headers(compiler: Sequence[str]) -> str:
    """Return the versions of the compiler and of the Fast CDR it finds; empty without them."""
    try:
        said = run_tool(
            [*compiler, "-E", "-dM", "-include", "fastcdr/Cdr.h", "-x", "c++", os.devnull],
            with_errors=False,
        )
    except (ToolError, OSError):
        return ""
    lines = said.splitlines()
    return "\n".join(
        sorted(line for line in lines if " FASTCDR_VERSION_" in line or " __VERSION__ " in line)
    )
