"""Results are continued only with the same code and inputs; digests of both."""

from __future__ import annotations

import os

import pytest

from firm_hdl.verify.results.environment import environment, inputs_digest
from tests.frontend.workspace import make_files

TEXTS = {"p/msg/A.msg": "int8 a\n", "p/msg/B.msg": "int8 b\n", "p/package.xml": "<package/>"}


def digest_of(folder, files=TEXTS):
    return inputs_digest([str(make_files(folder, files))])


def test_the_same_inputs_have_one_digest_wherever_they_are(tmp_path):
    assert digest_of(tmp_path / "a") == digest_of(tmp_path / "b")
    # What no definition is read from does not count.
    assert digest_of(tmp_path / "c", TEXTS | {"p/README.md": "x"}) == digest_of(tmp_path / "a")


@pytest.mark.parametrize(
    "files",
    [
        TEXTS | {"p/msg/A.msg": "int8 c\n"},
        TEXTS | {"p/package.xml": "<package></package>"},
        TEXTS | {"p/msg/C.msg": ""},
        {name: text for name, text in TEXTS.items() if name != "p/msg/B.msg"},
        # The same texts in files of other names.
        {name.replace("A.msg", "0.msg"): text for name, text in TEXTS.items()},
        {name.replace("p/", "q/"): text for name, text in TEXTS.items()},
    ],
)
def test_every_change_of_an_input_changes_the_digest(files, tmp_path):
    assert digest_of(tmp_path / "a") != digest_of(tmp_path / "b", files)


def test_a_recording_counts_by_its_size_and_its_time(tmp_path):
    bag = tmp_path / "run.bag"
    seen = []
    for text, time in (("abc", 1000), ("abcd", 1000), ("abcd", 1001), ("xyzw", 1001)):
        bag.write_text(text)
        os.utime(bag, (time, time))
        seen.append(inputs_digest([str(bag)]))
    # The content is not read.
    assert len(set(seen[:3])) == 3 and seen[3] == seen[2]
    bag.unlink()
    assert inputs_digest([str(bag)]) not in seen


def test_an_environment_has_versions_and_what_is_added():
    found = environment(executor="processes")
    assert found["executor"] == "processes" and found["amaranth"][0].isdigit()
    assert {"started", "firm-hdl", "Python", "system", "processors"} <= found.keys()
