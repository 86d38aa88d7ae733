"""The sides whose motions are compared with numbers from elsewhere, and how their motions are read between instants."""

from scipy.interpolate import CubicHermiteSpline

from reference.problem import Trajectory

# Keys of motions to compare: of the reference equations, of these with Exudyn's regularized friction, of Exudyn
EQUATIONS, SMOOTHED, ENGINE = "equations", "smoothed", "engine"


def interpolate_platform(motion: Trajectory, axis: int = 0) -> CubicHermiteSpline:
    """Return the platform's position along x (axis 0) or y (1), m, as a cubic function of time between instants."""
    return CubicHermiteSpline(motion.time, motion.position[:, 0, axis], motion.velocity[:, 0, axis])
