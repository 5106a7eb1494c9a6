"""Work in other processes: programs, and tasks that are distributed to workers."""

from __future__ import annotations

from firm_hdl.jobs.executors import PROCESSES, ExecutorError, run_each
from firm_hdl.jobs.processes import ToolError, run_tool, worker_pool

__all__ = ["PROCESSES", "ExecutorError", "ToolError", "run_each", "run_tool", "worker_pool"]
