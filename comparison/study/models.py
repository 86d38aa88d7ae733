"""
The models of the study in order, each adding one effect to the one before. A new model is one entry of MODEL_HIERARCHY.

A model names the function that answers for it ("package:function", the contract of `reference.amplification` and
`multibody.amplification`), so that a worker process can import it by itself.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from reference.problem import Scene, mirror_symmetric, no_friction

V_REG = 1e-3  # m/s: below it friction grows linearly with the slip velocity, on both sides alike
REFERENCE_TOLERANCE = 1e-6  # asked at least of the equations, which are cheap: their error blurs no difference
SOFTENED = "softened-"  # begins the key of a model whose bars are softened


def dry(scene: Scene) -> bool:
    """Whether there is dry friction, which may be regularized."""
    return not scene.lubricated and not no_friction(scene)


def any_scene(scene: Scene) -> bool:
    """Whether a model applies that applies to every scene."""
    return True


def never(scene: Scene) -> bool:
    """Whether mirrored phases give mirrored motions, for a model of which that is not known."""
    return False


def _spatial_data(scene: Scene) -> dict[str, object]:
    """What a scene says, by key, of where its supports are and how high and large its bodies; None if not stated."""
    isolator = scene.isolator
    data: dict[str, object] = {
        "isolator.supports": isolator.supports,
        "isolator.ring": isolator.supports if isinstance(isolator.supports, list) else isolator.ring,
        "isolator.sphere_radius": isolator.sphere_radius,
    }
    for number, body in enumerate(scene.bodies):
        data |= {f"bodies.{number}.height": body.height, f"bodies.{number}.size": body.size}
    return data


def has_spatial_data(scene: Scene) -> bool:
    """Whether the scene states all that the spatial model needs."""
    return None not in _spatial_data(scene).values()


def why_not_spatial(scene: Scene) -> str:
    """Why a scene that states a part of what the spatial model needs goes without it; "" otherwise."""
    data = _spatial_data(scene)
    missing = [key for key, value in data.items() if value is None]
    # the radius of a sphere alone asks for no body that turns
    if not missing or set(data) - set(missing) <= {"isolator.sphere_radius"}:
        return ""
    return f"no spatial model, as it lacks {', '.join(missing)}"


def with_unloaded_bars(scene: Scene) -> bool:
    """Whether bars are stated without load in a scene that the spatial model cannot take."""
    return scene.has_unloaded_bars and not has_spatial_data(scene)


def with_unloaded_bars_in_space(scene: Scene) -> bool:
    """Whether bars are stated without load in a scene that the spatial model can take."""
    return scene.has_unloaded_bars and has_spatial_data(scene)


@dataclass(frozen=True)
class Model:
    """
    One model. `adds`: the sentence the report prints. `settings`: keyword arguments of its functions.
    `assumptions`: its row in the report's table of equations. `applies`: whether the scene gives it anything to add.
    `most`: phases per axis that its cost allows, or None; of a finer study it computes every k-th phase. `symmetric`:
    whether mirrored phases (symmetry.py) are known to give mirrored motions of the scene and are not computed again.
    `refusal`: the function that tells from the scene alone
    why all phase pairs would be refused, or "" ("package:function", the contract of `multibody.refusal`). `side`:
    "user" for a user-supplied engine (user_models.py), which has no place in the steps from model to model and no
    trajectory. `like`: key of the reference's model that such an engine is compared with. `timeout`: most processor
    time of one call, s.
    """

    key: str
    title: str
    adds: str
    side: Literal["reference", "engine", "user"]
    amplification: str
    trajectory: str
    settings: Mapping[str, object]
    assumptions: Mapping[str, str]
    batch: int  # phase pairs solved in one call: about a second of work
    most: int | None = None
    symmetric: Callable[[Scene], object] = field(default=never)  # true or false
    applies: Callable[[Scene], bool] = field(default=any_scene)
    refusal: str | None = None
    effect: str = ""
    like: str | None = None
    timeout: float | None = None

    @property
    def is_spatial(self) -> bool:
        """Whether bodies turn in it."""
        return self.settings.get("model") == "spatial"

    def arguments(self, tolerance: float, full: bool) -> dict[str, object]:
        """Keyword arguments of its amplification in a study of this tolerance."""
        asked = {"full": True} if full else {}
        return {**self.settings, "tolerance": self.tolerance(tolerance), **asked}

    def tolerance(self, asked: float) -> float:
        """Relative error this model asks of its own numbers when the study asks for `asked`."""
        return min(asked, REFERENCE_TOLERANCE) if self.side == "reference" else asked


@dataclass(frozen=True)
class Pair:
    """Two models whose difference is reported, `second` minus `first`, relative to `first`."""

    key: str
    title: str
    sentence: str
    first: Model
    second: Model


def with_max_work(hierarchy: Sequence[Model], max_work: float) -> tuple[Model, ...]:
    """The hierarchy with this many steps of the engine allowed for a phase pair."""
    return tuple(
        replace(model, settings={**model.settings, "max_work": max_work}) if model.side == "engine" else model
        for model in hierarchy
    )


def models_of(scene: Scene, hierarchy: Sequence[Model]) -> list[Model]:
    """The models that apply to this scene, in order."""
    return [model for model in hierarchy if model.applies(scene)]


def steps_of(scene: Scene, hierarchy: Sequence[Model]) -> list[Model]:
    """The models of the scene that lead from one to the next: all but those that a user supplies."""
    return [model for model in models_of(scene, hierarchy) if model.side != "user"]


def pairs_of(scene: Scene, hierarchy: Sequence[Model], left_out: Collection[str] = ()) -> list[Pair]:
    """
    A like-for-like difference of every user-supplied engine, then the total one, that within the paper's assumptions,
    and the like-for-like one: what the scene allows.

    left_out: keys of models without results. The total then leads from the first to the last model that has values. The
    other two compare fixed models: without one of these they are left out.
    """
    asked = steps_of(scene, hierarchy)
    models = [model for model in asked if model.key not in left_out]
    first, last = models[0], models[-1]
    printed = "the paper's printed equations" if first is asked[0] else f"the {first.title}"
    equations = [model for model in asked if model.side == "reference"]
    reference = equations[-1]
    engine = next((model for model in asked if model.side == "engine"), None)
    complete = last is asked[-1] and engine is not None
    other = "the most complete engine model" if complete else f"the {last.title}"
    pairs = [Pair("total", "total", f"{printed} against {other}", first, last)]
    if engine is not None and engine in models:  # else it does not meet the tolerance, fit the budget, or answer
        if engine is not last and first is asked[0]:
            sentence = f"{printed} against the engine under the paper's own assumption that no body turns"
            pairs.append(Pair("translational", "translational", sentence, first, engine))
        if reference in models:
            sentence = "same geometry and same friction law on both sides: this gap must close"
            pairs.append(Pair("like-for-like", "like for like", sentence, reference, engine))
    of_users = []
    for supplied in models_of(scene, hierarchy):
        if supplied.side == "user" and supplied.key not in left_out:
            like = next((model for model in equations if model.key == supplied.like), reference)
            if like in models:
                sentence = f"the {like.title} against a user-supplied engine: what it solves is not known here"
                of_users.append(Pair(supplied.key, f"{supplied.title}, like for like", sentence, like, supplied))
    return of_users + pairs


_PEAK = "largest value the computed motion reaches"


def _next(before: Model, departs: Mapping[str, str], **changes: Any) -> Model:
    """The model after `before`: the same but for `changes`, and for the assumptions in which it `departs`."""
    return replace(before, assumptions={**before.assumptions, **departs}, **changes)


SMALL = Model(
    key="small",
    title="small equations",
    adds="The paper's small-vibration equations (4.3)-(4.4) as printed, with dry friction that really sticks.",
    side="reference",
    amplification="reference:amplification",
    trajectory="reference:trajectory",
    settings={"equations": "small", "regularization": None},
    assumptions={
        "equations": "(4.3)-(4.4), as printed",
        "geometry": "small: the sphere enters through g x/rho and the kept friction terms only",
        "friction": "set-valued Coulomb, mu constant or of the slip velocity, or mu = f_c |v| in a lubricated scene",
        "normal contact": "rigid, m_sum (g + zeta'') to the kept order",
        "unknowns": "2 N horizontal displacements; the vertical one follows from the sphere (2.1)",
        "links": "springs of the stiffness that the scene states; bars as they are without load",
        "mu_i": "supremum of (5.1) with one-sided limits at stops, in closed form",
    },
    batch=64,
    symmetric=any_scene,
)
EXACT = _next(
    SMALL,
    {
        "equations": "(3.9)-(3.13), errata corrected",
        "geometry": "exact sphere of radius rho",
        "normal contact": "rigid, from the constraint with its centripetal part",
    },
    key="exact",
    title="exact equations",
    effect="geometry",
    adds="The whole sphere: equations (3.9)-(3.13) with the errata of the print corrected, same friction law.",
    settings={"equations": "exact", "regularization": None},
)
RESOLVED = _next(
    EXACT,
    {"mu_i": "largest value at rest or sliding faster than v_c = 1e-3 m/s"},
    key="resolved",
    title="exact equations, resolved peak",
    effect="the peak at the stop",
    adds="The same motion, read only at rest and while sliding faster than v_c = 1e-3 m/s: what the one-sided "
    "limits at stops, which no sampling reaches, are worth.",
    settings={**EXACT.settings, "cutoff": V_REG},
    applies=dry,
)
REGULARIZED = _next(
    EXACT,
    {"friction": "the same Coulomb law, times |v| / v_reg below v_reg = 1e-3 m/s", "mu_i": _PEAK},
    key="regularised",
    title="exact equations, v_reg",
    effect="regularized friction",
    adds="Friction linear below v_reg = 1e-3 m/s, as an engine has it: no true rest, no jump at a stop.",
    settings={"equations": "exact", "regularization": V_REG},
    applies=dry,
)
TRANSLATIONAL = _next(
    REGULARIZED,
    {
        "equations": "Newton-Euler of the bodies, assembled by Exudyn",
        "geometry": "exact spheres: support of radius r in a depression of radius R; a plane for a flat slider",
        "friction": "the same Coulomb law, times |v| / v_reg below v_reg = 1e-3 m/s, or mu = f_c |v| if lubricated",
        "normal contact": "elastic: spring and damper, so the platform sinks by N/k_c",
        "unknowns": "translations of every body, the platform's vertical one free",
    },
    key="translational",
    title="translational engine",
    effect="elastic contact",
    adds="Exudyn: spheres in hollow spheres with an elastic contact, every body free to translate only.",
    side="engine",
    amplification="multibody:amplification",
    trajectory="multibody:trajectory",
    refusal="multibody:refusal",
    settings={"model": "translational", "regularization": V_REG},
    batch=2,
    applies=any_scene,
    most=16,
)
SPATIAL = _next(
    TRANSLATIONAL,
    {
        "geometry": "exact spheres at the supports, bodies as boxes at their heights, offsets and angles",
        "normal contact": "elastic and one-sided at every support: loads differ, a support may lift off",
        "unknowns": "six of every body: translations and rotations",
    },
    key="spatial",
    title="spatial engine",
    effect="turning of the bodies",
    adds="Every body free to turn, at its height, on its supports: overturning shares the load unequally, "
    "friction twists the platform, supports may lift off.",
    settings={"model": "spatial", "regularization": V_REG},
    batch=1,
    applies=has_spatial_data,
    most=16,
    symmetric=mirror_symmetric,
)

MODEL_HIERARCHY: tuple[Model, ...] = (SMALL, EXACT, RESOLVED, REGULARIZED, TRANSLATIONAL, SPATIAL)


def _softened(model: Model, applies: Callable[[Scene], bool]) -> Model:
    """The step after an engine model that softens its bars."""
    return _next(
        model,
        {"links": "bars as soft as the weight that they carry makes them"},
        key=f"{SOFTENED}{model.key}",
        title=f"{model.title}, softened bars",
        effect="softening of the bars",
        adds="Bars under the weight that they carry: it makes them softer in sway, and they would buckle under more.",
        settings={**model.settings, "softened": True},
        applies=applies,
    )


SOFTENED_TRANSLATIONAL = _softened(TRANSLATIONAL, with_unloaded_bars)
SOFTENED_SPATIAL = _softened(SPATIAL, with_unloaded_bars_in_space)


def with_softened_bars(hierarchy: Sequence[Model], scenes: Sequence[Scene]) -> tuple[Model, ...]:
    """The hierarchy with the step that softens bars at its end, where a scene has bars without it."""
    functions = {model.amplification for model in hierarchy}
    steps = (SOFTENED_TRANSLATIONAL, SOFTENED_SPATIAL)
    added = (model for model in steps if model.amplification in functions and any(map(model.applies, scenes)))
    return (*hierarchy, *added)
