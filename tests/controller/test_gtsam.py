"""`delayed-ekf` beside GTSAM's fixed-lag smoother: the same, but for where they linearise."""

import sys

import numpy as np
import pytest

from .overheard import OLDEST, SEEDS, TICKS, Apart, recorded

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="GTSAM has no wheels for Windows")

SIDEWAYS = 1e-8
"""[m] of noise a tick where there is none, for GTSAM inverts every covariance; ten times as much or
a tenth changes none of the figures below."""

BOUND = Apart(position=6e-4, heading=2e-4, deviations=0.06, covariance=0.04)
"""Twice what was measured, at noise 1."""


@pytest.mark.parametrize("lag", [OLDEST, TICKS + 1], ids=["fixed lag", "batch MAP"])
@pytest.mark.parametrize("noise", [1.0, 0.1])
@pytest.mark.parametrize("seed", SEEDS)
def test_only_the_linearisation_is_between_the_two(seed, noise, lag):
    """x and P at every tick, with all that had arrived.

    The filter linearises the motion of a tick where the robot seemed to be then, the smoother where
    it seems by now to have been, or did when the tick left the lag. That is of second order: with a
    tenth of the noise a hundredth of the difference is left, so a tenth of its share of the
    standard deviation. What is of first order would keep its share: two measurements left out make
    half a standard deviation, at either noise. Measured, with GTSAM 4.3.0:

    | noise | position | heading | in standard deviations | P |
    |---|---|---|---|---|
    | 1 | 2.7e-4 m | 1.0e-4 rad | 0.028 | 1.9 % |
    | 0.1 | 3.1e-6 m | 1.0e-6 rad | 0.0031 | 0.21 % |

    A lag as long as the run makes it the batch MAP estimate, at 1.8e-4 m, 0.020 standard deviations
    and 1.2 % of P.
    """
    record = recorded(seed, noise)
    apart = record.apart(*smoothed(record, lag))
    assert max(apart.position / BOUND.position, apart.heading / BOUND.heading) < noise**2
    assert max(apart.deviations / BOUND.deviations, apart.covariance / BOUND.covariance) < noise


def smoothed(record, lag):
    """GTSAM's newest pose (N+1, 3) and its covariance (N+1, 3, 3), at every tick."""
    import gtsam

    config, robot = record.config, record.config.model
    smoother = exact_smoother(lag)
    factors = measured(0, config.initial_estimate, config.initial_covariance)
    pose = gtsam.Pose2(*config.initial_estimate)
    said = []
    for k, arrived in enumerate(record.arrivals):
        if k:
            way, noise = motion(robot, record.inputs[k - 1])
            factors = [gtsam.BetweenFactorPose2(k - 1, k, way, noise)]
            pose = pose.compose(way)
        for s, z in arrived.items():
            factors += measured(s, z, robot.R)
        advance(smoother, k, pose, factors)
        pose = smoother.calculateEstimatePose2(k)
        P = turned(smoother.marginalCovariance(k), pose.theta())
        said.append(((pose.x(), pose.y(), pose.theta()), P))
    return map(np.array, zip(*said, strict=True))


def exact_smoother(lag):
    """It leaves nothing out to save time."""
    import gtsam

    step = gtsam.ISAM2GaussNewtonParams()
    step.setWildfireThreshold(0.0)
    parameters = gtsam.ISAM2Params()
    parameters.setOptimizationParams(step)
    parameters.setFactorization("QR")
    parameters.setRelinearizeThreshold(1e-8)
    parameters.relinearizeSkip = 1
    return gtsam.IncrementalFixedLagSmoother(lag, parameters)


def advance(smoother, k, pose, factors):
    """To tick k, and on until the newest linearisation has settled."""
    import gtsam

    graph, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
    for factor in factors:
        graph.add(factor)
    values.insert(k, pose)
    smoother.update(graph, values, {k: float(k)})
    for _ in range(3):
        smoother.update()


def motion(robot, u):
    """g_k, and W Q W^T (32) as seen from its end, where GTSAM has the noise of a motion."""
    import gtsam

    along, turn = robot.sample_time * u
    W = robot.W(np.zeros(3))
    from_start = W @ robot.Q @ W.T + np.diag([0.0, SIDEWAYS**2, 0.0])
    noise = gtsam.noiseModel.Gaussian.Covariance(turned(from_start, -turn))
    return gtsam.Pose2(along, 0.0, turn), noise


def measured(s, z, R):
    """That x_s is z, position and heading each with its part of R, along the axes of the world.

    PriorFactorPose2 would compare in the frame of z, whose heading is noisy. That is another noise
    model, and makes seven times the difference in standard deviations.
    """
    import gtsam

    pose, covariance = gtsam.Pose2(*z), gtsam.noiseModel.Gaussian.Covariance
    return [
        gtsam.PoseTranslationPrior2D(s, pose, covariance(R[:2, :2])),
        gtsam.PoseRotationPrior2D(s, pose, covariance(R[2:, 2:])),
    ]


def turned(P, angle):
    """P of a pose in a frame that is turned: GTSAM has it in the robot's, laglab in the world's."""
    c, s = np.cos(angle), np.sin(angle)
    T = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return T @ P @ T.T
