"""Settings of the tests of the fuzzer."""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path

import pytest

from firm_hdl.verify.simulators.programs import Runtime
from lab.fuzz import build
from tests.depth import THOROUGH


@pytest.fixture(scope="package", autouse=True)
def fast_compiler():
    """Compile without optimization: compilers take longer than a few thousand packets."""
    with pytest.MonkeyPatch.context() as patch:
        if not THOROUGH:
            patch.setattr(build, "_HARNESS_OPTIONS", ("-O0", *build._HARNESS_OPTIONS[1:]))
            patch.setattr(build, "_MODEL_OPTIONS", ("-O0", *build._MODEL_OPTIONS[1:]))
            patch.setattr(build, "runtime_of", joined_runtime)
        yield


@functools.cache
def joined_runtime(compiler, options, sources):
    """Join the sources of a runtime: most of the time of a compiler goes into common headers."""
    headers = [f"-I{each}" for each in dict.fromkeys(path.parent for path in sources)]
    own = [path for path in sources if path.parent == build._HARNESS]
    half = len(own) // 2
    with tempfile.TemporaryDirectory(prefix="firm-hdl-") as folder:
        # Two files, for judge.cpp and packets.cpp have constants of the same name.
        joined = [Path(folder, "first.cpp"), Path(folder, "second.cpp")]
        joined[0].write_text(included(own[:half]))
        joined[1].write_text(included(path for path in sources if path not in own[:half]))
        made = Runtime(compiler, [*options, *headers], joined)
    made.includes += headers
    return made


def included(sources):
    return "".join(f'#include "{source}"\n' for source in sources)
