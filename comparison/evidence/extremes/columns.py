"""Columns of the matrix of extremes: the models, and the finer runs that confirm each."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from comparison.study.models import EXACT, TRANSLATIONAL, Model
from reference.problem.readings import DEFAULT_V_REG

# Import paths of the functions that compute the amplification mu by the equations and by the engine
EQUATIONS, ENGINE = EXACT.amplification, TRANSLATIONAL.amplification


@dataclass(frozen=True)
class ModelColumn:
    """A model, and the finer runs that confirm its answers."""

    key: str
    title: str
    amplification: str  # function as "package:function"
    settings: Mapping[str, Any]  # keyword arguments of the function
    tolerance: float  # relative error asked of the model
    # finer runs in order until one answers: function, settings, relative error asked
    finer: tuple[tuple[str, Mapping[str, Any], float], ...]
    seconds: float = 0.5  # s, rough processor time of a cell with its finer runs
    like: str = ""  # for a user's engine, the column whose rows concern it as well


MAX_WORK = 6e5  # largest number of engine steps for a phase pair: the cell then ends within its time limit


def _model_column(key: str, title: str, equations: str, regularization: float | None) -> ModelColumn:
    """Return the column of a model of the reference equations; finer runs have tolerances of 1e-8 and 1e-7."""
    function, settings = EQUATIONS, {"equations": equations, "regularization": regularization}
    return ModelColumn(key, title, function, settings, 1e-6, ((function, settings, 1e-8), (function, settings, 1e-7)))


# Keyword arguments of the models with friction linear below v_reg
_REGULARIZED = {"equations": "exact", "regularization": DEFAULT_V_REG}
_TRANSLATIONAL = {"model": "translational", "regularization": DEFAULT_V_REG, "max_work": MAX_WORK}
_SPATIAL = {"model": "spatial", "regularization": DEFAULT_V_REG, "max_work": MAX_WORK}
# The engine at the step or contact stiffness that the row states
STATED_ENGINE = "comparison.evidence.extremes.engine:amplification"
# Finer runs that check a value, in order until one answers: the equations of the same law and geometry, then the engine
# at a far closer tolerance
_FINER = (EQUATIONS, _REGULARIZED, 1e-6), (ENGINE, _TRANSLATIONAL, 3e-5), (ENGINE, _TRANSLATIONAL, 1e-4)
_FINER_SPATIAL = (ENGINE, _SPATIAL, 3e-4), (ENGINE, _SPATIAL, 1e-3)  # finer runs of the spatial model
COLUMNS = (  # columns of the matrix in their order
    _model_column("small", "small equations", "small", None),
    _model_column("exact", "exact equations", "exact", None),
    _model_column("regularised", "exact equations, v_reg", "exact", DEFAULT_V_REG),
    ModelColumn("translational", "translational engine", ENGINE, _TRANSLATIONAL, 1e-3, _FINER, 1.0),
    ModelColumn("spatial", "spatial engine", ENGINE, _SPATIAL, 1e-2, _FINER_SPATIAL, 8.5),
)
ALL_MODELS = tuple(column.key for column in COLUMNS)  # keys of the built-in models


def make_user_column(model: Model) -> ModelColumn:
    """Return the column of a user's engine, which the equations with the same friction law confirm."""
    law = {key: value for key, value in model.settings.items() if key != "engine"}
    like = str(model.like) if model.like in ALL_MODELS else "exact"
    finer = ((EQUATIONS, law, 1e-8), (EQUATIONS, law, 1e-6))
    return ModelColumn(model.key, model.title, model.amplification, model.settings, 1e-3, finer, like=like)


PLANAR_MODELS = ALL_MODELS[:4]  # models whose bodies do not rotate
# Models of the equations: small, exact, and exact with regularized friction
REFERENCE_MODELS = ALL_MODELS[:3]
REGULARIZED_MODELS = ALL_MODELS[2:]  # models with friction linear below v_reg
ENGINE_MODELS = ALL_MODELS[3:]  # models of Exudyn
SPATIAL_MODELS = ALL_MODELS[4:]  # model of Exudyn whose bodies rotate
