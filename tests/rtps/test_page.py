"""docs/rtps.md: its example runs, and its table has all modules."""

from __future__ import annotations

import re
from pathlib import Path

import firm_hdl

ROOT = Path(firm_hdl.__file__).parent.parent
PAGE = (ROOT / "docs" / "rtps.md").read_text(encoding="utf-8")
# What others are made of, or in a row of its own.
NOT_IN_TABLE = {"__init__.py", "endpoints.py", "events.py", "outgoing.py"}


def test_the_example_runs():
    (text,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    for old, new in (
        ('domain=0, interface="eth0"', 'domain=187, interface="127.0.0.1", multicast=False'),
        ("wait_for_match()", "wait_for_match(timeout=0)"),
    ):
        assert old in text
        text = text.replace(old, new)
    exec(text, {"packet": bytes(320)})


def test_the_table_has_all_modules():
    folder = ROOT / "firm_hdl" / "rtps"
    modules = {path.name for path in (*folder.glob("*.py"), *folder.glob("wire/*.py"))}
    named = set(re.findall(r"`(?:\w+/)?(\w+\.py)`", PAGE))
    assert named == modules - NOT_IN_TABLE
