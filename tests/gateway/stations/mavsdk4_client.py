"""What a mavsdk program does with a rover, told as JSON: `python mavsdk4_client.py PORT`.

A process of its own, since mavsdk's threads end with it.
"""

import json
import queue
import sys
import time
from typing import Any

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.exceptions import MavsdkError
from mavsdk.plugins.action import Action
from mavsdk.plugins.ftp import Ftp
from mavsdk.plugins.info import Info
from mavsdk.plugins.log_files import LogFiles
from mavsdk.plugins.mavlink_direct import MavlinkDirect, MavlinkMessage
from mavsdk.plugins.mission_raw import MissionRaw
from mavsdk.plugins.param import Param, ParamError
from mavsdk.plugins.telemetry import Telemetry

from laglab_protocol.dialect.mavgen import dialect_path

ARM = {"command": 400, "confirmation": 0, "param1": 1.0, **{f"param{i}": 0.0 for i in range(2, 8)}}
RESET = {"command": 52100, "confirmation": 0, **{f"param{i}": 0.0 for i in range(1, 8)}}


def command(direct: MavlinkDirect, fields: dict[str, float]) -> int:
    whole = fields | {"target_system": 1, "target_component": 1}
    ack = direct.send_command(MavlinkMessage("COMMAND_LONG", 0, 0, 1, 1, json.dumps(whole)))
    return int(json.loads(ack.fields_json)["result"])


def refused(param: Param) -> str:
    try:
        param.set_param_float("DELAY_N", 3.0)
    except ParamError as error:
        return str(error.result.name)
    return "nothing"


def first(subscribe: Any) -> Any:
    """What a subscription tells first."""
    told: queue.Queue[Any] = queue.Queue()
    subscribe(lambda value, _: told.put(value))
    return told.get(timeout=10)


def outcome(ask: Any, *arguments: Any) -> str:
    """The error's name, or what there is."""
    try:
        return str(ask(*arguments))
    except MavsdkError as error:
        return str(error.result.name)


def look_around(system: Any) -> dict[str, Any]:
    """What a program asks for that knows nothing of the robot."""
    telemetry, missions = Telemetry(system), MissionRaw(system)
    odometry = first(telemetry.subscribe_odometry)
    position = first(telemetry.subscribe_position)
    home = first(telemetry.subscribe_home)
    return {
        "frames": [odometry.frame_id.name, odometry.child_frame_id.name],
        "odometry": [odometry.position_body.x_m, odometry.position_body.y_m],
        "position": [position.latitude_deg, position.longitude_deg],
        "home": [home.latitude_deg, home.longitude_deg],
        "landed": first(telemetry.subscribe_landed_state).name,
        "health": telemetry.health().is_global_position_ok,
        "origin": telemetry.get_gps_global_origin().latitude_deg,
        "version": Info(system).get_version().flight_sw_minor,
        "mission": outcome(missions.download_mission),
        "fence": outcome(missions.download_geofence),
        "rally": outcome(missions.download_rallypoints),
        "cleared": outcome(missions.clear_mission),
        "logs": outcome(LogFiles(system).get_entries),
        "files": outcome(Ftp(system).list_directory, "/"),
        "hold": outcome(Action(system).hold),
    }


def tour(port: int) -> dict[str, Any]:
    configuration = Configuration.create_with_component_type(ComponentType.GROUND_STATION)
    with Mavsdk(configuration) as mavsdk:
        mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = mavsdk.first_autopilot(20.0)
        param, direct = Param(system), MavlinkDirect(system)
        positions: queue.Queue[dict[str, float]] = queue.Queue()
        direct.subscribe_message(
            "LOCAL_POSITION_NED", lambda message, _: positions.put(json.loads(message.fields_json))
        )
        seen: dict[str, Any] = {"system": system.get_system_id()}
        direct.load_custom_xml(dialect_path().read_text())
        seen["read"] = param.get_param_float("DELAY_N")
        param.set_param_float("V_MAX", 1.5)
        seen["set"] = param.get_param_float("V_MAX")
        seen["refused"] = refused(param)
        began = time.monotonic()
        seen["around"] = look_around(system)
        seen["seconds"] = time.monotonic() - began
        seen["before"] = positions.get(timeout=10)
        seen["armed"] = command(direct, ARM)
        while (position := positions.get(timeout=10))["x"] == seen["before"]["x"]:
            pass
        seen["after"] = position
        seen["reset while armed"] = command(direct, RESET)
    return seen


if __name__ == "__main__":
    print(json.dumps(tour(int(sys.argv[1]))))
