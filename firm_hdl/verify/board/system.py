"""The test system ``board`` for the command: opens a board, and sends it one type after the other.

A test is one type. All of them go through the same board, one at a time. A board that does not
answer fails all that are left at once, with the same text.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, cast

from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.node import Description, Topic
from firm_hdl.node.boards import Board, board_of
from firm_hdl.sim.fast.engines import EngineName, expected_engine
from firm_hdl.verify.board.description import chosen_loops
from firm_hdl.verify.board.judge import judge_loop
from firm_hdl.verify.board.talk import Talk, TalkError
from firm_hdl.verify.references.clients import find_references
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import Record, Test
from firm_hdl.verify.results.verdict import Failed, KnownDifference, NotJudged, Passed
from firm_hdl.verify.systems.options import Request
from firm_hdl.verify.systems.system import Made, System, Trial, counted, failure_of, kept
from firm_hdl.verify.ts3.task import command_of, words_of

__all__ = ["Boards"]


class Boards(System):
    """The types of a board; a test is one type.

    Parameters
    ----------
    description : Description
        Of the node on the board.
    request : Request
        `types`, `board`, `node`, `engine`, `silent_seconds` and the options of cases are used.
    board : Board or None
        A board in place of the one that the request names.

    Raises
    ------
    UserError
        If the name of the board is none, or no loop of the node has a type that is named.
    """

    name = "board"

    def __init__(self, description: Description, request: Request, board: Board | None = None):
        self._description, self._request = description, request
        named = request.types if request.node is not None else ()
        self._loops = chosen_loops(description, named)
        if board is None:
            more = {"engine": request.engine} if request.board == "sim" else {}
            board = board_of(str(request.board), description, **more)
        self._board = board

    def __enter__(self) -> Boards:
        for line in find_references(self._request.references, [self._description.wire]):
            print(line)
        return self

    @property
    def _engine(self) -> str:
        """The engine that simulates the board, if that is what it is."""
        if self._request.board != "sim":
            return ""
        return expected_engine(cast(EngineName, self._request.engine))[0]

    @property
    def tests(self) -> Sequence[Test]:
        """A test for each type that the node loops, or for each loop if a type has several."""
        return list(self._loop_of)

    @cached_property
    def _loop_of(self) -> dict[Test, tuple[Topic, Topic]]:
        """The loops by their tests."""
        counts = Counter(loop[0].type for loop in self._loops)
        return {self._test(loop, counts[loop[0].type] > 1): loop for loop in self._loops}

    @property
    def options(self) -> Mapping[str, Any]:
        """The options that determine the cases, and the board."""
        request = self._request
        return {
            "board": request.board,
            "engine": self._engine,
            "node": request.node,
            "fingerprint": f"{self._description.fingerprint:016x}",
            "seed": request.seed,
            "cases": request.most_cases,
            "broken": request.broken,
            "references": None if request.references is None else list(request.references),
        }

    def run(self, writer: ResultsWriter | None) -> list[Record]:
        """Open the board, and send the types that have no record."""
        records = kept(self.tests, writer, self._records, self._lines, label="board")
        for verdict in (Passed, KnownDifference, Failed, NotJudged):
            found = [each for each in records if isinstance(each.verdict, verdict)]
            if found:
                packets = sum(each.packets for each in found)
                print(
                    f"board {self._board.name}: {len(found)} of {len(records)} types "
                    f"{verdict.name}, {packets} packets sent"
                )
        return counted(records)

    def _records(self, left: Sequence[Test]) -> Made:
        if not left:
            return
        if self._request.board == "sim":
            print(
                "board sim: starts; to compile a new node takes a minute or more",
                flush=True,
            )
        with Talk(self._board, self._description, self._request.silent_seconds) as talk:
            is_open, gone = False, ""
            for test in left:
                trial = Trial.of(test)
                try:
                    if gone:
                        raise TalkError(gone)
                    if not is_open:
                        talk.open()
                except TalkError as error:
                    gone = str(error)
                    trial.failures.append(gone)
                else:
                    is_open = self._judge(talk, self._loop_of[test], trial)
                yield [replace(trial.end(), command=self._command())]

    def _judge(self, talk: Talk, loop: tuple[Topic, Topic], trial: Trial) -> bool:
        """Judge a type; return whether the talk can go on."""
        try:
            judge_loop(talk, self._description, loop, self._request, trial)
        except TalkError as error:
            trial.failures.append(str(error))
            return False
        except (UserError, DefinitionError):
            # What is wrong with a node is wrong for all types.
            raise
        except Exception as error:
            trial.stop(error)
        return True

    def _test(self, loop: tuple[Topic, Topic], is_one_of_several: bool) -> Test:
        request, description = self._request, self._description
        # A board is not stalled, whatever was asked for.
        options = replace(request, stalled=True)
        node = [] if request.node is None else [f"node={request.node}"]
        node += [f"topic={loop[0].name}"] if is_one_of_several else []
        return Test(
            system=self.name,
            distro=description.distro,
            type=loop[0].type,
            same=(description.distro,),
            wire=description.wire,
            bus_bytes=description.bus_bytes,
            options=",".join([f"board={request.board}", *words_of(options, *node)]),
        )

    def _command(self) -> str:
        """Return the command that repeats the tests. The node depends on all of its types."""
        request = self._request
        return command_of(
            request,
            *request.types,
            board=request.board,
            node=request.node,
            engine=None if request.engine == "auto" else request.engine,
            silent_seconds=request.silent_seconds,
            distro=None if request.node else self._description.distro,
            bus_bytes=None if request.node else self._description.bus_bytes,
            # What a board does not have.
            **dict.fromkeys(("max_message_bytes", "simulator", "wire", "no_stalls", "vcd")),
        )

    def _lines(self, record: Record) -> Iterator[str]:
        """Yield the failures and the note of a type."""
        yield from failure_of(f"{record.test.type} ({record.test.distro})", record)
        if record.note:
            yield f"note: {record.test.type} ({record.test.distro}): {record.note}"
