"""
Measured settings: questions, each with a reference solution, and the settings of methods that answer them.

A reference solution is a run at a tolerance at least 100 times tighter than any setting that is compared with it.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from comparison.evidence.tradeoff.trade import StatedSetting
from comparison.study.models import EXACT, TRANSLATIONAL, V_REG_TEXT, Model, has_dry_friction, has_spatial_data
from comparison.study.user_models import engine_description
from reference.problem import Scene
from reference.problem.readings import DEFAULT_V_REG

REFERENCE, ENGINE = EXACT.amplification, TRANSLATIONAL.amplification  # import paths of the amplification functions
# Import paths of functions for a single run without error control: equations, Exudyn, Exudyn at constant steps
REFERENCE_RUN, ENGINE_LEVEL, CONSTANT_STEP_RUN = (
    f"comparison.evidence.tradeoff.single_runs:{name}"
    for name in ("run_reference_once", "run_engine_once", "run_at_constant_step")
)
SCIPY_FACTORS = "comparison.evidence.tradeoff.outside:solve_factors_by_scipy"  # import path: amplification by SciPy

REFERENCE_SOLUTION_TOLERANCE = 1e-10  # relative error of reference solutions by the equations: smallest allowed
SPATIAL_SOLUTION_TOLERANCE = 1e-5  # relative error asked of Exudyn's reference solution with bodies that rotate
# s, constant time steps that are measured, by name of Exudyn's integrator
STEPS_OF_INTEGRATOR = {
    "generalized alpha": (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4),
    "trapezoidal": (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4),
    "RK44": (4e-4, 2e-4, 1e-4),
    "velocity Verlet": (4e-4, 2e-4, 1e-4, 5e-5),
}
DRY_REGULARIZATIONS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)  # m/s, speeds v_reg below which dry friction is linear

# Name of the parameter for contact compliance: penetration under the weight / rho, the radius of the sliding path
PENETRATION_PARAMETER = "penetration under the weight, over rho"

Settings = Mapping[str, Any]  # keyword arguments of a function that computes the amplification


@dataclass(frozen=True)
class TradeoffQuestion:
    """Equations to solve, and their reference solution (function, arguments); points, quick: numbers of phase pairs."""

    key: str
    title: str
    reference_solution: tuple[str, Settings]
    points: int
    quick: int
    seconds: float  # s per phase pair, rough processor time of the reference solution


@dataclass(frozen=True)
class Setting(StatedSetting):
    """
    A method with one value of its varied parameter; its error and time are measured as one point of a plot.

    function: import path, called as (scene, phases, **settings). seconds: s per phase pair, rough processor time.
    against: reference solution if not the question's.
    """

    function: str
    settings: Settings
    seconds: float
    against: tuple[str, Settings] | None = None


# Keyword arguments of the reference equations, by key of the question (equations, friction law) that they solve
_LAWS: Mapping[str, Settings] = {
    "exact": {},
    "small": {"equations": "small"},
    "regularised": {"regularization": DEFAULT_V_REG},
}
# Keyword arguments of Exudyn for the reference solution with bodies that rotate
_SPATIAL = {"model": "spatial", "regularization": DEFAULT_V_REG, "tolerance": SPATIAL_SOLUTION_TOLERANCE}
# Function and keyword arguments of each question's reference solution, the most accurate solution of these equations
_REFERENCE_SOLUTIONS = {
    question: (REFERENCE, {**law, "tolerance": REFERENCE_SOLUTION_TOLERANCE}) for question, law in _LAWS.items()
}
# Equations to solve: key, title, reference solution, phase pairs (usual, --quick), s per phase pair of the solution
QUESTIONS = (
    TradeoffQuestion("exact", "exact equations, supremum", _REFERENCE_SOLUTIONS["exact"], 48, 12, 0.006),
    TradeoffQuestion("small", "small equations, supremum", _REFERENCE_SOLUTIONS["small"], 48, 12, 0.006),
    TradeoffQuestion(
        "regularised", f"exact equations, v_reg = {V_REG_TEXT}", _REFERENCE_SOLUTIONS["regularised"], 12, 3, 0.01
    ),
    TradeoffQuestion("spatial", f"spatial engine model, v_reg = {V_REG_TEXT}", (ENGINE, _SPATIAL), 6, 2, 3.0),
)


def list_questions(scene: Scene) -> list[TradeoffQuestion]:
    """Return the questions (each: equations to solve, with friction law) for which a scene has the data."""
    return [question for question in QUESTIONS if question.key != "spatial" or has_spatial_data(scene)]


def list_settings(scene: Scene, quick: bool = False) -> list[Setting]:
    """Return methods with parameter values to measure for a scene; quick: fewer values of parameters that take long."""
    keys = {question.key for question in list_questions(scene)}
    every = [
        *_reference_settings(scene),
        *_scipy_settings(quick),
        *_engine_settings(quick),
        *_constant_step_settings(quick),
    ]
    return [setting for setting in every if setting.question in keys]


class _VariedCall(NamedTuple):
    """Function (import path), argument varied along a curve of error over time, and its other keyword arguments."""

    function: str
    argument: str
    others: Settings


def _make_curve_settings(
    question: str, method: str, parameter: str, call: _VariedCall, values: Sequence[float],
    seconds: float | Sequence[float], **stated: Any,
) -> list[Setting]:  # fmt: skip
    """
    Return the settings of one method, one for each of `values` of the varied argument of its function `call`.

    question, method, parameter: as `StatedSetting` has them. seconds: s, per point, of each or of all. stated: other
    fields of `Setting`, as `unit` or `against`, by name.
    """
    fields = {"unit": "", "controlled": False, "model_error": False, **stated}
    return [
        Setting(
            question=question, method=method, parameter=parameter, value=value, function=call.function,
            settings={**call.others, call.argument: value}, seconds=time, **fields,
        )
        for value, time in zip(values, np.broadcast_to(seconds, len(values)).tolist())
    ]  # fmt: skip


def _reference_settings(scene: Scene) -> Iterator[Setting]:
    """Yield methods by the equations: error-controlled; single runs; regularized friction, compared with rigid."""
    powers = [10.0**-power for power in range(1, 9)]
    for question, law in _LAWS.items():
        controlled, single = _VariedCall(REFERENCE, "tolerance", law), _VariedCall(REFERENCE_RUN, "step_tolerance", law)
        method = "reference, two runs and an estimate"
        yield from _make_curve_settings(
            question, method, "tolerance of mu", controlled, powers[1:], 0.003, controlled=True
        )
        yield from _make_curve_settings(
            question, "reference, one run", "tolerance inside a step", single, powers, 0.0015
        )
    call = _VariedCall(REFERENCE, "regularization", {"tolerance": 1e-6})
    for speed in DRY_REGULARIZATIONS if has_dry_friction(scene) else ():
        faster = REFERENCE, {"cutoff": speed, "tolerance": REFERENCE_SOLUTION_TOLERANCE}
        for what, against in (("supremum", None), ("peak faster than v_reg", faster)):
            method = f"v_reg, model error against the {what}"
            yield from _make_curve_settings(
                "exact", method, "v_reg", call, [speed], 0.004, unit="m/s", model_error=True, against=against
            )


def _scipy_settings(quick: bool) -> Iterator[Setting]:
    """Yield settings of SciPy's general-purpose integrators on the equations with regularized friction."""
    lsoda, others = ((4, 10), (4, 8)) if quick else ((3, 4, 6, 8, 10), (3, 4, 6, 8))
    # LSODA goes to tighter tolerances because its finest run checks the reference solution.
    for method, powers, seconds in (("LSODA", lsoda, 0.15), ("Radau", others, 1.0), ("DOP853", others, 1.0)):
        call = _VariedCall(SCIPY_FACTORS, "tolerance", {"method": method, "v_reg": DEFAULT_V_REG})
        values = [10.0**-power for power in powers]
        yield from _make_curve_settings(
            "regularised", f"SciPy {method}", "relative tolerance of a step", call, values, seconds
        )


def _engine_settings(quick: bool) -> Iterator[Setting]:
    """Yield settings of Exudyn: runs with error control, then single runs in which one parameter is changed."""
    parameters = (
        ("step", "largest step over the usual one", "step", (8.0, 4.0, 2.0, 1.0, 0.5, 0.25)),
        ("contact compliance", PENETRATION_PARAMETER, "penetration", (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)),
        ("Newton", "relative tolerance of Newton's iteration", "newton", (1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8)),
    )
    for question, model, tolerances, dearer in (
        ("regularised", "translational", {1e-2: 0.35, 1e-3: 0.35, 1e-4: 1.0, 1e-5: 1.8}, 1.0),
        ("spatial", "spatial", {1e-2: 0.35, 1e-3: 0.35}, 1.7),
    ):
        law, method = {"model": model, "regularization": DEFAULT_V_REG}, f"{model} engine, two levels and an estimate"
        seconds = [dearer * each for each in tolerances.values()]
        controlled = _VariedCall(ENGINE, "tolerance", law)
        yield from _make_curve_settings(
            question, method, "tolerance of mu", controlled, list(tolerances), seconds, controlled=True
        )
        for name, parameter, key, values in parameters:
            method, few = f"{model} engine, one run: {name}", values[:: 3 if quick else 1]
            call = _VariedCall(ENGINE_LEVEL, key, law)
            yield from _make_curve_settings(question, method, parameter, call, few, 0.25 * dearer)


def _constant_step_settings(quick: bool) -> Iterator[Setting]:
    """Yield settings of Exudyn's own time integrators at constant time steps."""
    for solver, steps in STEPS_OF_INTEGRATOR.items():
        call = _VariedCall(CONSTANT_STEP_RUN, "step", {"solver": solver, "v_reg": DEFAULT_V_REG})
        few = steps[:: 2 if quick else 1]
        seconds = [0.25e-3 / step for step in few]
        yield from _make_curve_settings(
            "regularised", f"Exudyn, {solver}", "constant step", call, few, seconds, unit="s"
        )


def list_user_settings(models: Sequence[Model]) -> list[Setting]:
    """Return settings of users' engines: one for each of several tolerances, or one if the engine takes none."""
    measured = []
    for model in models:
        law = {key: value for key, value in model.settings.items() if key != "engine"}
        question, against = str(model.like), None
        if question not in {each.key for each in QUESTIONS}:
            question, against = "exact", (REFERENCE, {**law, "tolerance": REFERENCE_SOLUTION_TOLERANCE})
        parameter, values = "as it is, beside a tolerance of", [1e-3]
        if "tolerance" in engine_description(model.settings).get("names", ""):
            parameter, values = "tolerance of mu", [1e-2, 1e-3, 1e-4, 1e-5]
        call = _VariedCall(model.amplification, "tolerance", model.settings)
        measured += _make_curve_settings(
            question, f"user model: {model.title}", parameter, call, values, 1.0, against=against
        )
    return measured
