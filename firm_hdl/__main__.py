"""The command ``firm-hdl``, for ``python -m firm_hdl``."""

from __future__ import annotations

import sys

from firm_hdl.cli import main

sys.exit(main())
