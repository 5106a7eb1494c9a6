"""Verification: converters against oracles, on every type.

``python -m firm_hdl.verify`` runs it.
"""

from __future__ import annotations

from firm_hdl.verify.cases.make import Case, make_cases
from firm_hdl.verify.references.oracle import Oracle, distro_oracle
from firm_hdl.verify.systems.tasks import Task, collect_tasks
from firm_hdl.verify.ts3.acceptance import accept, accept_message
from firm_hdl.verify.ts3.options import Options, Result
from firm_hdl.verify.ts3.runner import run_tasks

__all__ = [
    "Case",
    "Options",
    "Oracle",
    "Result",
    "Task",
    "accept",
    "accept_message",
    "collect_tasks",
    "distro_oracle",
    "make_cases",
    "run_tasks",
]
