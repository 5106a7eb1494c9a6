"""TS3 on a few types that have every feature; `make verify` runs all types, with all cases.

In `make test`, half of the types are judged, each is either stalled or damaged, and of large ones
only the plan is judged. `test_random_definitions` does both with other types.

The types are in ``covering/``. ``make cover`` selects them again after a change.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from firm_hdl.covering.choose import all_features
from firm_hdl.covering.command import read_chosen
from firm_hdl.export.build import plan_of
from firm_hdl.frontend import Library
from firm_hdl.plan import DEFAULT_MAX_MESSAGE_BYTES
from firm_hdl.verify.systems.options import CaseOptions
from tests.depth import THOROUGH, by_depth
from tests.verify.judged import NAN_KEY, accept, assert_passed
from tests.verify.ts3.stand_ins import STAND_INS, stand_in_package

FOLDER = Path(__file__).parents[1] / "covering"
DISTROS = ("lyrical", "noetic")
KEPT = {distro: read_chosen(FOLDER / f"{distro}.txt") for distro in DISTROS}
# One case of each mode.
MOST_CASES = 5
# Only the plan is judged in `make test`. Other types and `STAND_INS` have the same features in less
# hardware, which `test_every_feature_is_simulated` makes sure of.
PLANNED = {
    "lyrical": (
        "geometry_msgs/msg/PolygonStamped",
        "nav_msgs/msg/OccupancyGrid",
        "sensor_msgs/msg/CameraInfo",
        "std_msgs/msg/Int16MultiArray",
        "std_msgs/msg/UInt16MultiArray",
        "std_msgs/msg/UInt32MultiArray",
        "std_msgs/msg/UInt64MultiArray",
        "visualization_msgs/msg/InteractiveMarkerInit",
    ),
    "noetic": (
        "actionlib/TestRequestGoal",
        "actionlib_msgs/GoalStatusArray",
        "diagnostic_msgs/DiagnosticArray",
        "nav_msgs/MapMetaData",
        "sensor_msgs/CompressedImage",
        "sensor_msgs/JointState",
        "sensor_msgs/Joy",
        "sensor_msgs/MagneticField",
        "sensor_msgs/PointCloud",
        "std_msgs/ByteMultiArray",
        "std_msgs/Int16MultiArray",
        "std_msgs/Int8MultiArray",
        "std_msgs/UInt16MultiArray",
        "std_msgs/UInt32MultiArray",
        "std_msgs/UInt64MultiArray",
        "visualization_msgs/InteractiveMarker",
    ),
}
# Hardware has these features; the others are those of texts.
IN_HARDWARE = re.compile("layout: |plan: |definition: (?!constant |default )")
KNOWN = {("lyrical", "sensor_msgs/msg/Joy"): (NAN_KEY,)}


def options_of(distro: str, name: str) -> CaseOptions:
    """Return the options of a type; all cases are for `make nightly`."""
    if THOROUGH:
        return CaseOptions(bus_bytes=8)
    is_damaged = (KEPT[distro].index(name) + DISTROS.index(distro)) % 2 == 0
    return CaseOptions(
        bus_bytes=8,
        most_cases=MOST_CASES,
        stalled=not is_damaged,
        broken=is_damaged,
        simulated=name not in PLANNED[distro],
    )


@pytest.mark.parametrize(
    ("distro", "name"), [(distro, name) for distro in DISTROS for name in KEPT[distro]]
)
@pytest.mark.sampled(8)
def test_a_covering_type_passes(distro, name):
    result = accept(distro, name, options_of(distro, name))
    known = KNOWN.get((distro, name), ())
    assert assert_passed(result, known) >= result.cases > 0


@pytest.fixture(scope="module")
def stand_ins(tmp_path_factory):
    return str(stand_in_package(tmp_path_factory.mktemp("stand_ins")))


@pytest.mark.parametrize(
    ("distro", "name"), [(distro, name) for distro in DISTROS for name in STAND_INS[distro]]
)
@pytest.mark.sampled(4)
def test_a_small_type_with_features_of_large_ones_passes(stand_ins, distro, name):
    options = CaseOptions(bus_bytes=8, most_cases=by_depth(MOST_CASES, None), paths=(stand_ins,))
    result = accept(distro, f"stand_ins/msg/{name}", options)
    assert assert_passed(result) >= 2 * result.cases > 0


def planned(library, name):
    message = library.message(name)
    return message, plan_of(message, None, 8, DEFAULT_MAX_MESSAGE_BYTES)


@cache
def features(distro):
    """Return the features of each type of a distribution."""
    library = Library(distro)
    return {name: all_features(library, *planned(library, name)) for name in library.names()}


def missing(distro, kept):
    """Return the features of a distribution that none of the given types has."""
    found = features(distro)
    return set().union(*found.values()) - set().union(*(found[name] for name in kept))


@pytest.mark.snapshot
@pytest.mark.parametrize("distro", DISTROS)
def test_the_kept_types_have_every_feature(distro):
    assert missing(distro, KEPT[distro]) == set(), "choose again: make cover"
    # Must-fail twin: a type that is left out is missed.
    name = "rcl_interfaces/msg/ParameterValue" if distro == "lyrical" else "sensor_msgs/Joy"
    left = missing(distro, [each for each in KEPT[distro] if each != name])
    families = {feature.partition(":")[0] for feature in left}
    assert {"definition", "plan"} <= families


def in_hardware(types):
    """Return the features of types, pairs of a library and a name, that their hardware has."""
    found = set().union(
        *(all_features(library, *planned(library, name)) for library, name in types)
    )
    return {feature for feature in found if IN_HARDWARE.match(feature)}


@pytest.mark.snapshot
def test_every_feature_is_simulated(stand_ins):
    libraries = {distro: Library(distro, [stand_ins]) for distro in DISTROS}
    types = {
        (libraries[distro], name): name not in PLANNED[distro]
        for distro in DISTROS
        for name in KEPT[distro]
    }
    simulated = in_hardware(both for both, is_simulated in types.items() if is_simulated)
    small = in_hardware(
        (libraries[distro], f"stand_ins/msg/{name}")
        for distro in DISTROS
        for name in STAND_INS[distro]
    )
    assert in_hardware(types) <= simulated | small, "simulate more of the planned types"
    # Must-fail twin: without the small types, something is missing.
    assert not in_hardware(types) <= simulated


@pytest.mark.parametrize("distro", DISTROS)
def test_a_type_that_is_left_out_is_missed(distro):
    name = "rcl_interfaces/msg/ParameterValue" if distro == "lyrical" else "sensor_msgs/Joy"
    left = missing(distro, [each for each in KEPT[distro] if each != name])
    families = {feature.partition(":")[0] for feature in left}
    assert {"definition", "plan"} <= families
