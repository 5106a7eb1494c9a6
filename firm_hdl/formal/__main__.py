"""``python -m firm_hdl.formal``; ``make formal`` runs it."""

from __future__ import annotations

import sys

from firm_hdl.formal.command import main

if __name__ == "__main__":
    sys.exit(main())
