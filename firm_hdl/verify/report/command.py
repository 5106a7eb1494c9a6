"""``firm-hdl report``: makes a report of files of results."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

from firm_hdl.export.build import BuildError
from firm_hdl.files import write_file
from firm_hdl.verify.report.formats import FORMATS
from firm_hdl.verify.report.summary import summarise
from firm_hdl.verify.results.file import ResultsError, read_results

__all__ = ["add_report_arguments", "run_report", "write_report"]


def add_report_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl report``."""
    parser.add_argument(
        "results", nargs="+", metavar="RESULTS", help="files that firm-hdl verify --results wrote"
    )
    parser.add_argument("--out", metavar="FILE", help="file to write; default: standard output")
    parser.add_argument(
        "--format", choices=list(FORMATS), help="default: that of the file's name, or md"
    )
    parser.add_argument("--title", default="Verification of firm-hdl", help="default: %(default)s")


def run_report(given: argparse.Namespace) -> None:
    """Run ``firm-hdl report``.

    Raises
    ------
    BuildError
        If a file is not one of results.
    """
    form = given.format
    if given.out is None:
        print(_made(given.results, form or "md", given.title), end="")
        return
    write_report(given.results, given.out, form, given.title)
    print(f"wrote   {given.out}")


def write_report(
    results: Sequence[str | os.PathLike[str]],
    out: str | os.PathLike[str],
    form: str | None = None,
    title: str = "Verification of firm-hdl",
) -> None:
    """Write a report of files of results.

    Parameters
    ----------
    out : path
    form : str or None
        A key of `FORMATS`; `None`: the suffix of `out`.

    Raises
    ------
    BuildError
        If a file is not one of results, or if the suffix of `out` is not a key of `FORMATS`.
    """
    path = Path(out)
    form = form or path.suffix.lstrip(".").lower()
    if form not in FORMATS:
        ends = ", ".join(f".{name}" for name in FORMATS)
        raise BuildError(f"'{out}': the name of a report must end in {ends}, or give --format")
    for each in results:
        if path.exists() and path.samefile(each):
            raise BuildError(f"'{out}' is one of the results; the report needs another name")
    text = _made(results, form, title)
    write_file(path, text)


def _made(results: Sequence[str | os.PathLike[str]], form: str, title: str) -> str:
    try:
        found = {str(path): read_results(path) for path in results}
    except ResultsError as error:
        raise BuildError(str(error)) from None
    return FORMATS[form](summarise(found, title))
