"""The arguments of ``firm-hdl verify`` that are about client libraries."""

from __future__ import annotations

import argparse

from firm_hdl.verify.clients.run import SutOptions
from firm_hdl.verify.references.choice import NO_REFERENCE, WRITERS
from firm_hdl.verify.references.clients import CLIENTS

__all__ = ["add_sut_arguments", "check_sut", "references_of", "sut_options"]

# What a library is never asked, and what it is by default.
_OTHERS = {
    "bag": [],
    "bus_bytes": None,
    "executor": "processes",
    "golden": None,
    "mutations": 0,
    "oracle": [],
    "reference": [],
    "report": None,
    "results": None,
    "share_circuits": None,
    "simulator": "python",
    "systems": ["ts3"],
    "vcd": None,
}


def add_sut_arguments(group: argparse._ArgumentGroup, ts3: argparse._ArgumentGroup) -> None:
    """Add the arguments: of libraries under test, and of those that confirm bytes in TS3."""
    group.add_argument(
        "--sut",
        action="append",
        default=[],
        choices=list(CLIENTS),
        metavar="NAME",
        help="compare a client library with ROS's own serializer, instead of running test systems: "
        f"{', '.join(CLIENTS)}; repeatable",
    )
    ts3.add_argument(
        "--reference",
        action="append",
        default=[],
        choices=[*WRITERS, NO_REFERENCE],
        metavar="NAME",
        help="library that has to write the same bytes as rosbags: "
        f"{', '.join(WRITERS)}, or {NO_REFERENCE}; repeatable; default: all that are here",
    )


def check_sut(given: argparse.Namespace) -> None:
    """Refuse what does not go together."""
    if NO_REFERENCE in given.reference and len(given.reference) > 1:
        given.refuse(f"--reference {NO_REFERENCE} goes with no other")
    if not given.sut:
        return
    for name, default in _OTHERS.items():
        if getattr(given, name, default) != default:
            given.refuse(f"--{name.replace('_', '-')} does not go with --sut")
    if not (given.stalls and given.broken):
        given.refuse("--no-stalls and --no-broken do not go with --sut")


def references_of(given: argparse.Namespace) -> tuple[str, ...] | None:
    """Return the references of TS3 that are asked for; `None`: all that are here."""
    if not given.reference:
        return None
    return tuple(name for name in dict.fromkeys(given.reference) if name != NO_REFERENCE)


def sut_options(given: argparse.Namespace) -> SutOptions:
    """Return what is asked of libraries."""
    return SutOptions(
        libraries=tuple(dict.fromkeys(given.sut)),
        wire=given.wire,
        seed=given.seed,
        most_cases=given.cases,
        paths=tuple(given.path),
        names_wires=bool(given.distro or given.wire),
    )
