"""The standard benchmark: the figures of ``docs/performance.md`` and of `firm_hdl.estimates`."""

__all__ = []
