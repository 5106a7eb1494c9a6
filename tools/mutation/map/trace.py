"""A plugin of pytest: record the lines that each test runs, in all its processes, and its time.

Use it by ``-p tools.mutation.map.trace``, with the name of a folder in the environment. Each test
is a context of coverage, named by its number. Code that runs once for several tests is marked.
Imports have no context. Cached functions and fixtures of a wider scope have a context with a ``+``
before the number of the first test that needs them.

Killed processes, and processes started without this environment, leave no lines. Tests with such
processes are reported as opaque.
"""

from __future__ import annotations

import contextlib
import functools
import json
import multiprocessing.process
import os
import resource
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import coverage
import pytest

from tools.mutation.chosen import remove_time_limits

__all__ = ["EACH", "FOLDER", "SETTINGS"]

FOLDER = "FIRM_HDL_MUTATION_TRACE"
EACH = "FIRM_HDL_MUTATION_EACH"
CONTEXT = "FIRM_HDL_MUTATION_TEST"
# Every process except the first one has a single context: that of the test that started it. The
# name of its data file also has the context, in case the process runs no line of the program.
SETTINGS = f"""[run]
data_file = {{folder}}/data.${{{{{CONTEXT}-}}}}
parallel = true
source = {{source}}
concurrency = multiprocessing,thread
context = ${{{{{CONTEXT}-}}}}
disable_warnings = no-data-collected,module-not-measured,module-not-imported,already-imported,
  trace-changed,couldnt-parse,no-sysmon,no-ctracer
"""
PROGRAMS = ("python", "firm-hdl")
OURS = os.path.dirname(coverage.__file__)


class _Trace:
    """The contexts of coverage, and the records of the tests."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        settings = folder / "settings"
        os.environ["COVERAGE_PROCESS_START"] = str(settings)
        os.environ[CONTEXT] = ""
        self._coverage = coverage.Coverage(config_file=str(settings), context="")
        self._depth = 0
        self._test = ""
        self.tests: list[dict[str, Any]] = []
        # Tests that were left out, because other tests of the same function took long enough.
        self.skipped: list[dict[str, Any]] = []
        self.snapshot = False
        # Processor time by name of the test without parameters.
        self.seconds: dict[str, float] = defaultdict(float)
        self._coverage.start()

    def enter(self, nodeid: str) -> None:
        """Begin a test."""
        self._test = str(len(self.tests))
        self.tests.append({"id": nodeid, "started": 0, "lost": False, "snapshot": self.snapshot})
        self.tests[-1]["cpu"] = -_cpu_seconds()
        os.environ[CONTEXT] = self._test
        self._coverage.switch_context(self._test)

    def leave(self) -> None:
        """End the test."""
        self.tests[-1]["cpu"] += _cpu_seconds()
        self.seconds[self.tests[-1]["id"].partition("[")[0]] += self.tests[-1]["cpu"]
        self._test = ""
        os.environ[CONTEXT] = ""
        self._coverage.switch_context("")

    @contextlib.contextmanager
    def shared(self) -> Iterator[None]:
        """Mark lines that run for other tests, too."""
        self._depth += 1
        if self._depth == 1 and self._test:
            self._coverage.switch_context(f"+{self._test}")
        try:
            yield
        finally:
            self._depth -= 1
            if self._depth == 0 and self._test:
                self._coverage.switch_context(self._test)

    def mark_opaque(self) -> None:
        """Note that lines of the test may be missing."""
        if self._test:
            self.tests[-1]["lost"] = True

    def count_process(self) -> None:
        """Count a started process, so that missing lines of it are detected."""
        if self._test:
            self.tests[-1]["started"] += 1

    def end(self) -> None:
        """Write the lines and the records to files."""
        self._coverage.stop()
        self._coverage.save()
        given = {"tests": self.tests, "skipped": self.skipped}
        (self._folder / "tests.json").write_text(json.dumps(given))


_trace: _Trace | None = None
_main = os.getpid()


def _cpu_seconds() -> float:
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def _here() -> _Trace | None:
    """Return the trace; `None` in forked processes."""
    return _trace if os.getpid() == _main else None


@pytest.hookimpl(tryfirst=True)
def pytest_load_initial_conftests() -> None:
    """Begin tracing before any module of the program is loaded."""
    global _trace, _main
    _main = os.getpid()
    _trace = _Trace(Path(os.environ[FOLDER]))
    _watch_caches()
    _watch_processes()


def pytest_configure() -> None:
    """Remove time limits, because tracing makes tests slower."""
    remove_time_limits()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> bool | None:
    """Leave out further sets of parameters of a test that has used its time, if it has a limit."""
    assert _trace
    _trace.snapshot = item.get_closest_marker("snapshot") is not None
    if _trace.seconds[item.nodeid.partition("[")[0]] <= float(os.environ.get(EACH) or "inf"):
        return None
    _trace.skipped.append({"id": item.nodeid, "snapshot": _trace.snapshot})
    # Tear down fixtures that the previous test has left for this one.
    item.session._setupstate.teardown_exact(nextitem)
    return True


def pytest_runtest_logstart(nodeid: str) -> None:
    """Begin the context of a test."""
    assert _trace
    _trace.enter(nodeid)


def pytest_runtest_logfinish() -> None:
    """End the context of the test."""
    assert _trace
    _trace.leave()


@pytest.hookimpl(wrapper=True)
def pytest_fixture_setup(fixturedef: pytest.FixtureDef[Any]) -> Iterator[None]:
    """Mark lines of fixtures that serve several tests."""
    assert _trace
    wide = fixturedef.scope != "function"
    with _trace.shared() if wide else contextlib.nullcontext():
        return (yield)


def pytest_sessionfinish() -> None:
    """Write the results at the end of the session."""
    assert _trace
    _trace.end()


def _watch_caches() -> None:
    """Mark lines of cached functions: later tests use the result without running the lines."""
    lru_cache, cached_property = functools.lru_cache, functools.cached_property

    def watched(function: Callable[..., Any]) -> Callable[..., Any]:
        if not getattr(function, "__module__", "").startswith(("firm_hdl", "tests")):
            return function

        @functools.wraps(function)
        def run(*args: Any, **keywords: Any) -> Any:
            trace = _here()
            with trace.shared() if trace else contextlib.nullcontext():
                return function(*args, **keywords)

        return run

    def watched_cache(maxsize: Any = 128, typed: bool = False) -> Any:
        if callable(maxsize):
            return lru_cache(watched(maxsize))
        return lambda function: lru_cache(maxsize, typed)(watched(function))

    class WatchedProperty(cached_property):  # type: ignore[misc, valid-type]
        def __init__(self, function: Callable[..., Any]) -> None:
            super().__init__(watched(function))

    functools.lru_cache = watched_cache
    functools.cache = watched_cache(None)
    functools.cached_property = WatchedProperty  # type: ignore[assignment, misc]


def _watch_processes() -> None:
    """Count the processes that should leave lines; note events that hide lines of this process."""

    def audit(event: str, arguments: tuple[Any, ...]) -> None:
        if event not in ("subprocess.Popen", "sys.settrace", "os.fork"):
            return
        trace = _here()
        if trace is None:
            return
        if event == "subprocess.Popen":
            name = os.path.basename(os.fsdecode(arguments[0] or ""))
            if name.startswith(PROGRAMS) and not str(arguments[0]).startswith("/usr/"):
                trace.count_process()
        elif event == "os.fork" and not _starting:
            trace.count_process()
        elif event == "sys.settrace" and not sys._getframe(1).f_code.co_filename.startswith(OURS):
            trace.mark_opaque()

    _starting: list[bool] = []
    start = multiprocessing.process.BaseProcess.start

    def started(process: multiprocessing.process.BaseProcess) -> None:
        trace = _here()
        if trace:
            trace.count_process()
        _starting.append(True)
        try:
            start(process)
        finally:
            _starting.pop()

    multiprocessing.process.BaseProcess.start = started  # type: ignore[assignment, method-assign]
    sys.addaudithook(audit)
