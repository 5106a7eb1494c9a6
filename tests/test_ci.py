"""Both CI services run `.ci/run`, with targets that the Makefile has."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[1]


def gitlab(text: str) -> list[str]:
    """Return the commands of all jobs."""
    jobs = [job for job in yaml.safe_load(text).values() if isinstance(job, dict)]
    return [command for job in jobs for command in job.get("script", [])]


def github(text: str) -> list[str]:
    """Return the commands of all jobs."""
    jobs = yaml.safe_load(text)["jobs"].values()
    return [step["run"] for job in jobs for step in job["steps"] if "run" in step]


@pytest.mark.parametrize(
    ("name", "commands"), [(".gitlab-ci.yml", gitlab), (".github/workflows/ci.yml", github)]
)
def test_jobs_run_targets_of_the_makefile(name, commands):
    found = commands((ROOT / name).read_text(encoding="utf-8"))
    assert ".ci/run" in found
    for command in found:
        run = re.fullmatch(r"\.ci/run( [a-z]+)?", command)
        assert run, command
        target = (run[1] or "test").strip()
        make = ["make", "--question", "--no-print-directory", target, "MAKE=true", "SHELL=true"]
        done = subprocess.run(make, cwd=ROOT, capture_output=True, text=True, check=False)
        assert "No rule to make target" not in done.stderr


def test_the_script_runs_the_tests():
    last = (ROOT / ".ci/run").read_text(encoding="utf-8").splitlines()[-1]
    assert last == 'make "${1:-test}"'
