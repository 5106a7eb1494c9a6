"""The accelerator that sends messages back: which descriptions it takes."""

from __future__ import annotations

import re

import pytest

from firm_hdl.errors import UserError
from firm_hdl.node.loop import Loop
from tests.node.samples import read

HEAD = "node: n\ndistro: jazzy\n"
TWO = "{type: std_msgs/msg/UInt16}"
ONE = "{type: std_msgs/msg/UInt8}"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (
            f"subscribe: {{/a: {TWO}}}\npublish: {{/b: {ONE}}}",
            "a loop needs a publication of std_msgs/msg/UInt16 for '/a'",
        ),
        (
            f"publish: {{/b: {ONE}}}",
            "a loop needs a subscription of std_msgs/msg/UInt8 for '/b'",
        ),
        (
            f"subscribe: {{/a: {TWO}, /b: {TWO}}}\npublish: {{/c: {TWO}}}",
            "a loop needs a publication of std_msgs/msg/UInt16 for '/b'",
        ),
        (
            "serve: {/c: {type: robot_msgs/srv/Calibrate}}",
            "a loop has no services, and '/c' is one",
        ),
    ],
)
def test_a_topic_without_a_partner_is_refused(text, reason):
    with pytest.raises(UserError, match=f"^{re.escape(reason)}$"):
        Loop(read(HEAD + text))


def test_partners_are_of_one_type_in_their_order():
    text = f"publish: {{/c: {TWO}, /d: {ONE}, /e: {TWO}}}\nsubscribe: {{/a: {ONE}, /b: {TWO}}}"
    description = read(HEAD + text)
    assert [(came.name, goes.name) for came, goes in description.loops()] == [
        ("/a", "/d"),
        ("/b", "/c"),
    ]
    # Each has one partner, however many there are.
    with pytest.raises(UserError, match=r"for '/e'$"):
        Loop(description)
    members = Loop(read(HEAD + text.replace(f", /e: {TWO}", ""))).signature.members
    assert {"subscribe", "publish", "time"} == set(members)
