"""(27) for many robots."""

from laglab_control.batch.matrices import covariance_of, led
from laglab_control.batch.rows import Belief, Row, Speeds
from laglab_control.motion import Motion
from laglab_control.robot import RobotModel


def predicted(model: RobotModel, belief: Belief, heading: tuple[Row, Row], u: Speeds) -> Belief:
    """One tick further, given the cosine and sine of the belief's heading.

    `compose` with the motion of one tick, less what is 0 there: the robot only drives forward, and
    its wheels' noise does not push it aside.
    """
    n_xx, _, n_xt, _, _, n_tt = model.noise
    c, s = heading
    distance = model.sample_time * u.v
    dx, dy = c * distance, s * distance
    xx, xy, xt, yy, yt, tt = led(covariance_of(belief), dx, dy)
    along = n_xx * c
    xx += along * c
    xy += along * s
    across = s * s
    across *= n_xx
    yy += across
    if n_xt:
        xt += n_xt * c
        yt += n_xt * s
    dx += belief.x
    dy += belief.y
    turned = belief.theta + model.sample_time * u.omega
    return Motion(dx, dy, turned, xx, xy, xt, yy, yt, tt + n_tt)
