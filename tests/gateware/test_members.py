"""Python names for ROS names."""

from hypothesis import given
from hypothesis import strategies as st

from firm_hdl.gateware.members import member_tree

names = st.lists(
    st.sampled_from(
        ["a", "b", "a_", "a__b", "a__valid", "a__ready", "b_", "_b", "clk", "clk_", "signature"]
    ),
    min_size=1,
    max_size=3,
)


def members(*paths):
    tree = member_tree(tuple(path.split(".")) for path in paths)
    return [".".join(path) for _, path in tree.leaves()]


def test_ordinary_names_stay_as_they_are():
    assert members("header.stamp.sec", "payload", "shape", "length.items") == [
        "header.stamp.sec",
        "payload",
        "shape",
        "length.items",
    ]


def test_reserved_names_get_an_underscore():
    assert members("signature", "metadata", "elaborate", "clk", "rst", "from.lambda") == [
        "signature_",
        "metadata_",
        "elaborate_",
        "clk_",
        "rst_",
        "from_.lambda_",
    ]


def test_names_that_would_share_a_port_are_kept_apart():
    # Amaranth joins parts with two underscores: both would be `a__b`, and one would be lost.
    assert members("a.b", "a__b") == ["a.b", "a__b_"]
    assert members("a__b", "a.b", "a.b_") == ["a__b__", "a.b", "a.b_"]
    assert members("clk", "clk_") == ["clk_", "clk__"]
    # Of names that may clash, the first one in wire order has as few underscores as possible.
    assert members("clk_", "clk") == ["clk_", "clk__"]
    for port in ("payload", "valid", "ready"):
        assert members("x", f"x__{port}") == ["x", f"x__{port}_"]
        assert members("a.x", f"a__x__{port}") == ["a.x", f"a__x__{port}_"]


@given(paths=st.lists(names.map(tuple), unique=True, min_size=1, max_size=8))
def test_no_two_leaves_ever_share_a_port(paths):
    # A path that continues another one cannot come from a message.
    paths = [p for p in paths if not any(q != p and q[: len(p)] == p for q in paths)]
    tree = member_tree(paths)
    ports = [
        "__".join((*path, port))
        for _, path in tree.leaves()
        for port in ("payload", "valid", "ready")
    ]
    assert len(set(ports)) == len(ports)
