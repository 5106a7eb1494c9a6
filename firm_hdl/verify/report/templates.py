"""The Jinja environment of the templates of reports."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined

from firm_hdl.verify.report import charts, prose, tables
from firm_hdl.verify.report.outcomes import failures_of
from firm_hdl.verify.report.verdicts import reason_groups

__all__ = ["environment", "text_of"]


def text_of(name: str) -> str:
    """Return the text of a file that is beside this one."""
    return files(__package__ or "").joinpath(name).read_text(encoding="utf-8")


def environment(*, is_html: bool, **filters: Any) -> Environment:
    """Return a Jinja environment with the functions that templates may use.

    Parameters
    ----------
    is_html : bool
        Whether text is escaped, so that nothing in it is a tag.
    **filters
        Filters by the names that templates have for them.
    """
    found = Environment(
        loader=FunctionLoader(text_of),
        autoescape=is_html,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    found.globals.update(
        charts=charts,
        prose=prose,
        tables=tables,
        failures_of=failures_of,
        reason_groups=reason_groups,
    )
    found.filters.update(filters)
    return found
