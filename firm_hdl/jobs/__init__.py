"""Work in other processes: programs, and tasks that are distributed to workers."""

from __future__ import annotations

from firm_hdl.jobs.executors import ExecutorError, run_each
from firm_hdl.jobs.processes import ToolError, TooSlowError, made_by, run_tool, worker_pool
from firm_hdl.jobs.programs import ProgramMissingError

__all__ = [
    "ExecutorError",
    "ProgramMissingError",
    "TooSlowError",
    "ToolError",
    "made_by",
    "run_each",
    "run_tool",
    "worker_pool",
]
