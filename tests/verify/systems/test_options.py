"""The request of a user: what follows from its arguments, and the command that repeats a test."""

from __future__ import annotations

import shlex

import pytest

from firm_hdl.verify.systems.options import Request, command_again


@pytest.mark.parametrize(
    ("given", "named", "shares"),
    [
        ({}, False, True),
        ({"types": ("p/A",)}, True, False),
        ({"node": "node.yaml"}, True, True),
        ({"types": ("p/A",), "mutations": 9}, True, False),
        ({"bags": ("run.bag",)}, False, False),
        ({"share_circuits": False}, False, False),
        ({"types": ("p/A",), "share_circuits": True}, True, True),
    ],
)
def test_what_is_named_has_to_be_judged_and_simulated(given, named, shares):
    request = Request(**given)
    assert (request.is_named, request.shares_circuits) == (named, shares)


def test_the_command_is_one_that_a_shell_reads_back():
    options = {"path": ("a b", "c"), "seed": 0, "wire": None, "no_stalls": True, "broken": False}
    text = command_again("p/A", "p/It's", **options)
    assert shlex.split(text) == [
        *("firm-hdl", "verify", "--path", "a b", "--path", "c", "--seed", "0", "--no-stalls"),
        *("p/A", "p/It's"),
    ]
