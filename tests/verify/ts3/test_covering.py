"""TS3 on a few types that have every feature; `make verify` runs all types, with all cases.

In `make test`, each type is either stalled or damaged. Tests of the parser, and
`test_random_definitions`, do both with other types.

The types are in ``covering/``. ``make cover`` selects them again after a change.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from firm_hdl.covering.branches import branches
from firm_hdl.covering.choose import all_features, cost
from firm_hdl.covering.command import read_chosen
from firm_hdl.export.build import plan_of
from firm_hdl.frontend import Library
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES
from firm_hdl.verify import Options, accept
from tests.depth import THOROUGH
from tests.verify.judged import NAN_KEY, assert_passed

FOLDER = Path(__file__).parents[1] / "covering"
DISTROS = ("lyrical", "noetic")
KEPT = {distro: read_chosen(FOLDER / f"{distro}.txt") for distro in DISTROS}
# The branches of the generator for all types take a minute; `make cover` checks them.
STRIDE = 20
# One case of each mode.
MOST_CASES = 5
# It takes as long as many others: one short case that enters loops of several levels.
SHORT_SEEDS = {"visualization_msgs/msg/InteractiveMarkerInit": 6}
# Only the plan is judged: another array with elements of the same size is simulated,
# or deeper loops on the other wire.
PLANNED = (
    ("lyrical", "std_msgs/msg/UInt16MultiArray"),
    ("noetic", "std_msgs/Int16MultiArray"),
    ("noetic", "std_msgs/Int64MultiArray"),
    ("noetic", "std_msgs/Int8MultiArray"),
    ("noetic", "visualization_msgs/InteractiveMarker"),
)
KNOWN = {("lyrical", "sensor_msgs/msg/Joy"): (NAN_KEY,)}


def options_of(distro: str, name: str) -> Options:
    """Return the options of a type; all cases are for `make test-thorough`."""
    if THOROUGH:
        return Options(bus_bytes=8)
    # The distributions have several types in common, such as DiagnosticArray: one is damaged.
    is_damaged = (KEPT[distro].index(name) + DISTROS.index(distro)) % 2 == 0
    seed = SHORT_SEEDS.get(name)
    return Options(
        bus_bytes=8,
        most_cases=MOST_CASES if seed is None else 1,
        seed=seed or 0,
        stalled=not is_damaged,
        broken=is_damaged,
        simulated=(distro, name) not in PLANNED,
    )


@pytest.mark.parametrize(
    ("distro", "name"), [(distro, name) for distro in DISTROS for name in KEPT[distro]]
)
def test_a_covering_type_passes(distro, name):
    result = accept(distro, name, options_of(distro, name))
    known = KNOWN.get((distro, name), ())
    assert assert_passed(result, known) >= result.cases > 0


def planned(library, name):
    message = library.message(name)
    return message, plan_of(message, None, 8, DEFAULT_MAX_MESSAGE_BYTES)


def missing(distro, kept):
    """Return the features of a distribution that none of the given types has."""
    library = Library(distro)
    found = {name: all_features(library, *planned(library, name)) for name in library.names()}
    return set().union(*found.values()) - set().union(*(found[name] for name in kept))


@pytest.mark.snapshot
@pytest.mark.parametrize("distro", DISTROS)
def test_the_kept_types_have_every_feature(distro):
    assert missing(distro, KEPT[distro]) == set(), "choose again: make cover"


@pytest.mark.parametrize("distro", DISTROS)
def test_a_type_that_is_left_out_is_missed(distro):
    name = "rcl_interfaces/msg/ParameterValue" if distro == "lyrical" else "sensor_msgs/Joy"
    left = missing(distro, [each for each in KEPT[distro] if each != name])
    families = {feature.partition(":")[0] for feature in left}
    assert {"definition", "plan"} <= families


def not_taken(library, wanted, kept):
    """Remove the branches that types take, small types first; return the branches that are left."""
    left = set(wanted)
    plans = sorted((planned(library, name) for name in kept), key=lambda both: cost(both[1]))
    for message, plan in plans:
        if not left:
            break
        left -= branches(message, plan)
    return left


@pytest.mark.thorough
@pytest.mark.parametrize("distro", DISTROS)
def test_other_types_take_no_branch_that_the_kept_do_not(distro):
    library = Library(distro)
    others = library.names()[::STRIDE]
    taken = set().union(*(branches(*planned(library, name)) for name in others))
    assert len(taken) > 1000
    assert not_taken(library, taken, KEPT[distro]) == set(), "choose again: make cover"
    # Must-fail twin: a few of the types do not take all branches.
    assert not_taken(library, taken, KEPT[distro][-8:-5])
