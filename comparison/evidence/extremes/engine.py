"""
The engine at a contact stiffness or a largest step that the caller states.

The engine computes a motion at several levels of accuracy, each with a smaller step and a stiffer contact, until two
agree. In a study it chooses both by itself. Here its levels start at the given step or stiffness, which shows whether
the error estimate covers a bad choice, and whether the levels find the way from it to an answer.
"""

import math
from dataclasses import replace

from numpy.typing import ArrayLike

import multibody
from reference.problem import GRAVITY, Amplification, Scene
from reference.problem.readings import DEFAULT_V_REG

MAX_LEVELS = 6  # largest number of accuracy levels tried in turn: more take long and do not change the answer
LEVELS_TO_USUAL_CONTACT = 3  # accuracy levels from the stated contact stiffness to the usual one, by equal factors
LEVEL_STEP_RATIO = 4  # largest time step of an accuracy level / that of the next finer level


def amplification(
    scene: Scene,
    phases: ArrayLike,
    model: str = "translational",
    regularization: float | None = DEFAULT_V_REG,
    tolerance: float = 1e-2,
    contact_stiffness: float | None = None,
    step: float | None = None,
    max_work: float = multibody.MAX_WORK,
) -> Amplification:
    """
    Return Exudyn's amplification by accuracy levels that begin at a stated contact stiffness, N/m, or largest step, s.

    max_work: largest number of Exudyn's steps per phase pair. Other arguments: as of `multibody.amplification`.
    """
    levels = multibody.levels(scene, model, tolerance, regularization)[:MAX_LEVELS]
    if contact_stiffness is not None:
        first = scene.total_mass * GRAVITY / (contact_stiffness * scene.radius)
        for number, level in enumerate(levels):  # interpolate from the stated stiffness to that usual at this level
            share = min(number / LEVELS_TO_USUAL_CONTACT, 1.0)
            levels[number] = replace(level, penetration=first ** (1.0 - share) * level.penetration**share)
    if step is not None:  # multiply the largest step by `factor`; keep the smallest
        factor = step / math.sqrt(scene.radius / GRAVITY) / levels[0].step
        more_divisions = math.ceil(math.log(factor, LEVEL_STEP_RATIO))  # as many as keep the smallest step
        error_growth = max(factor, 1.0) ** 2  # The error of a level is of second order in the step.
        for number, level in enumerate(levels):
            changed = replace(level, step=level.step * factor, error_floor=level.error_floor * error_growth)
            levels[number] = replace(changed, max_divisions=max(level.max_divisions + more_divisions, 0))
    return multibody.amplification(
        scene, phases, model, regularization, tolerance, full=True, levels=levels, max_work=max_work
    )
