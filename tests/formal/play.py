"""Play a scene in Amaranth's simulator: inputs in, broken claims out."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from amaranth.hdl import Signal
from amaranth.sim import Simulator

from firm_hdl.formal.scene import Scene

__all__ = ["play", "play_each"]


def play(
    build: Callable[[Scene], None],
    steps: Iterable[Mapping[str, int]] | Callable[[dict[str, int]], Iterable[Mapping[str, int]]],
    *watched: str,
) -> tuple[dict[str, list[int]], list[tuple[int, ...]]]:
    """Play a scene.

    Parameters
    ----------
    steps : iterable of mapping
        Inputs that are not 0, by name, for each cycle; or a function that returns them, and takes
        the bits of all inputs by name.
    *watched : str
        Names of attributes of the scene, set by `build`, whose values are returned.

    Returns
    -------
    broken : dict of str to list of int
        Cycles in which each claim is broken.
    values : list of tuple of int
        Values of what is watched, for each cycle.
    """
    scene = Scene(build)
    inputs: dict[str, Signal] = {each.name: each for each in scene.inputs}
    broken: dict[str, list[int]] = {name: [] for name in scene.claims}
    values: list[tuple[int, ...]] = []
    if callable(steps):
        steps = steps({name: len(signal) for name, signal in inputs.items()})

    async def bench(ctx) -> None:
        for cycle, given in enumerate(steps):
            assert given.keys() <= inputs.keys(), given.keys() - inputs.keys()
            for name, signal in inputs.items():
                ctx.set(signal, given.get(name, 0))
            for name, claim in scene.claims.items():
                if ctx.get(claim):
                    broken[name].append(cycle)
            values.append(tuple(int(ctx.get(getattr(scene, name))) for name in watched))
            await ctx.tick()

    simulator = Simulator(scene)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
    return broken, values


def play_each(
    build: Callable[[Scene], None], runs: Iterable[Iterable[Mapping[str, int]]]
) -> list[set[str]]:
    """Play a scene several times, each time from its reset on; return the broken claims of each.

    Parameters
    ----------
    runs : iterable of iterable of mapping
        Of each run, the inputs of each cycle, as for `play`.
    """
    scene = Scene(build)
    inputs = {each.name: each for each in scene.inputs}
    waiting, broken = [[*run] for run in runs], list[set[str]]()

    async def bench(ctx) -> None:
        broken.append(set())
        for given in waiting[len(broken) - 1]:
            assert given.keys() <= inputs.keys(), given.keys() - inputs.keys()
            for name, signal in inputs.items():
                ctx.set(signal, given.get(name, 0))
            broken[-1] |= {name for name, claim in scene.claims.items() if ctx.get(claim)}
            await ctx.tick()

    simulator = Simulator(scene)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    for number in range(len(waiting)):
        if number:
            simulator.reset()
        simulator.run()
    return broken
