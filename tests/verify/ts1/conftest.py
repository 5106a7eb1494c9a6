"""Fixtures of TS1: a workspace for one test, and the installed oracles."""

from __future__ import annotations

import os
from collections import Counter
from contextlib import closing
from functools import cache
from itertools import count
from types import SimpleNamespace

import pytest

from firm_hdl.verify.results.verdict import Failed
from firm_hdl.verify.ts1.judge import judge
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.universe import Universe, write_definitions
from tests.frontend.workspace import make_files


def judged_by(run):
    """Judge all definitions, all of one oracle.

    Returns
    -------
    Counter of (oracle, name of the verdict), int, list
        The number of definitions that both refuse, and the names and failures of those that differ.
    """
    with closing(run.judged(list(run.cases))) as shares:
        records = [record for share in shares for record in share]
    found = [(record.test, each) for record in records for each in record.verdicts]
    wrong = [
        (test.type, each.verdict.failures)
        for test, each in found
        if isinstance(each.verdict, Failed)
    ]
    verdicts = Counter((each.oracle, each.verdict.name) for _, each in found)
    return verdicts, sum(each.is_refused for _, each in found), wrong


class Court:
    """Definitions in a folder, and the oracles that judge them."""

    def __init__(self, distro, root, files, embedded):
        (root / "src").mkdir(parents=True, exist_ok=True)
        make_files(root / "src", files)
        self.universe = Universe(distro, [str(root / "src")], str(root / "all"))
        write_own_definitions(self.universe, embedded(distro))

    def oracle(self, name):
        """Return an oracle; if it is not installed, skip the test, or fail in CI."""
        oracle = ORACLES[name](self.universe)
        need(name, oracle.missing())
        return oracle

    def answer(self, name, type_):
        """Return the answer of an oracle about a type."""
        (case,) = self.universe.select([type_])
        return self.oracle(name).judge(case)

    def outcome(self, name, type_):
        """Return the outcome of the comparison."""
        (case,) = self.universe.select([type_])
        return judge(self.universe, self.oracle(name), case)


def write_own_definitions(universe, shared):
    """Do what `write_definitions` does, but link packages without files to those in `shared`."""
    own = {case.package for case in universe.by_source.values() if os.path.isfile(case.source)}
    few = {name: case for name, case in universe.by_source.items() if case.package in own}
    os.makedirs(universe.folder, exist_ok=True)
    for package in set(os.listdir(shared)) - own:
        os.symlink(shared / package, os.path.join(universe.folder, package))
    write_definitions(SimpleNamespace(by_source=few, folder=universe.folder))


def need(name, missing):
    """Skip a test whose oracle is not installed; in CI, fail it."""
    if missing is None:
        return
    message = f"{name} is not installed (as root: make oracles): {missing}"
    if os.environ.get("CI"):
        pytest.fail(message)
    pytest.skip(message)


@pytest.fixture(scope="session")
def embedded_definitions(tmp_path_factory):
    """A function that returns the folder of the definitions that firm-hdl has of a distro."""

    @cache
    def folder(distro):
        root = tmp_path_factory.mktemp(distro)
        write_definitions(Universe(distro, [], str(root / "all")))
        return root / "all"

    return folder


@pytest.fixture
def court(tmp_path, monkeypatch, embedded_definitions):
    """A function that makes a court from texts of ``package/kind/file``.

    Processes of oracles are used by all tests, and definitions of firm-hdl itself are written once.
    """
    for kind in ORACLES.values():
        monkeypatch.setattr(kind, "close", lambda self: None)
    numbers = count()
    return lambda distro, files: Court(
        distro, tmp_path / str(next(numbers)), files, embedded_definitions
    )
