"""Small IDL texts, each judged by rosidl_parser: where firm-hdl differs, it is on purpose.

``docs/reference/errata.md`` has the differences.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.verify.results.verdict import KnownDifference, NotJudged, Passed
from firm_hdl.verify.ts1.judge import judge, read

from .variations import AGREED, READ_HERE, REFUSED_FOR_OTHER_REASONS, REFUSED_HERE

FILES = {
    "q/msg/X.msg": "int8 x\n",
    "q/srv/X.srv": "int8 x\n---\n",
    "q/action/X.action": "int8 x\n---\n---\n",
    "p/msg/T.idl": "module p { module msg { struct T { long a; }; }; };",
    "p/srv/A.idl": "module p { module srv { struct A_Request { long a; }; "
    "struct A_Response { long a; }; }; };",
    "p/action/A.idl": "module p { module action { struct A_Goal { long a; }; "
    "struct A_Result { long a; }; struct A_Feedback { long a; }; }; };",
}


# One court for the texts of a group, because links to the packages of a distro take time.
@pytest.mark.parametrize(
    ("texts", "expected", "is_refused_here"),
    [
        pytest.param(AGREED, Passed, None, id="agreed"),
        pytest.param(READ_HERE, KnownDifference, False, id="read here"),
        pytest.param(REFUSED_HERE, KnownDifference, True, id="refused here"),
        pytest.param(REFUSED_FOR_OTHER_REASONS, NotJudged, True, id="refused for other reasons"),
    ],
)
def test_variations_are_read_as_rosidl_reads_them_or_differ_on_purpose(
    court, texts, expected, is_refused_here
):
    here = court("lyrical", FILES)
    cases = {case.kind: case for case in here.universe.select(["p/msg/T", "p/srv/A", "p/action/A"])}
    oracle = here.oracle("rosidl_parser")
    found = {}
    for name, text in texts.items():
        kind = "action" if "A_Goal" in text else "srv" if "A_Re" in text else "msg"
        case = replace(cases[kind], text=text, before="")
        ours = read(here.universe, case)
        verdict = judge(here.universe, oracle, case, ours).verdict
        is_refused = isinstance(ours, DefinitionError)
        if is_refused:
            assert all(problem.span is not None for problem in ours.diagnostics), name
        if not isinstance(verdict, expected) or is_refused_here not in (None, is_refused):
            found[name] = is_refused, verdict
    assert not found
