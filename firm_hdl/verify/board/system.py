"""The test system ``board`` for the command: opens a board, and sends it one type after the other.

A test is one type. All of them go through the same board, one at a time. A board that does not
answer fails all that are left at once, with the same text.

Packets, their order and the expected bytes come from rosbags, as in TS3. For damaged packets, the
golden model (:mod:`firm_hdl.plan.interpret`) says which are refused, and why; the board has to drop
exactly these, and to count them at the right place.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

from firm_hdl.cases import NotJudgedError
from firm_hdl.cases.damage import broken_and_good
from firm_hdl.cases.directed import bare_packets
from firm_hdl.cases.effort import all_cases, digest, figures
from firm_hdl.cases.make import Case
from firm_hdl.cases.user_oracle import Judge, judge_of
from firm_hdl.errors import DefinitionError, UserError
from firm_hdl.frontend import Library
from firm_hdl.model import Message
from firm_hdl.node import Description, Topic
from firm_hdl.node.boards import Board, board_of
from firm_hdl.node.capacity import most_bytes
from firm_hdl.node.control import FIFO_COUNTERS, GATE_COUNTERS, LINK_COUNTERS, registers
from firm_hdl.plan import Plan
from firm_hdl.plan.interpret import decode, encode
from firm_hdl.sim.fast.engines import EngineName, expected_engine
from firm_hdl.verify.board.description import chosen_loops
from firm_hdl.verify.board.talk import Talk, TalkError
from firm_hdl.verify.references.clients import find_references, may_stand_in
from firm_hdl.verify.results.file import ResultsWriter
from firm_hdl.verify.results.records import Record, Test
from firm_hdl.verify.results.verdict import NotJudged
from firm_hdl.verify.systems.options import CaseOptions, Request
from firm_hdl.verify.systems.system import Made, System, Trial, failure_of, run_and_record
from firm_hdl.verify.ts3.acceptance import confirm_cases
from firm_hdl.verify.ts3.compare import packet_differences
from firm_hdl.verify.ts3.task import command_of, words_of

__all__ = ["Boards"]


MOST = (1 << 32) - 1
"""A counter stops there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Run:
    """Packets for a board, and what has to come of them."""

    where: str  # Name of the run in failures.
    packets: list[bytes]
    names: list[str]  # What each packet is.
    statuses: list[str]  # `OK`, or why the gate has to drop a packet.
    answers: list[bytes | None]  # What has to come back for each packet; `None`: nothing.

    @property
    def expected(self) -> list[bytes]:
        """All packets that have to come back."""
        return [answer for answer in self.answers if answer is not None]

    @property
    def expected_names(self) -> list[str]:
        """What they are."""
        pairs = zip(self.names, self.answers, strict=True)
        return [name for name, answer in pairs if answer is not None]


def judge_loop(
    talk: Talk,
    description: Description,
    loop: tuple[Topic, Topic],
    options: CaseOptions,
    trial: Trial,
) -> None:
    """Send the cases of a type through a board, and add to the trial.

    * `talk`: open.
    * `options`: `seed`, `most_cases`, `broken` and `references` are used.

    Raises `NotJudgedError` if the oracle cannot judge the type, or no case fits into the memories
    of the node. Raises `TalkError` if the board is gone.
    """
    store = loop[0].store("in")
    message, wire = store.message, description.wire
    judge = _judge_of(message, description.distro, options)
    trial.record.note = judge.note
    plan = description.plan(store)
    trial.record.shape = digest(plan)
    cases = all_cases(judge.oracle, judge.name, plan, seed=options.seed, most=options.most_cases)
    room = min(most_bytes(description, way, each) for topic in loop for way, each in topic.stores)
    cases = _fitting(cases, min(room, store.max_message_bytes), trial)
    trial.record.cases = len(cases)
    trial.record.metrics = figures(message, plan, [case.packet for case in cases])
    confirm_cases(message, wire, cases, options, trial, judge.oracle)
    if isinstance(trial.obstacle, NotJudged):
        return
    runs = [_good_run(plan, cases)]
    if options.broken:
        rng = random.Random(f"{options.seed}/{message.name}/broken")
        runs.append(_damaged_run(plan, cases, rng, room))
    talk.take(loop[1])
    trial.watch.enter("simulation")
    counters = _counters(talk, description, loop)
    for number, run in enumerate(runs):
        trial.watch.enter("simulation")
        got, counters = _sent(talk, description, loop, run, trial, counters)
        trial.watch.enter("testing")
        trial.record.packets += len(run.packets)
        # As in TS3, what follows damage is judged by the golden model, and does not count.
        trial.judged += len(got) if number == 0 else 0
    trial.watch.enter("testing")


def _judge_of(message: Message, distro: str, options: CaseOptions) -> Judge:
    """Return the oracle: rosbags' own definition, if the type is that of the distribution."""
    try:
        is_own = Library(distro).message(message.name) == message
    except DefinitionError:
        is_own = False
    stand_in = may_stand_in(message, options.references)
    return judge_of(message, distro if is_own else None, stand_in=stand_in)


def _fitting(cases: Sequence[Case], room: int, trial: Trial) -> list[Case]:
    """Return the cases for which a board has room; note how many there are of the others."""
    found = [case for case in cases if max(len(case.sent), len(case.packet)) <= room]
    if not found:
        raise NotJudgedError(f"every case is larger than the {room} bytes that the node takes")
    if len(found) < len(cases):
        trial.record.add_note(
            f"{len(cases) - len(found)} of {len(cases)} cases are larger than the {room} bytes "
            "that the node takes, and were left out"
        )
    return found


def _good_run(plan: Plan, cases: Sequence[Case]) -> _Run:
    """Every case, and the packets of other senders that have to come back as a case."""
    bare = bare_packets(plan, cases)
    judged = [*cases, *(case for case, _ in bare)]
    return _Run(
        where="board",
        packets=[case.sent for case in cases] + [packet for _, packet in bare],
        names=[case.what for case in judged],
        statuses=["OK"] * len(judged),
        answers=[case.packet for case in judged],
    )


def _damaged_run(plan: Plan, cases: Sequence[Case], rng: random.Random, room: int) -> _Run:
    """Damaged packets, each followed by a good one, as in TS3."""
    # What has no room is dropped as large; that is no damage.
    packets = broken_and_good(plan, cases, rng, room)
    statuses: list[str] = []
    answers: list[bytes | None] = []
    for packet in packets:
        decoded = decode(plan, packet)
        statuses.append(decoded.status)
        # What was read without an error is written without one, too.
        answers.append(encode(plan, decoded.streams)[0] if decoded.status == "OK" else None)
    return _Run(
        where="board, damaged packets",
        packets=packets,
        names=[packet.hex() for packet in packets],
        statuses=statuses,
        answers=answers,
    )


def _sent(
    talk: Talk,
    description: Description,
    loop: tuple[Topic, Topic],
    run: _Run,
    trial: Trial,
    before: Mapping[tuple[str, str], int],
) -> tuple[list[bytes], Mapping[tuple[str, str], int]]:
    """Send a run, and add what is wrong to the failures; return what came back, and the counters.

    `before` are the counters up to now.
    """
    got = talk.exchange(loop, run.packets, [answer is not None for answer in run.answers])
    after = _counters(talk, description, loop)
    # A packet that nobody asked for may have come meanwhile.
    got += talk.take(loop[1])
    failures = list(_differences(run, got))
    changes = {key: after[key] - before[key] for key in after if after[key] < MOST}
    failures += _miscounts(run, changes, loop)
    losses = [f"{count} {cause} on the way to it" for cause, count in _lost(changes).items()]
    losses += [f"{count} {cause} on the way back" for cause, count in talk.losses().items()]
    if failures and losses:
        failures.append(f"{run.where}: messages and frames: {', '.join(losses)}")
    elif losses:
        # Only requests for registers were lost, and repeated.
        trial.record.add_note(f"the link lost requests of control: {', '.join(losses)}")
    trial.failures += failures
    return got, after


def _differences(run: _Run, got: Sequence[bytes]) -> Iterator[str]:
    """Yield what differs between the packets that came back and those that should have."""
    wanted = run.expected
    missing = _missing(got, wanted)
    if not missing:
        yield from packet_differences(run.where, got, wanted, run.expected_names)
        return
    names = [run.expected_names[number] for number in missing[:4]]
    more = f" and {len(missing) - 4} more" if len(missing) > 4 else ""
    yield (
        f"{run.where}: {len(missing)} of {len(wanted)} packets did not come back: "
        f"{'; '.join(names)}{more}"
    )


def _missing(got: Sequence[bytes], wanted: Sequence[bytes]) -> list[int]:
    """Return which packets are missing if all others came in order; else none."""
    missing: list[int] = []
    at = 0
    for number, packet in enumerate(wanted):
        if at < len(got) and got[at] == packet:
            at += 1
        else:
            missing.append(number)
    return missing if at == len(got) else []


def _counters(
    talk: Talk, description: Description, loop: tuple[Topic, Topic]
) -> Mapping[tuple[str, str], int]:
    """Read the counters of a loop and of the link, by part (``in``, ``out``, ``link``) and name."""
    ids = {topic.id for topic in loop}
    chosen = {
        (each.part, each.name): each.number
        for each in registers(description)
        if each.part == "link" or each.topic in ids
    }
    values = talk.read(chosen.values())
    return {key: values[number] for key, number in chosen.items()}


def _miscounts(
    run: _Run, changes: Mapping[tuple[str, str], int], loop: tuple[Topic, Topic]
) -> Iterator[str]:
    """Yield each counter of gate and FIFO that does not count what it should."""
    statuses = Counter(run.statuses)
    gate = {name: statuses[name.upper()] for name in GATE_COUNTERS}
    gate["passed"] = statuses["OK"]
    fifo = dict.fromkeys(FIFO_COUNTERS, 0)
    fifo["passed"] = len(run.expected)
    for part, topic, wanted in (("in", loop[0], gate), ("out", loop[1], fifo)):
        for name, count in wanted.items():
            found = changes.get((part, name), count)
            if found != count:
                yield f"{run.where}: '{name}' of {topic.name} counts {found} instead of {count}"
    sizes = {
        "in": sum(
            len(packet)
            for packet, status in zip(run.packets, run.statuses, strict=True)
            if status == "OK"
        ),
        "out": sum(map(len, run.expected)),
    }
    for part, topic in (("in", loop[0]), ("out", loop[1])):
        found = changes.get((part, "bytes_low"), sizes[part]) % (MOST + 1)
        if found != sizes[part] % (MOST + 1):
            yield f"{run.where}: {topic.name} counts {found} bytes instead of {sizes[part]}"


def _lost(changes: Mapping[tuple[str, str], int]) -> Mapping[str, int]:
    """Return what the link of the board lost, by cause."""
    names = [name for name in LINK_COUNTERS if name not in ("passed", "unsent")]
    return {name: count for name in names if (count := changes.get(("link", name), 0))}


class Boards(System):
    """The types of a board; a test is one type.

    * `description`: of the node on the board.
    * `request`: `types`, `board`, `node`, `engine`, `silent_seconds` and the options of cases are
      used.
    * `board`: a board in place of the one that the request names.

    Raises `UserError` if the name of the board is none, or no loop of the node has a type that is
    named.
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

    def records(self, writer: ResultsWriter | None) -> list[Record]:
        """Open the board, and send the types that have no record."""
        return run_and_record(self.tests, writer, self._records, self._lines, label="board")

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
            options=",".join(
                [f"board={request.board}", *words_of(options, *node), *options.folders]
            ),
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
