"""Records, counts and commands of TS2, and files that are no golden plans."""

from __future__ import annotations

import pytest

from firm_hdl import load_message
from firm_hdl.cli import main
from firm_hdl.plan import build_plan
from firm_hdl.verify.results.file import read_results
from firm_hdl.verify.results.records import Test
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import Trial
from firm_hdl.verify.ts2 import system as ts2
from firm_hdl.verify.ts2.golden import add
from firm_hdl.wire import lay_out
from tests.frontend.workspace import make_files

STRING, TWIST = "std_msgs/msg/String", "geometry_msgs/msg/Twist"


def checked(name, *, wire=None, bus_bytes=8):
    test = Test(system="ts2", distro="lyrical", type=name, bus_bytes=bus_bytes)
    with Trial.of(test) as trial:
        ts2.check_plan(load_message(name), wire, trial)
    return trial.end()


def test_the_wire_that_was_asked_for_reaches_the_plans(tmp_path, capsys):
    shapes = {}
    for wire in ("cdr", "ros1"):
        path = tmp_path / f"{wire}.jsonl"
        call = ["verify", "--systems", "ts2", "--wire", wire, "--results", str(path)]
        assert main([*call, "--distro", "lyrical", "--jobs", "1", STRING]) == 0
        (record,) = read_results(path).records.values()
        assert (record.test.wire, record.test.bus_bytes) == (wire, 8)
        assert record.command.endswith(f"--wire {wire} --bus-bytes 8 {STRING}")
        shapes[wire] = record.shape
    assert shapes == {wire: checked(STRING, wire=wire).shape for wire in shapes}


def test_a_type_counts_for_each_distribution_that_has_the_same(capsys):
    """It is planned once. Circuits of plans that failed do not count."""
    assert main(["verify", "--systems", "ts2", "--jobs", "1", STRING]) == 0
    lines = capsys.readouterr().out.splitlines()
    counted = [line.split()[:4] for line in lines if "plans are sound" in line]
    assert counted == [[distro, "1", "of", "1"] for distro, *_ in counted] and len(counted) > 5
    assert lines[-1].endswith(" different circuits")


def test_a_golden_plan_may_be_of_any_distribution_that_has_the_same_type(tmp_path, capsys):
    folder = str(tmp_path / "golden")
    for distro in ("kilted", "lyrical"):
        assert main(["golden", "add", folder, STRING, "--distro", distro]) == 0
    call = ["verify", "--systems", "ts2", "--golden", folder, "--jobs", "1"]
    for more, count in (([], 2), (["--distro", "kilted"], 1)):
        capsys.readouterr()
        assert main([*call, *more, STRING]) == 0
        assert f"golden plans: {count} compared, 0 differ\n" in capsys.readouterr().out
    # None is of this type, so nothing was judged.
    assert main([*call, TWIST]) == 1
    out = capsys.readouterr().out
    assert "golden plans: 0 compared, 0 differ\n" in out
    assert f"not judged: golden plans of {folder}, ts2: none of them is of a type that was" in out


def test_the_folder_of_golden_plans_is_an_option_of_the_run_and_of_the_command(tmp_path, capsys):
    folder, path = str(tmp_path / "golden"), tmp_path / "r.jsonl"
    for given in (None, folder):
        assert ts2.Ts2([], Request(golden=given)).options == {"golden": given}
    assert main(["golden", "add", folder, STRING]) == 0
    call = ["verify", "--systems", "ts2", "--distro", "lyrical", "--jobs", "1", STRING]
    assert main([*call, "--golden", folder, "--results", str(path)]) == 0
    plan, compared = read_results(path).records.values()
    again = f"firm-hdl verify --systems ts2 --distro lyrical --golden {folder} {STRING}"
    assert (plan.command.count("--golden"), compared.command) == (0, again)
    # A run without them goes on with another file.
    assert main([*call, "--results", str(path)]) == 1
    assert "is of another run" in capsys.readouterr().err


@pytest.fixture
def folder(tmp_path):
    """A folder with one golden plan."""
    message = load_message(STRING)
    add(tmp_path, "lyrical", message, build_plan(lay_out(message)))
    return tmp_path


def test_a_file_that_is_no_text_is_an_error(folder, capsys):
    (path,) = folder.glob("*/*.yaml")
    path.write_bytes(path.read_bytes() + b"# \xff\n")
    assert main(["golden", "check", str(folder)]) == 1
    assert capsys.readouterr().err == f"error: '{path}' is not UTF-8 text\n"


def test_a_plan_without_a_field_of_its_type_has_no_reason_to_be_accepted(tmp_path, capsys):
    """A type that is refused today has no plan, and keeps the file."""
    own = ["--path", str(make_files(tmp_path / "src", {"p/msg/A.msg": "int8 x\n"}))]
    where = str(tmp_path / "golden")
    assert main(["golden", "add", where, "p/msg/A", *own]) == 0
    (path,) = (tmp_path / "golden").glob("*/*.yaml")
    before = path.read_text()
    make_files(tmp_path / "src", {"p/msg/A.msg": "int8[ x\n"})
    assert main(["golden", "accept", where, *own]) == 1
    assert path.read_text() == before
    assert f"not accepted: {path}\n" in capsys.readouterr().err
