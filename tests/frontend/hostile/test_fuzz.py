"""The fuzzer of the front end (``make fuzz``), on a few damaged files."""

from __future__ import annotations

import os
import random
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from firm_hdl.errors import DefinitionError, Diagnostic, Source
from firm_hdl.frontend import interfaces, parse
from firm_hdl.frontend.idl import read_idl
from tests import fuzz_frontend
from tests.damage import TOKEN, WORDS, mutate
from tests.depth import by_depth
from tests.fuzz_frontend import Finding, Fuzzer, main, seeds
from tests.steps import calls_at_most

FOLDER = Path(__file__).parents[1] / "errors"
IDL = (
    '#include "a.idl"\nmodule p { module msg { module T_Constants { const long N = 1 << 2; };\n'
    "typedef sequence<string<N>, 3> S; enum E { A }; @final struct T {\n"
    '@default(value=-1) @verbatim(language="comment", text="x" "\\n") long a, b; // c\n'
    '@unit(value="m") S d; q::msg::X e[N + 1]; @default(value="(1, 2)") sequence<octet> f;\n'
    "char g; wchar h; unsigned long long i; /* j */ wstring<2> k; }; }; };\n"
)


def test_damaged_files_end_in_a_model_or_an_error():
    folder = Path(os.environ.get("FIRM_HDL_CORPUS") or FOLDER)
    seed = random.SystemRandom().randrange(10**6)
    print(f"--seed {seed}")
    counts, findings = Fuzzer(folder, seed).run(range(by_depth(150, 300)))
    assert findings == []
    assert counts["model"] and counts["error"]


@settings(max_examples=by_depth(100, 200), deadline=None)
@given(st.integers(0, 2**32))
def test_damaged_idl_gives_messages_and_diagnostics(number):
    rng = random.Random(number)
    text = mutate(rng, IDL, IDL)
    # A long text has many calls: about 100 for each character were counted.
    with calls_at_most(1_000_000 + 150 * len(text)):
        messages, wrong = read_idl(Source(name="test.idl", text=text), lambda path: None)
        assert isinstance(messages, dict)
        assert all(isinstance(d, Diagnostic) and str(d) for d in wrong)


@settings(max_examples=200, deadline=None)
@given(st.lists(st.sampled_from([*WORDS, *TOKEN.findall(IDL)]), max_size=40))
def test_any_words_give_messages_and_diagnostics(words):
    source = Source(name="test.idl", text="module p { struct T { " + " ".join(words))
    messages, wrong = read_idl(source, lambda path: source)
    assert wrong or messages


def test_inputs_are_made_of_all_languages_and_can_be_made_again():
    fuzzer, again = Fuzzer(FOLDER, 1), Fuzzer(FOLDER, 1)
    inputs = [fuzzer.input(number) for number in range(200)]
    assert inputs == [again.input(number) for number in range(200)]
    assert {seed.language for seed, _ in inputs} == {"msg", "srv", "action", "idl"}
    assert {seed.dialect for seed, _ in inputs} == {"ros1", "ros2"}
    assert len({text for _, text in inputs}) > 150


def test_seeds_are_all_files():
    assert len(seeds(FOLDER)) == len([p for p in FOLDER.rglob("*.*") if p.suffix != ".err"])


@pytest.mark.parametrize("number", range(3))
def test_an_exception_of_another_kind_is_found_and_cut_down(number, monkeypatch):
    fuzzer = Fuzzer(FOLDER, 1)
    original = parse.read_message

    def broken(source, *arguments, **keywords):
        if "Fuzz" in source.name and "int" in source.text:
            raise RuntimeError("this is a bug")
        return original(source, *arguments, **keywords)

    monkeypatch.setattr(interfaces, "read_message", broken)
    numbers = [n for n in range(100) if fuzzer.input(n)[0].language == "msg"]
    counts, findings = fuzzer.run(numbers[10 * number : 10 * number + 10])
    assert counts["finding"] == len(findings) > 0
    for finding in findings:
        assert isinstance(finding, Finding)
        assert finding.problem.startswith("RuntimeError in test_fuzz.py:")
        assert finding.text == "int"


def test_slow_input_is_found(monkeypatch):
    fuzzer = Fuzzer(FOLDER, 1)
    monkeypatch.setattr(fuzz_frontend, "MOST_SECONDS", 0.05)

    ends = []

    def slow(source, *arguments, **keywords):
        end = time.process_time() + 10
        while time.process_time() < end:
            pass
        ends.append(source)

    monkeypatch.setattr(interfaces, "read_message", slow)
    monkeypatch.setattr(Fuzzer, "_smaller", lambda self, number, seed, text, problem: text)
    number = next(n for n in range(100) if fuzzer.input(n)[0].language == "msg")
    _, (finding,) = fuzzer.run([number])
    assert finding.problem == "takes too long"
    assert not ends


def test_an_error_without_a_text_is_found(monkeypatch):
    def silent(source, *arguments, **keywords):
        raise DefinitionError([Diagnostic(message="")])

    monkeypatch.setattr(DefinitionError, "__str__", lambda self: "")
    monkeypatch.setattr(interfaces, "read_message", silent)
    fuzzer = Fuzzer(FOLDER, 1)
    seed = next(s for s in seeds(FOLDER) if s.language == "msg")
    assert fuzzer.attempt(0, seed, seed.text) == "an error without a text"


def test_command_prints_its_seed_and_what_came_out(tmp_path, monkeypatch, capsys):
    monkeypatch.delenv("FIRM_HDL_CORPUS", raising=False)
    arguments = ["-n", "20", "--seed", "7", "--jobs", "1", "--out", str(tmp_path)]
    assert main(arguments) == 0
    first, last = capsys.readouterr().out.splitlines()
    assert first.startswith("--seed 7, 20 inputs from ")
    assert ", 0 findings; " in last
