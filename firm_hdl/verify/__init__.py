"""Verification: converters against oracles, on every type.

``python -m firm_hdl.verify`` runs it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from firm_hdl.verify.cases.make import Case, make_cases
    from firm_hdl.verify.references.oracle import RosbagsOracle, distro_oracle
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
    "Case": "cases.make",
    "Options": "systems.options",
    "RosbagsOracle": "references.oracle",
    "Result": "ts3.result",
    "TypeUnderTest": "systems.tasks",
    "accept": "ts3.acceptance",
    "accept_message": "ts3.acceptance",
    "collect_tasks": "systems.tasks",
    "distro_oracle": "references.oracle",
    "make_cases": "cases.make",
    "run_tasks": "ts3.system",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"firm_hdl.verify.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
