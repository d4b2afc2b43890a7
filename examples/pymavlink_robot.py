"""A robot in lock-step, some sixty lines on pymavlink: `python pymavlink_robot.py PORT`.

It follows protocol/README.md alone, and answers what it must.
"""

import math
import socket
import sys
import time
from contextlib import suppress

from laglab_protocol.dialect.generated import laglab as mavlink  # elsewhere: what mavgen makes

ROBOT, STATION = (1, 1), (200, 190)
SAMPLE_TIME, REPEAT, SILENCE = 0.01, 0.1, 3.0  # [s]


class Robot:
    def __init__(self, port):
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.link.bind(("127.0.0.1", port))
        self.link.settimeout(REPEAT / 2)
        self.mav, self.tick = mavlink.MAVLink(self, *ROBOT), None

    def write(self, frame):  # pymavlink has made it
        self.link.sendto(frame, self.station)

    def run(self):
        while True:
            with suppress(TimeoutError):
                self.take(*self.link.recvfrom(2048))
            if self.tick is not None and time.monotonic() - self.heard > SILENCE:
                self.end(mavlink.LAGLAB_END_REASON_FAILED)
            elif self.tick is not None and time.monotonic() - self.said > REPEAT:
                self.say_tick()

    def take(self, datagram, sender):
        parser = mavlink.MAVLink(None)  # a new one each time: a datagram is a unit
        parser.robust_parsing = True
        for message in parser.parse_buffer(datagram) or []:
            if (message.get_srcSystem(), message.get_srcComponent()) == STATION:
                self.station, self.heard = sender, time.monotonic()
                getattr(self, message.get_type(), lambda _: None)(message)

    def HEARTBEAT(self, _):
        if self.tick is None:
            self.tick, self.stamp, self.before = 0, -1, 0
            self.pose, self.speeds = (-3.0, -3.0, 0.0), (0.0, 0.0)
            self.say_tick()

    def say_tick(self):
        self.mav.laglab_measurement_send(*self.pose, *self.speeds, self.tick, self.stamp)
        self.mav.laglab_tick_send(self.tick, 1)
        self.said = time.monotonic()

    def LAGLAB_ESTIMATE(self, _):
        self.before += 1

    LAGLAB_RECALL = LAGLAB_ESTIMATE  # it is counted, and need not be answered

    def LAGLAB_COMMAND(self, command):
        whole, self.before = self.before >= command.estimates, 0
        meant = (command.target_system, command.target_component) == ROBOT
        finite = math.isfinite(command.v) and math.isfinite(command.omega)
        if whole and meant and finite and command.tick == self.tick:
            self.drive(command.v, command.omega)
            self.tick, self.stamp = self.tick + 1, self.tick
            self.say_tick()

    def drive(self, v, omega):
        (x, y, theta), step = self.pose, SAMPLE_TIME * v
        x, y = x + step * math.cos(theta), y + step * math.sin(theta)
        self.pose, self.speeds = (x, y, theta + SAMPLE_TIME * omega), (v, omega)

    def COMMAND_LONG(self, request):
        if request.target_system in (ROBOT[0], 0) and request.target_component in (ROBOT[1], 0):
            self.mav.command_ack_send(request.command, 3, 0, 0, *STATION)  # unsupported

    COMMAND_INT = COMMAND_LONG

    def LAGLAB_END(self, end):
        if self.tick is not None:
            self.end(end.reason)

    def end(self, reason):
        self.mav.laglab_end_send(self.tick, reason)
        self.tick = None


if __name__ == "__main__":
    Robot(int(sys.argv[1])).run()
