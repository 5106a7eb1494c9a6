"""``python -m lab.formal``; ``make -C lab formal`` runs it."""

from __future__ import annotations

import sys

from lab.formal.command import main

if __name__ == "__main__":
    sys.exit(main())
