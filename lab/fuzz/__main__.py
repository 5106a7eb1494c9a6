"""``python -m lab.fuzz``; ``make -C lab fuzz-hardware`` runs this."""

from __future__ import annotations

import sys

from lab.fuzz.command import main

if __name__ == "__main__":
    sys.exit(main())
