"""``python -m firm_hdl.fuzz``; ``make fuzz-hardware`` runs this."""

from __future__ import annotations

import sys

from firm_hdl.fuzz.command import main

if __name__ == "__main__":
    sys.exit(main())
