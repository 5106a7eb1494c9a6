"""Yosys must not take an element of an array for a bit of the array."""

from __future__ import annotations

from firm_hdl.rtlil import without_indices


def test_elements_of_arrays_get_names_of_their_own() -> None:
    before = (
        "wire width 8 \\a.d\nwire width 2 \\a.d[1]\nwire \\A.D_1\nwire \\m[0][2].x\n"
        "connect \\a.d[1] \\a.d [3:2]\nconnect \\m[0][2].x \\a.d[1] [0]\n"
    )
    assert without_indices(before) == (
        "wire width 8 \\a.d\nwire width 2 \\a.d_1_2\nwire \\A.D_1\nwire \\m_0_2.x\n"
        "connect \\a.d_1_2 \\a.d [3:2]\nconnect \\m_0_2.x \\a.d_1_2 [0]\n"
    )


def test_two_elements_never_get_one_name() -> None:
    before = "wire \\a[0][1]\nwire \\a_0[1]\nwire \\A_0_1\n"
    assert without_indices(before) == "wire \\a_0_1_2\nwire \\a_0_1_3\nwire \\A_0_1\n"
