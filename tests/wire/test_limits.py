"""Types that are too large to lay out: they are counted and refused by name, quickly."""

from __future__ import annotations

from pathlib import Path

import pytest

import firm_hdl
from firm_hdl import load_message
from firm_hdl.errors import DefinitionError
from firm_hdl.frontend import Library, show
from firm_hdl.identity import proto
from firm_hdl.metrics import metrics_of
from firm_hdl.model import PRIMITIVES, Array, Field, Message, Sequence
from firm_hdl.plan import build_plan
from firm_hdl.timing import timing
from firm_hdl.wire import MAX_LEAVES, MAX_LEVELS, lay_out, refusals
from tests.frontend.workspace import make_files
from tests.steps import calls_at_most

INT8 = PRIMITIVES["ros2"]["int8"]


def message(name, *kinds, dialect="ros2"):
    fields = tuple(Field(name=f"f{number}", type=kind) for number, kind in enumerate(kinds))
    return Message(name=f"p/msg/{name}", dialect=dialect, fields=fields)


def tree(levels, width):
    kind = message("L0", INT8)
    for level in range(1, levels):
        kind = message(f"L{level}", *[kind] * width)
    return kind


def chain(levels, wrap=lambda kind: kind):
    kind = message("L0", INT8)
    for level in range(1, levels):
        kind = message(f"L{level}", INT8, wrap(kind))
    return kind


def test_a_tree_that_explodes_is_counted_not_laid_out():
    with calls_at_most(20_000), pytest.raises(DefinitionError) as caught:
        lay_out(tree(8, 100))
    assert str(caught.value) == (
        "error: p/msg/L7 has 100000000000000 fields when all messages in it are written out, and "
        "at most 32767 can be laid out"
    )


def test_depth_beyond_the_limit_is_refused_by_name():
    with pytest.raises(DefinitionError) as caught:
        lay_out(chain(480))
    assert str(caught.value) == (
        "error: p/msg/L479 has 480 levels of messages, and at most 32 can be laid out"
    )


@pytest.mark.parametrize("count", [MAX_LEAVES, MAX_LEAVES + 1])
def test_the_limit_of_fields_is_exact(count):
    first, rest = message("A", *[INT8] * 1000), count - 32 * 1000
    top = message("T", *[first] * 32, *[INT8] * rest)
    assert top.leaf_count == count
    assert bool(refusals(top)) == (count > MAX_LEAVES)
    if not refusals(top):
        assert len(lay_out(top).nodes) == count


@pytest.mark.parametrize(
    "wrap",
    [
        lambda kind: kind,
        lambda kind: Sequence(element=kind, bound=None),
        lambda kind: Array(element=kind, count=1),
    ],
)
@pytest.mark.parametrize("levels", [MAX_LEVELS, MAX_LEVELS + 1])
def test_the_limit_of_levels_is_exact_and_what_is_below_it_works(levels, wrap):
    top = chain(levels, wrap)
    assert bool(refusals(top)) == (levels > MAX_LEVELS)
    if not refusals(top):
        plan = build_plan(lay_out(top))
        assert timing(plan).shortest.bytes >= 4


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_fields_are_counted_as_by_the_metrics(distro):
    library = Library(distro)
    for name in library.names():
        found = library.message(name)
        assert found.leaf_count == metrics_of(found).leaves, name


@pytest.mark.parametrize("distro", ["noetic", "lyrical"])
def test_text_that_explodes_is_counted_not_written(tmp_path, distro):
    files = {
        f"p/msg/L{level}.msg": "\n".join(f"L{level - 1} f{i}" for i in range(100))
        for level in range(1, 8)
    }
    library = Library(distro, [make_files(tmp_path, {**files, "p/msg/L0.msg": "int8 x\n"})])
    top = library.message("p/L7")
    with calls_at_most(90_000), pytest.raises(DefinitionError) as caught:
        show(library, "p/L7")
    assert "is shown in" in str(caught.value)
    with calls_at_most(1_500_000), pytest.raises(DefinitionError, match="an example of"):
        proto(top)


def test_loops_in_loops_end_the_search_for_the_hardest_packet(monkeypatch):
    monkeypatch.setattr("firm_hdl.timing.figures.MAX_TRANSFERS", 100)
    top = chain(10, lambda kind: Sequence(element=kind, bound=None))
    plan = build_plan(lay_out(top))
    with calls_at_most(110_000):
        assert timing(plan).hardest.bytes < 1000


def test_figures_of_too_large_types_are_refused():
    with pytest.raises(DefinitionError) as caught:
        metrics_of(tree(300, 100))
    assert str(caught.value) == (
        "error: p/msg/L299 has more than 10^100 fields when it is written out"
    )


def test_limit_of_a_length_is_the_documented_one():
    plan = build_plan(lay_out(load_message("sensor_msgs/msg/PointCloud2")))
    limits = {str(plan.leaves[leaf]): length.limit for leaf, length in plan.lengths.items()}
    limit = limits["fields.length"]
    # 4 bytes of encapsulation, 24 up to the fields, 16 each with padding, and 17 after them.
    fits = (plan.max_message_bytes - 4 - 24 - 17) // 16
    assert fits < limit
    text = (Path(firm_hdl.__file__).parent.parent / "docs" / "reference" / "status.md").read_text()
    sentence = f"the limit is {limit:,} `fields`, and packets of that size can hold {fits:,}."
    assert sentence in " ".join(text.split())
