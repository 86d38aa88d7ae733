"""Demands at all phase pairs of a surface by the paper's equations."""

from __future__ import annotations

from numpy.typing import ArrayLike

from reference.defaults import DEFAULT_TOLERANCE
from reference.measures import PeakDemands
from reference.measures.peak_demands import demands_of_motions
from reference.motion import trajectory
from reference.problem import Scene, Trajectory
from reference.problem.scene import require_scene
from reference.surface import prepare_run


@require_scene
def peak_demands(
    scene: Scene,
    phases: ArrayLike,
    equations: str = "exact",
    regularization: float | None = None,
    tolerance: float = DEFAULT_TOLERANCE,
    rest_condition: str = "consistent",
) -> PeakDemands:
    """
    Return the demands on isolator and structure at every pair of initial phases of the loading, with errors.

    Parameters
    ----------
    scene : Scene
    phases : array_like, (..., 2), rad
        Initial phases of the loading, in any shape; under a record they have no effect.
    equations, regularization, tolerance, rest_condition
        As in `trajectory`.

    Returns
    -------
    PeakDemands
        The fields of `Demands` for all pairs. A pair without an answer is NaN; its status says why.

    Raises
    ------
    ValueError
        For an argument outside its range (`reference.problem.ranges`), in one line.

    Notes
    -----
    Every motion goes to its end, since a demand may reach its largest value later than the accelerations. So a pair
    takes about thirty times as long as with `amplification`.

    Examples
    --------
    >>> import reference
    >>> demands = reference.peak_demands(reference.load_scene("fig3-I"), [(0.3, 1.1), (2.0, 0.7)])
    >>> demands["drift"].value.shape, bool((demands["base_shear"].error < 1e-2).all())
    ((2, 1), True)
    """
    prepare_run(scene, equations, regularization, tolerance, None, rest_condition)

    def compute_trajectory(phase: ArrayLike) -> Trajectory:
        """Return the motion at one pair of initial phases of the loading."""
        return trajectory(scene, phase, equations, regularization, tolerance, rest_condition)

    return demands_of_motions(scene, phases, compute_trajectory)
