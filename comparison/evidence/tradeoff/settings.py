"""
Measured settings: questions, each with a reference solution, and the settings of methods that answer them.

A question is a set of equations with a law of friction, whose amplification is sought. A setting is a method with one
value of the parameter that varies along its curve of error over time. A reference solution is a run at a tolerance at
least 100 times tighter than any setting that is compared with it.
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
    """Equations to solve, with their reference solution."""

    key: str
    title: str
    reference_solution: tuple[str, Settings]  # import path of a function, and its keyword arguments
    points: int  # number of phase pairs
    quick: int  # number of phase pairs with --quick
    seconds: float  # s per phase pair, rough processor time of the reference solution


@dataclass(frozen=True)
class Setting(StatedSetting):
    """A method with one value of its varied parameter; its error and time are measured as one point of a plot."""

    function: str  # import path of a function, called as (scene, phases, **settings)
    settings: Settings
    seconds: float  # s per phase pair, rough processor time
    # Reference solution (function, keyword arguments) of this setting alone; None: that of the question
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
QUESTIONS = (  # all sets of equations to solve, in the order of the report
    TradeoffQuestion(
        key="exact",
        title="exact equations, supremum",
        reference_solution=_REFERENCE_SOLUTIONS["exact"],
        points=48,
        quick=12,
        seconds=0.006,
    ),
    TradeoffQuestion(
        key="small",
        title="small equations, supremum",
        reference_solution=_REFERENCE_SOLUTIONS["small"],
        points=48,
        quick=12,
        seconds=0.006,
    ),
    TradeoffQuestion(
        key="regularised",
        title=f"exact equations, v_reg = {V_REG_TEXT}",
        reference_solution=_REFERENCE_SOLUTIONS["regularised"],
        points=12,
        quick=3,
        seconds=0.01,
    ),
    TradeoffQuestion(
        key="spatial",
        title=f"spatial engine model, v_reg = {V_REG_TEXT}",
        reference_solution=(ENGINE, _SPATIAL),
        points=6,
        quick=2,
        seconds=3.0,
    ),
)


def list_questions(scene: Scene) -> list[TradeoffQuestion]:
    """Return the questions (each: equations to solve, with friction law) for which a scene has the data."""
    return [question for question in QUESTIONS if question.key != "spatial" or has_spatial_data(scene)]


def list_settings(scene: Scene, quick: bool = False) -> list[Setting]:
    """Return the settings to measure for a scene; with `quick`, fewer of those that take long."""
    keys = {question.key for question in list_questions(scene)}
    every = [
        *_reference_settings(scene),
        *_scipy_settings(quick),
        *_engine_settings(quick),
        *_constant_step_settings(quick),
    ]
    return [setting for setting in every if setting.question in keys]


class _VariedCall(NamedTuple):
    """Call of a function of which one argument varies along a curve of error over time."""

    function: str  # import path
    argument: str  # name of the argument that varies
    others: Settings  # its other keyword arguments


def _make_curve_settings(
    question: str, method: str, parameter: str, call: _VariedCall, values: Sequence[float],
    seconds: float | Sequence[float], **stated: Any,
) -> list[Setting]:  # fmt: skip
    """
    Return the settings of one method, one for each of `values` of the varied argument of its function `call`.

    question, method, parameter: as `StatedSetting` has them. seconds: rough processor time of a phase pair, one for
    all values or one for each. stated: other fields of `Setting`, such as `unit` or `against`, by name.
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
    """
    Yield settings of the reference equations.

    They are runs with error control, single runs, and the exact equations with regularized friction, whose error
    against those with rigid friction is that of the model.
    """
    powers = [10.0**-power for power in range(1, 9)]
    for question, law in _LAWS.items():
        yield from _make_curve_settings(
            question,
            method="reference, two runs and an estimate",
            parameter="tolerance of mu",
            call=_VariedCall(REFERENCE, "tolerance", law),
            values=powers[1:],
            seconds=0.003,
            controlled=True,
        )
        yield from _make_curve_settings(
            question,
            method="reference, one run",
            parameter="tolerance inside a step",
            call=_VariedCall(REFERENCE_RUN, "step_tolerance", law),
            values=powers,
            seconds=0.0015,
        )
    for speed in DRY_REGULARIZATIONS if has_dry_friction(scene) else ():
        faster = REFERENCE, {"cutoff": speed, "tolerance": REFERENCE_SOLUTION_TOLERANCE}
        for what, against in (("supremum", None), ("peak faster than v_reg", faster)):
            yield from _make_curve_settings(
                "exact",
                method=f"v_reg, model error against the {what}",
                parameter="v_reg",
                call=_VariedCall(REFERENCE, "regularization", {"tolerance": 1e-6}),
                values=[speed],
                seconds=0.004,
                unit="m/s",
                model_error=True,
                against=against,
            )


def _scipy_settings(quick: bool) -> Iterator[Setting]:
    """Yield settings of SciPy's general-purpose integrators on the equations with regularized friction."""
    lsoda, others = ((4, 10), (4, 8)) if quick else ((3, 4, 6, 8, 10), (3, 4, 6, 8))
    # LSODA goes to tighter tolerances because its finest run checks the reference solution.
    for method, powers, seconds in (("LSODA", lsoda, 0.15), ("Radau", others, 1.0), ("DOP853", others, 1.0)):
        yield from _make_curve_settings(
            "regularised",
            method=f"SciPy {method}",
            parameter="relative tolerance of a step",
            call=_VariedCall(SCIPY_FACTORS, "tolerance", {"method": method, "v_reg": DEFAULT_V_REG}),
            values=[10.0**-power for power in powers],
            seconds=seconds,
        )


def _engine_settings(quick: bool) -> Iterator[Setting]:
    """Yield settings of Exudyn: runs with error control, then single runs in which one parameter is changed."""
    parameters = (  # name of a curve, what varies along it in words, argument of `run_engine_once`, values
        ("step", "largest step over the usual one", "step", (8.0, 4.0, 2.0, 1.0, 0.5, 0.25)),
        ("contact compliance", PENETRATION_PARAMETER, "penetration", (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)),
        ("Newton", "relative tolerance of Newton's iteration", "newton", (1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8)),
    )
    for question, model, tolerances, cost in (  # tolerances: with s per phase pair, which `cost` multiplies
        ("regularised", "translational", {1e-2: 0.35, 1e-3: 0.35, 1e-4: 1.0, 1e-5: 1.8}, 1.0),
        ("spatial", "spatial", {1e-2: 0.35, 1e-3: 0.35}, 1.7),
    ):
        law = {"model": model, "regularization": DEFAULT_V_REG}
        yield from _make_curve_settings(
            question,
            method=f"{model} engine, two levels and an estimate",
            parameter="tolerance of mu",
            call=_VariedCall(ENGINE, "tolerance", law),
            values=list(tolerances),
            seconds=[cost * each for each in tolerances.values()],
            controlled=True,
        )
        for name, parameter, argument, values in parameters:
            yield from _make_curve_settings(
                question,
                method=f"{model} engine, one run: {name}",
                parameter=parameter,
                call=_VariedCall(ENGINE_LEVEL, argument, law),
                values=values[:: 3 if quick else 1],
                seconds=0.25 * cost,
            )


def _constant_step_settings(quick: bool) -> Iterator[Setting]:
    """Yield settings of Exudyn's own time integrators at constant time steps."""
    for solver, steps in STEPS_OF_INTEGRATOR.items():
        few = steps[:: 2 if quick else 1]
        yield from _make_curve_settings(
            "regularised",
            method=f"Exudyn, {solver}",
            parameter="constant step",
            call=_VariedCall(CONSTANT_STEP_RUN, "step", {"solver": solver, "v_reg": DEFAULT_V_REG}),
            values=few,
            seconds=[0.25e-3 / step for step in few],
            unit="s",
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
        measured += _make_curve_settings(
            question,
            method=f"user model: {model.title}",
            parameter=parameter,
            call=_VariedCall(model.amplification, "tolerance", model.settings),
            values=values,
            seconds=1.0,
            against=against,
        )
    return measured
