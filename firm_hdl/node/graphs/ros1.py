"""The graph of ROS 1 through rospy. Messages pass as bytes, and no class of theirs is needed.

rospy takes any class that has the name and the md5 sum of a type, and that reads and writes bytes;
its own `AnyMsg` is one without name and sum. With both, nodes that have another definition are
refused by their peers.
"""

from __future__ import annotations

import os
import threading
import time
from concurrent.futures import CancelledError, Future
from concurrent.futures import TimeoutError as NoAnswer
from contextlib import suppress
from importlib import import_module
from typing import Any

from firm_hdl.errors import UserError
from firm_hdl.identity import md5sum
from firm_hdl.model import Message, Service, closure
from firm_hdl.node.description import Description, Topic
from firm_hdl.node.graphs.graph import FutureGraph, GraphError, OnMessage

__all__ = ["RospyGraph", "definitions"]

_ANSWER_SECONDS = 15.0
"""A call ends without a response after so long; the bridge gives up before."""

_WATCH_SECONDS = 1.0


class RospyGraph(FutureGraph):
    """A node of rospy. A process can have one, whose name it keeps.

    The master is that of the environment (``ROS_MASTER_URI``). If it ends or starts again, topics
    and services are registered anew. Callbacks run in threads of rospy, one per connection.

    Raises `UserError` if there is no rospy.
    """

    def __init__(self, description: Description) -> None:
        super().__init__("rospy")
        self._description = description
        # rospy reads it when it is imported.
        os.environ["ROS_NAMESPACE"] = description.namespace
        try:
            self._rospy: Any = import_module("rospy")
            self._rosgraph: Any = import_module("rosgraph")
        except ImportError:
            raise UserError(
                "the graph 'ros1' needs rospy, which this Python does not have; source the setup "
                "of ROS 1, or install the package python3-rospy; firm-hdl doctor says more"
            ) from None
        self._publishers: dict[int, Any] = {}
        self._others: list[Any] = []
        self._is_named = False
        self._problem = ""
        self._ends = threading.Event()

    def open(self, on_message: OnMessage) -> None:
        self.close()
        rospy = self._rospy
        if not self._rosgraph.is_master_online():
            raise GraphError(f"no master at {self._rosgraph.get_master_uri()}")
        try:
            if not self._is_named:
                rospy.init_node(self._description.node, argv=[""], disable_signals=True)
                self._is_named = True
            for topic in self._description.topics:
                self._add(topic, on_message)
        except (OSError, rospy.ROSException) as error:
            raise GraphError(f"rospy: {error}") from None
        self._problem, self._ends = "", threading.Event()
        threading.Thread(target=self._watch, args=[self._ends], daemon=True).start()

    def _add(self, topic: Topic, on_message: OnMessage) -> None:
        rospy, qos = self._rospy, topic.qos
        if topic.kind == "serve":
            self._others.append(self._serve(topic, on_message))
            return
        raw = _raw(rospy, topic.stores[0][1].message)
        if topic.kind == "publish":
            is_latched = qos.durability == "transient_local"
            self._publishers[topic.id] = rospy.Publisher(
                topic.name, raw, queue_size=qos.depth, latch=is_latched, tcp_nodelay=True
            )
            return

        def take(message: Any) -> None:
            on_message(topic, message._buff, None)

        self._others.append(rospy.Subscriber(topic.name, raw, take, tcp_nodelay=True))

    def _serve(self, topic: Topic, on_message: OnMessage) -> Any:
        stores = dict(topic.stores)
        request, response = (_raw(self._rospy, stores[way].message) for way in ("in", "out"))
        service = Service(
            name=topic.type,
            dialect="ros1",
            request=stores["in"].message,
            response=stores["out"].message,
        )
        found = {
            "_type": topic.type,
            "_md5sum": md5sum(service),
            "_request_class": request,
            "_response_class": response,
        }

        def handle(asked: Any) -> Any:
            future: Future[bytes] = Future()
            on_message(topic, asked._buff, future)
            answer = response()
            try:
                answer._buff = future.result(_ANSWER_SECONDS)
            except (CancelledError, NoAnswer):
                raise self._rospy.ServiceException("the board did not answer") from None
            return answer

        return self._rospy.Service(topic.name, type("Service", (), found), handle)

    def _watch(self, ends: threading.Event) -> None:
        """Find out whether the master is still the same one; the answer may take long."""
        master = self._rosgraph.Master(self._rospy.get_name())
        first, problem = None, ""
        while not ends.wait(_WATCH_SECONDS):
            try:
                found = master.getPid()
            except Exception as error:
                problem = f"the master does not answer: {error}"
                break
            first = first or found
            if found != first:
                problem = "the master has started again"
                break
            types: dict[str, str] = {}
            with suppress(Exception):
                types = dict(master.getTopicTypes())
            for topic in self._description.topics:
                other = types.get(topic.name, "*") if topic.kind != "serve" else "*"
                if other not in ("*", topic.type):
                    self.tell(
                        f"{topic.name}: another node has it with the type '{other}', and the type "
                        f"here is '{topic.type}'; no messages pass"
                    )
        if not ends.is_set():
            self._problem = problem

    def check(self) -> None:
        if self._problem:
            raise GraphError(self._problem)

    def publish(self, topic: Topic, packet: bytes) -> bool:
        publisher = self._publishers.get(topic.id)
        if publisher is None:
            raise GraphError("rospy was shut down")
        message = publisher.data_class()
        message._buff = packet
        try:
            publisher.publish(message)
        except self._rospy.ROSException as error:
            raise GraphError(f"rospy: {error}") from None
        return True

    def close(self) -> None:
        self._ends.set()
        publishers, self._publishers = self._publishers, {}
        others, self._others = self._others, []
        for each in (*publishers.values(), *others):
            # The master, with whom they were registered, may be gone.
            with suppress(Exception):
                each.shutdown("closed") if hasattr(each, "uri") else each.unregister()
        if publishers or others:
            # rospy tells the master in a thread of its own.
            time.sleep(0.05)


def _raw(rospy: Any, message: Message) -> Any:
    """Return a class of a message whose content is bytes."""
    known = {
        "__slots__": ["_buff"],
        "_type": message.name,
        "_md5sum": md5sum(message),
        "_full_text": definitions(message),
    }
    return type(message.base_name, (rospy.AnyMsg,), known)


def definitions(message: Message) -> str:
    """Return the definitions of a type and those it needs, as recordings of ROS 1 have them.

    The form is that of ``gendeps --cat`` of genmsg.
    """
    *parts, own = closure([message])
    texts = [own.text, *(f"MSG: {each.name}\n{each.text}" for each in parts if each.package)]
    return ("\n" + "=" * 80 + "\n").join(texts)
