"""The printed form of errors."""

from __future__ import annotations

import pickle

from firm_hdl.errors import DefinitionError, Diagnostic, Source, Span, UserError, described
from tests.steps import calls_at_most
from tests.verify.judged import accept


def diagnostic(text, start, end, message="no"):
    source = Source(name="a.msg", text=text)
    return Diagnostic(message=message, span=Span(source=source, start=start, end=end))


def test_caret_stands_under_the_words():
    text = "int8 a\r\n\tint9 b\n"
    assert str(diagnostic(text, 9, 13)) == "a.msg:2:2: error: no\n\tint9 b\n\t^^^^"


def test_carets_are_counted_in_columns_of_a_terminal():
    # Chinese signs take two columns each, and an accent of its own takes none.
    text = "\u5b57e\u0301 int9\tx"
    assert str(diagnostic(text, 4, 8)) == f"a.msg:1:5: error: no\n{text}\n    ^^^^"
    assert str(diagnostic("a \u5b57\u6bb5 b", 2, 4)).endswith("\n  ^^^^")


def test_place_after_the_last_line_has_a_caret():
    assert str(diagnostic("a\n", 2, 2)) == "a.msg:2:1: error: no\n\n^"


def test_lines_are_counted_from_1():
    text = "\na\n\nb"
    spans = [diagnostic(text, start, start).span for start in range(len(text) + 1)]
    assert [(s.line, s.column) for s in spans] == [(1, 1), (2, 1), (2, 2), (3, 1), (4, 1), (4, 2)]
    assert [s.line_text for s in spans] == ["", "a", "a", "", "b", "b"]


def test_long_line_is_cut_around_the_place():
    text = "x" * 1000 + "here" + "y" * 1000
    first, line, carets = str(diagnostic(text, 1000, 1004)).split("\n")
    assert first == "a.msg:1:1001: error: no"
    assert line == "..." + "x" * 200 + "here" + "y" * 196 + "..."
    assert carets == " " * 203 + "^^^^"
    _, line, carets = str(diagnostic(text, 0, 2)).split("\n")
    assert line == "x" * 400 + "..." and carets == "^^"
    _, line, carets = str(diagnostic(text, 2000, 2004)).split("\n")
    assert line.endswith("y") and len(line) == 207 and carets == " " * 203 + "^^^^"
    # The part that is shown ends with the line.
    _, line, _ = str(diagnostic(text, len(text) - 200, len(text))).split("\n")
    assert line == "..." + "y" * 400


def test_a_line_that_fits_is_shown_whole():
    _, line, carets = str(diagnostic("x" * 396 + "here", 396, 400)).split("\n")
    assert line == "x" * 396 + "here" and carets == " " * 396 + "^^^^"
    _, line, _ = str(diagnostic("x" * 397 + "here", 397, 401)).split("\n")
    assert line == "..." + "x" * 200 + "here"


def test_a_carriage_return_is_part_of_a_line_unless_it_ends_it():
    text = "\rint9 a\r\n"
    assert str(diagnostic(text, 1, 5)) == "a.msg:1:2: error: no\n\\rint9 a\n  ^^^^"


def test_a_place_between_two_characters_has_one_caret():
    assert str(diagnostic("ab\x07c", 2, 2)) == "a.msg:1:3: error: no\nab\\x07c\n  ^"


def test_words_of_several_lines_are_marked_in_the_first():
    assert str(diagnostic("int8 a\nint8 b\n", 5, 12)) == "a.msg:1:6: error: no\nint8 a\n     ^"
    assert str(diagnostic("int8 a", 5, 9)) == "a.msg:1:6: error: no\nint8 a\n     ^"


def test_text_without_a_line_end_is_shown_to_its_last_character():
    assert str(diagnostic("int8 a\nint8 bc", 12, 14)).endswith("\nint8 bc\n     ^^")


def test_all_errors_are_printed_in_their_order():
    wrong = [diagnostic("a\nb\n", 2, 3, "second"), Diagnostic(message="none"),
             diagnostic("a\nb\n", 0, 1, "first")]  # fmt: skip
    assert str(DefinitionError(wrong)).splitlines() == [
        "a.msg:2:1: error: second", "b", "^", "error: none", "a.msg:1:1: error: first", "a", "^",
    ]  # fmt: skip


def test_many_errors_in_one_line_are_printed_in_time():
    text = "x " * 50_000
    with calls_at_most(1_000_000):
        error = DefinitionError(diagnostic(text, 2 * i, 2 * i + 1) for i in range(1000))
        assert len(str(error).splitlines()) == 3000


def test_error_survives_pickling():
    error = DefinitionError([diagnostic("a b", 2, 3)])
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) and again.diagnostics == error.diagnostics


def test_errors_for_users_print_without_an_exception_name():
    assert described(UserError("Yosys needs memory")) == "Yosys needs memory"
    wrong = diagnostic("int8 a", 0, 4)
    assert described(DefinitionError([wrong])) == str(wrong)
    assert described(KeyError("x")) == "KeyError: 'x'"


def test_failure_to_run_a_type_has_the_message_for_users(monkeypatch):
    def refused(*_):
        raise UserError("Yosys needs memory")

    monkeypatch.setattr("firm_hdl.verify.ts3.acceptance.library_of", refused)
    assert accept("lyrical", "std_msgs/msg/Bool").failures == ("Yosys needs memory",)
