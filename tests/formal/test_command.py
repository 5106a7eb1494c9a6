"""The command: which proofs it runs, what it prints, and its exit status. No solver runs here."""

from __future__ import annotations

import pytest

from firm_hdl.formal import command
from firm_hdl.formal.run import all_proofs, prove, refute
from firm_hdl.formal.solve import Answer
from firm_hdl.jobs import ProgramMissingError

PROVED, BROKEN = Answer(result="proved"), Answer(result="broken", cycles=3, inputs="go@0 go@2")


@pytest.fixture
def asked(monkeypatch):
    """Return the questions to the solvers; they find that all holds, and every bug."""
    found: list[tuple[object, list[str], float, int]] = []

    def in_processes(work, tasks, jobs):
        keys = [key for key, _ in tasks]
        [timeout] = {timeout for key, (same, timeout) in tasks if key == same}
        found.append((work, keys, timeout, jobs))
        return ((key, PROVED if work is prove else BROKEN) for key in keys)

    monkeypatch.setattr(command, "in_processes", in_processes)
    monkeypatch.setattr(command, "find_tools", lambda *, ghdl: None)
    return found


def answer(monkeypatch, proofs: Answer, twins: Answer) -> None:
    """Give an answer to each proof, and one to each twin."""
    monkeypatch.setattr(
        command,
        "in_processes",
        lambda work, tasks, jobs: (
            (key, proofs if work is command.prove else twins) for key, _ in tasks
        ),
    )


@pytest.mark.parametrize(
    ("options", "works"),
    [
        ([], [prove]),
        (["--twins"], [prove, refute]),
        (["--only-twins"], [refute]),
        (["--only-twins", "--twins"], [refute]),
    ],
)
def test_twins_come_after_the_proofs_or_alone(asked, options, works):
    assert command.main(["slice/order", *options]) == 0
    assert asked == [(work, ["slice/order"], 900.0, 2) for work in works]


def test_options_reach_the_solvers(asked):
    assert command.main(["slice/order", "--timeout", "7", "--jobs", "3"]) == 0
    assert asked == [(prove, ["slice/order"], 7.0, 3)]


def test_each_name_chooses_proofs_in_the_order_of_the_table(asked):
    assert command.main(["router/counters", "slice/*-moves", "nothing/*"]) == 0
    assert asked[0][1] == ["slice/input-moves", "slice/output-moves", "router/counters"]
    assert command.main([]) == 0
    assert asked[1][1] == list(all_proofs())


@pytest.mark.parametrize(
    ("proofs", "twins", "status"),
    [(PROVED, BROKEN, 0), (BROKEN, BROKEN, 1), (PROVED, PROVED, 1), (BROKEN, PROVED, 1)],
)
@pytest.mark.usefixtures("asked")
def test_proofs_and_twins_both_count(monkeypatch, proofs, twins, status):
    answer(monkeypatch, proofs, twins)
    assert command.main(["slice/order", "--twins"]) == status


@pytest.mark.usefixtures("asked")
def test_a_counterexample_is_shown_unless_a_twin_was_to_have_one(monkeypatch, capsys):
    answer(monkeypatch, BROKEN, BROKEN)
    command.main(["slice/order"])
    assert "3 cycles" in (shown := capsys.readouterr().out) and "go@0 go@2" in shown
    command.main(["slice/order", "--only-twins"])
    assert "3 cycles" in (shown := capsys.readouterr().out) and "go@0 go@2" not in shown
    failed = Answer(result="undecided", inputs="Yosys failed")
    answer(monkeypatch, failed, failed)
    for options in ([], ["--only-twins"]):
        assert command.main(["slice/order", *options]) == 1
        assert "Yosys failed" in capsys.readouterr().out


@pytest.mark.parametrize("names", [[], ["router/*"]])
def test_a_list_runs_nothing(asked, names, capsys):
    assert command.main(["--list", *names]) == 0
    keys = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert keys == [key for key in all_proofs() if not names or key.startswith("router/")]
    assert asked == []


def test_without_yosys_nothing_is_proved(asked, monkeypatch, capsys):
    def find_tools(*, ghdl: bool) -> None:
        assert not ghdl
        raise ProgramMissingError("no Yosys")

    monkeypatch.setattr(command, "find_tools", find_tools)
    assert command.main(["slice/order"]) == 1
    assert capsys.readouterr().err == "error: no Yosys\n"
    assert asked == []


@pytest.mark.usefixtures("asked")
def test_the_table_has_the_proofs_and_the_page_keeps_its_text(tmp_path):
    page = tmp_path / "page.md"
    begin = "<!-- proofs: written by `python -m firm_hdl.formal --write lab/notes/formal.md` -->"
    page.write_text(f"before\n{begin}\nold rows\n<!-- end of proofs -->\nafter\n")
    # The answers of the twins, which come later, are not those of the table.
    assert command.main(["--twins", "--write", str(page)]) == 0
    before, table, after = page.read_text().split("<!--")
    assert (before, after) == ("before\n", " end of proofs -->\nafter\n")
    assert "old rows" not in table
    assert table.count("| 0.0 |") == len(all_proofs())


def test_a_part_of_the_proofs_writes_no_table(asked, tmp_path):
    page = tmp_path / "page.md"
    for options in (["slice/order"], ["--only-twins"]):
        assert command.main([*options, "--write", str(page)]) == 1
    assert asked == [] and not page.exists()
