"""
Errata in the printed text: what is printed, what it should be, why, and what the printed form does to mu_i.

The effect is measured on a few phase pairs of every scene to which it applies, over the first seconds of the motion,
in which the loading is strongest: mu_i with the erratum over mu_i without it, minus one.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Annotated, Any

import numpy as np
import xarray as xr

import reference
from comparison.analyses.errata.printed_matrices import WRONG_DAMPING, WRONG_SPRING, printed_amplification
from comparison.analyses.mapped import MappedAnalysis
from comparison.result_types import Array, Number, Text, result
from comparison.runner.task_results import TaskResults
from comparison.study.models import DEFAULT_V_REG, any_scene
from comparison.study.study import Study
from reference.problem import Scene

PHASES = np.array([(0.3, 1.1), (4.0, 5.5)])  # rad
DURATION = 6.0  # s

RIGID_PERIOD = 1e-3  # s, of half of the platform on its other half, critically damped; moves exact mu_i by 1e-4

Mu = Callable[[Scene], Array]  # mu (M, N), NaN where the printed form has no answer


def _mu(scene: Scene, **settings: Any) -> Array:
    return reference.amplification(scene, PHASES, **settings).mu


def _softened(scene: Scene) -> Array:
    """Every link 144 times softer: 12 n E J / l^3 read as n E J / (12 l^3)."""
    softer: dict[str, Any] = {}
    for number, link in enumerate(scene.stiffness, start=1):
        softer |= {f"bodies.{number}.{key}": None for key in ("period", "bars")}
        softer |= {f"bodies.{number}.stiffness": link / 144.0}
    return _mu(scene.with_values(softer))


def _two_springs(scene: Scene) -> bool:
    """Whether the lowest link differs along x and y; the printed matrices have no plane and no normal force."""
    differ = len(scene.bodies) > 1 and scene.stiffness[0, 0] != scene.stiffness[0, 1]
    return differ and not scene.flat and not scene.dry_friction.by_load


def _moving(scene: Scene) -> bool:
    return not scene.lubricated


def cut_platform(scene: Scene) -> Scene:
    """The scene with its platform cut in two halves: a link between them that is rigid but for RIGID_PERIOD."""
    half = 0.5 * float(scene.masses[0])
    stiffness = half * (2.0 * np.pi / RIGID_PERIOD) ** 2
    rigid = {"mass": half, "stiffness": [stiffness] * 2, "damping": [np.sqrt(2.0 * stiffness * half)] * 2}
    above = [
        {"mass": float(mass), "stiffness": spring.tolist(), **({"damping": damper.tolist()} if damper.any() else {})}
        for mass, spring, damper in zip(scene.masses[1:], scene.stiffness, scene.damping)
    ]
    return scene.with_values({"bodies": [{"mass": half}, rigid, *above], "measured": None})


def _cut(scene: Scene, **settings: Any) -> Array:
    """mu with the platform cut: of the platform that of its lower half."""
    return np.delete(_mu(cut_platform(scene), **settings), 1, axis=1)


def _small(scene: Scene) -> dict[str, Any]:
    """Small equations with regularized friction, which keeps the one-sided limits at stops out."""
    return {"equations": "small", "regularization": None if scene.lubricated else DEFAULT_V_REG}


@result
class Effect:
    """What the printed form of an erratum does to mu in one scene."""

    scene: Annotated[Text, "name of the scene"]
    erratum: Annotated[int, "number of the erratum, from 0"]
    change: tuple[tuple[Number, ...], ...] = ()
    """relative change of mu by phase pair and body; null where the printed form has no answer; empty if untouched"""
    error_message: Annotated[Text, "what went wrong, or empty"] = ""


@result
class MeasuredErratum:
    """One erratum of the print."""

    where: Annotated[str, "place in the paper"]
    printed: Annotated[str, "what is printed"]
    corrected: Annotated[str, "what it should be"]
    why: Annotated[str, "reason"]
    none: Annotated[str, "why it has no measurable effect, or empty"] = ""
    effects: Annotated[tuple[Effect, ...], "one per scene with phases"] = ()


_NAME = "a name or an index; no number depends on it"
ERRATA = (
    MeasuredErratum(
        "after (2.3)",
        "k = n E J / (12 l^3)",
        "k = 12 n E J / l^3",
        "a bar clamped at both ends yields F l^3 / (12 E J) to a lateral force F; printed, links are 144 times softer",
    ),
    MeasuredErratum(
        "after (2.5)",
        "F_F = -2 lambda_1 sign(lambda_1) rho tau",
        "F_F = -2 mu lambda_1 sign(lambda_1) rho tau",
        "(2.5) makes the printed force the whole normal force; (3.2) has the factor mu",
    ),
    MeasuredErratum(
        "(3.1)", "dPhi_1/dz_i = -1", "dPhi_i/dz_1 = -1", "Phi_i = z_i - z_1, and Phi_1 does not know z_i", _NAME
    ),
    MeasuredErratum(
        "(3.11)-(3.13)",
        "w and zeta in the brackets",
        "W of (3.5) and zeta''",
        "(3.6)-(3.7) carry W - zeta'' - g; a displacement cannot be added to accelerations",
        "w is not defined, and zeta = zeta'' = 0 in the paper's scenes",
    ),
    MeasuredErratum(
        "(3.12)",
        "c_24 = -k^x_21 Delta",
        "c_24 = -k^y_21 Delta",
        "(3.7) has the spring of y; printed, the springs of y do work in every cycle unless T_3x = T_3y",
    ),
    MeasuredErratum(
        "(3.12)", "c_1e = 0 for e = 4 ... N, c_2e = 0 for e = 5 ... N", "up to 2 N", "q has 2 N components (3.9)", _NAME
    ),
    MeasuredErratum(
        "(3.15)",
        "h_12, h_21 without rho; h_22 with xi'' Q; h_21 called h_11",
        "factor rho; eta'' Q; its own name",
        "mu = f_c v put into (3.11); the same mu = f_c v also enters M (3.10) and E (3.13)",
    ),
    MeasuredErratum(
        "(4.3)",
        "friction terms xi'' x_1 / rho and eta'' y_1 / rho without x_1'' x_1 / rho and k (x_2 - x_1) x_1 / rho",
        "all terms of this order, or none",
        "the terms kept grow with m_1 alone: a platform cut in two by a rigid link is the same platform, and (4.3) "
        "alone moves it differently; the exact equations with regularized friction do not",
    ),
    MeasuredErratum(
        "(4.6)",
        "components of F_F are mu N each; F_3 has minus signs before g x_1 / rho and k (x_1 - x_2)",
        "|F_F| = mu N in every direction; F_3 = -(xi'' + (m_sum / m_1)(zeta'' + g) x_1 / rho + (k / m_1)(x_1 - x_2))",
        "printed, |F_F| is sqrt(2) mu N at the origin, and a displaced platform is pushed away; (4.3) at rest",
    ),
    MeasuredErratum(
        "after (4.7)",
        "motion along x + beta y = 0",
        "along x - beta y = 0",
        "v_i = x_i - beta y_i = 0 is the solution (4.7)",
        "a statement about the motion; the motion itself stays in the plane x = beta y",
    ),
    MeasuredErratum(
        "(5.1)",
        "the maximum of the platform's acceleration",
        "its resolved peak, or the peak with regularized friction",
        "under Coulomb friction the maximum is a one-sided limit at a stop, which depends on how mass is lumped: cut "
        "in two by a rigid link, the same platform has another one",
    ),
    MeasuredErratum("section 5", "solution (5.7)", "solution (4.7)", "there is no (5.7)", _NAME),
)
_printed, _rest = partial(printed_amplification, phases=PHASES), partial(_mu, equations="small")
# by number of the erratum, from 0: to which scenes it applies, mu as printed, and mu without it
MEASURES: dict[int, tuple[Callable[[Scene], bool], Mu, Mu]] = {
    0: (any_scene, _softened, _mu),
    1: (_moving, lambda scene: _mu(scene.with_values({"isolator.friction": 1.0})), _mu),
    4: (_two_springs, partial(_printed, errata=[WRONG_SPRING]), _printed),
    # (3.9) is multiplied by Delta, which is infinite on a plane
    6: (lambda scene: scene.lubricated and not scene.flat, partial(_printed, errata=[WRONG_DAMPING]), _printed),
    7: (any_scene, lambda scene: _cut(scene, **_small(scene)), lambda scene: _mu(scene, **_small(scene))),
    8: (_moving, partial(_rest, rest_condition="printed"), partial(_rest, rest_condition="consistent")),
    10: (_moving, _cut, _mu),
}


def measured(task: tuple[Scene, int]) -> Effect:
    """The effect of one erratum in one scene."""
    scene, number = task
    short = scene.with_values({"duration": min(scene.duration, DURATION)})
    applies, printed, mended = MEASURES[number]
    try:
        change = printed(short) / mended(short) - 1.0 if applies(short) else np.empty((0, 0))
    except Exception as error:
        return Effect(scene.name, number, error_message=f"{type(error).__name__}: {error}")
    return Effect(scene.name, number, tuple(tuple(map(float, row)) for row in change))


class Errata(MappedAnalysis[list[MeasuredErratum]]):
    """Every erratum, measured in every scene where it can be."""

    key, stage, level = "errata", "errata", 2
    function = staticmethod(measured)
    without_value = staticmethod(lambda task, failed: Effect(task[0].name, task[1], error_message=failed.reason))

    def arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> list[tuple[Scene, int]]:
        """Every scene with phases, with the number of every erratum that is measured."""
        return [(scene, number) for scene in study.phased for number in MEASURES]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> list[MeasuredErratum]:
        """Every erratum with its effects, in the order of the paper."""
        return with_effects(self.values(study, surfaces, results))


def with_effects(effects: Sequence[Effect]) -> list[MeasuredErratum]:
    """Every erratum with its effects."""
    return [
        replace(erratum, effects=tuple(effect for effect in effects if effect.erratum == number))
        for number, erratum in enumerate(ERRATA)
    ]
