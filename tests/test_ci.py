"""Files of CI services: their targets exist, and earlier jobs make the artifacts of later ones."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[1]
GITLAB = ROOT / ".gitlab-ci.yml"
GITHUB = ROOT / ".github" / "workflows" / "ci.yml"
# Top-level keys of GitLab that are not jobs; its file may use these.
NOT_JOBS = {"stages", "default", "variables", "workflow", "include"}
JOB_KEYWORDS = {
    "artifacts", "cache", "extends", "image", "needs", "parallel", "publish", "rules", "script",
    "stage", "timeout", "variables", "when",
}  # fmt: skip
# Files that targets read and that an earlier job has to write.
READS = {"simulate": "build/vhdl_out", "report": "build/verify"}


@dataclass(frozen=True, kw_only=True)
class Job:
    """A job of either service."""

    name: str
    stage: str | None
    commands: tuple[str, ...]
    needs: tuple[str, ...]
    makes: frozenset[str]
    takes: frozenset[str] | None  # None: all artifacts of the jobs that it needs.


def targets(makefile: str) -> dict[str, set[str]]:
    """Return the targets, each with its dependencies and with those that its recipe makes."""
    rules = re.findall(r"^([a-z0-9-]+):([^#=\n]*).*\n((?:\t.*\n)*)", makefile, re.MULTILINE)
    return {
        name: {*needs.split(), *" ".join(re.findall(r"@\$\(MAKE\)(.*)", recipe)).split()}
        for name, needs, recipe in rules
    }


def gitlab_jobs(text: str) -> Iterator[Job]:
    everything = yaml.safe_load(text)
    for name, job in everything.items():
        if name in NOT_JOBS or name.startswith("."):
            continue
        job = {**everything.get(job.get("extends"), {}), **job}
        assert set(job) <= JOB_KEYWORDS, name
        paths = job.get("artifacts", {}).get("paths", [])
        yield Job(
            name=name,
            stage=job["stage"],
            commands=tuple(job["script"]),
            needs=tuple(job.get("needs", [])),
            makes=frozenset(paths),
            takes=None,
        )


def github_jobs(text: str) -> Iterator[Job]:
    uploads, downloads = {}, {}
    jobs = yaml.safe_load(text)["jobs"]
    for name, job in jobs.items():
        for step in job["steps"]:
            action = step.get("uses", "").partition("@")[0]
            if action == "actions/upload-artifact":
                uploads.setdefault(name, {})[step["with"]["name"]] = step["with"]["path"]
            elif action == "actions/download-artifact":
                downloads.setdefault(name, {})[step["with"]["name"]] = step["with"]["path"]
    uploaded = {(each, path) for found in uploads.values() for each, path in found.items()}
    for name, job in jobs.items():
        needs = job.get("needs", [])
        taken = downloads.get(name, {})
        yield Job(
            name=name,
            stage=None,
            commands=tuple(step["run"] for step in job["steps"] if "run" in step),
            needs=(needs,) if isinstance(needs, str) else tuple(needs),
            makes=frozenset(uploads.get(name, {}).values()),
            takes=frozenset(path for each, path in taken.items() if (each, path) in uploaded),
        )


def problems(jobs: list[Job], stages: list[str] | None, makefile: str) -> Iterator[str]:
    known = targets(makefile)
    by_name = {job.name: job for job in jobs}
    run: set[str] = set()
    for job in jobs:
        named = [word for command in job.commands for word in targets_of(command)]
        run.update(named)
        if not named:
            yield f"{job.name}: runs no target of the Makefile"
        yield from (f"{job.name}: make has no '{word}'" for word in named if word not in known)
        if stages is not None and job.stage not in stages:
            yield f"{job.name}: stage '{job.stage}' is not declared"
        for need in job.needs:
            if need not in by_name:
                yield f"{job.name}: needs '{need}', which is no job"
            elif stages is not None and by_name[need].stage not in earlier(job, stages):
                yield f"{job.name}: needs '{need}', which is not of an earlier stage"
        artifacts = {path for need in job.needs if need in by_name for path in by_name[need].makes}
        there = artifacts if job.takes is None else job.takes & artifacts
        for word in named:
            if word in READS and READS[word] not in there:
                yield f"{job.name}: nothing earlier makes {READS[word]}"
    for word in sorted(run & known.keys()):
        run.update(with_dependencies(word, known))
    for word in targets_of(last_line(ROOT / ".ci" / "run")):
        if word not in run and not known.get(word, set()) & known.keys() <= run:
            yield f"nothing runs 'make {word}', as .ci/run does"


def earlier(job: Job, stages: list[str]) -> list[str]:
    return stages[: stages.index(job.stage)] if job.stage in stages else stages


def with_dependencies(target: str, known: dict[str, set[str]]) -> set[str]:
    needed = known.get(target, set())
    return {target, *(each for need in needed for each in with_dependencies(need, known))}


def targets_of(command: str) -> list[str]:
    """Return the targets that a command makes."""
    words = shlex.split(command)
    if words[:1] != ["make"]:
        return []
    return [word for word in words[1:] if "=" not in word and not word.startswith("-")]


def last_line(path: Path) -> str:
    return path.read_text(encoding="utf-8").splitlines()[-1]


def check(path: Path, text: str) -> list[str]:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    if path == GITLAB:
        return [*problems([*gitlab_jobs(text)], yaml.safe_load(text)["stages"], makefile)]
    return [*problems([*github_jobs(text)], None, makefile)]


@pytest.mark.parametrize("path", [GITLAB, GITHUB], ids=["gitlab", "github"])
def test_jobs_run_targets_and_pass_on_what_they_make(path):
    assert check(path, path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    ("path", "good", "bad", "message"),
    [
        (GITLAB, "make simulate", "make simulation", "simulate: make has no 'simulation'"),
        (GITLAB, "make lint", "ruff check", "lint: runs no target of the Makefile"),
        (GITLAB, "make lint", "make tools", "nothing runs 'make test', as .ci/run does"),
        (GITLAB, "stage: verify", "stage: check", "verify: stage 'check' is not declared"),
        (GITLAB, "paths: [build/vhdl_out]", "paths: [build]", "simulate: nothing earlier makes"),
        (GITLAB, "needs: [generate]", "needs: [lint]", "simulate: nothing earlier makes"),
        (GITLAB, "needs: [generate]", "needs: [report]", "which is not of an earlier stage"),
        (GITLAB, "needs: [verify]", "needs: [verity]", "report: needs 'verity', which is no job"),
        (GITHUB, "make report", "make repot", "report: make has no 'repot'"),
        (GITHUB, "make test", "make tools", "nothing runs 'make test', as .ci/run does"),
        (GITHUB, "needs: generate", "needs: lint", "simulate: nothing earlier makes build/vhdl_"),
        (GITHUB, "path: build/verify\n", "path: build\n", "report: nothing earlier makes build/"),
    ],
)
def test_mistakes_are_found(path, good, bad, message):
    text = path.read_text(encoding="utf-8")
    assert good in text
    assert message in "\n".join(check(path, text.replace(good, bad, 1)))


def test_areas_are_all_of_the_tests():
    (matrix,) = yaml.safe_load(GITLAB.read_text(encoding="utf-8"))["tests"]["parallel"]["matrix"]
    named = " ".join(matrix["AREA"]).split()
    assert len(named) == len(set(named))
    covered = {path for pattern in named for path in ROOT.glob(pattern)}
    folders = {path.parent for path in ROOT.glob("tests/*/test_*.py")}
    folders |= {
        ROOT / "tests" / path.relative_to(ROOT).parts[1]
        for path in (ROOT.glob("tests/*/*/**/test_*.py"))
    }
    assert folders and folders | set(ROOT.glob("tests/test_*.py")) == covered
