"""Feed the front end with damaged definitions: each must end in a model or in a `DefinitionError`.

``python -m lab.fuzz_frontend -n 1000000 --jobs 2`` takes real files, damages each at random, and
asks a library for the type. Another exception, more than a second of processor time (for a long
input, up to three) or more than a gibibyte of memory is a finding: it is printed with its number,
cut down to what still shows it, and written to a file. The same seed and number make the same input
again: ``--seed S --only NUMBER``.

Real files come from the folder that ``FIRM_HDL_CORPUS`` names; without it, from ``errors/``.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import random
import resource
import signal
import sys
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from firm_hdl.errors import DefinitionError, Source
from firm_hdl.frontend import Library
from firm_hdl.frontend.names import Kind
from firm_hdl.frontend.sources import (
    Definition,
    EmbeddedOrigin,
    FolderOrigin,
    Language,
    Origin,
    PackagePlace,
)
from firm_hdl.terminal import printable_streams, progress, stage
from tests.damage import MOST_CHARACTERS, mutate

__all__ = ["Finding", "Fuzzer", "Seed", "main", "seeds"]

MOST_SECONDS = 1.0
# Characters for which an input has as long again: 40,000 in 10,000 lines took 1.04 s on a slow
# machine.
MORE_CHARACTERS = 20_000
MOST_BYTES = 1 << 30
# Inputs per library: a library keeps all of them in memory.
INPUTS_PER_TASK = 500
# Real files per library: it reads the dependencies of each of them.
SEEDS_PER_TASK = 50

DISTROS = {"ros1": "noetic", "ros2": "lyrical"}
ENDINGS: dict[str, Language] = {".msg": "msg", ".srv": "srv", ".action": "action", ".idl": "idl"}

KINDS: dict[str, Kind] = {"msg": "msg", "srv": "srv", "action": "action"}


@dataclass(frozen=True)
class Seed:
    """A real file."""

    dialect: str
    package: str
    kind: Kind
    name: str
    language: Language
    text: str


@dataclass(frozen=True)
class Finding:
    """An input that ended neither in a model nor in a `DefinitionError`."""

    number: int
    seed: Seed
    problem: str
    text: str


def seeds(folder: Path) -> list[Seed]:
    """Read all definitions in ``<folder>/ros1``, ``<folder>/ros2`` and below ``invalid``."""
    found = []
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        dialect = next((part for part in parts if part in DISTROS), None)
        kind = KINDS.get(path.parent.name)
        if dialect and path.suffix in ENDINGS and kind:
            text = path.read_bytes().decode("utf-8", "replace")
            if len(text) <= MOST_CHARACTERS:
                package = path.parent.parent.name
                language = ENDINGS[path.suffix]
                found.append(Seed(dialect, package, kind, path.stem, language, text))
    return found


class _InputOrigin:
    """An origin with the inputs that are being tried."""

    packages: ClassVar[dict[str, PackagePlace]] = {}

    def __init__(self) -> None:
        self.definitions: dict[tuple[str, Kind, str], Definition] = {}

    def names(self) -> Iterable[tuple[str, Kind, str]]:
        return self.definitions

    def find(self, package: str, kind: Kind, name: str) -> Definition | None:
        return self.definitions.get((package, kind, name))


class Fuzzer:
    """A fuzzer in one process.

    Parameters
    ----------
    folder : path
        The folder of the real files and of the packages that they need.
    seed : int
        The seed of all random numbers.
    """

    def __init__(self, folder: Path, seed: int) -> None:
        self._seed = seed
        self._seeds: dict[str, list[Seed]] = {}
        for one in seeds(folder):
            self._seeds.setdefault(one.language, []).append(one)
        self._origins: dict[str, list[Origin]] = {
            dialect: [FolderOrigin(folder / dialect), EmbeddedOrigin(distro)]
            for dialect, distro in DISTROS.items()
        }

    def input(self, number: int) -> tuple[Seed, str]:
        """Make the input of a number. All languages are equally likely."""
        rng = random.Random(f"{self._seed}:{number}")
        task, which = number // INPUTS_PER_TASK, rng.randrange(SEEDS_PER_TASK)
        pool = random.Random(f"{self._seed}:{task}:{which}")
        language = pool.choice(sorted(self._seeds))
        seed = pool.choice(self._seeds[language])
        other = rng.choice(self._seeds[language])
        # A struct has the name of its file, and each input has its own name.
        text = seed.text.replace(seed.name, _name(number)) if language == "idl" else seed.text
        return seed, mutate(rng, text, other.text)

    def run(self, numbers: Iterable[int]) -> tuple[Counter[str], list[Finding]]:
        """Try the inputs of some numbers; count the results."""
        inputs = {number: self.input(number) for number in numbers}
        libraries = {dialect: self._library(dialect, inputs) for dialect in DISTROS}
        counts: Counter[str] = Counter()
        findings = []
        for number, (seed, text) in inputs.items():
            outcome = _attempt(libraries[seed.dialect], seed, number, text)
            if outcome not in ("model", "error"):
                findings.append(
                    Finding(number, seed, outcome, self._smaller(number, seed, text, outcome))
                )
                outcome = "finding"
            counts[outcome] += 1
        return counts, findings

    def attempt(self, number: int, seed: Seed, text: str) -> str:
        """Try one text alone; its expected results are "model" and "error"."""
        library = self._library(seed.dialect, {number: (seed, text)})
        return _attempt(library, seed, number, text)

    def _library(self, dialect: str, inputs: Mapping[int, tuple[Seed, str]]) -> Library:
        origin = _InputOrigin()
        for number, (seed, text) in inputs.items():
            name = _name(number)
            source = Source(name=f"{name}.{seed.language}", text=text)
            definition = Definition(source=source, language=seed.language)
            if seed.dialect == dialect:
                origin.definitions[seed.package, seed.kind, name] = definition
        library = Library(DISTROS[dialect], origins=[origin, *self._origins[dialect]])
        # Work that is done once must not count for the first input.
        with suppress(DefinitionError):
            library.message("std_msgs/Nothing")
        return library

    def _smaller(self, number: int, seed: Seed, text: str, problem: str) -> str:
        """Cut a text down, as long as it shows the same problem, for at most a minute."""
        end = time.monotonic() + 60
        size = len(text) // 2
        while size:
            start = 0
            while start < len(text) and time.monotonic() < end:
                shorter = text[:start] + text[start + size :]
                if self.attempt(number, seed, shorter) == problem:
                    text = shorter
                else:
                    start += size
            size //= 2
        return text


def _name(number: int) -> str:
    return f"Fuzz{number}"


def _attempt(library: Library, seed: Seed, number: int, text: str) -> str:
    most = MOST_SECONDS * (1 + len(text) / MORE_CHARACTERS)
    start = time.process_time()
    try:
        with _alarm(most):
            interface = library.interface(f"{seed.package}/{seed.kind}/{_name(number)}")
            for message in interface.messages:
                assert message.depth > 0
            outcome = "model"
    except DefinitionError as error:
        outcome = "error" if str(error) else "an error without a text"
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        outcome = f"{type(error).__name__} in {_place_of(error)}"
    if time.process_time() - start > most:
        return "takes too long"
    return outcome


def _place_of(error: BaseException) -> str:
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    if trace is None:
        return "nowhere"
    code = trace.tb_frame.f_code
    return f"{Path(code.co_filename).name}:{trace.tb_lineno}"


class _TooLongError(BaseException):
    pass


@contextmanager
def _alarm(most: float) -> Iterator[None]:
    """Stop an input that takes ten times as long as allowed."""

    def stop(number: int, frame: object) -> None:
        raise _TooLongError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, 10 * most)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


_FUZZER: Fuzzer | None = None


def _prepare(folder: Path, seed: int) -> None:
    global _FUZZER
    _FUZZER = Fuzzer(folder, seed)
    # The memory that libraries reserve, above all numpy, differs from machine to machine.
    statistics = Path("/proc/self/statm")
    pages = int(statistics.read_text().split()[0]) if statistics.exists() else 0
    most = pages * resource.getpagesize() + MOST_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _task(numbers: range) -> tuple[Counter[str], list[Finding]]:
    assert _FUZZER is not None
    return _FUZZER.run(numbers)


def _report(finding: Finding, seed: int, out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"{seed}_{finding.number}.{finding.seed.language}"
    path.write_text(finding.text, encoding="utf-8", newline="")
    where = f"{finding.seed.dialect}/{finding.seed.package}/{finding.seed.kind}/{finding.seed.name}"
    print(f"--seed {seed} --only {finding.number}: {finding.problem}; from {where}; {path}")


def _ranges(count: int, first: int) -> Iterator[range]:
    for start in range(first, first + count, INPUTS_PER_TASK):
        yield range(start, min(start + INPUTS_PER_TASK, first + count))


def main(arguments: list[str] | None = None) -> int:
    """Run; the exit status is 1 if anything was found."""
    parser = argparse.ArgumentParser(prog="fuzz_frontend", description=__doc__.split("\n")[0])
    parser.add_argument("-n", type=int, default=1_000_000, help="number of inputs")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(10**6))
    parser.add_argument("--only", type=int, help="the one input of this number")
    parser.add_argument("--out", type=Path, default=Path("build/fuzz"), help="folder of findings")
    options = parser.parse_args(arguments)
    corpus = os.environ.get("FIRM_HDL_CORPUS")
    folder = Path(corpus) if corpus else Path(__file__).parents[1] / "tests" / "frontend" / "errors"
    first, count = (0, options.n) if options.only is None else (options.only, 1)
    print(f"--seed {options.seed}, {count} inputs from {folder}", flush=True)
    counts: Counter[str] = Counter()
    start = time.monotonic()
    pool = ProcessPoolExecutor(
        options.jobs,
        # A copy of a process with threads may hang.
        mp_context=multiprocessing.get_context("spawn"),
        initializer=_prepare,
        initargs=(folder, options.seed),
    )
    with pool, printable_streams(), progress("fuzzing"):
        tasks = [pool.submit(_task, numbers) for numbers in _ranges(count, first)]
        for task in as_completed(tasks):
            found, findings = task.result()
            counts += found
            for finding in findings:
                _report(finding, options.seed, options.out)
            stage("fuzzing: inputs", counts.total(), count)
    seconds = time.monotonic() - start
    print(
        f"{counts['model']} models, {counts['error']} errors, {counts['finding']} findings; "
        f"{count / seconds:.0f} inputs per second"
    )
    return 1 if counts["finding"] else 0


if __name__ == "__main__":
    sys.exit(main())
