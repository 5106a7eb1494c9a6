"""docs/rtps.md: its table has all modules."""

from __future__ import annotations

import re
from pathlib import Path

import firm_hdl

ROOT = Path(firm_hdl.__file__).parent.parent
PAGE = (ROOT / "docs" / "rtps.md").read_text(encoding="utf-8")
# What others are made of, or in a row of its own.
NOT_IN_TABLE = {"__init__.py", "endpoints.py", "events.py", "outgoing.py", "settings.py"}


def test_the_table_has_all_modules():
    folder = ROOT / "firm_hdl" / "rtps"
    modules = {path.name for path in (*folder.glob("*.py"), *folder.glob("wire/*.py"))}
    named = set(re.findall(r"`(?:\w+/)?(\w+\.py)`", PAGE))
    assert named == modules - NOT_IN_TABLE
