"""The commands that judge converters, such as ``verify``, ``prove`` and ``bench``."""

from __future__ import annotations

import argparse

from firm_hdl.arguments import add_json, add_options

__all__ = ["add_bench", "add_cover", "add_golden", "add_prove", "add_report", "add_verify"]


def add_verify(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl verify``."""
    from firm_hdl.verify.command import add_verify_arguments, run_verify

    add_verify_arguments(command)
    add_json(command)
    command.set_defaults(run=run_verify)


def add_report(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl report``."""
    from firm_hdl.verify.report.formats import add_report_arguments, run_report

    add_report_arguments(command)
    command.set_defaults(run=run_report)


def add_prove(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl prove``."""
    from firm_hdl.equivalence.command import add_prove_arguments, run_prove

    add_prove_arguments(command)
    add_options(command)
    command.set_defaults(run=run_prove)


def add_bench(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl bench``."""
    from firm_hdl.bench.command import add_bench_arguments, run_bench

    add_bench_arguments(command)
    command.set_defaults(run=run_bench)


def add_golden(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl golden``."""
    from firm_hdl.verify.ts2.golden import add_golden_arguments, run_golden

    add_golden_arguments(command)
    add_options(command)
    command.set_defaults(run=run_golden)


def add_cover(command: argparse.ArgumentParser) -> None:
    """Add the arguments of ``firm-hdl cover``."""
    from firm_hdl.covering.command import add_cover_arguments, run_cover

    add_cover_arguments(command)
    add_options(command)
    command.set_defaults(run=run_cover)
