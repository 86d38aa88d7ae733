"""Columns of the matrix of extremes: the models, and what confirms each."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from comparison.study.models import EXACT, TRANSLATIONAL, Model
from reference.problem.readings import DEFAULT_V_REG

EQUATIONS, ENGINE = EXACT.amplification, TRANSLATIONAL.amplification


@dataclass(frozen=True)
class ModelColumn:
    """A model and what confirms it."""

    key: str
    title: str
    amplification: str  # "package:function"
    settings: Mapping[str, Any]  # arguments of the function
    tolerance: float  # relative error asked
    # how a value is confirmed, in this order until one answers: function, settings, relative error asked
    finer: tuple[tuple[str, Mapping[str, Any], float], ...]
    seconds: float = 0.5  # rough processor time of a cell with its finer runs
    like: str = ""  # for an engine of the user: the column whose rows concern it, too


MAX_WORK = 6e5  # steps of the engine for a phase pair: a cell ends within the limit of its processor time


def _model_column(key: str, title: str, equations: str, regularization: float | None) -> ModelColumn:
    function, settings = EQUATIONS, {"equations": equations, "regularization": regularization}
    return ModelColumn(key, title, function, settings, 1e-6, ((function, settings, 1e-8), (function, settings, 1e-7)))


_REGULARIZED = {"equations": "exact", "regularization": DEFAULT_V_REG}
_TRANSLATIONAL = {"model": "translational", "regularization": DEFAULT_V_REG, "max_work": MAX_WORK}
_SPATIAL = {"model": "spatial", "regularization": DEFAULT_V_REG, "max_work": MAX_WORK}
STATED = "comparison.evidence.extremes.engine:amplification"  # the engine at a step or a contact stiffness of the row
# Calls that check a value, the first with an answer: the equations of the same law and geometry, then the engine at a
# far closer tolerance
_FINER = (EQUATIONS, _REGULARIZED, 1e-6), (ENGINE, _TRANSLATIONAL, 3e-5), (ENGINE, _TRANSLATIONAL, 1e-4)
_FINER_SPATIAL = (ENGINE, _SPATIAL, 3e-4), (ENGINE, _SPATIAL, 1e-3)
COLUMNS = (
    _model_column("small", "small equations", "small", None),
    _model_column("exact", "exact equations", "exact", None),
    _model_column("regularised", "exact equations, v_reg", "exact", DEFAULT_V_REG),
    ModelColumn("translational", "translational engine", ENGINE, _TRANSLATIONAL, 1e-3, _FINER, 1.0),
    ModelColumn("spatial", "spatial engine", ENGINE, _SPATIAL, 1e-2, _FINER_SPATIAL, 8.5),
)
ALL = tuple(column.key for column in COLUMNS)


def user_column(model: Model) -> ModelColumn:
    """The column of an engine of the user, confirmed by the equations with the same law."""
    law = {key: value for key, value in model.settings.items() if key != "engine"}
    like = str(model.like) if model.like in ALL else "exact"
    finer = ((EQUATIONS, law, 1e-8), (EQUATIONS, law, 1e-6))
    return ModelColumn(model.key, model.title, model.amplification, model.settings, 1e-3, finer, like=like)


PLANAR = ALL[:4]  # every model whose bodies do not turn
REFERENCE = ALL[:3]
WITH_V_REG = ALL[2:]
WITH_ENGINE = ALL[3:]
SPATIAL = ALL[4:]
