"""
Scaling test: how the step from small to exact equations falls when loading and friction scale down together.

If loading and dry friction are multiplied by s, and the rate at which friction changes with the speed by 1/s, then the
motion is multiplied by s. The geometry that the small equations drop is of the order of the motion's square. So the
relative difference between the two equations, called the step, must fall like s^2, or geometry is not its cause. The
viscous friction coefficient f_c |v| scales by itself. The printed small equations are not quite invariant either: their
friction terms with xi'' x_1 / rho shrink like s^2 too, which the second trend shows.
"""

from typing import Any

import numpy as np

import reference
from comparison.evidence.trends import NO_VALUES, Trend, fit_trend
from comparison.result_types import Array
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task import TaskResult
from comparison.study.models import has_dry_friction
from comparison.study.study import Study
from reference.problem import Scene
from reference.problem.readings import DEFAULT_V_C

LOADING_SCALES = (1.0, 0.5, 0.25, 0.125)  # factors s by which loading and dry friction are multiplied
SCALING_PHASES = np.array([(0.3, 1.1), (1.0, 3.0), (2.0, 0.7), (4.0, 5.5)])  # rad, phase pairs computed at each scale
# relative error asked of the amplification, which by exact and small-vibration equations differs by 1e-5 or more
SCALING_TOLERANCE = 1e-8
# name of the difference of amplification between exact and small-vibration equations
EXACT_MINUS_SMALL = "exact minus small"
# name of the change of amplification by the small-vibration equations when loading and friction are halved
SMALL_SCALE_DIFFERENCE = "small, s minus s/2"

# A scene, and whether its peaks count at any sliding speed (`supremum`) or only at rest and above s * 1 mm/s
Arguments = tuple[Scene, bool]


def scale_scene(scene: Scene, s: float) -> Scene:
    """
    Return the scene whose motion is s times as large: loading, dry friction and travel limit are multiplied by s.

    The rate at which friction changes with the sliding speed is divided by s.
    """
    values: dict[str, Any] = {"excitation.scale": s * (scene.excitation.scale or 1.0)}
    law = scene.dry_friction
    if not law.constant or law.elastic:
        table = {"slow": s * law.slow} | ({"load_exponent": law.exponent} if law.exponent else {})
        table |= {"initial_stiffness": law.stiffness} if law.elastic else {}
        values["isolator.friction"] = table | ({"fast": s * law.fast, "rate": law.rate / s} if law.varies else {})
    elif not scene.lubricated:
        values["isolator.friction"] = s * scene.friction_coefficient
    if scene.isolator.travel is not None:
        values["isolator.travel"] = s * scene.isolator.travel
    return scene.with_values(values)


def fit_scene_trends(task: Arguments) -> list[Trend]:
    """
    Fit power laws in s to two relative changes of each body's amplification. Runs inside a worker process.

    The first is from the small to the exact equations at each s, the second is by the small equations from s/2 to s.
    """
    scene, supremum = task
    answers = [_solve_both_equations(scale_scene(scene, s), supremum, s) for s in LOADING_SCALES]
    mu, error = (np.array([answer[part] for answer in answers]) for part in (0, 1))  # (scale, equations, phases, body)
    (small, exact), (small_error, exact_error) = np.moveaxis(mu, 1, 0), np.moveaxis(error, 1, 0)
    step, step_error = exact / small - 1.0, np.hypot(exact_error, small_error) / small
    halving = small[:-1] / small[1:] - 1.0
    halving_error = np.hypot(small_error[:-1], small_error[1:]) / small[1:]
    name = _name_peak(scene, supremum)
    return [
        fit_trend(
            scene.name,
            body + 1,
            f"{what}, {name}",
            LOADING_SCALES[: len(size)],
            size[..., body].T,
            error[..., body].T,
            2.0,
        )
        for body in range(len(scene.bodies))
        for what, size, error in (
            (EXACT_MINUS_SMALL, step, step_error),
            (SMALL_SCALE_DIFFERENCE, halving, halving_error),
        )
    ]


def _solve_both_equations(scene: Scene, supremum: bool, s: float) -> tuple[Array, Array]:
    """Return amplification and error; axes of each: equations (small, exact), phase pair, body."""
    cutoff = None if supremum else DEFAULT_V_C * s  # m/s, peaks at slower sliding do not count; scales with the motion
    answers = [
        reference.amplification(scene, SCALING_PHASES, equations=equations, tolerance=SCALING_TOLERANCE, cutoff=cutoff)
        for equations in ("small", "exact")
    ]
    return np.array([answer.mu for answer in answers]), np.array([answer.error for answer in answers])


def _without_value(task: Arguments, failed: TaskResult) -> list[Trend]:
    """Return one trend for each body, without values and with the reason why the task failed."""
    scene, supremum = task
    what = f"{EXACT_MINUS_SMALL}, {_name_peak(scene, supremum)}"
    bodies = range(1, len(scene.bodies) + 1)
    return [
        fit_trend(scene.name, body, what, LOADING_SCALES, NO_VALUES, NO_VALUES, 2.0, failed.reason) for body in bodies
    ]


def _name_peak(scene: Scene, supremum: bool) -> str:
    """Return in words which peak acceleration enters the amplification: "supremum", "resolved peak" or "peak"."""
    return "peak" if not has_dry_friction(scene) else "supremum" if supremum else "resolved peak"


class Scaling(MappedAnalysis[list[Trend]]):
    """Analysis of how the step from small to exact equations falls as loading and friction become smaller."""

    key, stage, level = "scaling", "scaling test", 2
    seconds = 0.1
    function, without_value = staticmethod(fit_scene_trends), staticmethod(_without_value)

    def task_arguments(self, study: Study, surfaces: Any = None) -> list[Arguments]:
        """
        Return each scene under harmonics with each definition of the peak that makes a difference in it.

        Scenes with heated friction are left out, because heat does not scale with the motion.
        """
        scenes = [scene for scene in study.phased if scene.dry_friction.heat is None]
        return [
            (scene, supremum) for scene in scenes for supremum in ([True, False] if has_dry_friction(scene) else [True])
        ]
