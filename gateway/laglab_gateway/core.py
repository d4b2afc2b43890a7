"""A plant that is stepped, at the end of the link: frames and a tick in, the bytes of others out.

One tick (in the order of docs/tick.md): `open_tick` samples the sensor and gives the frames
for the station; `hear` takes the station's; `settle` lets the commands that are due come
into force and sets the plant going; `close_tick` says what happened. `settle` comes right after
`open_tick`, so what arrives during a tick counts from the next one on; only in lock-step with
n = 0 it waits for the answer to this tick, so that n = 0 means no delay.
"""

from collections.abc import Mapping

from laglab_gateway.config import GatewayConfig
from laglab_gateway.drive import speeds, supervise
from laglab_gateway.link.fates import Fates
from laglab_gateway.link.timeline import Direction
from laglab_gateway.plant import Plant
from laglab_gateway.record.trace import TraceRow
from laglab_gateway.services import RobotState, Services, standard_parameters
from laglab_gateway.side import RobotSide
from laglab_protocol import Measurement, Sender


class Gateway(RobotSide):
    """A plant at the end of a link, stepped by whoever drives the gateway from tick to tick."""

    def __init__(
        self,
        plant: Plant,
        config: GatewayConfig,
        fates: Mapping[Direction, Fates] | None = None,
        services: Services | None = None,
        sender: Sender | None = None,
    ) -> None:
        n, m = config.command_delay, config.measurement_delay
        services = services or Services(standard_parameters(n, m, config.safety))
        super().__init__(config, services, fates, sender)
        self._plant = plant
        self._speeds = (0.0, 0.0)
        self._reading = plant.read()

    @property
    def immediate(self) -> bool:
        """Whether the command of a tick comes into force at that tick."""
        return self._config.command_delay == 0

    def _begin_tick(self) -> None:
        self._go_to(self.tick + 1)
        if pose := self.services.arming.take_reset():
            self._plant.place(*pose)
        self._reading = self._plant.read()

    @property
    def state(self) -> RobotState:
        """The robot at this tick, for those who ask."""
        reading = self._reading
        return RobotState(
            self.time_us, reading.x, reading.y, reading.theta, reading.v, reading.omega
        )

    def open_tick(self) -> list[bytes]:
        """Sample the sensor at k; the frames: each z that has come across the link, the tick."""
        return self._tell([self._sample()])

    def _sample(self) -> Measurement:
        """z_k, and the command in force on [t_{k-1}, t_k)."""
        _, _, _, x, y, theta, *_ = self._reading
        return Measurement(x, y, theta, *self._speeds, self.tick, self._drive.command_tick)

    def settle(self) -> None:
        """Let the commands that have crossed the link come into force, and the failsafe watch.

        Then the plant is on its way to k + 1, unless the run ends at k.
        """
        k, Ts, safety = self.tick, self._config.sample_time, self.safety
        came = self._take_commands(k)
        for asked in came.recalls:
            self._owed.owe(self._memory.answers(asked))
        for command in came.commands:
            self.audit.command.arrived(command.tick, k)
        for planned in came.ready:
            if self._follow(planned, k, safety):
                self.notes.came("command", planned.tick, k, self.elapsed)
        supervised = supervise(self._drive, k, Ts, safety)
        if supervised.mode is not self._drive.mode:
            self.audit.stopped(k)
            if self._stopping.by_itself:
                self.announce(f"no fresh command for {safety.link_timeout} s: stopping")
        self._say_why_stopping(k - supervised.fresh, safety)
        self._drive = supervised
        self._speeds = self._armed(*speeds(self._drive, k, Ts, safety))
        self._memory.keep(k, self._speeds)
        if self._ending is None:
            self._plant.step(*self._speeds)

    def close_tick(self) -> TraceRow:
        """On to k + 1, unless the run ends at k; says what happened at k."""
        row = self._row(self._reading[:3], self._reading[3:6], self._speeds)
        self._close()
        if self.outcome is None:
            self._begin_tick()
        return row
