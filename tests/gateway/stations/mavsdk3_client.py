"""What a program on mavsdk 3 asks of a rover, told as JSON: `python mavsdk3_client.py PORT`.

For an environment of its own: mavsdk 3 and 4 bear the same name.
"""

import asyncio
import json
import socket
import sys
import time
from collections.abc import AsyncIterator, Awaitable
from typing import Any

from mavsdk import System

PATIENCE = 10.0


async def first(told: AsyncIterator[Any]) -> Any:
    """What a subscription tells first."""
    return await asyncio.wait_for(anext(told), PATIENCE)


async def outcome(asked: Awaitable[Any]) -> str:
    """The error's name, or what there is."""
    try:
        return str(await asyncio.wait_for(asked, PATIENCE))
    except Exception as error:  # each plugin has a class of its own
        return str(error).partition(":")[0]


async def look_around(system: System) -> dict[str, Any]:
    """What a program asks for that knows nothing of the robot."""
    telemetry, missions = system.telemetry, system.mission_raw
    odometry = await first(telemetry.odometry())
    position = await first(telemetry.position())
    home = await first(telemetry.home())
    return {
        "odometry": [odometry.position_body.x_m, odometry.position_body.y_m],
        "position": [position.latitude_deg, position.longitude_deg],
        "home": [home.latitude_deg, home.longitude_deg],
        "landed": str(await first(telemetry.landed_state())),
        "health": (await first(telemetry.health())).is_global_position_ok,
        "origin": (await telemetry.get_gps_global_origin()).latitude_deg,
        "version": (await system.info.get_version()).flight_sw_minor,
        "mission": await outcome(missions.download_mission()),
        "fence": await outcome(missions.download_geofence()),
        "rally": await outcome(missions.download_rallypoints()),
        "cleared": await outcome(missions.clear_mission()),
        "logs": await outcome(system.log_files.get_entries()),
        "files": await outcome(system.ftp.list_directory("/")),
        "hold": await outcome(system.action.hold()),
    }


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


async def tour(port: int) -> dict[str, Any]:
    system = System(port=free_port())
    await system.connect(system_address=f"udpin://127.0.0.1:{port}")
    async for state in system.core.connection_state():
        if state.is_connected:
            break
    began = time.monotonic()
    around = await look_around(system)
    seconds = time.monotonic() - began
    await system.param.set_param_float("V_MAX", 1.5)
    return {
        "around": around,
        "seconds": seconds,
        "set": await system.param.get_param_float("V_MAX"),
        "parameters": len((await system.param.get_all_params()).float_params),
        "armed": await outcome(system.action.arm()),
        "disarmed": await outcome(system.action.disarm()),
    }


if __name__ == "__main__":
    print(json.dumps(asyncio.run(tour(int(sys.argv[1])))))
