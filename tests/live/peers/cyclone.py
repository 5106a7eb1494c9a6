"""A peer in Cyclone DDS, run by the Python of an environment with `cyclonedds`; as `ros.py`."""

import json
import sys
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import sequence, uint8
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class Text(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data: str


@dataclass
class Block(IdlStruct, typename="firm_hdl::msg::dds_::Block_"):
    number: int
    data: sequence[uint8]


def say(**what):
    print(json.dumps(what), flush=True)


def message_of(options, number):
    if options["type"] == "string":
        return Text(data=f"m{number}")
    size = options["bytes"] // 251 & ~3
    return Block(number=number, data=[(number + i * 7) & 0xFF for i in range(251)] * size)


def number_of(options, message):
    number = int(message.data[1:]) if options["type"] == "string" else message.number
    return number if message == message_of(options, number) else -1


def qos():
    return Qos(
        Policy.Reliability.Reliable(duration(seconds=10)),
        Policy.History.KeepAll,
        Policy.DataRepresentation(use_cdrv0_representation=True),
    )


def publish(topic, options):
    writer = DataWriter(topic.participant, topic, qos=qos())
    messages = [message_of(options, n) for n in range(options["count"])]
    say(ready=True)
    end = time.monotonic() + options.get("patience", 20)
    while writer.get_matched_subscriptions() == [] and time.monotonic() < end:
        time.sleep(0.02)
    time.sleep(0.3)
    for message in messages:
        writer.write(message)
        time.sleep(options.get("period", 0))
    time.sleep(2)
    say(sent=len(messages))


def subscribe(topic, options):
    reader = DataReader(topic.participant, topic, qos=qos())
    say(ready=True)
    numbers = []
    end = time.monotonic() + options.get("patience", 20)
    while len(numbers) < options["count"] and time.monotonic() < end:
        numbers += [number_of(options, each) for each in reader.take(N=100)]
        time.sleep(0.01)
    say(numbers=numbers)


def echo(topic, options):
    """Send back what comes, until this process is killed."""
    reader = DataReader(topic.participant, topic, qos=qos())
    back = Topic(topic.participant, options["back"], Text, qos=qos())
    writer = DataWriter(topic.participant, back, qos=qos())
    say(ready=True)
    for message in reader.take_iter():
        writer.write(message)


if __name__ == "__main__":
    what, options = sys.argv[1], json.loads(sys.argv[2])
    kind = {"string": Text, "block": Block}[options["type"]]
    participant = DomainParticipant(options.get("domain", 0))
    topic = Topic(participant, options["topic"], kind, qos=qos())
    {"publish": publish, "subscribe": subscribe, "echo": echo}[what](topic, options)
