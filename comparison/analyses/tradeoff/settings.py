"""
What is measured: questions, each with a reference solution, and the settings of methods that answer them.

A reference solution is a run at a tolerance at least 100 times tighter than any setting that is compared with it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from comparison.study.models import V_REG, Model, dry, has_spatial_data
from comparison.study.user_models import engine_of
from reference.problem import Scene

REFERENCE, ENGINE = "reference:amplification", "multibody:amplification"
RUN, LEVEL, CONSTANT = (
    f"comparison.analyses.tradeoff.single_runs:{name}" for name in ("reference_run", "engine_run", "constant_step_run")
)
SCIPY = "comparison.analyses.tradeoff.outside:factors_by_scipy"

TIGHT = 1e-10  # the tightest the reference takes
SPATIAL_TIGHT = 1e-5
STEPS = {
    "generalized alpha": (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4),
    "trapezoidal": (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4),
    "RK44": (4e-4, 2e-4, 1e-4),
    "velocity Verlet": (4e-4, 2e-4, 1e-4, 5e-5),
}  # s
DRY_SPEEDS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)  # m/s, v_reg

PENETRATION = "penetration under the weight, over rho"

Settings = Mapping[str, Any]


@dataclass(frozen=True)
class Question:
    """
    One panel of the diagram. reference_solution: function and settings of its reference solution. check: how good that
    is known to be, in words that the measured numbers complete. points, quick: phase pairs of the sample.
    """

    key: str
    title: str
    reference_solution: tuple[str, Settings]
    points: int
    quick: int
    seconds: float  # of the reference solution, per point, about


@dataclass(frozen=True)
class Setting:
    """
    One point of a diagram. function: answers (scene, phases, **settings). method: the curve it belongs to; parameter:
    what varies along that, value: here. controlled: comes with an error estimate. model_error: `question` is not what
    the equations solved here ask. against: reference solution of its own in place of the question's. seconds: per
    point, about.
    """

    question: str
    method: str
    parameter: str
    unit: str
    value: float
    function: str
    settings: Settings
    seconds: float
    controlled: bool = False
    model_error: bool = False
    against: tuple[str, Settings] | None = None


QUESTIONS = (
    Question("exact", "exact equations, supremum", (REFERENCE, {"tolerance": TIGHT}), 48, 12, 0.006),
    Question(
        "small",
        "small equations, supremum",
        (REFERENCE, {"equations": "small", "tolerance": TIGHT}),
        48,
        12,
        0.006,
    ),
    Question(
        "regularised",
        "exact equations, v_reg = 1e-3 m/s",
        (REFERENCE, {"regularization": V_REG, "tolerance": TIGHT}),
        12,
        3,
        0.01,
    ),
    Question(
        "spatial",
        "spatial engine model, v_reg = 1e-3 m/s",
        (ENGINE, {"model": "spatial", "regularization": V_REG, "tolerance": SPATIAL_TIGHT}),
        6,
        2,
        3.0,
    ),
)  # fmt: skip


def asked(scene: Scene) -> list[Question]:
    """The questions that a scene allows."""
    return [question for question in QUESTIONS if question.key != "spatial" or has_spatial_data(scene)]


def settings(scene: Scene, quick: bool = False) -> list[Setting]:
    """Every setting that is measured for a scene; quick: every other one of the expensive ones."""
    keys = {question.key for question in asked(scene)}
    every = [*_reference(scene), *_scipy(quick), *_engine(quick)]
    return [setting for setting in every if setting.question in keys]


def _reference(scene: Scene) -> list[Setting]:
    measured = []
    laws: Sequence[tuple[str, Settings]] = (
        ("exact", {}),
        ("small", {"equations": "small"}),
        ("regularised", {"regularization": V_REG}),
    )
    for question, law in laws:
        for power in range(2, 9):
            value = 10.0**-power
            measured.append(
                Setting(question, "reference, two runs and an estimate", "tolerance of mu", "", value, REFERENCE,
                        {**law, "tolerance": value}, 0.003, controlled=True)
            )  # fmt: skip
        for power in range(1, 9):
            value = 10.0**-power
            measured.append(
                Setting(question, "reference, one run", "tolerance inside a step", "", value, RUN,
                        {**law, "inside": value}, 0.0015)
            )  # fmt: skip
    for speed in DRY_SPEEDS if dry(scene) and scene.friction_coefficient > 0.0 else ():
        for what, against in (
            ("supremum", None),
            ("peak faster than v_reg", (REFERENCE, {"cutoff": speed, "tolerance": TIGHT})),
        ):
            measured.append(
                Setting("exact", f"v_reg, model error against the {what}", "v_reg", "m/s", speed, REFERENCE,
                        {"regularization": speed, "tolerance": 1e-6}, 0.004, model_error=True, against=against)
            )  # fmt: skip
    return measured


def _scipy(quick: bool) -> list[Setting]:
    seconds = {"LSODA": 0.15, "Radau": 1.0, "DOP853": 1.0}
    lsoda, others = (
        ((4, 10), (4, 8)) if quick else ((3, 4, 6, 8, 10), (3, 4, 6, 8))
    )  # LSODA checks the reference solution, too
    powers = {"LSODA": lsoda, "Radau": others, "DOP853": others}
    return [
        Setting("regularised", f"SciPy {method}", "relative tolerance of a step", "", 10.0**-power, SCIPY,
                {"method": method, "tolerance": 10.0**-power, "v_reg": V_REG}, seconds[method])
        for method in seconds
        for power in powers[method]
    ]  # fmt: skip


def _engine(quick: bool) -> list[Setting]:
    return [*_levels(quick), *_constant(quick)]


def _levels(quick: bool) -> list[Setting]:
    """The engine as the package runs it: error-controlled, and single runs with one parameter changed."""
    parameters: Sequence[tuple[str, str, str, Sequence[float]]] = (
        ("step", "largest step over the usual one", "step", (8.0, 4.0, 2.0, 1.0, 0.5, 0.25)),
        ("contact compliance", PENETRATION, "penetration", (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)),
        ("Newton", "relative tolerance of Newton's iteration", "newton", (1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8)),
    )
    models: Sequence[tuple[str, str, Sequence[float], float]] = (
        ("regularised", "translational", (1e-2, 1e-3, 1e-4, 1e-5), 1.0),
        ("spatial", "spatial", (1e-2, 1e-3), 1.7),
    )
    measured = []
    for question, model, tolerances, dearer in models:
        law = {"model": model, "regularization": V_REG}
        for value, seconds in zip(tolerances, (0.35, 0.35, 1.0, 1.8)):
            measured.append(
                Setting(question, f"{model} engine, two levels and an estimate", "tolerance of mu", "", value, ENGINE,
                        {**law, "tolerance": value}, seconds * dearer, controlled=True)
            )  # fmt: skip
        for name, parameter, key, values in parameters:
            for value in values[:: 3 if quick else 1]:
                measured.append(
                    Setting(question, f"{model} engine, one run: {name}", parameter, "", value, LEVEL,
                            {**law, key: value}, 0.25 * dearer)
                )  # fmt: skip
    return measured


def _constant(quick: bool) -> list[Setting]:
    """The engine at constant step, by its integrators."""
    curves = [(f"Exudyn, {solver}", {"solver": solver}, steps, 0.25e-3) for solver, steps in STEPS.items()]
    return [
        Setting("regularised", method, "constant step", "s", step, CONSTANT,
                {**integrator, "step": step, "v_reg": V_REG}, cost / step)
        for method, integrator, steps, cost in curves
        for step in steps[:: 2 if quick else 1]
    ]  # fmt: skip


def user_settings(models: Sequence[Model]) -> list[Setting]:
    """Engines of the user at the tolerances that they take, or as they are."""
    keys = {question.key for question in QUESTIONS}
    measured = []
    for model in models:
        law = {key: value for key, value in model.settings.items() if key != "engine"}
        question, against = (
            (model.like, None) if model.like in keys else ("exact", (REFERENCE, {**law, "tolerance": TIGHT}))
        )
        takes_tolerance = "tolerance" in engine_of(model.settings).get("names", "")
        for value in (1e-2, 1e-3, 1e-4, 1e-5) if takes_tolerance else (1e-3,):
            parameter = "tolerance of mu" if takes_tolerance else "as it is, beside a tolerance of"
            measured.append(
                Setting(str(question), f"user model: {model.title}", parameter, "", value, model.amplification,
                        {**model.settings, "tolerance": value}, 1.0, against=against)
            )  # fmt: skip
    return measured
