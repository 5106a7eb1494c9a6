"""The test of a type with some options, the command that repeats it, and types with one circuit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from firm_hdl.cases.effort import digest, message_limit
from firm_hdl.errors import DefinitionError
from firm_hdl.export.build import BuildError, plan_of
from firm_hdl.verify.results.records import Test
from firm_hdl.verify.systems import system
from firm_hdl.verify.systems.options import LONGEST, CaseOptions, command_again
from firm_hdl.verify.systems.tasks import TypeUnderTest, library_of
from firm_hdl.wire import lay_out

__all__ = ["as_test", "command_of", "same_circuits", "words_of"]


def command_of(options: CaseOptions, *names: str, distro: str | None, **more: object) -> str:
    """Return the command that tests types again: with what `more` says, and then these options."""
    references = options.references
    given: dict[str, object] = {
        "distro": distro,
        "path": options.paths,
        "depends": options.depends,
        "bag": options.bags,
        "max_message_bytes": None if options.longest == LONGEST else options.longest,
        "simulator": None if options.simulator == "python" else options.simulator,
        "bus_bytes": options.bus_bytes,
        "wire": options.wire,
        "seed": options.seed,
        "no_stalls": not options.stalled,
        "no_broken": not options.broken,
        "cases": options.most_cases,
        "reference": ("none",) if references == () else references,
        "vcd": options.vcd,
    }
    first = dict.fromkeys(name for name in more if name not in given)
    return command_again(*names, **{**first, **given, **more})


def as_test(task: TypeUnderTest, options: CaseOptions) -> Test:
    """Return the test that runs a task with some options."""
    more = [f"bag={bag}" for bag in options.bags]
    more += [] if options.longest == LONGEST else [f"longest={options.longest}"]
    words = [*words_of(options), *more]
    return system.as_test("ts3", task, options, *words, simulator=options.simulator)


def words_of(options: CaseOptions, *more: str) -> list[str]:
    """Return what the cases of a type depend on, with `more` behind the seed, for a test's key."""
    own = [f"seed={options.seed}", *more]
    own += [] if options.most_cases is None else [f"cases={options.most_cases}"]
    own += [] if options.stalled else ["no-stalls"]
    own += [] if options.broken else ["no-broken"]
    own += [] if options.references is None else [f"references={'+'.join(options.references)}"]
    return own


def same_circuits(
    tasks: Sequence[TypeUnderTest], options: CaseOptions
) -> dict[TypeUnderTest, TypeUnderTest]:
    """Return the tasks whose circuit is equal to that of an earlier task, with the earlier task.

    Circuits are equal if plans are equal apart from names.
    """
    first: dict[str, TypeUnderTest] = {}
    found: dict[TypeUnderTest, TypeUnderTest] = {}
    for task in tasks:
        try:
            message = library_of(task.distro, options).message(task.name)
            wire: Any = options.wire or message.wire
            limit = message_limit(lay_out(message, wire).least_bytes)
            plan = plan_of(message, wire, options.bus_bytes, limit)
        except (DefinitionError, BuildError, ValueError):
            # The task's own test reports the error.
            continue
        other = first.setdefault(digest(plan), task)
        if other is not task:
            found[task] = other
    return found
