"""A node of ROS 2 whose messages are bytes: publishers, subscriptions, services and clients."""

from __future__ import annotations

import re
from typing import Any

from firm_hdl.rtps.endpoints import ClosedError, DataReader, DataWriter, OnSample
from firm_hdl.rtps.qos import Qos
from firm_hdl.rtps.ros import names
from firm_hdl.rtps.ros.context import Context
from firm_hdl.rtps.ros.graph import NodeInfo
from firm_hdl.rtps.ros.services import Client, Handler, Service

__all__ = ["Node"]

# Peers refuse the graph of a participant with a longer one.
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,254}")
# A burst of requests gets its replies also where some datagrams are lost.
_SERVICE_QOS = Qos(depth=256)


class Node:
    """A node. It is also a context manager, which closes it.

    Payloads are serialized messages with their encapsulation header of 4 bytes, as
    ``firm_hdl.plan.encode`` makes them on the wire ``cdr``, behind ``00 01 00 00``.

    Parameters
    ----------
    name, namespace : str
        Such as ``board`` and ``/``.
    domain : int
        The domain (``ROS_DOMAIN_ID``).
    context : Context or None
        The participant, if several nodes share one. By default, the node has its own.
    options
        Further parameters of :class:`Context` and of
        :class:`firm_hdl.rtps.participant.Participant`, such as `interface`.

    Raises
    ------
    ValueError
        A name breaks the rules of ROS 2, or the context has such a node already.
    """

    def __init__(
        self,
        name: str,
        namespace: str = "/",
        domain: int = 0,
        *,
        context: Context | None = None,
        **options: Any,
    ):
        if not _NAME.fullmatch(name):
            raise ValueError(f"'{name}' is no name of a node")
        if not namespace.startswith("/"):
            namespace = f"/{namespace}"
        if namespace != "/":
            namespace = names.expanded(namespace.rstrip("/"), name, "/")
        self.name = name
        self.namespace = namespace
        self._owns_context = context is None
        self.context = context or Context(domain, **options)
        if self.context.has(name, namespace):
            raise ValueError(f"there is a node '{name}' in '{namespace}' already")
        self._readers: list[DataReader] = []
        self._writers: list[DataWriter] = []
        self._closed = False
        self._update()

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def publisher(
        self,
        topic: str,
        type_name: str,
        qos: Qos | None = None,
        *,
        type_hash: str | None = None,
        **callbacks: Any,
    ) -> DataWriter:
        """Create a publisher.

        Parameters
        ----------
        topic, type_name : str
            Names of ROS, such as ``chatter`` and ``std_msgs/msg/String``.
        qos : Qos
            Policies. By default reliable, volatile, the last 10 samples, as in ROS 2.
        type_hash : str or None
            Type hash, such as ``firm-hdl hash`` prints it.
        callbacks
            `on_match` and `on_incompatible` of :class:`firm_hdl.rtps.endpoints.Endpoint`.
        """
        return self._writer(
            names.topic(self._expanded(topic)),
            names.type_name(type_name),
            qos,
            user_data=names.user_data(type_hash),
            **callbacks,
        )

    def subscription(
        self,
        topic: str,
        type_name: str,
        on_sample: OnSample,
        qos: Qos | None = None,
        *,
        type_hash: str | None = None,
        **callbacks: Any,
    ) -> DataReader:
        """Create a subscription. `on_sample` is called with each sample; the rest is as above."""
        return self._reader(
            names.topic(self._expanded(topic)),
            names.type_name(type_name),
            on_sample,
            qos,
            user_data=names.user_data(type_hash),
            **callbacks,
        )

    def service(
        self,
        name: str,
        type_name: str,
        handler: Handler,
        *,
        request_hash: str | None = None,
        response_hash: str | None = None,
    ) -> Service:
        """Create a service.

        Parameters
        ----------
        name, type_name : str
            Names of ROS, such as ``set_mode`` and ``std_srvs/srv/SetBool``.
        handler : callable
            Takes the payload of a request, and returns that of the reply. Called in the thread of
            the participant.
        request_hash, response_hash : str or None
            Type hashes of its two messages.
        """
        full, service = self._expanded(name), Service(handler)
        service.replies = self._writer(
            names.reply_topic(full),
            names.type_name(type_name, "_Response"),
            _SERVICE_QOS,
            user_data=names.user_data(response_hash),
            on_match=service.on_match,
        )
        service.requests = self._reader(
            names.request_topic(full),
            names.type_name(type_name, "_Request"),
            service.on_request,
            _SERVICE_QOS,
            user_data=names.user_data(request_hash),
        )
        return service

    def client(
        self,
        name: str,
        type_name: str,
        *,
        request_hash: str | None = None,
        response_hash: str | None = None,
    ) -> Client:
        """Create a client of a service; the parameters are as those of :meth:`service`."""
        full, client = self._expanded(name), Client(self.context.participant)
        replies = self._reader(
            names.reply_topic(full),
            names.type_name(type_name, "_Response"),
            client.on_reply,
            _SERVICE_QOS,
            user_data=names.user_data(response_hash),
        )
        requests = self._writer(
            names.request_topic(full),
            names.type_name(type_name, "_Request"),
            _SERVICE_QOS,
            user_data=names.user_data(request_hash),
        )
        client.open(requests, replies)
        return client

    def close(self) -> None:
        """Remove the node with all that it has; see :meth:`Participant.remove`."""
        if self._closed:
            return
        self._closed = True
        self.context.remove(self.name, self.namespace)
        if self._owns_context:
            self.context.close()
            return
        guids = [each.guid for each in (*self._readers, *self._writers)]
        self.context.participant.remove(*guids)

    def _expanded(self, name: str) -> str:
        if self._closed:
            raise ClosedError(f"the node '{self.name}' is closed")
        return names.expanded(name, self.name, self.namespace)

    def _writer(self, *args: Any, **options: Any) -> DataWriter:
        made = self.context.participant.writer(*args, **options)
        self._writers.append(made)
        self._update()
        return made

    def _reader(self, *args: Any, **options: Any) -> DataReader:
        made = self.context.participant.reader(*args, **options)
        self._readers.append(made)
        self._update()
        return made

    def _update(self) -> None:
        self.context.update(
            NodeInfo(
                name=self.name,
                namespace=self.namespace,
                readers=tuple(each.guid for each in self._readers),
                writers=tuple(each.guid for each in self._writers),
            )
        )
