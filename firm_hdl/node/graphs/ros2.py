"""The graph of ROS 2 through rclpy, where an environment of ROS 2 is active.

Messages of topics pass as bytes: rclpy's raw subscriptions give them, and its publishers take them.
rclpy has no raw services; there, requests are serialized again, and responses are read.
"""

from __future__ import annotations

import threading
from dataclasses import replace
from importlib import import_module
from typing import Any

from firm_hdl.errors import UserError
from firm_hdl.node.description import Description, Topic, TopicQos
from firm_hdl.node.graphs.graph import Graph, GraphError, OnMessage, domain_of
from firm_hdl.node.graphs.mismatch import OwnEndpoint, own_endpoints
from firm_hdl.rtps import Durability, Qos, Reliability
from firm_hdl.rtps.qos import INFINITE

__all__ = ["RclpyGraph", "has_rclpy"]

_QUEUED = 4096
"""How many messages for the board may wait for the thread of rclpy. The depth of a topic is that of
its publisher; here, it would lose what comes faster than Python takes it. The bridge has a queue of
its own behind, whose losses it counts."""

_NO_NAMES = ("_NODE_NAME_UNKNOWN_", "_CREATED_BY_BARE_DDS_APP_")
"""What rclpy says of an endpoint whose node is not known yet, or of one without a node."""

_DURATIONS = ("deadline", "liveliness_lease_duration")
_LONGEST = 1 << 31
"""A duration of more seconds has no end."""


def has_rclpy() -> bool:
    """Whether an environment of ROS 2 with rclpy is active."""
    try:
        import_module("rclpy")
    except ImportError:
        return False
    return True


class RclpyGraph(Graph):
    """A node of rclpy, with a thread of its own that waits for messages.

    The domain is that of the environment (``ROS_DOMAIN_ID``) unless it is given; the middleware is
    the environment's, too. The packages of all types have to be installed.

    * `domain`: as of :func:`.domain_of`.

    Raises `UserError` if the domain is none.
    """

    def __init__(self, description: Description, *, domain: int | None = None) -> None:
        super().__init__("rclpy")
        self._description, self._domain = description, domain_of(domain)
        self._context: Any = None
        self._node: Any = None
        self._executor: Any = None
        self._thread: threading.Thread | None = None
        self._publishers: dict[int, Any] = {}
        self._services: dict[int, Any] = {}
        self._own = list(own_endpoints(description))
        # Endpoints of peers that did not fit, and whose nodes were not known yet.
        self._nameless: set[bytes] = set()

    def open(self, on_message: OnMessage) -> None:
        self.close()
        rclpy: Any = import_module("rclpy")
        # A context of its own, so that the process may have other nodes, and its own signals.
        self._context = rclpy.context.Context()
        description = self._description
        try:
            rclpy.init(context=self._context, domain_id=self._domain, signal_handler_options=None)
            self._node = rclpy.create_node(
                description.node,
                namespace=description.namespace,
                context=self._context,
                start_parameter_services=False,
                enable_rosout=False,
            )
        except Exception as error:
            raise GraphError(f"rclpy: {error}") from None
        for topic in description.topics:
            self._add(topic, on_message)
        executors: Any = import_module("rclpy.executors")
        self._executor = executors.SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, name="rclpy", daemon=True)
        self._thread.start()

    def _add(self, topic: Topic, on_message: OnMessage) -> None:
        found = _class_of(topic)
        match topic.kind:
            case "publish":
                made = self._node.create_publisher(found, topic.name, _qos(topic.qos))
                self._publishers[topic.id] = made
            case "subscribe":

                def take(packet: bytes) -> None:
                    on_message(topic, bytes(packet), None)

                qos = replace(topic.qos, depth=max(topic.qos.depth, _QUEUED))
                self._node.create_subscription(found, topic.name, take, _qos(qos), raw=True)
            case "serve":
                self._services[topic.id] = self._serve(topic, found, on_message)

    def _serve(self, topic: Topic, found: Any, on_message: OnMessage) -> Any:
        serialize = import_module("rclpy.serialization").serialize_message

        def keep(request: Any, response: Any) -> Any:
            return request

        def ask(request: Any, header: Any) -> None:
            on_message(topic, bytes(serialize(request)), header)

        qos = _qos(TopicQos(depth=_QUEUED))
        service = self._node.create_service(found, topic.name, keep, qos_profile=qos)
        # The executor calls this with what the callback returned. The response comes later, and in
        # no thread of the executor, which must not wait for it.
        service.send_response = ask
        return service

    def _spin(self) -> None:
        context, executor = self._context, self._executor
        try:
            while context.ok():
                executor.spin_once(timeout_sec=0.5)
        except Exception:
            # The context was shut down while the executor waited; anything else is found by
            # `check`, as the thread has ended.
            return

    def publish(self, topic: Topic, packet: bytes) -> bool:
        self._call(self._publishers[topic.id].publish, packet)
        return True

    def respond(self, topic: Topic, caller: object, packet: bytes) -> bool:
        service = self._services[topic.id]
        deserialize = import_module("rclpy.serialization").deserialize_message
        response = self._call(deserialize, packet, service.srv_type.Response)
        self._call(type(service).send_response, service, response, caller)
        return True

    def check(self) -> None:
        if self._thread is not None and not self._thread.is_alive():
            raise GraphError("rclpy has ended")
        if self._node is not None:
            self._tell_mismatches()

    def _tell_mismatches(self) -> None:
        """Name the endpoints that do not fit; the nodes of peers may be known a little later.

        Our own endpoints are among them: the environment may have another definition of a type.
        """
        nameless: set[bytes] = set()
        for own in self._own:
            # Only middlewares of DDS have topics for a service.
            is_service = own.topic.kind == "serve"
            name = own.name if is_service else own.topic.name
            try:
                writers = self._node.get_publishers_info_by_topic(name, is_service)
                readers = self._node.get_subscriptions_info_by_topic(name, is_service)
            except Exception:
                # A middleware that cannot tell. Messages pass all the same.
                continue
            for each in (*writers, *readers):
                line = _mismatch(own, each, each.endpoint_type.name == "PUBLISHER")
                if line is None:
                    continue
                gid = bytes(each.endpoint_gid)
                if each.node_name in _NO_NAMES:
                    nameless.add(gid)
                if each.node_name not in _NO_NAMES or gid in self._nameless:
                    self.tell(line)
        self._nameless = nameless

    def close(self) -> None:
        context, self._context = self._context, None
        self._publishers, self._services = {}, {}
        if context is None:
            return
        if self._executor is not None:
            self._executor.shutdown(timeout_sec=2)
        if self._node is not None:
            self._node.destroy_node()
        if context.ok():
            context.shutdown()
        if self._thread is not None:
            self._thread.join(timeout=5)
        self._node = self._executor = self._thread = None

    def _call(self, function: Any, *arguments: Any) -> Any:
        if self._context is None or not self._context.ok():
            raise GraphError("rclpy was shut down")
        try:
            return function(*arguments)
        except Exception as error:
            raise GraphError(f"rclpy: {error}") from None


def _class_of(topic: Topic) -> Any:
    package, kind, name = topic.type.split("/")
    try:
        return getattr(import_module(f"{package}.{kind}"), name)
    except (ImportError, AttributeError):
        raise UserError(
            f"the active environment of ROS 2 has no '{topic.type}', which '{topic.name}' needs; "
            "build its package there, or use --graph rtps, which needs none"
        ) from None


def _qos(qos: TopicQos) -> Any:
    rclpy: Any = import_module("rclpy.qos")
    return rclpy.QoSProfile(
        history=rclpy.HistoryPolicy[qos.history.upper()],
        depth=qos.depth,
        reliability=rclpy.ReliabilityPolicy[qos.reliability.upper()],
        durability=rclpy.DurabilityPolicy[qos.durability.upper()],
    )


def _mismatch(own: OwnEndpoint, peer: Any, writes: bool) -> str | None:
    """Compare an endpoint of ours with what rclpy says of another one (`TopicEndpointInfo`)."""
    node = f"{peer.node_namespace.rstrip('/')}/{peer.node_name}"
    # Before Iron, there were no type hashes.
    found = str(getattr(peer, "topic_type_hash", ""))
    return own.mismatch(
        "" if peer.node_name in _NO_NAMES else node,
        writes,
        peer.topic_type,
        found if found.startswith("RIHS") else None,
        _policies(peer.qos_profile),
    )


def _policies(profile: Any) -> Qos:
    """Return what is known of the policies of an endpoint that rclpy has found."""
    given: dict[str, Any] = {}
    for name, kind in (("reliability", Reliability), ("durability", Durability)):
        value = getattr(profile, name).name
        if value in kind.__members__:
            given[name] = kind[value]
    ends = {name: getattr(profile, name).nanoseconds / 1e9 for name in _DURATIONS}
    deadline, lease = (INFINITE if ends[each] > _LONGEST else ends[each] for each in _DURATIONS)
    is_manual = profile.liveliness.name == "MANUAL_BY_TOPIC"
    return Qos(**given, deadline=deadline, lease=lease, liveliness=2 * is_manual)
