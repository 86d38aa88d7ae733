"""Peak demands on isolator and structure at every phase pair, by the engine."""

from __future__ import annotations

from numpy.typing import ArrayLike

from multibody.defaults import DEFAULT_TOLERANCE, DEFAULT_V_REG
from multibody.integration.refine import MAX_WORK
from multibody.motion import trajectory
from reference.measures import PeakDemands
from reference.measures.peak_demands import demands_of_motions
from reference.problem import Scene, Trajectory
from reference.problem.scene import require_scene


@require_scene
def peak_demands(
    scene: Scene,
    phases: ArrayLike,
    model: str = "translational",
    regularization: float | None = DEFAULT_V_REG,
    tolerance: float = DEFAULT_TOLERANCE,
    max_work: float = MAX_WORK,
) -> PeakDemands:
    """
    Compute the peak demands on isolator and structure of the motion at every phase pair, with errors.

    Parameters
    ----------
    scene : Scene
    phases : array_like, (..., 2), rad
        Initial phases of the loading, in any shape; under a record they have no effect.
    model, regularization, tolerance, max_work
        As in `trajectory`.

    Returns
    -------
    PeakDemands
        The fields of `Demands` for all pairs; support forces and uplift only of the spatial model. A pair without an
        answer is NaN; its status says why.

    Raises
    ------
    ValueError
        For wrong arguments.

    Notes
    -----
    Every motion goes to its end and the model is never reduced: demands may settle later than accelerations.

    Examples
    --------
    >>> import multibody, reference
    >>> scene = reference.load_scene("fig3-I").with_values({"duration": 1.0})
    >>> multibody.peak_demands(scene, [(0.3, 1.1)])["displacement"].value.shape
    (1,)
    """

    def compute_motion(phase: ArrayLike) -> Trajectory:
        """Return the motion of one phase pair."""
        return trajectory(scene, phase, model, regularization, tolerance, max_work=max_work)

    return demands_of_motions(scene, phases, compute_motion)
