"""What is asked of the libraries that are timed, and whose answer is whose; none of them runs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from firm_hdl.bench import BenchError
from firm_hdl.bench.software import fastcdr, python
from firm_hdl.bench.software.cpp import cpp_types
from firm_hdl.bench.software.fastcdr import fastcdr_versions, time_fastcdr
from firm_hdl.bench.software.python import genpy_versions, time_genpy, time_rosbags
from firm_hdl.bench.software.sample import Sample, Timed
from firm_hdl.frontend import load_message
from firm_hdl.jobs import ProgramMissingError, ToolError, programs
from firm_hdl.model import Message


@pytest.fixture(autouse=True)
def fresh_caches() -> Iterator[None]:
    """Empty caches of found tools, before and after the test."""
    found = (fastcdr_versions, genpy_versions, fastcdr._compiler)
    for each in found:
        each.cache_clear()
    yield
    for each in found:
        each.cache_clear()


@pytest.fixture
def run_tool(monkeypatch: pytest.MonkeyPatch) -> list[Sequence[str]]:
    """Commands of a compiler that is not there; the program takes 200.5 ns and 100.25 ns."""
    commands: list[Sequence[str]] = []

    def answer(command: Sequence[str], folder: Path) -> str:
        if "-E" in command:
            assert (folder / command[-1]).read_text().split()[::2] == ["fastcdr", "compiler"]
            return '# 1 "a.cpp"\n\nfastcdr "2.2.5"\ncompiler "12.2.0 20220101"\n'
        commands.append(command)
        if "-lfastcdr" in command:
            assert "using Root = " in (folder / "message.h").read_text()
            return ""
        assert (folder / "packets").read_bytes() == b"\5\0\0\0\0\1\0\0\1\5\0\0\0\0\1\0\0\0"
        return "a remark\n200.5\n100.25\n"

    monkeypatch.setattr(fastcdr, "run_tool", answer)
    monkeypatch.setattr(programs, "which", lambda name: f"/bin/{name}")
    return commands


BOOLS = Sample(
    message=load_message("std_msgs/msg/Bool"),
    wire="cdr",
    packets=(b"\0\1\0\0\1", b"\0\1\0\0\0"),
)


def test_versions_are_those_of_fast_cdr_and_of_its_compiler(run_tool: object) -> None:
    assert fastcdr_versions() == {
        "Fast CDR": "2.2.5",
        "g++ -std=c++17 -O2": "12.2.0 20220101",
    }


def test_fast_cdr_reads_in_the_first_time_and_writes_in_the_second(
    run_tool: list[Sequence[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CXX", "clang++")
    found = time_fastcdr(BOOLS, 3, 0.5)
    assert found == Timed(deserialize=200.5, serialize=100.25)
    compile_, program = run_tool
    assert compile_[:3] == ["/bin/clang++", "-std=c++17", "-O2"]
    assert list(program[1:]) == ["packets", "3", "0.5"]


def test_without_a_setting_the_compiler_is_that_of_gnu(
    run_tool: list[Sequence[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("CXX", raising=False)
    time_fastcdr(BOOLS, 1, 0.0)
    assert run_tool[0][0] == "/bin/g++"


def test_a_message_without_fields_is_an_octet_in_cpp() -> None:
    text = cpp_types(Message(name="p/msg/Empty", dialect="ros2", fields=()))
    for line in ("  uint8_t f0{};", "  cdr << message.f0;", "  cdr >> message.f0;"):
        assert text.splitlines().count(line) == 1


def test_reading_takes_packets_and_writing_takes_messages(monkeypatch: pytest.MonkeyPatch) -> None:
    def best_ns(work: Any, items: Sequence[Any]) -> float:
        assert len(items) == 2
        return 1.0 if all(isinstance(item, bytes) for item in items) else 2.0

    monkeypatch.setattr(python, "best_ns", best_ns)
    assert time_rosbags(BOOLS) == Timed(deserialize=1.0, serialize=2.0)


ROS1 = Sample(
    message=load_message("std_msgs/Bool", distro="noetic"), wire="ros1", packets=(b"\1", b"\xff")
)


@pytest.fixture
def genpy(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """The process with genpy: ``answer`` or ``stderr`` is set, ``request`` is seen."""
    process: dict[str, Any] = {"answer": {}, "stderr": ""}

    def run(command: Sequence[str], **_: object) -> str:
        process["request"] = json.loads(Path(command[-1]).read_text())
        if process["stderr"]:
            raise ToolError(process["stderr"])
        return json.dumps(process["answer"])

    monkeypatch.setattr(python, "run_tool", run)
    return process


def test_genpy_gets_the_definition_and_the_packets(genpy: dict[str, Any]) -> None:
    genpy["answer"] = {"deserialize": 3.0, "serialize": 4.0, "versions": {}}
    assert time_genpy(ROS1) == Timed(deserialize=3.0, serialize=4.0)
    request = genpy["request"]
    assert (request["name"], request["packets"]) == ("std_msgs/Bool", ["\1", "\xff"])
    assert request["text"].split()[-2:] == ["bool", "data"]


def test_wrong_bytes_of_genpy_have_no_figure(genpy: dict[str, Any]) -> None:
    genpy["answer"] = {"wrong": "it is another packet", "versions": {}}
    with pytest.raises(BenchError, match=r"^genpy, std_msgs/Bool: it is another packet$"):
        time_genpy(ROS1)


def test_a_process_with_genpy_that_fails_says_why_in_its_last_line(genpy: dict[str, Any]) -> None:
    genpy.update(stderr="Traceback\nKeyError: 'x'\n")
    with pytest.raises(BenchError, match=r"^genpy failed: .*KeyError: 'x'"):
        time_genpy(ROS1)


def test_genpy_that_is_not_installed_has_no_version(genpy: dict[str, Any]) -> None:
    genpy["answer"] = {"missing": "No module named 'genpy'"}
    with pytest.raises(
        ProgramMissingError,
        match=r"^genpy cannot be used: No module named 'genpy' \(Debian: python3-genpy\)$",
    ):
        genpy_versions()
    genpy["answer"] = {"versions": {"genpy": "0.6", "its Python": "3.11"}}
    assert genpy_versions() == {"genpy": "0.6", "its Python": "3.11"}
