"""What the robot's side is told before it begins."""

import math

from laglab_gateway.drive import Safety
from laglab_gateway.values import Positive, Ticks, checked
from laglab_protocol import Settings


@checked
class GatewayConfig:
    """Delays n and m [ticks], the tick that ends the run (None: none does), Ts [s], the failsafe;
    the robot's geometry [m], for the station to compare, where it is known; the play-out of
    commands here, and of measurements at the station, and for how much longer commands plan
    [ticks], 0 without.

    Raises ConfigError, naming the field, when one cannot be.
    """

    command_delay: Ticks
    measurement_delay: Ticks
    last_tick: Ticks | None
    sample_time: Positive
    safety: Safety = Safety()
    wheel_radius: Positive | None = None
    track: Positive | None = None
    command_playout: Ticks = 0
    measurement_playout: Ticks = 0
    plan: Ticks = 0

    @property
    def settings(self) -> Settings:
        """What the station is told of all this."""
        v_limit, omega_limit = self.safety.v_limit, self.safety.omega_limit
        return Settings(
            sample_time=self.sample_time,
            wheel_radius=self.wheel_radius or math.nan,
            track=self.track or math.nan,
            v_max=math.inf if v_limit is None else v_limit,
            omega_max=math.inf if omega_limit is None else omega_limit,
            command_delay=self.command_delay,
            measurement_delay=self.measurement_delay,
            command_playout=self.command_playout,
            measurement_playout=self.measurement_playout,
            plan=self.plan,
        )
