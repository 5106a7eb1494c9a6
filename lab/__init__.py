"""What proves firm-hdl to its developers; see README.md in this folder.

It imports `firm_hdl`, is imported by nobody, and is not installed.
"""

__all__ = []
