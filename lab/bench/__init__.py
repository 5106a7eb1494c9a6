"""The standard benchmark: figures of ``lab/notes/performance.md`` and `firm_hdl.estimates`."""

__all__ = []
