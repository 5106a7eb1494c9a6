"""TS3 on a few types that have every feature; `make verify` runs all types, with all cases.

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
from tests.depth import by_depth
from tests.verify.judged import NAN_KEY, assert_passed

FOLDER = Path(__file__).parents[1] / "covering"
DISTROS = ("lyrical", "noetic")
KEPT = {distro: read_chosen(FOLDER / f"{distro}.txt") for distro in DISTROS}
# The branches of the generator for all types take a minute; `make cover` checks them.
STRIDE = 20
MOST_CASES = by_depth(12, None)
# All cases of these types take as long as those of all other types together.
LARGE = ("InteractiveMarker", "InteractiveMarkerControl", "InteractiveMarkerInit")
FEW_CASES = by_depth(2, None)
KNOWN = {("lyrical", "sensor_msgs/msg/Joy"): (NAN_KEY,)}


@pytest.mark.parametrize(
    ("distro", "name"), [(distro, name) for distro in DISTROS for name in KEPT[distro]]
)
def test_a_covering_type_passes(distro, name):
    most = FEW_CASES if name.rpartition("/")[2] in LARGE else MOST_CASES
    result = accept(distro, name, Options(bus_bytes=8, most_cases=most))
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
