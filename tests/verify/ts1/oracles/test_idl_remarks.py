"""Comments and units in IDL, which rosidl_parser tells and TS1 compares."""

from __future__ import annotations

import pytest

from firm_hdl.frontend.idl import read
from firm_hdl.verify.results.verdict import Failed
from tests.depth import by_depth
from tests.verify.judged import assert_passed


def said(text):
    return f'@verbatim(language="comment", text="{text}")'


FILES = {
    "p/msg/A.idl": f"""
        module p {{ module msg {{
          module A_Constants {{ {said("Of N.")} const long N = 3; const long M = 4; }};
          {said("Whole.")}
          struct A {{
            {said("Of x.")} {said("More.")} @unit(value="m") long x;
            long y;
            @verbatim(language="C", text="int y;") @unit(value="s") @unit(value="h") long z;
          }};
        }}; }};""",
    "p/srv/S.idl": f"""
        module p {{ module srv {{
          {said("Whole.")} struct S_Request {{ {said("Of x.")} @unit(value="m") long x; }};
          struct S_Response {{ {said("Of y.")} @unit(value="s") long y; }};
        }}; }};""",
    "p/action/Do.idl": f"""
        module p {{ module action {{
          {said("Whole.")} struct Do_Goal {{ {said("Of x.")} @unit(value="m") long x; }};
          struct Do_Result {{ {said("Of y.")} long y; }};
          struct Do_Feedback {{ @unit(value="s") long z; }};
        }}; }};""",
}
RELEASES = pytest.mark.parametrize("oracle", ["rosidl_parser", "rosidl_parser-4.9"])
ONE = pytest.mark.parametrize("oracle", by_depth(["rosidl_parser"], ["rosidl_parser-4.9"]))


def remarks(message, kind="fields"):
    return [(each["name"], each["comment"], each["unit"]) for each in message[kind]]


@RELEASES
def test_rosidl_parser_tells_of_comments_and_units(court, oracle):
    here = court("lyrical", FILES)
    whole = here.answer(oracle, "p/A").facts["structure"]["p/msg/A"]
    assert whole["comment"] == "Whole."
    assert remarks(whole) == [("x", "Of x.\nMore.", "m"), ("y", "", None), ("z", "", "s")]
    assert remarks(whole, "constants") == [("N", "Of N.", None), ("M", "", None)]
    parts = here.answer(oracle, "p/S").facts["structure"]
    assert remarks(parts["p/srv/S_Request"]) == [("x", "Of x.", "m")]
    assert remarks(parts["p/srv/S_Response"]) == [("y", "Of y.", "s")]
    # rosidl_parser gives comments to whole messages only.
    assert "comment" not in parts["p/srv/S_Request"]
    for type_ in ("p/A", "p/S", "p/Do"):
        assert_passed(here.outcome(oracle, type_))


@ONE
@pytest.mark.parametrize(
    ("name", "wrong", "places"),
    [
        ("_comment_of", lambda right: right.replace("Whole", "All"), ["comment"]),
        ("_comment_of", lambda right: right.replace("Of x", "Of y"), ["fields/x/comment"]),
        ("_comment_of", lambda right: right.partition("\n")[0], ["fields/x/comment"]),
        ("_comment_of", lambda right: right.replace("Of N", ""), ["constants/N/comment"]),
        ("_unit_of", lambda right: right and "s", ["fields/x/unit"]),
        ("_unit_of", lambda right: None, ["fields/x/unit", "fields/z/unit"]),
        (
            "_unit_of",
            lambda right: right or "m",
            ["fields/y/unit", "constants/N/unit", "constants/M/unit"],
        ),
    ],
)
def test_a_wrong_comment_or_unit_is_a_difference(court, monkeypatch, oracle, name, wrong, places):
    right = getattr(read, name)
    monkeypatch.setattr(read, name, lambda annotations: wrong(right(annotations)))
    verdict = court("lyrical", FILES).outcome(oracle, "p/A").verdict
    assert isinstance(verdict, Failed)
    found = [text.partition(": ")[0] for text in verdict.failures]
    assert found == [f"structure/p/msg/A/{place}" for place in places]
