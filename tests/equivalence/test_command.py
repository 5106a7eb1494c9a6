"""The command ``firm-hdl prove``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from firm_hdl.cli import main
from firm_hdl.equivalence import Proof, Tools, command, tools
from firm_hdl.equivalence.command import Attempt, ProofTask
from firm_hdl.jobs import ToolError, programs

TASK = ProofTask(distro="lyrical", name="a/msg/B", direction="serializer")
EQUAL = Attempt(proof=Proof(result="equal", registers=1, claims=1, seconds=1.0))
UNEQUAL = Attempt(
    proof=Proof(
        result="unequal",
        differences=("output o is 0x1 in the RTLIL and 0x0 in the VHDL",),
        counterexample={"input i": 5},
        registers=1,
        claims=1,
        seconds=2.0,
    )
)


@pytest.mark.usefixtures("tools")
def test_both_converters_are_proved(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "std_msgs/msg/Bool", "--bus-bytes", "1"]) == 0
    lines = sorted(line[:9] + line.split("s  ")[1] for line in capsys.readouterr().out.splitlines())
    assert lines == [
        "equal    std_msgs/msg/Bool deserializer (lyrical, 1 bytes)",
        "equal    std_msgs/msg/Bool serializer (lyrical, 1 bytes)",
    ]


@pytest.mark.parametrize(
    ("attempt", "status"),
    [(EQUAL, 0), (UNEQUAL, 1), (Attempt(proof=None, problem="no"), 1)],
)
def test_status_says_whether_all_are_equal(
    attempt: Attempt,
    status: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(command, "find_tools", lambda: Tools(ghdl=(), yosys=()))
    monkeypatch.setattr(
        command, "run_tasks", lambda tasks, jobs: iter([(TASK, EQUAL), (TASK, attempt)])
    )
    assert command.run_proofs([TASK, TASK], 1, with_summary=True) == status
    out = capsys.readouterr().out
    assert f"{'2 equal' if status == 0 else '1 equal, 1 ' + attempt.result}" in out
    if attempt is UNEQUAL:
        assert "input i = 0x5" in out


def test_a_line_names_the_converter_and_what_is_wrong(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    other = replace(TASK, direction="deserializer", wire="ros1", bus_bytes=4)
    results = [(TASK, EQUAL), (other, UNEQUAL), (other, Attempt(proof=None, problem="no\nGHDL"))]
    monkeypatch.setattr(command, "find_tools", lambda: Tools(ghdl=(), yosys=()))
    monkeypatch.setattr(command, "run_tasks", lambda tasks, jobs: iter(results))
    assert command.run_proofs([TASK] * 3, 1, with_summary=False) == 1
    assert capsys.readouterr().out.splitlines() == [
        "equal        1.0 s  a/msg/B serializer (lyrical, 8 bytes)",
        "unequal      2.0 s  a/msg/B deserializer (lyrical, ros1, 4 bytes)",
        "    output o is 0x1 in the RTLIL and 0x0 in the VHDL",
        "    for",
        "    input i = 0x5",
        "failed              a/msg/B deserializer (lyrical, ros1, 4 bytes)",
        "    no",
        "    GHDL",
    ]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--max-message-bytes", "3"], "Maximum message size must be from 5 bytes"),
        (["std_msgs/msg/Boo"], "type 'Boo' is not defined"),
    ],
)
def test_nothing_is_proved_if_a_type_or_an_option_is_wrong(
    options: list[str],
    message: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    asked: list[object] = []
    monkeypatch.setattr(command, "run_proofs", lambda *given, **options: asked.append(given) or 0)
    assert main(["prove", "std_msgs/msg/Empty", "std_msgs/msg/String", *options]) == 1
    assert message in capsys.readouterr().err and asked == []


def test_missing_tools_are_named_with_the_command_that_installs_them(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(programs, "which", lambda name: None)
    monkeypatch.setattr(programs, "find_package", lambda name: None)
    tools.find_tools.cache_clear()
    try:
        assert main(["prove", "std_msgs/msg/Bool"]) == 1
    finally:
        tools.find_tools.cache_clear()
    stderr = capsys.readouterr().err
    assert "GHDL is not installed" in stderr and "apt install ghdl-mcode" in stderr
    assert "pip install 'firm-hdl[prove]'" in stderr


@pytest.mark.usefixtures("tools")
def test_yosys_is_made_ready_before_any_proof(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    runs = []

    def run(command: object, timeout: float) -> str:
        runs.append((command, timeout))
        raise ToolError("it is broken")

    monkeypatch.setattr(programs, "run_tool", run)
    monkeypatch.setattr(programs, "find_package", lambda name: object())
    tools.find_tools.cache_clear()
    try:
        assert main(["prove", "std_msgs/msg/Bool", "std_msgs/msg/Int8"]) == 1
    finally:
        tools.find_tools.cache_clear()
    assert capsys.readouterr().err == "error: Yosys failed: it is broken\n"
    # The first run compiles WebAssembly for a minute or more, if Yosys is that of YoWASP.
    ((command_line, timeout),) = runs
    assert "native_yosys.py" in command_line[-2]
    assert (command_line[-1], timeout) == ("-V", 3600.0)


def test_unknown_types_are_an_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "std_msgs/msg/Boo"]) == 1
    assert "did you mean" in capsys.readouterr().err


def test_type_that_cannot_be_built_is_a_failure() -> None:
    attempt = command.attempt(ProofTask(distro="lyrical", name="no/msg/T", direction="serializer"))
    assert attempt.result == "failed"
    assert "no/msg/T" in attempt.problem or "package 'no'" in attempt.problem


def test_type_that_is_too_large_is_a_failure(tmp_path: Path) -> None:
    (tmp_path / "big_msgs" / "msg").mkdir(parents=True)
    fields = "".join(f"uint8[] f{k}\n" for k in range(120))
    (tmp_path / "big_msgs" / "msg" / "Big.msg").write_text(fields)
    task = replace(TASK, name="big_msgs/msg/Big", paths=(str(tmp_path),), bus_bytes=64)
    assert "Amaranth elaborates at most 65535" in command.attempt(task).problem
