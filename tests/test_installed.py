"""The package as users install it: its wheel and its sdist, away from the clone."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Sequence
from pathlib import Path

import pytest

import firm_hdl
from tests.depth import THOROUGH
from tests.tools import need

ROOT = Path(__file__).parents[1]

NODE = """\
node: echo
bus_bytes: 1
accelerator: echo:Echo
subscribe: {heard: {type: std_msgs/msg/Bool}}
publish: {said: {type: std_msgs/msg/Bool}}
"""


def run(*command: object, folder: Path, given: str = "") -> str:
    """Run a program that must succeed; return what it printed."""
    done = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env={name: text for name, text in os.environ.items() if name != "PYTHONPATH"},
        input=given,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def pip(*arguments: object, folder: Path) -> None:
    options = ("--disable-pip-version-check", "--quiet")
    run(sys.executable, "-m", "pip", *options, *arguments, folder=folder)


def build_wheel(source: Path, out: Path) -> Path:
    """Build a wheel with the build system of this environment, without a network."""
    pip("wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", out, source, folder=out.parent)
    (wheel,) = out.glob("*.whl")
    return wheel


@pytest.fixture(scope="module")
def tracked() -> list[str]:
    """The files of the repository, such as ``firm_hdl/__init__.py``."""
    if not (ROOT / ".git").exists():
        pytest.skip("this is no clone")
    git = need("git", shutil.which("git"))
    # The clone may be another user's, as in a container.
    said = run(git, "-c", f"safe.directory={ROOT}", "ls-files", "-z", folder=ROOT)
    return said.rstrip("\0").split("\0")


@pytest.fixture(scope="module")
def clone(tmp_path_factory: pytest.TempPathFactory, tracked: Sequence[str]) -> Path:
    """A clone that has been worked in: with bytecode, and what an older version's build left."""
    clone = tmp_path_factory.mktemp("clone")
    for name in tracked:
        (clone / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, clone / name)
    for name in ("build/lib/firm_hdl/old.py", "firm_hdl/plan/__pycache__/old.cpython-310.pyc"):
        (clone / name).parent.mkdir(parents=True, exist_ok=True)
        (clone / name).write_bytes(b"")
    return clone


@pytest.fixture(scope="module")
def wheel(clone: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_wheel(clone, tmp_path_factory.mktemp("built") / "wheel")


def test_the_wheel_has_the_tracked_files_of_the_package_and_no_others(wheel, tracked):
    with zipfile.ZipFile(wheel) as archive:
        names = [name for name in archive.namelist() if ".dist-info/" not in name]
    assert {name for name in names if ".data/" not in name} == {
        name for name in tracked if name.startswith("firm_hdl/")
    }
    # Messages and reports name pages of the documentation.
    pages = {name.partition("/share/doc/firm-hdl/")[2] for name in names if ".data/" in name}
    assert pages == {name for name in tracked if name == "README.md" or name.startswith("docs/")}


@pytest.mark.thorough
def test_the_sdist_has_all_tracked_files_and_gives_the_same_wheel(clone, wheel, tracked, tmp_path):
    run(sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", tmp_path, folder=clone)
    (sdist,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert names == {*tracked, "PKG-INFO"}
    assert build_wheel(sdist, tmp_path / "wheel").read_bytes() == wheel.read_bytes()


@pytest.fixture
def readme_lines(clone: Path) -> str:
    """The lines of the README that install firm-hdl. `make nightly` runs them as they stand.

    By day, the wheel that is there already is installed, in an environment without a pip of its
    own: that takes a third of the time.
    """
    text = (clone / "README.md").read_text()
    (lines,) = re.findall(r"^```sh\n(python3 -m venv.*?)^```$", text, re.M | re.S)
    return str(lines)


def install(lines: str, clone: Path, wheel: Path, others: Sequence[str]) -> None:
    """Install firm-hdl in `venv`. What it depends on is in the folders `others` already."""
    if not THOROUGH:
        run(sys.executable, "-m", "venv", "--without-pip", "venv", folder=clone)
        python = ("--python", clone / "venv/bin/python")
        pip(*python, "install", "--no-index", "--no-deps", "--no-compile", wheel, folder=clone)
        return
    variables = {
        **os.environ,
        "PATH": f"{sys.base_prefix}/bin:{os.environ['PATH']}",
        "PYTHONPATH": ":".join(others),
        "PIP_NO_INDEX": "1",
        "PIP_NO_COMPILE": "1",  # Modules that are imported are compiled, which are few.
        "PIP_NO_BUILD_ISOLATION": "0",  # As pip reads it: "no isolation".
    }
    done = subprocess.run(
        ["sh", "-e", "-c", f"{lines}command -v firm-hdl\nfirm-hdl --version"],
        cwd=clone, env=variables, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.splitlines()[-2:] == [
        str(clone / "venv/bin/firm-hdl"),
        f"firm-hdl {firm_hdl.__version__}",
    ]


def test_what_is_installed_works_in_an_empty_folder(clone, wheel, readme_lines, tmp_path):
    others = [path for path in sys.path if path.endswith(("site-packages", "dist-packages"))]
    install(readme_lines, clone, wheel, others)
    env, folder = clone / "venv", tmp_path
    (site,) = env.glob("lib/python*/site-packages")
    # Python reads no `.pth` file in these folders, so that no editable installation counts.
    (site / "others.pth").write_text("".join(f"{path}\n" for path in others))
    # A package may be installed where its users cannot write.
    installed = [path for path in (site, *site.rglob("*")) if path.suffix != ".pyc"]
    for path in installed:
        path.chmod(path.stat().st_mode & ~0o222)
    where = run(
        env / "bin/python", "-c", "import firm_hdl; print(firm_hdl.__file__)", folder=folder
    )
    assert Path(where.strip()) == site / "firm_hdl" / "__init__.py"

    def command(*arguments: str, given: str = "") -> str:
        return run(env / "bin" / "firm-hdl", *arguments, folder=folder, given=given)

    assert "5 bytes in 5 beats" in command("build", "std_msgs/msg/Bool", "--bus-bytes", "1")
    asked = "from firm_hdl.cli import doctor; print(doctor.documentation())"
    documentation = run(env / "bin" / "python", "-c", asked, folder=folder)
    assert Path(documentation.strip()) == env.resolve() / "share/doc/firm-hdl/docs/index.md"

    (folder / "echo.yaml").write_text(NODE)
    shutil.copy(ROOT / "examples/nodes/echo_ros1/echo.py", folder)
    said = command(
        *("node", "run", "echo.yaml", "--graph", "none", "--engine", "amaranth"),
        given='{"topic": "/heard", "packet": "0001000001"}\n',
    )
    assert said == '{"topic": "/said", "packet": "0001000001"}\n'

    if THOROUGH:
        words = ["verify", "std_msgs/msg/Bool", "--distro", "lyrical", "--bus-bytes", "1"]
        verified = command(*words, "--jobs", "1", "--results", "r.jsonl", "--report", "r.html")
        assert "1 of    1 types pass" in verified

    assert {path for path in (site, *site.rglob("*")) if path.suffix != ".pyc"} == set(installed)
