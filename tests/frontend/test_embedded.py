"""The types of every distribution, compared with rosbags, their source."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from rosbags.typesys import get_typestore

from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import DEFAULT_DISTRO, DISTROS, Library
from firm_hdl.verify.ros2_wheels import RELEASES

from .structure import field_descriptions


def need(what: str, is_here: bool, how: str) -> None:
    """Skip the test if something is not installed; in CI, fail it."""
    if not is_here:
        (pytest.fail if os.environ.get("CI") else pytest.skip)(f"{what} are not here {how}")


def test_distributions():
    assert [*DISTROS] == ["noetic", "foxy", "humble", "iron", "jazzy", "kilted", "lyrical"]
    assert {d.name for d in DISTROS.values() if d.dialect == "ros1"} == {"noetic"}
    assert DEFAULT_DISTRO == "lyrical"
    # Each has the types of its own name.
    for name, distro in DISTROS.items():
        assert distro.store.value == f"{distro.dialect}_{name}"


@pytest.mark.parametrize("distro", DISTROS)
def test_every_type_is_what_rosbags_has(distro):
    library = Library(distro)
    ours = {}
    for name in library.names():
        message = library.message(name)
        assert message.name == name
        constants = [(c.name, str(c.type), c.value) for c in message.constants]
        ours[f"{message.package}/msg/{message.base_name}"] = constants, field_descriptions(message)
    theirs = dict(get_typestore(DISTROS[distro].store).fielddefs)
    if library.dialect == "ros1":
        # In ROS 1 these two are builtin.
        del theirs["builtin_interfaces/msg/Time"], theirs["builtin_interfaces/msg/Duration"]
    padding = "structure_needs_at_least_one_member"
    assert ours == {
        name: (list(constants), [field for field in fields if field[0] != padding])
        for name, (constants, fields) in theirs.items()
    }
    assert len(ours) > 140


DEFAULTS = {
    "geometry_msgs/msg/Quaternion": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
    "rcl_interfaces/msg/ParameterDescriptor": {"read_only": False, "dynamic_typing": False},
    "sensor_msgs/msg/NavSatStatus": {"status": -2},
    "type_description_interfaces/msg/FieldType": {"type_id": 0},
}
LATER = {
    "foxy": {("ParameterDescriptor", "dynamic_typing"), ("NavSatStatus", "status")},
    "humble": {("NavSatStatus", "status")},
    "iron": {("NavSatStatus", "status")},
}


def defaults_of(message):
    return {f.name: f.default for f in message.fields if f.default is not None}


@pytest.mark.parametrize("distro", DISTROS)
def test_defaults_are_those_of_ros(distro):
    library = Library(distro)
    for name in library.names():
        want = {} if distro == "noetic" else DEFAULTS.get(name, {})
        base = name.rpartition("/")[2]
        want = {k: v for k, v in want.items() if (base, k) not in LATER.get(distro, ())}
        assert defaults_of(library.message(name)) == want, name


def test_defaults_are_those_of_the_corpus(corpus):
    embedded = Library("lyrical")
    real = Library("lyrical", [corpus / "ros2"], origins=())
    compared = 0
    for name in {*embedded.names()} & {*real.names()}:
        compared += 1
        assert defaults_of(embedded.message(name)) == defaults_of(real.message(name)), name
    assert compared > 150


@pytest.mark.parametrize("release", RELEASES, ids=lambda release: release.name)
def test_definitions_are_those_that_the_release_published(release):
    share = release.folder / "share"
    need(f"{release.name}'s definitions", (share / "sensor_msgs").is_dir(), release.how)
    embedded = Library(release.name)
    real = Library(release.name, [share])
    compared = 0
    for name in map(str, real.interfaces()):
        package, kind, base = name.split("/")
        if kind != "msg" or not (share / package / kind / f"{base}.msg").is_file():
            continue
        compared += 1
        ours, theirs = embedded.message(name), real.message(name)
        assert defaults_of(ours) == defaults_of(theirs), name
        assert field_descriptions(ours) == field_descriptions(theirs), name
        constants = [[(c.name, c.value) for c in each.constants] for each in (ours, theirs)]
        assert constants[0] == constants[1], name
    assert compared >= 78
    # Every field with a default was compared.
    assert {name.split("/")[0] for name in DEFAULTS} <= {path.name for path in share.iterdir()}


def missing_packages() -> dict[str, set[str]]:
    """Return the missing packages of each distribution, as the documentation lists them."""
    text = (Path(__file__).parents[2] / "docs" / "reference" / "limits.md").read_text()
    table = text.partition("### Packages that do not come with firm-hdl")[2].partition("\n## ")[0]
    rows = dict(re.findall(r"^\| ([a-z, ]+) \| (.*) \|$", table, re.MULTILINE))
    listed = {distro: {*re.findall(r"`(\w+)`", rows[distro])} for distro in ("noetic", "foxy")}
    assert rows["humble, iron, jazzy"] == "those of foxy"
    for distro in ("humble", "iron", "jazzy"):
        listed[distro] = listed["foxy"]
    replaced = re.search(r"without `(\w+)`, and `(\w+)` instead of `(\w+)`", rows["kilted"])
    assert replaced is not None
    listed["kilted"] = (listed["foxy"] | {replaced[2]}) - {replaced[1], replaced[3]}
    listed["lyrical"] = listed["kilted"] | {*re.findall(r"and `(\w+)`$", rows["lyrical"])}
    return listed


def test_packages_listed_as_missing_are_missing_and_named_in_errors():
    listed = missing_packages()
    assert [*listed] == [*DISTROS]
    assert "actionlib_msgs" in listed["lyrical"] and "turtlesim_msgs" in listed["kilted"]
    for distro, packages in listed.items():
        library = Library(distro)
        assert not packages & {name.split("/")[0] for name in library.names()}, distro
        for package in packages:
            with pytest.raises(DefinitionError, match="this ROS package does not come"):
                library.interface(f"{package}/Such")


@pytest.mark.parametrize(("distro", "package"), [("noetic", "tf2_msgs"), ("lyrical", "std_srvs")])
def test_missing_package_of_ros_is_distinguished_from_an_unknown_one(distro, package):
    with pytest.raises(DefinitionError) as caught:
        Library(distro).interface(f"{package}/Such")
    assert str(caught.value) == (
        f"error: package '{package}' is not found; this ROS package does not come with "
        f"firm-hdl: name a folder that has it with --path (in a node: 'paths'), or source the "
        f"setup file of an installation that does"
    )
    with pytest.raises(DefinitionError, match=r"package 'nobodys' is not found; --path names"):
        Library(distro).interface("nobodys/Such")
