"""Estimate again from the log of a session: `python from_a_log.py robot.tlog`.

The log may come from `laglab run`, or from a real robot that speaks the dialect.
"""

import sys
from pathlib import Path

import numpy as np

from laglab_control import StationConfig
from laglab_station import read_session, shadow


def main(path):
    """What each filter says at the end, and how sure it is of it, printed."""
    session = list(read_session(path))
    first = next(message for heard in session for message in heard.measurements)
    for name in ("ekf", "popf", "delayed-ekf"):
        config = StationConfig(
            estimator=name, initial_estimate=first.pose, initial_covariance=np.eye(3) * 1e-3
        )
        *_, last = shadow(config, session)
        x, y, theta = last.x
        deviations = np.sqrt(np.diag(last.P))
        print(f"{name:12} x {x:+.3f} m, y {y:+.3f} m, theta {theta:+.3f} rad  +- {deviations}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
