"""What tests of TS1 share: a workspace made for one test, and oracles where they are installed."""

from __future__ import annotations

import os
from contextlib import ExitStack, closing
from itertools import count

import pytest

from firm_hdl.verify.ts1.judge import judge
from firm_hdl.verify.ts1.oracles import ORACLES
from firm_hdl.verify.ts1.universe import Universe, write_definitions
from tests.frontend.workspace import make_files


def tally_of(run):
    """Judge everything; return what came of it."""
    with closing(run.judgements()) as shares:
        return run.tally((number, found.said) for share in shares for number, found in share)


class Court:
    """Definitions in a folder, and oracles to put them before."""

    def __init__(self, distro, root, files, stack):
        (root / "src").mkdir(parents=True, exist_ok=True)
        make_files(root / "src", files)
        self.universe = Universe(distro, [str(root / "src")], str(root / "all"))
        write_definitions(self.universe)
        self._stack = stack

    def oracle(self, name):
        """Give an oracle. Where it is not installed, skip the test; in CI, fail it."""
        oracle = ORACLES[name](self.universe)
        self._stack.callback(oracle.close)
        need(name, oracle.missing())
        return oracle

    def answer(self, name, type_):
        """What an oracle says of a type."""
        (answer,) = self.oracle(name).judge(self.universe.select([type_]))
        return answer

    def outcome(self, name, type_):
        """What comes of the comparison."""
        (outcome,) = judge(self.universe, self.oracle(name), self.universe.select([type_]))
        return outcome


def need(name, missing):
    """Skip a test whose oracle is not installed; in CI, fail it."""
    if missing is None:
        return
    message = f"{name} is not installed (as root: make oracles): {missing}"
    if os.environ.get("CI"):
        pytest.fail(message)
    pytest.skip(message)


@pytest.fixture
def court(tmp_path):
    """Make a court of ``package/kind/file`` texts."""
    numbers = count()
    with ExitStack() as stack:
        yield lambda distro, files: Court(distro, tmp_path / str(next(numbers)), files, stack)
