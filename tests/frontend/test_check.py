"""Limits that definitions have to keep, on both sides; wording: ``test_errors.py``."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library
from tests.frontend.workspace import make_files


def load(tmp_path, line):
    return Library("lyrical", [make_files(tmp_path, {"p/msg/T.msg": line})]).message("p/msg/T")


@pytest.mark.parametrize("line", ["int8[{}] a", "int8[<={}] a", "string<={} a"])
@pytest.mark.parametrize(
    ("size", "is_legal"), [(0, False), (1, True), (2**32 - 1, True), (2**32, False)]
)
def test_sizes_are_those_that_32_bits_can_count(tmp_path, line, size, is_legal):
    if is_legal:
        assert str(size) in str(load(tmp_path, line.format(size)).fields[0].type)
    else:
        with pytest.raises(DefinitionError, match=r"must be at (least|most)"):
            load(tmp_path, line.format(size))
