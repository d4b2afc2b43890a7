"""A mavsdk program that knows our dialect: `python mavsdk_peer.py PORT`.

Each line of its input, {"name": …, "fields": …}, it sends as a message; each message of ours that
it receives it prints as such a line. The first line of its output is "ready".
"""

import json
import sys

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.mavlink_direct import MavlinkDirect, MavlinkMessage

from laglab_protocol.dialect.mavgen import dialect_path


def tell(message: MavlinkMessage, _: object) -> None:
    if message.message_name.startswith("LAGLAB"):
        print(json.dumps({"name": message.message_name, "fields": message.fields_json}), flush=True)


def main(port: int) -> None:
    configuration = Configuration.create_with_component_type(ComponentType.GROUND_STATION)
    with Mavsdk(configuration) as mavsdk:
        mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        direct = MavlinkDirect(mavsdk.first_autopilot(20.0))
        direct.load_custom_xml(dialect_path().read_text())
        direct.subscribe_message("", tell)
        print("ready", flush=True)
        for line in sys.stdin:
            asked = json.loads(line)
            fields = json.dumps(asked["fields"])
            direct.send_message(MavlinkMessage(asked["name"], 0, 0, 1, 1, fields))


if __name__ == "__main__":
    main(int(sys.argv[1]))
