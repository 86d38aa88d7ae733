"""Refusal of a scene whose work exceeds the limit, before any step is taken, and changes that would help."""

from __future__ import annotations

import math
from collections.abc import Callable

from multibody.defaults import DEFAULT_TOLERANCE, DEFAULT_V_REG
from multibody.integration.constant_step import silence_engine
from multibody.integration.engine_run import Budget
from multibody.integration.level import plan_levels
from multibody.integration.level_runs import MAX_WORK_GROWTH
from multibody.integration.look_ahead import level_of_longest_steps
from multibody.integration.refine import MAX_WORK, WORK_RANGE
from multibody.integration.time_scales import STEPS_PER_PERIOD
from multibody.models.assembly import assemble, choose_model
from reference.problem import Scene, SceneError
from reference.problem.ranges import TOLERANCE_RANGE
from reference.problem.scene import require_scene
from reference.support.arguments import check_number

# Number of steps for one motion (levels 0 and 1, and a run on a softer contact) over that of level 0 if all its steps
# were the largest. Smaller steps at stops double the number of steps.
WORK_PER_MOTION_OVER_COARSEST_RUN = 2.0 * (1.0 + 2.0 * MAX_WORK_GROWTH)


@require_scene
def refusal(
    scene: Scene,
    model: str = "translational",
    regularization: float | None = DEFAULT_V_REG,
    tolerance: float = DEFAULT_TOLERANCE,
    full: bool = False,
    max_work: float = MAX_WORK,
    softened: bool = False,
) -> str:
    """
    Predict whether `amplification` refuses every phase pair of a scene, because of its work or of bars that buckle.

    Parameters
    ----------
    scene, model, regularization, tolerance, full, max_work, softened
        As in `amplification`.

    Returns
    -------
    str
        One line with the work that is needed, what makes it, and the duration that is expected to have values; or
        with the load of bars that buckle.
        Empty if the model is tried. A model that is tried may still run out of work on the way.

    Raises
    ------
    ValueError
        For wrong arguments, as in `amplification`.

    Examples
    --------
    >>> import multibody, reference
    >>> multibody.refusal(reference.load_scene("fig3-I"))
    ''
    """
    tolerance = check_number("tolerance", tolerance, TOLERANCE_RANGE)
    max_work = check_number("max_work", max_work, WORK_RANGE)
    if softened:
        try:
            scene = scene.softened()
        except SceneError as error:
            return f"refused before any step: {error}"
    with silence_engine():
        built = assemble(scene, choose_model(scene, model, full), regularization)
    first = plan_levels(scene, built, tolerance)[0]
    longest = level_of_longest_steps(built, first, full)
    if Budget(max_work).has_work_left_for(scene.duration / built.units.time, longest):
        return ""
    first_step, step = (level.step * built.units.time for level in (first, longest))
    needed, work = scene.duration / step, WORK_PER_MOTION_OVER_COARSEST_RUN * scene.duration / first_step
    # the extra coarse level before level 0, if there is one, has steps twice as long as those of level 0
    period = STEPS_PER_PERIOD * first_step / (1 + first.precedes_level_0)
    looser_helps = scene.recorded and not first.precedes_level_0
    tried, enough = max_work * step, max_work * first_step / WORK_PER_MOTION_OVER_COARSEST_RUN
    return (
        f"refused before any step: it needs {needed:.2g} steps of the engine or more, and a phase pair may take "
        f"{max_work:.2g} ({built.coordinates} coordinates in steps of {step:.2g} s over {scene.duration:g} s; the "
        f"fastest period is {period:.2g} s). Allow more work (max_work or "
        f"--max-work, about {_round_digits(work, math.ceil):g} steps), shorten the duration to about "
        f"{_round_digits(enough, math.floor):g} s (above {_round_digits(tried, math.ceil):g} s no step is taken), "
        f"or take a longer period; a looser tolerance {'may help' if looser_helps else 'does not help'}"
    )


def _round_digits(value: float, rounded: Callable[[float], int]) -> float:
    """Return a positive number rounded to two digits by `rounded`, which is `math.floor` or `math.ceil`."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{rounded(value / unit) * unit:.2g}")
