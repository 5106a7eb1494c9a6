"""Reports of results: one page in HTML, and the same as Markdown and as JSON."""

__all__ = []
