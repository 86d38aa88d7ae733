"""
The models of the study in order, each adding one effect to the one before. A new model is one entry of MODEL_HIERARCHY.

A model names the function that answers for it ("package:function", the contract of `reference.amplification` and
`multibody.amplification`), so that a worker process can import it by itself.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any, Literal

from reference.problem import Scene
from reference.problem.readings import AS_INTEGRATED, DEFAULT_V_C, DEFAULT_V_REG, LITERAL_SUPREMUM
from reference.problem.reductions import is_mirror_symmetric

# Default speeds as text: v_reg of regularized friction; v_c, below which sliding does not count for peak accelerations
V_REG_TEXT, V_C_TEXT = (f"{1e3 * speed:g} mm/s" for speed in (DEFAULT_V_REG, DEFAULT_V_C))
# Largest relative error asked of package `reference` in any study: it is cheap, and differences hardly show its error.
REFERENCE_TOLERANCE = 1e-6
SOFTENED = "softened-"  # prefix of the key of a model whose bars are softened


def has_dry_friction(scene: Scene) -> bool:
    """Return whether there is rigid dry friction, which may be regularized."""
    return scene.has_dry_friction


def has_yielding_friction(scene: Scene) -> bool:
    """Return whether dry friction yields elastically before it slides."""
    return scene.dry_friction.elastic


def applies_to_every_scene(scene: Scene) -> bool:
    """Return True: the model applies to every scene."""
    return True


def has_smooth_friction(scene: Scene) -> bool:
    """Return whether no friction is dry and rigid: limits just before stops then add nothing to peak accelerations."""
    return not has_dry_friction(scene)


def applies_to_no_scene(scene: Scene) -> bool:
    """Return False for every scene: the default for a property that a model does not have."""
    return False


def _spatial_data(scene: Scene) -> dict[str, object]:
    """
    Return by key a scene's places of supports, sphere radius, and heights and sizes of bodies; None where not stated.
    """
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
    """Return whether the scene states all that the spatial model needs."""
    return None not in _spatial_data(scene).values()


def why_not_spatial(scene: Scene) -> str:
    """Return why the spatial model is not used for a scene that states only part of its data; "" otherwise."""
    data = _spatial_data(scene)
    missing = [key for key, value in data.items() if value is None]
    # A sphere radius that is stated alone does not mean that the spatial model is wanted.
    if not missing or set(data) - set(missing) <= {"isolator.sphere_radius"}:
        return ""
    return f"no spatial model, as it lacks {', '.join(missing)}"


def has_only_planar_unloaded_bars(scene: Scene) -> bool:
    """Return whether a scene gives bars without softening by weight, but not the data that the spatial model needs."""
    return scene.has_unloaded_bars and not has_spatial_data(scene)


def has_spatial_unloaded_bars(scene: Scene) -> bool:
    """Return whether a scene gives bars without softening by weight, and the data that the spatial model needs."""
    return scene.has_unloaded_bars and has_spatial_data(scene)


@dataclass(frozen=True)
class Model:
    """
    Model of the study: equations of motion, or an engine.

    Attributes:
    - adds: Text of the report on what the model adds to the one before.
    - side: "user" for an engine of a user (user_models.py), which has no place in the steps from model to model.
    - amplification, trajectory: Functions of the model, each as "package:function"; a user's engine has no trajectory.
    - settings: Further arguments of these functions.
    - assumptions: Row of the model in the report's table of equations.
    - most: Phases per axis that the model's cost allows, or None. Of a finer study it computes every k-th phase.
    - symmetric: Tells whether mirrored phases (symmetry.py) give mirrored motions of a scene, so that they are not
      computed again.
    - applies: Tells whether the scene gives the model anything to add.
    - refusal: Function that tells from the scene alone why all phase pairs would be refused, or "", with the contract
      of `multibody.refusal`; as "package:function".
    - effect: What it adds to the model before, as a name.
    - like: Key of the reference's model with which a user's engine is compared.
    - timeout: Limit of the processor time of one call, s.
    - reading: What counts as peak acceleration in (5.1), where friction is dry.
    - in_chain: Tells whether the scene's chain of models has it. In the chain each model adds one effect to the one
      before, and peak accelerations are those of the motion as integrated.
    - seconds: Rough processor time of a phase pair of the scene that costs.py is for.
    - rigid: Whether friction is rigid in the model where the scene's friction yields.
    """

    key: str
    title: str
    adds: str
    side: Literal["reference", "engine", "user"]
    amplification: str
    trajectory: str
    settings: Mapping[str, object]
    assumptions: Mapping[str, str]
    batch: int  # number of phase pairs solved in one call, which then takes about a second
    most: int | None = None
    symmetric: Callable[[Scene], object] = field(default=applies_to_no_scene)
    applies: Callable[[Scene], bool] = field(default=applies_to_every_scene)
    refusal: str | None = None
    effect: str = ""
    like: str | None = None
    timeout: float | None = None
    reading: str = AS_INTEGRATED
    in_chain: Callable[[Scene], bool] = field(default=applies_to_every_scene)
    seconds: float = 1.0
    rigid: bool = False

    @property
    def is_spatial(self) -> bool:
        """Return whether bodies rotate in this model."""
        return self.settings.get("model") == "spatial"

    @property
    def motion_settings(self) -> dict[str, object]:
        """Return arguments for computing a motion: settings without `cutoff`, a slip speed that affects peaks only."""
        return {key: value for key, value in self.settings.items() if key != "cutoff"}

    def scene_of(self, scene: Scene) -> Scene:
        """Return the scene as this model computes it: with friction that does not yield if the model is `rigid`."""
        return scene.with_yield_displacement(0.0) if self.rigid else scene

    def arguments(self, tolerance: float, full: bool) -> dict[str, object]:
        """
        Return the arguments of the model's amplification function at a study's tolerance.

        full: whether every motion is computed to its end, and with a model that is not reduced.
        """
        asked = {"full": True} if full else {}
        return {**self.settings, "tolerance": self.tolerance(tolerance), **asked}

    def tolerance(self, asked: float) -> float:
        """Return the relative error required of this model's amplification when the study requires `asked`."""
        return min(asked, REFERENCE_TOLERANCE) if self.side == "reference" else asked


@dataclass(frozen=True)
class Pair:
    """
    Two models whose difference is reported: `second` minus `first`, as a share of the amplification mu of `base`.

    effect: what the second adds to the first; "" for a pair that differs by several effects, or by what counts as peak
    acceleration. sentence: what the pair compares, in words.
    """

    key: str
    title: str
    sentence: str
    first: Model
    second: Model
    base: Model
    effect: str = ""


def label_of(model: Model, scene: Scene) -> str:
    """Return a model's title, and how it reads peak accelerations (as integrated, literal supremum) if that matters."""
    title, readings = model.title.removesuffix(f", {model.reading}"), readings_of([model], scene)
    return f"{title}, {model.reading}" if readings else title


def readings_of(models: Sequence[Model], scene: Scene) -> list[str]:
    """List how models read peak accelerations (as integrated, literal supremum), each once; none where both agree."""
    return [*dict.fromkeys(each.reading for each in models if not has_smooth_friction(each.scene_of(scene)))]


def with_max_work(hierarchy: Sequence[Model], max_work: float) -> tuple[Model, ...]:
    """Return the models with the engine's number of steps per phase pair limited to `max_work`."""
    return tuple(
        replace(model, settings={**model.settings, "max_work": max_work}) if model.side == "engine" else model
        for model in hierarchy
    )


def models_of(scene: Scene, hierarchy: Sequence[Model]) -> list[Model]:
    """Return the models that apply to this scene, in order."""
    return [model for model in hierarchy if model.applies(scene)]


def chain_of(scene: Scene, hierarchy: Sequence[Model]) -> list[Model]:
    """Return the scene's chain of models: each adds one effect to the one before; all define the peak alike."""
    return [model for model in models_of(scene, hierarchy) if model.side != "user" and model.in_chain(scene)]


def pairs_of(scene: Scene, hierarchy: Sequence[Model], left_out: Collection[str] = ()) -> list[Pair]:
    """
    Return pairs of models to compare: first with last, `reference` with Exudyn on the same equations, and others.

    They are, as far as the scene allows: every user's engine against its partner, then the total, the difference
    under the paper's assumptions, and the like-for-like one. left_out: keys of models without results. The total then
    leads from the first to the last model with values; the other two need their fixed models.
    """
    asked = chain_of(scene, hierarchy)
    models = [model for model in asked if model.key not in left_out]
    first, last = models[0], models[-1]
    printed = "the paper's printed equations" if first is asked[0] else f"the {first.title}"
    reference = [model for model in asked if model.side == "reference"][-1]
    engine = next((model for model in asked if model.side == "engine"), None)
    complete = last is asked[-1] and engine is not None
    other = "the most complete model of Exudyn" if complete else f"the {last.title}"
    sentence = f"{printed} against {other}"
    pairs = [Pair(key="total", title="total", sentence=sentence, first=first, second=last, base=first)]
    # The next two pairs need models with results: within the tolerance and the budget, and with an answer.
    if engine is not None and engine in models:
        if engine is not last and first is asked[0]:
            sentence = f"{printed} against Exudyn under the paper's own assumption that no body turns"
            key = "translational"
            pairs.append(Pair(key=key, title=key, sentence=sentence, first=first, second=engine, base=first))
        if reference in models:
            sentence = "same geometry and same friction law on both sides: this gap must close"
            key, title = "like-for-like", "same equations and friction law"
            pairs.append(Pair(key=key, title=title, sentence=sentence, first=reference, second=engine, base=reference))
    of_users = []
    for supplied in models_of(scene, hierarchy):
        if supplied.side == "user" and supplied.key not in left_out:
            like = partner_of(supplied, scene, hierarchy)
            if like.key not in left_out:
                sentence = f"the {like.title} against an engine of yours, which is said to solve the same"
                title = f"{supplied.title}, against the {like.title}"
                of_users.append(
                    Pair(key=supplied.key, title=title, sentence=sentence, first=like, second=supplied, base=like)
                )
    return of_users + pairs


def partner_of(engine: Model, scene: Scene, hierarchy: Sequence[Model]) -> Model:
    """
    Return the reference's model that solves the same equations as the user's engine.

    Where no friction is dry, every law is the same: the partner is then the model that applies and has its geometry.
    """
    equations = [model for model in models_of(scene, hierarchy) if model.side == "reference"]
    same = [model for model in equations if model.key == engine.like]
    solved = [model.assumptions["equations"] for model in MODEL_HIERARCHY if model.key == engine.like]
    alike = [model for model in equations if model.assumptions["equations"] in solved]
    return (same or alike or equations)[-1]


def effect_pairs_of(scene: Scene, hierarchy: Sequence[Model], left_out: Collection[str] = ()) -> list[Pair]:
    """
    Return pairs of models that differ by one effect, successive ones first, or by what counts as peak acceleration.

    An effect as integrated is a share of the amplification of the chain's first model, so that the effects of the chain
    add up to the total. Between literal suprema it is a share of the literal supremum of the small equations.
    """
    known = {model.key: model for model in models_of(scene, hierarchy) if model.key not in left_out}
    chain = [model for model in chain_of(scene, hierarchy) if model.key in known]
    pairs = [_effect_pair(second.effect, "", first, second, chain[0]) for first, second in pairwise(chain)]
    for effect, where, first, second in BESIDE_THE_CHAIN:
        if first.key in known and second.key in known and not (first.in_chain(scene) and second.in_chain(scene)):
            base = first if first.reading == LITERAL_SUPREMUM else chain[0]
            pairs.append(_effect_pair(effect, where, known[first.key], known[second.key], known[base.key]))
    if SMALL.key in known and chain[0].key == SMALL_AS_INTEGRATED.key:
        small, printed = known[SMALL.key], chain[0]
        above = "what the limits at stops add to the small equations as integrated"
        below = "what an integration of the small equations misses of the literal supremum"
        title = "literal supremum above as integrated"
        pairs.append(Pair(key="supremum", title=title, sentence=above, first=printed, second=small, base=printed))
        title = "as integrated against literal supremum"
        pairs.append(Pair(key="reading", title=title, sentence=below, first=small, second=printed, base=small))
        last, title = chain[-1], "total from the literal supremum"
        sentence = f"the literal supremum of the printed equations against the {last.title}"
        pairs.append(Pair(key="supremum-total", title=title, sentence=sentence, first=small, second=last, base=small))
    return pairs


def _effect_pair(effect: str, where: str, first: Model, second: Model, base: Model) -> Pair:
    """
    Return the pair of models that differ by `effect`, which is reported as a share of the amplification of `base`.

    where: end of the key of the pair, or "".
    """
    title = effect or f"the step to the {second.title}"
    key = "-".join([*(effect or second.key).split(), *where.split()])
    sentence = f"what {title} adds to the {first.title}"
    return Pair(key=key, title=title, sentence=sentence, first=first, second=second, base=base, effect=title)


# Text on what counts as the peak acceleration of models in which all of the motion counts
_PEAK = "largest value the computed motion reaches"
# Text on what counts as the peak acceleration of models in which sliding slower than v_c does not count
_RESOLVED_PEAK = f"largest value at rest or sliding faster than v_c = {V_C_TEXT}"


def _model_after(before: Model, changed_assumptions: Mapping[str, str], **changes: Any) -> Model:
    """Return a copy of the model `before` with some assumptions changed, by key, and some fields, by name."""
    return replace(before, assumptions={**before.assumptions, **changed_assumptions}, **changes)


# First model: small-vibration equations (4.3)-(4.4); peak accelerations include the limits just before stops (literal
# supremum of (5.1)). Each later model is a changed earlier one.
SMALL = Model(
    key="small",
    title="small equations, literal supremum",
    adds="The paper's small-vibration equations (4.3)-(4.4) as printed, with dry friction that really sticks; (5.1) "
    "counts the one-sided limits at stops, which no integration meets.",
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
        "mu_i": "literal supremum of (5.1) with one-sided limits at stops, in closed form",
    },
    batch=64,
    symmetric=applies_to_every_scene,
    reading=LITERAL_SUPREMUM,
    in_chain=has_smooth_friction,
    seconds=0.0005,
)
# Exact equations (3.9)-(3.13) of large displacements; friction law and peaks, with limits at stops, as in model SMALL
EXACT = _model_after(
    SMALL,
    {
        "equations": "(3.9)-(3.13), errata corrected",
        "geometry": "exact sphere of radius rho",
        "normal contact": "rigid, from the constraint with its centripetal part",
    },
    key="exact",
    title="exact equations, literal supremum",
    effect="geometry",
    adds="The whole sphere: equations (3.9)-(3.13) with the errata of the print corrected, same friction law.",
    settings={"equations": "exact", "regularization": None},
)
# Motion as in model SMALL, equations (4.3)-(4.4); sliding slower than v_c does not count for the peak acceleration
SMALL_AS_INTEGRATED = _model_after(
    SMALL,
    {"mu_i": _RESOLVED_PEAK},
    key="small-resolved",
    title="small equations, as integrated",
    adds=f"The same motion, read at rest and while sliding faster than v_c = {V_C_TEXT}: what an integration of the "
    "printed equations with steps of about 1 ms sees, as the paper's own.",
    settings={**SMALL.settings, "cutoff": DEFAULT_V_C},
    applies=has_dry_friction,
    reading=AS_INTEGRATED,
    in_chain=applies_to_every_scene,
)
# Motion as in model EXACT, equations (3.9)-(3.13); sliding slower than v_c does not count for the peak acceleration
EXACT_AS_INTEGRATED = _model_after(
    EXACT,
    {"mu_i": _RESOLVED_PEAK},
    key="resolved",
    title="exact equations, as integrated",
    adds="The whole sphere, read like the small equations as integrated.",
    settings={**EXACT.settings, "cutoff": DEFAULT_V_C},
    applies=has_dry_friction,
    reading=AS_INTEGRATED,
    in_chain=applies_to_every_scene,
)
# Assumptions that differ in models with regularized friction: friction law, and what counts as the peak in mu_i
_REGULARIZED_FRICTION_ASSUMPTIONS = {
    "friction": f"the same Coulomb law, times |v| / v_reg below v_reg = {V_REG_TEXT}",
    "mu_i": _PEAK,
}
# Small-vibration equations with friction that is linear below v_reg; REGULARIZED adds the exact geometry
SMALL_REGULARIZED = _model_after(
    SMALL_AS_INTEGRATED,
    _REGULARIZED_FRICTION_ASSUMPTIONS,
    key="small-regularised",
    title="small equations, v_reg",
    effect="regularized friction",
    adds=f"The printed equations with friction that is linear below v_reg = {V_REG_TEXT}, as most codes have it: what "
    "geometry adds under that law is seen from here.",
    settings={"equations": "small", "regularization": DEFAULT_V_REG},
    in_chain=applies_to_no_scene,
    seconds=0.001,
)
# Exact equations of large displacements with friction that is linear below v_reg, as in Exudyn
REGULARIZED = _model_after(
    EXACT_AS_INTEGRATED,
    _REGULARIZED_FRICTION_ASSUMPTIONS,
    key="regularised",
    title="exact equations, v_reg",
    effect="regularized friction",
    adds=f"Friction linear below v_reg = {V_REG_TEXT}, as an engine has it: no true rest, no jump at a stop.",
    settings={"equations": "exact", "regularization": DEFAULT_V_REG},
    applies=has_dry_friction,
    seconds=0.001,
)
# Model of Exudyn: spheres in hollow spheres with an elastic contact, and bodies that only translate
TRANSLATIONAL = _model_after(
    REGULARIZED,
    {
        "equations": "Newton-Euler of the bodies, assembled by Exudyn",
        "geometry": "exact spheres: support of radius r in a depression of radius R; a plane for a flat slider",
        "friction": f"the same Coulomb law, times |v| / v_reg below v_reg = {V_REG_TEXT}, "
        "or mu = f_c |v| if lubricated",
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
    settings={"model": "translational", "regularization": DEFAULT_V_REG},
    batch=2,
    applies=applies_to_every_scene,
    most=16,
    seconds=0.06,
)
# Model of Exudyn whose bodies also rotate, with heights and sizes, on supports that may lift off
SPATIAL = _model_after(
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
    settings={"model": "spatial", "regularization": DEFAULT_V_REG},
    batch=1,
    applies=has_spatial_data,
    most=16,
    symmetric=is_mirror_symmetric,
    seconds=0.22,
)

MODEL_HIERARCHY: tuple[Model, ...] = (  # all models for rigid friction and stiff bars, from simple to complete
    SMALL, EXACT, SMALL_AS_INTEGRATED, EXACT_AS_INTEGRATED, SMALL_REGULARIZED, REGULARIZED, TRANSLATIONAL, SPATIAL,
)  # fmt: skip
# Further pairs that show an effect, besides successive models of the chain. Each row: name of the effect, end of the
# pair's key, and both models.
BESIDE_THE_CHAIN = (
    (EXACT.effect, "supremum", SMALL, EXACT),
    (EXACT_AS_INTEGRATED.effect, "regularized", SMALL_REGULARIZED, REGULARIZED),
    (REGULARIZED.effect, "small", SMALL_AS_INTEGRATED, SMALL_REGULARIZED),
)


def _soften_model(model: Model, applies: Callable[[Scene], bool]) -> Model:
    """Return `model` with bars softened by the weight that they carry, for scenes that `applies` accepts."""
    return _model_after(
        model,
        {"links": "bars as soft as the weight that they carry makes them"},
        key=f"{SOFTENED}{model.key}",
        title=f"{model.title}, softened bars",
        effect="softening of the bars",
        adds="Bars under the weight that they carry: it makes them softer in sway, and they would buckle under more.",
        settings={**model.settings, "softened": True},
        applies=applies,
    )


# Models of Exudyn with bars softened by the weight that they carry, for scenes that give bars without this softening
SOFTENED_TRANSLATIONAL = _soften_model(TRANSLATIONAL, has_only_planar_unloaded_bars)
SOFTENED_SPATIAL = _soften_model(SPATIAL, has_spatial_unloaded_bars)  # spatial model, bars softened by weight


# SMALL_AS_INTEGRATED with friction that is rigid before it slides, for scenes whose friction yields elastically
SMALL_RIGID_FRICTION = _model_after(
    SMALL_AS_INTEGRATED,
    {"friction": "set-valued Coulomb, rigid before it slides, where the scene's yields"},
    key="rigid",
    title=f"small equations, rigid friction, {AS_INTEGRATED}",
    adds="The printed equations with friction that is rigid before it slides, in a scene whose friction yields; read "
    f"at rest and while sliding faster than v_c = {V_C_TEXT}.",
    applies=has_yielding_friction,
    rigid=True,
)
# Words for the friction law of scenes whose friction yields; mu is the friction coefficient.
_YIELDS = "elastic up to mu N before it slides, mu constant or of the slip velocity"


def _tell_of_yielding(model: Model, only: bool) -> Model:
    """
    Return `model` with texts that mention friction which yields elastically before it slides.

    only: whether friction yields in every scene, so that the texts on rigid friction are dropped.
    """
    if model.applies is has_dry_friction:  # used with rigid friction only: its texts stay
        return model
    friction = _YIELDS if only else f"{model.assumptions['friction']}; where the scene says so, {_YIELDS}"
    told = _model_after(model, {"friction": friction} | ({"mu_i": _PEAK} if only else {}))
    told = replace(told, title=model.title.removesuffix(f", {LITERAL_SUPREMUM}")) if only else told
    if model.key != SMALL.key:
        return told
    yields = "Friction that yields elastically before it slides never sticks: then no acceleration jumps."
    adds = f"The paper's small-vibration equations (4.3)-(4.4). {yields}" if only else f"{model.adds} {yields}"
    return replace(told, effect="yielding friction", adds=adds)


def with_steps_of_scenes(hierarchy: Sequence[Model], scenes: Sequence[Scene]) -> tuple[Model, ...]:
    """
    Return the models, plus those that some scene needs: with softened bars; with rigid friction if friction yields.

    Models with softened bars are added at the end. The one whose friction stays rigid comes first.
    """
    functions = {model.amplification for model in hierarchy}
    steps = (SOFTENED_TRANSLATIONAL, SOFTENED_SPATIAL)
    added = (model for model in steps if model.amplification in functions and any(map(model.applies, scenes)))
    yields = [has_yielding_friction(scene) for scene in scenes]
    if SMALL_RIGID_FRICTION.amplification in functions and any(yields):
        hierarchy = (SMALL_RIGID_FRICTION, *(_tell_of_yielding(model, all(yields)) for model in hierarchy))
    return (*hierarchy, *added)
