"""The standard benchmark: the figures of ``lab/notes/performance.md`` and of `firm_hdl.estimates`."""

__all__ = []
