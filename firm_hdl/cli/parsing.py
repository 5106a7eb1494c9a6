"""A parser of arguments that answers a wrong word with the words that are near to it."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Any, NoReturn

__all__ = ["Parser", "nearest"]

# Values that are nearer to another word than to the one that is meant.
_MEANT = {("wire", "ros2"): "cdr"}


class Parser(argparse.ArgumentParser):
    """A parser for a command or a subcommand.

    Every error is reported with the usage of the subcommand in which it is.

    * `examples`: command lines, which the help shows.
    """

    def __init__(self, *, examples: Sequence[str] = (), **options: Any) -> None:
        lines = "".join(f"\n  {line}" for line in examples)
        super().__init__(
            formatter_class=_Formatter,
            epilog=f"example{'s' if len(examples) > 1 else ''}:{lines}" if examples else None,
            **options,
        )

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        found, rest = super().parse_known_args(args, namespace)
        if rest:
            self._refuse(rest)
        return found, rest

    def _refuse(self, rest: Sequence[str]) -> NoReturn:
        options = [
            name
            for action in self._actions
            if action.help != argparse.SUPPRESS
            for name in action.option_strings
        ]
        wrong = [each.partition("=")[0] for each in rest if each.startswith("-")]
        near = [name for each in wrong for name in nearest(each, options)[:1]]
        self.error(_with_suggestions(f"unrecognized arguments: {' '.join(rest)}", near))

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            text = error.message
            if action.dest == "distro":
                from firm_hdl.frontend.embedded import replacement_of

                if instead := replacement_of(value):
                    raise argparse.ArgumentError(action, f"{text}; {instead}") from None
            near = [_MEANT[action.dest, value]] if (action.dest, value) in _MEANT else []
            words = [each for each in action.choices or () if isinstance(each, str)]
            near = near or nearest(str(value), words)
            raise argparse.ArgumentError(action, _with_suggestions(text, near)) from None


class _Formatter(argparse.HelpFormatter):
    """Keeps the lines of examples as they are."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        return text if "\n" in text else super()._fill_text(text, width, indent)


def nearest(word: str, words: Iterable[str]) -> list[str]:
    """Return the words that a user may mean, the likeliest first; case does not count."""
    plain = {each.casefold(): each for each in words}
    return [plain[each] for each in get_close_matches(word.casefold(), plain)]


def _with_suggestions(text: str, names: Sequence[str]) -> str:
    if not names:
        return text
    return f"{text}; did you mean {' or '.join(repr(name) for name in dict.fromkeys(names))}?"
