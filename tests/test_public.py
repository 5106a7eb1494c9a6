"""The packages whose names users import: complete for `dir`, and so for completion in an editor."""

from __future__ import annotations

import subprocess
import sys

import pytest


@pytest.mark.parametrize("package", ["firm_hdl", "firm_hdl.node", "firm_hdl.verify"])
def test_dir_shows_all_names_before_their_first_use(package: str) -> None:
    script = f"import {package} as p; print(set(p.__all__) - set(dir(p)))"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout == "set()\n"
