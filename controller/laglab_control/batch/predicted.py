"""(27) for many robots."""

import numpy as np

from laglab_control.batch.rows import Belief, Row, Speeds
from laglab_control.motion import Motion
from laglab_control.robot import RobotModel


def predicted(model: RobotModel, belief: Belief, heading: tuple[Row, Row], u: Speeds) -> Belief:
    """One tick further, given the cosine and sine of the belief's heading.

    `compose` with the motion of one tick, less what is 0 there: the robot only drives forward, and
    its wheels' noise does not push it aside.
    """
    x, y, theta, xx, xy, xt, yy, yt, tt = belief
    n_xx, _, n_xt, _, _, n_tt = model.noise
    c, s = heading
    distance = model.sample_time * u.v
    dx, dy = c * distance, s * distance
    xt_led, yt_led, along = dy * tt, dx * tt, n_xx * c
    np.subtract(xt, xt_led, xt_led)
    yt_led += yt
    xx_led, xy_led, yy_led = along * c, along * s, s * s
    yy_led *= n_xx
    xx_led -= dy * (xt + xt_led)
    xx_led += xx
    xy_led += dx * xt_led
    xy_led -= dy * yt
    xy_led += xy
    yy_led += dx * (yt + yt_led)
    yy_led += yy
    if n_xt:
        xt_led += n_xt * c
        yt_led += n_xt * s
    dx += x
    dy += y
    turned = theta + model.sample_time * u.omega
    return Motion(dx, dy, turned, xx_led, xy_led, xt_led, yy_led, yt_led, tt + n_tt)
