"""What a mavsdk program does with a rover, told as JSON: `python mavsdk_client.py PORT`.

A process of its own, since mavsdk's threads end with it.
"""

import json
import queue
import sys
from typing import Any

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.mavlink_direct import MavlinkDirect, MavlinkMessage
from mavsdk.plugins.param import Param, ParamError

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
        param.set_param_float("V_MAX", 1.25)
        seen["set"] = param.get_param_float("V_MAX")
        seen["refused"] = refused(param)
        seen["before"] = positions.get(timeout=10)
        seen["armed"] = command(direct, ARM)
        while (position := positions.get(timeout=10))["x"] == seen["before"]["x"]:
            pass
        seen["after"] = position
        seen["reset while armed"] = command(direct, RESET)
    return seen


if __name__ == "__main__":
    print(json.dumps(tour(int(sys.argv[1]))))
