"""A run as ROS 2 messages: other people's readers find what it holds."""

import math
import shutil
import subprocess
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import msgspec
import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

import laglab
from laglab.export import export
from laglab.export.ros.definitions import DEFINITIONS
from laglab.export.ros.topics import TOPICS
from laglab.results.run import Run, open_run
from laglab.results.summary import write_summary
from laglab_gateway import read_trace

SHADOW = "popf-exact"
Start = Callable[..., "subprocess.Popen[str]"]
ListeningPort = Callable[["subprocess.Popen[str]"], str]
Ts = 0.01


class Logged(NamedTuple):
    """A message, with its times [ns]."""

    at: int
    stamp: int
    message: Any


def stamp(message: Any) -> int:
    """In nanoseconds."""
    (message,) = getattr(message, "transforms", [message])
    of = message.header.stamp
    return int(of.sec * 10**9 + of.nanosec)


@pytest.fixture(scope="module")
def a_run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """With losses, delays, and a filter that shadows it."""
    folder = tmp_path_factory.mktemp("runs") / "radio"
    return laglab.run("lab-radio", {"duration": 2.0, "estimator.compare": [SHADOW]}, out=folder)


@pytest.fixture(scope="module")
def bag(a_run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return export(a_run, "ros2bag", tmp_path_factory.mktemp("bags") / "bag")


def by_mcap(bag: Path) -> Iterator[tuple[str, int, Any]]:
    with (bag / "run.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages():
            yield channel.topic, message.log_time, decoded


def by_rosbags(bag: Path) -> Iterator[tuple[str, int, Any]]:
    with AnyReader([bag]) as reader:
        for connection, time, raw in reader.messages():
            yield connection.topic, time, reader.deserialize(raw, connection.msgtype)


@pytest.fixture(scope="module", params=[by_mcap, by_rosbags])
def logged(request: pytest.FixtureRequest, bag: Path) -> dict[str, list[Logged]]:
    """All messages by topic."""
    topics: dict[str, list[Logged]] = {}
    before = 0
    for topic, time, message in request.param(bag):
        assert time >= before
        before = time
        topics.setdefault(topic, []).append(Logged(time, stamp(message), message))
    return topics


Topics = dict[str, list[Logged]]


def pose(of: Any) -> list[float]:
    """x, y, theta."""
    assert (of.position.z, of.orientation.x, of.orientation.y) == (0, 0, 0)
    turn = 2 * math.atan2(of.orientation.z, of.orientation.w)
    return [of.position.x, of.position.y, turn]


def covariance(of: Any) -> Any:
    """Of x, y, theta, (3, 3)."""
    return np.array(of.covariance).reshape(6, 6)[np.ix_([0, 1, 5], [0, 1, 5])]


def assert_poses(found: Any, run: Run, suffix: str, rows: Any = slice(None)) -> None:
    expected = np.stack([run.trace[axis + suffix][rows] for axis in ("x", "y", "theta")], axis=1)
    np.testing.assert_array_equal(np.array(found)[:, :2], expected[:, :2])
    turned = np.exp(1j * np.array(found)[:, 2]), np.exp(1j * expected[:, 2])
    np.testing.assert_allclose(*turned, atol=1e-15)


def test_each_tick_has_the_pose_and_the_estimate_with_its_covariance(
    a_run: Run, logged: Topics
) -> None:
    (shadow,) = (piece for piece in a_run.shadow_pieces(SHADOW) if len(piece["tick"]))
    upper = np.triu_indices(3)
    for topic, suffix, claims in (
        ("/laglab/true", "", None),
        ("/laglab/estimate", "_est", a_run.claims),
        ("/laglab/shadow/popf_exact", f"_{SHADOW}", shadow),
    ):
        every = logged[topic]
        ticks = [round(tick * Ts * 1e9) for tick in range(201)]
        assert [each.at for each in every] == [each.stamp for each in every] == ticks
        assert_poses([pose(each.message.pose.pose) for each in every], a_run, suffix)
        P = np.array([covariance(each.message.pose) for each in every])
        np.testing.assert_array_equal(P, P.transpose(0, 2, 1))
        names = ("p_xx", "p_xy", "p_xt", "p_yy", "p_yt", "p_tt")
        told = np.stack([claims[name] for name in names], axis=1) if claims else np.zeros((201, 6))
        np.testing.assert_array_equal(P[:, *upper], told)
        v = [each.message.twist.twist.linear.x for each in every]
        np.testing.assert_array_equal(v, a_run.trace["v"])


def test_the_transforms_are_the_same_poses(a_run: Run, logged: Topics) -> None:
    frames = {"robot": "", "robot_estimate": "_est", "robot_popf_exact": f"_{SHADOW}"}
    moved = [each.message.transforms[0] for each in logged["/tf"]]
    assert {each.header.frame_id for each in moved} == {"world"}
    assert {each.child_frame_id for each in moved} == frames.keys()
    for frame, suffix in frames.items():
        found = [
            pose(SimpleNamespace(position=of.translation, orientation=of.rotation))
            for of in (each.transform for each in moved if each.child_frame_id == frame)
        ]
        assert_poses(found, a_run, suffix)


def test_a_command_is_told_as_sent_and_as_applied(a_run: Run, logged: Topics) -> None:
    for topic, suffix in (("/laglab/command_sent", "_sent"), ("/laglab/command_applied", "")):
        twists = [each.message.twist for each in logged[topic]]
        np.testing.assert_array_equal([t.linear.x for t in twists], a_run.trace[f"v{suffix}"])
        np.testing.assert_array_equal([t.angular.z for t in twists], a_run.trace[f"omega{suffix}"])


def test_a_measurement_is_stamped_when_sampled_and_logged_when_it_came(
    a_run: Run, logged: Topics
) -> None:
    measured = a_run.arrivals["direction"] == "measurement"
    sampled = a_run.arrivals["tick"][measured].astype(int)
    arrived = a_run.arrivals["arrived"][measured].astype(int)
    assert 50 < len(sampled) < 180  # some late, some lost
    every = logged["/laglab/measurement"]
    assert [each.stamp for each in every] == [round(tick * Ts * 1e9) for tick in sampled]
    assert [each.at for each in every] == [round(tick * Ts * 1e9) for tick in arrived]
    assert_poses([pose(each.message.pose) for each in every], a_run, "_meas", sampled)


@pytest.mark.parametrize("direction", ["command", "measurement"])
def test_the_link_tells_what_it_did(a_run: Run, logged: Topics, direction: str) -> None:
    for kind, table in (("link", a_run.link), ("arrival", a_run.arrivals)):
        rows = table["direction"] == direction
        every = logged[f"/laglab/{kind}/{direction}"]
        for name in table.keys() - {"direction", "time"}:
            found = [getattr(each.message, name) for each in every]
            assert found == table[name][rows].tolist(), name
    delays = [each.message.delay for each in logged[f"/laglab/arrival/{direction}"]]
    assert (
        delays
        == (a_run.arrivals["arrived"] - a_run.arrivals["tick"])[
            a_run.arrivals["direction"] == direction
        ].tolist()
    )


def test_there_is_nothing_that_the_reference_does_not_tell(logged: Topics) -> None:
    places = tuple(topic.name for topic in TOPICS)
    assert all(topic.startswith(places) for topic in logged)
    assert all(any(topic.startswith(place) for topic in logged) for place in places)


def test_the_file_says_what_it_is(a_run: Run, bag: Path) -> None:
    with (bag / "run.mcap").open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == "ros2"
        (scenario,) = reader.iter_attachments()
        (metadata,) = reader.iter_metadata()
        assert {each[1].message_encoding for each in reader.iter_messages()} == {"cdr"}
    assert (scenario.name, scenario.data.decode()) == ("scenario.toml", a_run.scenario.to_toml())
    assert metadata.metadata["epoch"] == "the run's first tick"


def test_rosbag2_finds_what_its_metadata_says(bag: Path, logged: Topics) -> None:
    with Reader(bag) as reader:
        assert reader.message_count == sum(map(len, logged.values()))
        assert (reader.start_time, reader.duration) == (0, 2_000_000_001)
        assert Counter({each.topic: each.msgcount for each in reader.connections}) == {
            topic: len(every) for topic, every in logged.items()
        }


def test_ros_knows_the_definitions() -> None:
    """By the hash that ROS 2 itself takes of a type and all that it is made of."""
    ros, ours = get_typestore(Stores.ROS2_HUMBLE), get_typestore(Stores.EMPTY)
    for name, definition in DEFINITIONS.items():
        ours.register(get_types_from_msg(definition, name.replace("/", "/msg/")))
    names = {name.replace("/", "/msg/") for name in DEFINITIONS if "laglab" not in name}
    assert len(names) == len(DEFINITIONS) - 2
    for name in names:
        assert ours.hash_rihs01(name) == ros.hash_rihs01(name), name


def test_what_is_not_known_is_not_told(tmp_path: Path) -> None:
    """Before any message came; in memory, without a filter."""
    run = laglab.run("fig5", {"duration": 0.03})
    assert not len(run.arrivals["tick"])
    export(run, "mcap", tmp_path / "run.mcap")
    topics = {topic for topic, _, _ in by_mcap(tmp_path)}
    assert topics == {"/laglab/true", "/laglab/command_sent", "/laglab/command_applied", "/tf"}


def test_a_run_cut_short_is_told_as_far_as_it_went(a_run: Run, tmp_path: Path) -> None:
    assert a_run.directory
    shutil.copytree(a_run.directory, tmp_path / "cut")
    for name in ("trace.csv", "claims.csv", "arrivals.csv", "link.csv"):
        lines = (a_run.directory / name).read_text().splitlines(keepends=True)
        (tmp_path / "cut" / name).write_text("".join(lines[: len(lines) // 2]))
    ticks = len(read_trace(tmp_path / "cut" / "trace.csv")["tick"]) - 1
    write_summary(msgspec.structs.replace(a_run.summary, ticks=ticks), tmp_path / "cut")
    bag = export(open_run(tmp_path / "cut"), "ros2bag", tmp_path / "bag")
    every = [message for topic, _, message in by_rosbags(bag) if topic == "/laglab/true"]
    assert 80 < len(every) < 120
    assert_poses([pose(of.pose.pose) for of in every], a_run, "", slice(len(every)))


def test_of_a_real_robot_and_of_a_station_alone_no_true_pose_is_told(
    start: Start, listening_port: ListeningPort, tmp_path: Path
) -> None:
    """Another gateway, on a clock of its own, is the robot."""
    lab, here = ("lab", "--duration", "1"), ("--endpoint", "udpin://127.0.0.1:0")
    own = ("-n", "0", "-m", "0", "--pace", "realtime", "--speed", "4")
    robot = start("gateway", *lab, *own, *here)
    plant = f"udpout://127.0.0.1:{listening_port(robot)}"
    relay = start("gateway", *lab, *here, "--plant", plant, "--out", "relay")
    met = f"udpout://127.0.0.1:{listening_port(relay)}"
    station = start("controller", *lab, "--endpoint", met, "--out", "station")
    for side in (station, relay, robot):
        _, errors = side.communicate(timeout=30)
        assert side.returncode == 0, errors
    for name in ("relay", "station"):
        run = open_run(tmp_path / name)
        bag = export(run, "ros2bag", tmp_path / f"{name}-bag")
        topics: dict[str, list[Any]] = {}
        for topic, _, message in by_rosbags(bag):
            topics.setdefault(topic, []).append(message)
        assert topics.keys() >= {"/laglab/estimate", "/laglab/measurement", "/laglab/command_sent"}
        assert "/laglab/true" not in topics
        assert {each.transforms[0].child_frame_id for each in topics["/tf"]} == {"robot_estimate"}
        came = run.arrivals["direction"] == "measurement"
        assert 50 < len(topics["/laglab/measurement"]) <= came.sum()
        assert (covariance(topics["/laglab/estimate"][0].pose).diagonal() > 0).all()
