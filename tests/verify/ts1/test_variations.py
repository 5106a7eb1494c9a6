"""Small IDL texts, each judged by rosidl_parser: where firm-hdl differs, it is on purpose.

``docs/reference/errata.md`` has the differences.
"""

from __future__ import annotations

import re

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.verify.results.verdict import KnownDifference, NotJudged, Passed
from firm_hdl.verify.ts1.judge import judge, read

from .variations import AGREED, READ_HERE, REFUSED_FOR_OTHER_REASONS, REFUSED_HERE

FILES = {
    "q/msg/X.msg": "int8 x\n",
    "q/srv/X.srv": "int8 x\n---\n",
    "q/action/X.action": "int8 x\n---\n---\n",
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
    # Each text is the file of a package of its own, and names this one.
    files, types = dict(FILES), []
    for number, text in enumerate(texts.values()):
        kind = "action" if "A_Goal" in text else "srv" if "A_Re" in text else "msg"
        types.append(f"p{number}/{kind}/{'T' if kind == 'msg' else 'A'}")
        files[f"{types[-1]}.idl"] = re.sub(r"\bp(?= \{|::)", f"p{number}", text)
    here = court("lyrical", files)
    oracle = here.oracle("rosidl_parser")
    found = {}
    for name, case in zip(texts, here.universe.select(types), strict=True):
        ours = read(here.universe, case)
        verdict = judge(here.universe, oracle, case, ours).verdict
        is_refused = isinstance(ours, DefinitionError)
        if is_refused:
            assert all(problem.span is not None for problem in ours.diagnostics), name
        if not isinstance(verdict, expected) or is_refused_here not in (None, is_refused):
            found[name] = is_refused, verdict
    assert not found
