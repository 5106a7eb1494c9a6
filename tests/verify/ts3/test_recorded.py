"""TS3 with a result file: recorded correctly, resumed after a kill, and reported."""

from __future__ import annotations

import pytest

import firm_hdl.verify.ts3.acceptance as acceptance
from firm_hdl.cli import main
from firm_hdl.verify.results.file import read_results
from firm_hdl.verify.systems.options import CaseOptions
from tests.verify.judged import accept, assert_passed

pytestmark = pytest.mark.usefixtures("same_circuit")

FAST = ["--jobs", "1", "--cases", "3", "--reference", "none", "--distro", "humble"]


def verify(*arguments):
    return main(["verify", *FAST, *arguments])


def test_records_have_all_results():
    name = "std_msgs/msg/Header"
    record = accept("humble", name)
    assert assert_passed(record) >= 2 * record.cases
    assert record.test.key == "ts3 python humble std_msgs/msg/Header cdr/8 seed=0"
    assert record.cases and record.packets > record.cases and record.cycles > record.beats > 0
    assert record.written_by[0] == "rosbags"
    assert record.coverage.taken == record.coverage.possible > 0 and not record.coverage.missing
    assert min(record.seconds.generation, record.seconds.simulation, record.seconds.testing) > 0
    assert record.cpu_seconds > 0 and len(record.shape) == 16
    assert record.metrics["leaves"] == 3 and record.metrics["steps"] > 0
    assert record.command == "firm-hdl verify --distro humble --bus-bytes 8 --seed 0 " + name
    assert record.waveform_command == record.command.replace(name, f"--vcd waveforms {name}")


def test_wrong_answer_to_a_bare_string_is_found(monkeypatch):
    right = acceptance.bare_packets

    def wrong(plan, cases):
        # The packet of one case, with the expected packet of another.
        return [(cases[-1], packet) for _, packet in right(plan, cases)]

    monkeypatch.setattr(acceptance, "bare_packets", wrong)
    result = accept(
        "humble", "std_msgs/msg/String", CaseOptions(stalled=False, broken=False, seed=2)
    )
    assert any(failure.startswith("hardware: packet ") for failure in result.failures)


def test_failures_are_recorded_and_not_run_again(tmp_path, monkeypatch, capsys):
    path = tmp_path / "r.jsonl"
    decode = acceptance.decode
    monkeypatch.setattr(acceptance, "decode", lambda plan, packet: decode(plan, packet + bytes(99)))
    assert verify("--results", str(path), "std_msgs/Bool") == 1
    monkeypatch.undo()
    (record,) = read_results(path).records.values()
    assert "golden model" in record.verdict.failures[0]
    capsys.readouterr()
    # The fault is gone, but the file still has the old result.
    assert verify("--results", str(path), "std_msgs/Bool") == 1
    output = capsys.readouterr().out
    assert f"1 of 1 types have a result in {path}" in output and "0 of    1 types pass" in output


@pytest.mark.parametrize(
    "more", [[], pytest.param(["--simulator", "iverilog"], marks=pytest.mark.thorough)]
)
def test_waveforms_are_written(tmp_path, request, more):
    if more:
        request.getfixturevalue("iverilog")
    folder = tmp_path / "waves"
    assert verify("--vcd", str(folder), "--cases", "2", *more, "std_msgs/Bool") == 0
    names = sorted(path.name for path in folder.iterdir())
    assert names == [f"std_msgs_msg_Bool_cdr_8_run{number}.vcd" for number in (1, 2, 3)]
    assert "packets" in (folder / names[0]).read_text()


# Both are a sequence of elements with the same layout.
TWINS = ["geometry_msgs/msg/Point", "geometry_msgs/msg/Vector3"]


@pytest.mark.thorough
def test_same_circuits_are_simulated_once(tmp_path, capsys):
    path = tmp_path / "r.jsonl"
    assert verify("--results", str(path), "--share-circuits", *TWINS) == 0
    output = capsys.readouterr().out
    assert "1 of 2 types have the circuit of another, which was simulated" in output
    one, two = (
        next(r for r in read_results(path).records.values() if r.test.type == name)
        for name in TWINS
    )
    assert one.cycles and not one.same_as
    # The golden model was compared with the oracle for each.
    assert not two.cycles and two.cases and two.same_as == one.test.key and two.shape == one.shape


@pytest.mark.parametrize(
    ("arguments", "simulated"),
    [
        (["--all"], 1),
        pytest.param(["p/msg/A", "p/msg/B"], 2, marks=pytest.mark.thorough),
    ],
)
def test_all_types_share_circuits_and_those_with_a_name_do_not(tmp_path, arguments, simulated):
    (tmp_path / "p" / "msg").mkdir(parents=True)
    for name in "AB":
        (tmp_path / "p" / "msg" / f"{name}.msg").write_text(f"uint8 {name.lower()}\n")
    path = tmp_path / "r.jsonl"
    assert verify("--path", str(tmp_path), "--results", str(path), *arguments) == 0
    records = read_results(path).records.values()
    assert sum(record.cycles > 0 for record in records) == simulated
    assert sum(bool(record.same_as) for record in records) == 2 - simulated


def test_circuit_that_fails_fails_all_that_have_it(tmp_path, monkeypatch, capsys):
    path = tmp_path / "r.jsonl"
    monkeypatch.setattr(acceptance, "run_differences", lambda *given: ["hardware: no"])
    assert verify("--results", str(path), "--share-circuits", *TWINS) == 1
    assert "humble      0 of    2 types pass" in capsys.readouterr().out
