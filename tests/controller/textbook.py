"""The extended Kalman filter of the robot as the textbooks write it."""

import numpy as np

from laglab_control import RobotModel

ROBOT = RobotModel()


def predict(x, P, u):
    A, W = ROBOT.A(x, u), ROBOT.W(x)
    return ROBOT.f(x, u), A @ P @ A.T + W @ ROBOT.Q @ W.T


def correct(x, P, z):
    K = P @ np.linalg.inv(P + ROBOT.R)
    return x + K @ ROBOT.innovation(z, x), (np.eye(3) - K) @ P


def ekf_in_order(x, P, inputs, measurements):
    """From tick 0 over all inputs; `measurements` of some ticks, each at its own."""
    for k in range(len(inputs) + 1):
        if k:
            x, P = predict(x, P, inputs[k - 1])
        if k in measurements:
            x, P = correct(x, P, measurements[k])
    return x, P
