"""The conformance kit: does whatever answers at this address speak our protocol?"""

from pathlib import Path
from typing import Literal

from laglab_protocol.conform import controller, robot
from laglab_protocol.conform.items import carry_out
from laglab_protocol.conform.report import Report, Result, Verdict
from laglab_protocol.conform.session import Patience
from laglab_protocol.endpoints import open_endpoint

__all__ = ["Patience", "Report", "Result", "Verdict", "conform"]

Side = Literal["robot", "controller"]


def conform(
    url: str, side: Side, key_file: Path | None = None, patience: Patience | None = None
) -> Report:
    """Test the robot, or the controller, that answers at `url`; its run is over afterwards.

    A robot is told to stand still throughout. Raises the EndpointError and KeyFileError trees.
    """
    patience = patience or Patience()
    with open_endpoint(url) as endpoint:
        if side == "robot":
            session = robot.RobotSession(endpoint, patience, key_file)
            return Report(side, carry_out(robot.ITEMS, session))
        talk = controller.ControllerSession(endpoint, patience, key_file)
        return Report(side, carry_out(controller.ITEMS, talk))
