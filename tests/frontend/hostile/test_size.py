"""Definitions that are unusually deep, long or wide: no recursion, and no long run time."""

from __future__ import annotations

import pytest

from firm_hdl.frontend import Library, show
from firm_hdl.model import Array
from tests.depth import by_depth
from tests.frontend.workspace import make_files
from tests.steps import calls_at_most

DISTROS = {"ros1": "noetic", "ros2": "lyrical"}
# More than Python's stack has.
DEEP = by_depth(1100, 5000)


@pytest.fixture(scope="module")
def deep(tmp_path_factory):
    """A chain of nested messages, with a service and an action around the outermost."""
    files = {f"p/msg/T{i}.msg": f"T{i + 1} a\n" for i in range(DEEP)}
    files[f"p/msg/T{DEEP}.msg"] = "int8 x\n"
    files["p/srv/S.srv"] = "T0 a\n---\nT0[] b\n"
    files["p/action/A.action"] = "T0 a\n---\n---\n"
    return make_files(tmp_path_factory.mktemp("ws"), files)


@pytest.mark.parametrize("dialect", DISTROS)
def test_depth_is_not_limited(deep, dialect):
    library = Library(DISTROS[dialect], [deep])
    message = library.message("p/T0")
    assert message.depth == DEEP + 1
    assert message.is_fixed_size
    assert len(library.definition_hash(message)) == 64
    indent = "  " if dialect == "ros1" else "\t"
    assert show(library, "p/T0").splitlines()[-1] == indent * DEEP + "int8 x"
    # Models of two libraries are equal, and their hashes are.
    other = Library(DISTROS[dialect], [deep]).message(f"p/T{DEEP - 100}")
    assert other == library.message(f"p/T{DEEP - 100}")
    assert hash(other) == hash(library.message(f"p/T{DEEP - 100}"))


@pytest.mark.parametrize("dialect", DISTROS)
def test_depth_of_services_and_actions_is_not_limited(deep, dialect):
    library = Library(DISTROS[dialect], [deep])
    service, action = library.interface("p/S"), library.interface("p/A")
    assert (service.request.depth, service.request.is_fixed_size) == (DEEP + 2, True)
    assert not service.response.is_fixed_size
    assert max(m.depth for m in action.messages) == DEEP + 4
    assert len({library.definition_hash(name) for name in ("p/S", "p/A")}) == 2
    lines = show(library, "p/srv/S").splitlines()
    assert lines.index("---") == DEEP + 2


@pytest.mark.parametrize("dialect", DISTROS)
def test_a_lattice_is_evaluated_once_for_each_message(tmp_path, dialect):
    # 2**60 ways from top to bottom.
    files = {f"p/msg/T{i}.msg": f"T{i + 1} a\nT{i + 1}[2] b\n" for i in range(60)}
    make_files(tmp_path, files | {"p/msg/T60.msg": "int8 x"})
    library = Library(DISTROS[dialect], [tmp_path])
    message = library.message("p/T0")
    assert (message.depth, message.is_fixed_size) == (61, True)
    assert len(library.definition_hash("p/T0")) == 64


@pytest.mark.parametrize("dialect", DISTROS)
def test_many_fields_take_little_time(tmp_path, dialect):
    count = by_depth(1500, 12_000)
    text = "".join(f"float64 field{i}  # number {i}\n" for i in range(count))
    make_files(tmp_path, {"p/msg/T.msg": text})
    with calls_at_most(by_depth(800_000, 10_000_000)):
        library = Library(DISTROS[dialect], [tmp_path])
        message = library.message("p/T")
        assert len(message.fields) == count
        assert message.fields[-1].span.line == count
        assert show(library, "p/T").count("\n") == count
        assert len(library.definition_hash("p/T")) == 64


@pytest.mark.parametrize("dialect", DISTROS)
def test_large_arrays_are_not_unrolled(tmp_path, dialect):
    make_files(tmp_path, {"p/srv/S.srv": f"uint8[{1 << 23}] a\n---\nuint8[{2**32 - 1}] b\n"})
    with calls_at_most(100_000):
        library = Library(DISTROS[dialect], [tmp_path])
        service = library.interface("p/S")
        kinds = [part.fields[0].type for part in (service.request, service.response)]
        assert all(isinstance(kind, Array) for kind in kinds)
        assert [kind.count for kind in kinds] == [1 << 23, 2**32 - 1]
        assert show(library, "p/S") == f"uint8[{1 << 23}] a\n---\nuint8[{2**32 - 1}] b\n"
