"""A type with `long double` before every command: read, and never put on a wire."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from firm_hdl.cli import main
from firm_hdl.verify.ts2 import system as ts2
from tests.tools import need
from tests.vhdl.ghdl import GHDL

from .frontend.workspace import make_files

TEXT = """\
module p { module msg {
  struct Wide {
    double a;
    long double b;
  };
}; };
"""
SERVICE = """\
module p { module srv {
  struct Ask_Request { sequence<long double> q; };
  struct Ask_Response { long double r[2]; };
}; };
"""
SENTENCE = (
    "field 'b' of p/msg/Wide is of type 'long double': systems do not agree about its bytes, so "
    "it cannot be put on a wire"
)
ERROR = f"""\
src/p/msg/Wide.idl:4:17: error: {SENTENCE}
    long double b;
                ^
"""
ARGUMENTS = ["--distro", "lyrical", "--path", "src"]


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    files = {
        "p/msg/Wide.idl": TEXT,
        "p/srv/Ask.idl": SERVICE,
        "p/msg/Good.msg": "int8 x\n",
        "p/msg/Msg.msg": "long double x\n",
    }
    make_files(tmp_path / "src", files)
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        status = main([arguments[0], *ARGUMENTS, *arguments[1:]])
        return status, *capsys.readouterr()

    return run


COMMANDS = [
    ("build", "--out", "out", "p/Good", "p/Wide"),
    ("plan", "p/Wide"),
    ("info", "p/Good", "p/Wide"),
    ("prove", "p/Good", "p/Wide"),
    ("cover", "p/Good", "p/Wide"),
]


@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda arguments: arguments[0])
def test_commands_that_need_bytes_refuse_it_with_its_position(run, arguments):
    assert run(*arguments) == (1, "", ERROR)
    assert not Path("out").exists()


def test_golden_plans_refuse_it(run):
    assert run("golden", "add", "golden", "p/Good", "p/Wide") == (1, "", ERROR)
    assert not Path("golden").exists()


def test_a_service_is_refused_with_all_that_is_wrong(run):
    status, out, err = run("build", "--out", "out", "p/srv/Ask")
    assert (status, out) == (1, "")
    errors = [line for line in err.splitlines() if "error" in line]
    of = "src/p/srv/Ask.idl:{}: error: field '{}' of p/srv/Ask_{} is of type 'long double'"
    assert [line.partition(": systems")[0] for line in errors] == [
        of.format("2:46", "q", "Request"),
        of.format("3:37", "r", "Response"),
    ]


@pytest.mark.parametrize("system", ["ts2", "ts3", "bench"])
def test_test_systems_do_not_judge_it(run, system):
    if system == "bench":
        need("GHDL", GHDL)
    status, out, err = run("verify", "--systems", system, "--jobs", "1", "p/Wide", "p/srv/Ask")
    assert (status, err) == (1, "")
    assert f"not judged: p/msg/Wide (lyrical), {system}, 8-byte bus: {SENTENCE}\n" in out
    assert out.count("not judged: p/") == 4  # With the request, the response and the event.
    assert out.endswith("no test was judged, so the run fails\n")
    assert "FAIL" not in out


def test_without_the_rule_a_test_system_would_fail(run, monkeypatch):
    # Without this rule, the check of layouts still refuses the type.
    monkeypatch.setattr(ts2, "refusals", lambda message: [])
    status, out, _ = run("verify", "--systems", "ts2", "--jobs", "1", "p/Wide")
    assert status == 1 and "FAIL p/msg/Wide" in out and SENTENCE in out


def test_it_is_listed_shown_and_hashed(run):
    assert "p/msg/Wide\n" in run("list")[1]
    assert run("show", "p/Wide") == (0, "float64 a\nlong double b\n", "")
    assert run("proto", "--no-quotes", "p/Wide") == (0, "a: 0.0\nb: 0.0\n\n", "")
    status, out, err = run("hash", "p/Wide")
    assert (status, err) == (0, "") and out.startswith("RIHS01_")


def test_metrics_give_the_figures_that_exist(run):
    status, out, err = run("metrics", "p/Wide", "p/Good", "--format", "json")
    assert (status, err) == (0, "")
    wide, good = json.loads(out)
    assert (wide["leaves"], wide["depth"], wide["features"]) == (2, 1, ["long_doubles"])
    assert {wide[name] for name in ("min_bytes", "max_bytes", "aligned", "shifting")} == {None}
    assert (wide["unsized"], good["unsized"], good["min_bytes"]) == (SENTENCE, "", 5)
    status, out, err = run("metrics", "p/Wide")
    assert (status, err) == (0, "")
    assert out.splitlines()[1].split()[3:] == ["2", "2", "0", *"-----", "long_doubles"]
    assert out.splitlines()[2] == f"p/msg/Wide has no sizes: {SENTENCE}"
    # Whichever row it is that has none.
    status, out, err = run("metrics", "p/Good", "p/Wide")
    assert out.splitlines()[3:] == [f"p/msg/Wide has no sizes: {SENTENCE}"]


def test_a_constant_is_built_as_a_number_without_bits(run):
    text = TEXT.replace("long double b;", "").replace(
        "struct",
        "module Wide_Constants { const long double X = 0.1; const double Y = 0.1; }; struct",
    )
    make_files(Path("src"), {"p/msg/Wide.idl": text})
    status, _, err = run("build", "--out", "out", "p/Wide")
    assert (status, err) == (0, "")
    (package,) = Path("out").glob("lyrical/*/vhdl/p_msg_wide_cdr_8_pkg.vhd")
    lines = [line.split("--")[0].strip() for line in package.read_text().splitlines()]
    assert "constant X : real := 0.1;" in lines and "constant Y : real := 0.1;" in lines
    names = [line.split()[1] for line in lines if line.startswith("constant")]
    assert "Y_BITS" in names and "X_BITS" not in names


def test_a_msg_has_no_such_type(run):
    status, out, err = run("show", "p/Msg")
    assert (status, out) == (1, "")
    assert err.startswith("src/p/msg/Msg.msg:1:1: error: 'long' is not a type")
