"""The sides whose motions are compared with numbers from elsewhere, and how their motions are read between instants."""

from scipy.interpolate import CubicHermiteSpline

from reference.problem import Trajectory

EQUATIONS, SMOOTHED, ENGINE = "equations", "smoothed", "engine"  # smoothed: with the engine's friction law


def spline_along(motion: Trajectory, axis: int = 0) -> CubicHermiteSpline:
    """Position of the platform along x (0) or y (1), m: the cubics with its positions and velocities."""
    return CubicHermiteSpline(motion.time, motion.position[:, 0, axis], motion.velocity[:, 0, axis])
