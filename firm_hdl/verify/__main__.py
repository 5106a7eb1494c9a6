"""``python -m firm_hdl.verify``: ``firm-hdl verify``, with all types if none is named."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.terminal import printable_streams, progress
from firm_hdl.verify.command import add_verify_arguments, run_verify

__all__ = ["main"]


@printable_streams()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; exit statuses are those of ``firm-hdl``."""
    parser = argparse.ArgumentParser(prog="python -m firm_hdl.verify", description=__doc__)
    add_verify_arguments(parser)
    given = parser.parse_args(arguments)
    given.all = given.all or not (given.types or given.node)
    try:
        with progress("verify"):
            return run_verify(given)
    except DefinitionError as error:
        print(error, file=sys.stderr)
        return 1
    except UserError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
