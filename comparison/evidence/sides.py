"""The sides whose motions are compared with numbers from elsewhere, and how their motions are read between instants."""

from scipy.interpolate import CubicHermiteSpline

from reference.problem import Trajectory

# Keys of the codes that are compared (sides); smoothed: equations with the engine's regularized friction law
EQUATIONS, SMOOTHED, ENGINE = "equations", "smoothed", "engine"


def interpolate_platform(motion: Trajectory, axis: int = 0) -> CubicHermiteSpline:
    """Return the position of the platform along x (0) or y (1), m, as cubics through its positions and velocities."""
    return CubicHermiteSpline(motion.time, motion.position[:, 0, axis], motion.velocity[:, 0, axis])
