"""Settings of the tests of the fuzzer."""

from __future__ import annotations

import pytest

from firm_hdl.fuzz import build
from tests.depth import THOROUGH


@pytest.fixture(scope="package", autouse=True)
def fast_compiler():
    """Compile without optimization: compilers take longer than a few thousand packets."""
    with pytest.MonkeyPatch.context() as patch:
        if not THOROUGH:
            patch.setattr(build, "_HARNESS_OPTIONS", ("-O0", *build._HARNESS_OPTIONS[1:]))
            patch.setattr(build, "_MODEL_OPTIONS", ("-O0", *build._MODEL_OPTIONS[1:]))
        yield
