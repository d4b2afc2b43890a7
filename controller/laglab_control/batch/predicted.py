"""(27) for many robots."""

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
    xt_led, yt_led = xt - dy * tt, yt + dx * tt
    along, across = n_xx * c, n_xx * s
    xx, yy = xx - dy * (xt + xt_led) + along * c, yy + dx * (yt + yt_led) + across * s
    xy = xy + dx * xt_led - dy * yt + along * s
    if n_xt:
        xt_led, yt_led = xt_led + n_xt * c, yt_led + n_xt * s
    turned = theta + model.sample_time * u.omega
    return Motion(x + dx, y + dy, turned, xx, xy, xt_led, yy, yt_led, tt + n_tt)
