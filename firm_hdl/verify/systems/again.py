"""The command that repeats one test."""

from __future__ import annotations

import shlex

__all__ = ["command_again"]


def command_again(*names: str, **options: object) -> str:
    """Return a call of ``firm-hdl verify``.

    Parameters
    ----------
    *names : str
        What is tested, at the end.
    **options
        By their names, with underscores for dashes, in the order in which they are to stand. `None`
        and `False` leave one out; `True` is one without a value; a tuple repeats it.
    """
    words = ["firm-hdl", "verify"]
    for option, value in options.items():
        for each in value if isinstance(value, tuple) else (value,):
            if each is not None and each is not False:
                words.append(f"--{option.replace('_', '-')}")
                words += [] if each is True else [str(each)]
    return shlex.join([*words, *names])
