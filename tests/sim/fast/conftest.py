# amaranth: UnusedElaboratable=no
"""The one program that `make test` compiles."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from firm_hdl.jobs.caches import cache_folder
from firm_hdl.sim import StallPlan
from firm_hdl.sim.fast import EngineName, FastSimulation
from firm_hdl.sim.fast.compilers import program_of, verilated_source
from firm_hdl.sim.fast.ports import ports_of
from firm_hdl.sim.fast.top import Top
from tests.sim.fast.designs import Awkward
from tests.tools import made_once

OPTIONS = ("-O0",)

Open = Callable[..., FastSimulation]


@pytest.fixture(scope="session")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The user's folder of programs, with that of `Awkward`.

    One of pytest's processes compiles it, unless an earlier `make test` did: it takes 15 s.
    """

    def make(_: Path) -> None:
        design = Awkward()
        source = partial(verilated_source, Top(design, ports_of(design)))
        program_of(source, options=OPTIONS)

    made_once(tmp_path_factory, "programs", make)
    return cache_folder()


@pytest.fixture
def start(programs: Path, request: pytest.FixtureRequest) -> Open:
    """Start a simulation of `Awkward`, which is closed at the end of the test."""

    def started(engine: EngineName, stalls: StallPlan = None, **options: object) -> FastSimulation:
        simulation = FastSimulation(
            Awkward(),
            engine=engine,
            stalls=stalls,
            options=OPTIONS,
            cache=programs,
            **options,  # type: ignore[arg-type]
        )
        request.addfinalizer(simulation.close)
        return simulation

    return started
