"""Type libraries shared by the tests of a process."""

from __future__ import annotations

import pytest

from firm_hdl.errors import DefinitionError
from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.tasks import (
    TypeUnderTest,
    UnknownTypeError,
    collect_own,
    collect_tasks,
    library_of,
)
from tests.frontend.recordings import make_recording
from tests.frontend.workspace import make_files


def test_a_relative_folder_is_that_of_the_working_folder(tmp_path, monkeypatch):
    found = []
    for name in ("One", "Two"):
        make_files(tmp_path / name / "src", {f"p/msg/{name}.msg": "int8 x\n"})
        monkeypatch.chdir(tmp_path / name)
        library = library_of("lyrical", CaseOptions(paths=("src",)))
        assert library is library_of("lyrical", CaseOptions(paths=("src",)))
        found.append([each for each in library.interfaces() if each.startswith("p/")])
    assert found == [["p/msg/One"], ["p/msg/Two"]]


def test_a_recording_is_a_source_without_any_folder(tmp_path):
    library = library_of("lyrical", CaseOptions(bags=(str(make_recording(tmp_path, "mcap")),)))
    assert library.message("my_msgs/msg/Wheel").name == "my_msgs/msg/Wheel"


def test_a_type_is_one_task_for_the_distributions_that_define_it_equally():
    names = ["std_msgs/String", "std_msgs/msg/Header", "sensor_msgs/msg/Imu"]
    found = collect_tasks(["noetic", "humble", "lyrical"], names)
    # The header of ROS 1 has a number that the header of ROS 2 has not. The largest comes first.
    for name in ("std_msgs/msg/Header", "sensor_msgs/msg/Imu"):
        assert [task for task in found if task.name == name] == [
            TypeUnderTest(distro="noetic", name=name, same=("noetic",)),
            TypeUnderTest(distro="lyrical", name=name, same=("humble", "lyrical")),
        ]
    assert [task.name.rpartition("/")[2] for task in found] == [
        *("Imu", "Imu", "Header", "Header", "String", "String"),
    ]


def test_names_that_no_distribution_has_are_all_told():
    names = ["std_msgs/msg/Bool", "no_msgs/Such", "no_msgs/msg/Other"]
    text = "o distribution has no_msgs/msg/Other, no_msgs/msg/Such"
    with pytest.raises(UnknownTypeError, match=f"^N{text}$"):
        collect_tasks(["lyrical"], names)
    problems = {}
    (task,) = collect_tasks(["lyrical"], names, problems=problems)
    assert task.name == "std_msgs/msg/Bool" and list(problems) == [f"error: n{text}"]
    with pytest.raises(UnknownTypeError):
        collect_tasks(["lyrical"], names[1:], problems={})


OWN = {
    "own/p/msg/Small.msg": "int8 a\nint8 b\nint8 c\n",
    # Its own field is one, and those of the nested types are four.
    "own/p/msg/Big.msg": "q/Deep deep\n",
    "own/p/srv/Ask.srv": "int8 x\n---\nint8 y\n",
    "more/q/msg/Deep.msg": "p/Small s\n",
}


@pytest.fixture
def own(tmp_path):
    make_files(tmp_path, OWN)
    return [str(tmp_path / "own"), str(tmp_path / "more")]


def test_all_types_of_the_own_folders_are_tested_and_of_no_others(own):
    found = collect_own(["lyrical"], (), own[:1], depends=own[1:])
    names = [task.name for task in found]
    # The largest comes first.
    assert names.index("p/msg/Big") < names.index("p/msg/Small")
    assert sorted(names) == [
        *("p/msg/Big", "p/msg/Small"),
        *("p/srv/Ask_Event", "p/srv/Ask_Request", "p/srv/Ask_Response"),
    ]
    both = collect_own(["lyrical", "noetic"], ["q/Deep"], own)
    assert [(task.distro, task.name, task.same) for task in both] == [
        ("lyrical", "q/msg/Deep", ("lyrical",)),
        ("noetic", "q/Deep", ("noetic",)),
    ]
    assert "q/msg/Deep" in [task.name for task in collect_own(["lyrical"], (), own)]


def test_each_wrong_definition_is_told_and_the_others_are_tested(own, tmp_path):
    make_files(tmp_path, {"own/p/msg/Bad.msg": "Such a\nint8 int8 int8\nOther b\n"})
    problems = {}
    names = ["p/Bad", "p/Small"]
    assert [task.name for task in collect_own(["lyrical"], names, own, problems=problems)] == [
        "p/msg/Small"
    ]
    with pytest.raises(DefinitionError) as error:
        collect_own(["lyrical"], names, own)
    assert len(problems) > 1 and "\n".join(problems) == str(error.value)
    # Nothing is left of what was named, so there is nothing to test.
    with pytest.raises(DefinitionError):
        collect_own(["lyrical"], names[:1], own, problems={})


def test_a_type_that_is_too_large_is_an_error_only_if_it_is_named(tmp_path):
    """A hundred million fields cannot be laid out, but the definition is valid."""
    texts = {
        f"p/msg/L{level}.msg": "".join(
            f"{f'L{level + 1}' if level < 3 else 'uint8'} f{n}\n" for n in range(100)
        )
        for level in range(4)
    }
    path = [str(make_files(tmp_path, texts))]
    problems = {}
    assert len(collect_own(["lyrical"], (), path, problems=problems)) == 4 and not problems
    with pytest.raises(DefinitionError, match="has 100000000 fields"):
        collect_own(["lyrical"], ["p/L0"], path, problems={})
