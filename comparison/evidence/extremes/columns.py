"""Columns of the matrix of extremes: the models, and the finer runs that confirm each."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from comparison.study.models import EXACT, TRANSLATIONAL, Model
from reference.problem.readings import DEFAULT_V_REG

# Import paths of the functions that compute the amplification by the reference equations and by Exudyn
EQUATIONS, ENGINE = EXACT.amplification, TRANSLATIONAL.amplification


@dataclass(frozen=True)
class ModelColumn:
    """Column of the matrix of extremes: a model, and the finer runs that check its answers."""

    key: str
    title: str
    amplification: str  # import path "package:function" of the function that computes the amplification
    settings: Mapping[str, Any]  # keyword arguments of that function
    tolerance: float  # relative error asked of the model
    # finer runs, tried in order until one has an answer: function, settings, relative error asked
    finer: tuple[tuple[str, Mapping[str, Any], float], ...]
    seconds: float = 0.5  # s, rough processor time of the model and its finer runs at one extreme
    like: str = ""  # for a user's engine: key of the built-in model with the same extremes; "" for built-in models


MAX_WORK = 6e5  # largest number of Exudyn's steps per phase pair, so that a model at an extreme ends in its time limit


def _model_column(key: str, title: str, equations: str, regularization: float | None) -> ModelColumn:
    """Return the matrix column of a model of the reference equations, checked by finer runs of the same equations."""
    settings = {"equations": equations, "regularization": regularization}
    return ModelColumn(
        key=key,
        title=title,
        amplification=EQUATIONS,
        settings=settings,
        tolerance=1e-6,
        finer=((EQUATIONS, settings, 1e-8), (EQUATIONS, settings, 1e-7)),
    )


# Keyword arguments for models with friction linear below the sliding speed v_reg; here: the exact equations
_REGULARIZED = {"equations": "exact", "regularization": DEFAULT_V_REG}
# keyword arguments of Exudyn's translational model
_TRANSLATIONAL = {"model": "translational", "regularization": DEFAULT_V_REG, "max_work": MAX_WORK}
# keyword arguments of Exudyn's spatial model
_SPATIAL = {"model": "spatial", "regularization": DEFAULT_V_REG, "max_work": MAX_WORK}
# Import path of the function that computes the amplification by Exudyn at a stated time step or contact stiffness
STATED_ENGINE = "comparison.evidence.extremes.engine:amplification"
# Finer runs that check the translational model (function, keyword arguments, relative error asked), in order until one
# has an answer: the equations with the same law of friction and geometry, then Exudyn at a far closer tolerance
_FINER = (EQUATIONS, _REGULARIZED, 1e-6), (ENGINE, _TRANSLATIONAL, 3e-5), (ENGINE, _TRANSLATIONAL, 1e-4)
_FINER_SPATIAL = (ENGINE, _SPATIAL, 3e-4), (ENGINE, _SPATIAL, 1e-3)  # finer runs of the spatial model
COLUMNS = (  # columns of the matrix of extremes (built-in models) in their order
    _model_column("small", "small equations", equations="small", regularization=None),
    _model_column("exact", "exact equations", equations="exact", regularization=None),
    _model_column("regularised", "exact equations, v_reg", equations="exact", regularization=DEFAULT_V_REG),
    ModelColumn(
        key="translational",
        title="translational engine",
        amplification=ENGINE,
        settings=_TRANSLATIONAL,
        tolerance=1e-3,
        finer=_FINER,
        seconds=1.0,
    ),
    ModelColumn(
        key="spatial",
        title="spatial engine",
        amplification=ENGINE,
        settings=_SPATIAL,
        tolerance=1e-2,
        finer=_FINER_SPATIAL,
        seconds=8.5,
    ),
)
ALL_MODELS = tuple(column.key for column in COLUMNS)  # keys of the built-in models


def make_user_column(model: Model) -> ModelColumn:
    """Return the column of a user's engine; the reference equations with the same friction law check its answers."""
    law = {key: value for key, value in model.settings.items() if key != "engine"}
    like = str(model.like) if model.like in ALL_MODELS else "exact"
    return ModelColumn(
        key=model.key,
        title=model.title,
        amplification=model.amplification,
        settings=model.settings,
        tolerance=1e-3,
        finer=((EQUATIONS, law, 1e-8), (EQUATIONS, law, 1e-6)),
        like=like,
    )


PLANAR_MODELS = ALL_MODELS[:4]  # keys of the models whose bodies do not rotate
# Keys of the models by the reference equations: small vibrations, exact, and exact with regularized friction
REFERENCE_MODELS = ALL_MODELS[:3]
REGULARIZED_MODELS = ALL_MODELS[2:]  # keys of the models with friction linear below the sliding speed v_reg
ENGINE_MODELS = ALL_MODELS[3:]  # keys of Exudyn's models
SPATIAL_MODELS = ALL_MODELS[4:]  # key of Exudyn's model whose bodies rotate
