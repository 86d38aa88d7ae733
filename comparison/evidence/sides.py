"""The sides whose motions are compared with numbers from elsewhere, and how their motions are read between instants."""

from scipy.interpolate import CubicHermiteSpline

from reference.problem import Trajectory

# Keys of the codes whose motions are compared: reference equations; the same with Exudyn's regularized friction; Exudyn
EQUATIONS, SMOOTHED, ENGINE = "equations", "smoothed", "engine"


def interpolate_platform(motion: Trajectory, axis: int = 0) -> CubicHermiteSpline:
    """Return a function of time, s: platform position along x (axis 0) or y (1), m, as cubics between instants."""
    return CubicHermiteSpline(motion.time, motion.position[:, 0, axis], motion.velocity[:, 0, axis])
