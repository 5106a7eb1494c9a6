"""Verification: converters against oracles, on every type.

``python -m firm_hdl.verify`` runs it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from firm_hdl.cases.make import Case, make_cases
    from firm_hdl.cases.oracle import RosbagsOracle, distro_oracle
    from firm_hdl.verify.systems.options import Options
    from firm_hdl.verify.systems.tasks import TypeUnderTest, collect_tasks
    from firm_hdl.verify.ts3.acceptance import accept, accept_message
    from firm_hdl.verify.ts3.result import Result
    from firm_hdl.verify.ts3.system import run_tasks

__all__ = [
    "Case",
    "Options",
    "Result",
    "RosbagsOracle",
    "TypeUnderTest",
    "accept",
    "accept_message",
    "collect_tasks",
    "distro_oracle",
    "make_cases",
    "run_tasks",
]

# NumPy, Amaranth and simulators take seconds to import, and a wrong argument needs none of them.
_HOME = {
    "Case": "firm_hdl.cases.make",
    "Options": "firm_hdl.verify.systems.options",
    "RosbagsOracle": "firm_hdl.cases.oracle",
    "Result": "firm_hdl.verify.ts3.result",
    "TypeUnderTest": "firm_hdl.verify.systems.tasks",
    "accept": "firm_hdl.verify.ts3.acceptance",
    "accept_message": "firm_hdl.verify.ts3.acceptance",
    "collect_tasks": "firm_hdl.verify.systems.tasks",
    "distro_oracle": "firm_hdl.cases.oracle",
    "make_cases": "firm_hdl.cases.make",
    "run_tasks": "firm_hdl.verify.ts3.system",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
