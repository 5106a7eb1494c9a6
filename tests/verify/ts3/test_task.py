"""Types whose circuits are the same; the key of a test, and the command that repeats it."""

from __future__ import annotations

import shlex

import pytest

from firm_hdl.verify.systems.options import CaseOptions
from firm_hdl.verify.systems.tasks import TypeUnderTest
from firm_hdl.verify.ts3.task import as_test, command_of, same_circuits
from tests.frontend.workspace import make_files


def test_circuits_are_those_of_the_first_task_with_the_same_plan(tmp_path):
    texts = {f"p/msg/{name}.msg": "string s\n" for name in "ABC"}
    texts |= {"p/msg/Other.msg": "int8 s\n", "p/msg/Wrong.msg": "Such s\n"}
    # These are longer than the usual limit of a message, which their circuits raise.
    texts |= {f"p/msg/{name}.msg": "uint8[20000000] x\n" for name in ("Long", "Longer")}
    options = CaseOptions(paths=(str(make_files(tmp_path, texts)),))
    names = ("Wrong", "A", "Other", "B", "C", "Long", "Longer")
    tasks = [TypeUnderTest(distro="lyrical", name=f"p/msg/{n}", same=("lyrical",)) for n in names]
    found = same_circuits(tasks, options)
    assert [(one.name, other.name) for one, other in found.items()] == [
        ("p/msg/B", "p/msg/A"),
        ("p/msg/C", "p/msg/A"),
        ("p/msg/Longer", "p/msg/Long"),
    ]


OTHER = CaseOptions(
    bus_bytes=4,
    wire="ros1",
    seed=3,
    broken=False,
    most_cases=9,
    simulator="ghdl",
    paths=("a", "b c"),
    references=("genpy", "fastcdr"),
    vcd="waves",
)
REPLAY = CaseOptions(bags=("x.bag", "y.bag"), longest=100, stalled=False, references=())


@pytest.mark.parametrize(
    ("options", "words", "key"),
    [
        (CaseOptions(), "--distro humble --bus-bytes 8 --seed 0", "cdr/8 seed=0"),
        (
            OTHER,
            "--distro humble --path a --path 'b c' --simulator ghdl --bus-bytes 4 --wire ros1 "
            "--seed 3 --no-broken --cases 9 --reference genpy --reference fastcdr --vcd waves",
            "ros1/4 seed=3,cases=9,no-broken,references=genpy+fastcdr,path=a,path=b c",
        ),
        (
            REPLAY,
            "--distro humble --bag x.bag --bag y.bag --max-message-bytes 100 --bus-bytes 8 "
            "--seed 0 --no-stalls --reference none",
            "cdr/8 seed=0,no-stalls,references=,bag=x.bag,bag=y.bag,longest=100",
        ),
    ],
)
def test_command_and_key_have_every_option_that_is_not_usual(options, words, key):
    text = command_of(options, "p/msg/A", distro="humble")
    assert shlex.split(text) == shlex.split(f"firm-hdl verify {words} p/msg/A")
    task = TypeUnderTest(distro="humble", name="p/msg/A", same=("humble", "jazzy"))
    test = as_test(task, options)
    assert test.key == f"ts3 {options.simulator} humble p/msg/A {key}"
    assert test.same == ("humble", "jazzy")
