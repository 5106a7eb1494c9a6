"""The program ``python -m lab.prove``, which `make prove` runs."""

from __future__ import annotations

from lab import prove as command


def test_both_converters_of_covering_types_of_both_wires_are_proved(monkeypatch):
    seen = []

    def run(tasks, jobs, *, with_summary):
        seen.extend(tasks)
        assert jobs == 3
        return 1

    monkeypatch.setattr(command, "run_proofs", run)
    assert command.main(["--jobs", "3", "--bus-bytes", "4", "--timeout", "9"]) == 1
    assert {(task.distro, task.direction) for task in seen} == {
        (distro, direction)
        for distro in ("noetic", "lyrical")
        for direction in ("deserializer", "serializer")
    }
    assert {(task.bus_bytes, task.timeout) for task in seen} == {(4, 9.0)}
    assert {"sensor_msgs/msg/Imu", "proved_msgs/msg/Wide"} <= {task.name for task in seen}
