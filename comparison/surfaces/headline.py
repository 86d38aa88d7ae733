"""Headline of a body: how much the last model differs from the paper's equations, and why, in numbers and in words."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

from comparison.result_types import Number, Phases, Text, result
from comparison.study.models import Model, chain_of, models_of, partner_of
from comparison.surfaces.body_comparison import BodyComparison
from comparison.surfaces.differences import Difference
from comparison.surfaces.statements import name_engine, word_engine, word_engine_without_values, word_headline
from comparison.surfaces.surfaces import count_outcomes
from comparison.surfaces.waterfall import NAN, Waterfall

# An effect is named as a cause of the total difference if it is above this share of it. That an effect depends on the
# order of the effects is stated if the change is above this share of the effect.
NAMED_SHARE = 0.2
# For each effect: key of another pair of models that differ by it, with the effects in another order, and that order in
# words
SAME_EFFECT_PAIRS = {
    "geometry": ("geometry-regularized", "under regularized friction"),
    "regularized-friction": ("regularized-friction-small", "without geometry"),
}
# For each effect: key of the pair of models that differ by it and whose peaks include the one-sided limits of the
# acceleration at stops (literal supremum)
SUPREMUM_PAIRS = {"geometry": "geometry-supremum"}


@result
class Effect:
    """
    An effect, by which a model differs from the one before: the mean change of a body's amplification.

    With the effects in another order the change may be another one, which is stated beside it.
    """

    effect: Annotated[str, "name of the effect"]
    model: Annotated[str, "key of the model that has it, the one before in the chain has not"]
    mean: Annotated[Number, "mean as integrated, relative to mu of the first model of the chain"]
    error: Annotated[Number, "error of the mean, numerical and of sampling; null where the grid does not tell"]
    share: Annotated[Number, "mean over the mean of the total; null where the total is not resolved"]
    resolved: Annotated[bool, "whether the mean exceeds its sampling error, and five times the numerical one"]
    elsewhere: Annotated[Number, "mean of the same effect in another order of the steps; null where there is no other"]
    order: Annotated[str, "which other order that is; empty without one"]
    interaction: Annotated[Number, "elsewhere less mean: what the effect has in common with another one"]
    supremum: Annotated[Number, "mean of the effect between literal suprema, relative to that of the small equations"]

    @property
    def depends_on_order(self) -> bool:
        """Return whether the effect changes by more than a fifth if effects are added in another order."""
        return abs(self.interaction) > NAMED_SHARE * abs(self.mean)


# Effect of size zero, in place of one that a scene does not have
NO_EFFECT = Effect(
    effect="",
    model="",
    mean=0.0,
    error=0.0,
    share=NAN,
    resolved=True,
    elsewhere=NAN,
    order="",
    interaction=NAN,
    supremum=NAN,
)


@result
class Headline:
    """
    Total difference of one body between the first and the last model, in numbers and in one sentence.

    All sizes are as integrated and relative to the amplification by the first model, unless they say otherwise.
    """

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    name: Annotated[str, "name of the body"]
    reading: Annotated[str, "reading of (5.1) that both models have"]
    first: Annotated[str, "key of the first model, which is the base"]
    first_name: Annotated[str, "the same in words"]
    second: Annotated[str, "key of the last model"]
    second_name: Annotated[str, "the same in words"]
    mean: Annotated[Number, "mean of the signed difference over the phase pairs where both models have a value"]
    error: Annotated[Number, "error of the mean, numerical and of sampling; null where the grid does not tell"]
    resolved: Annotated[bool, "whether the mean exceeds its sampling error, and five times the numerical one"]
    spread: Annotated[Number, "standard deviation of the signed difference over the same phase pairs"]
    low: Annotated[Number, "smallest signed difference"]
    low_error: Annotated[Number, "error estimate of it"]
    low_phases: Annotated[Phases, "(alpha1, alpha2) of it, rad"]
    high: Annotated[Number, "largest signed difference"]
    high_error: Annotated[Number, "error estimate of it"]
    high_phases: Annotated[Phases, "(alpha1, alpha2) of it, rad"]
    phases_per_axis: Annotated[int, "of the grid of phase pairs that both models were asked for; 1 under a record"]
    points: Annotated[int, "phase pairs of this grid where both models have a value"]
    independent: Annotated[int, "of these, not related by a symmetry of the scene"]
    resolved_share: Annotated[Number, "fraction of these where the difference exceeds five times its error estimate"]
    beyond_error: Annotated[Number, "fraction of these where the difference exceeds both error estimates together"]
    maximum: Number
    """signed; the largest absolute difference of the first and any engine model, at any phase pair where both have a
    value"""
    maximum_error: Annotated[Number, "error estimate of the maximum"]
    maximum_phases: Annotated[Phases, "(alpha1, alpha2) of the maximum, rad; null under a record"]
    maximum_model: Annotated[str, "key of the engine model that has the maximum"]
    effects: Annotated[tuple[Effect, ...], "in the order of the chain"]
    causes: tuple[str, ...]
    """names of the effects whose resolved means exceed a fifth of the total, largest first; empty where the total is
    not resolved"""
    main_cause: str
    """the largest of the causes; empty where the errors of the means leave open which is larger"""
    like_for_like: Number
    """largest absolute difference of the two codes given the same equations and friction law, relative to the
    equations"""
    like_for_like_met: Annotated[bool | None, "whether it is within twice both error estimates; null without one"]
    like_for_like_ratio: Annotated[Number, "largest of it in units of both error estimates together; null without one"]
    supremum_mean: Annotated[Number, "mean by which the literal supremum of the first model's equations is higher"]
    supremum_error: Annotated[Number, "error of that mean; null where the grid does not tell"]
    supremum_maximum: Annotated[Number, "largest of it over the phases"]
    supremum_phases: Annotated[Phases, "(alpha1, alpha2) of the largest, rad"]
    engines: Annotated[tuple[Text, ...], "a sentence for each engine of the user"]
    sentence: Annotated[Text, "all that in words"]

    @property
    def statement(self) -> str:
        """Return the sentence on the total difference without the scene's name, for use below a heading that has it."""
        return self.sentence.removeprefix(f"{self.scene}, ")

    @property
    def compared(self) -> bool:
        """Return whether two models have a value in common."""
        return self.first != self.second and self.points > 0

    @property
    def within_error(self) -> bool:
        """Return whether the size of the mean difference is at most its error."""
        return abs(self.mean) <= self.error

    def find_effect(self, name: str) -> Effect:
        """Return the effect that has this name."""
        return next(effect for effect in self.effects if effect.effect == name)


def make_headline(comparison: BodyComparison, bars: Waterfall) -> Headline:
    """Return the total difference of one body in numbers and words. bars: its split into effects that add up to it."""
    total, pair, largest = comparison.total, comparison.total_pair, bars.largest
    scene = comparison.scene
    effects = compute_effects(comparison)
    causes = select_causes(effects, total)
    alike, supremum = comparison.rows.get("like-for-like"), comparison.rows.get("supremum")
    numbers = Headline(
        scene=scene.name,
        body=comparison.body,
        name="platform" if comparison.body == 1 else f"body {comparison.body}",
        reading=total.reading,
        first=pair.first.key,
        first_name=_word_model_name(pair.first, chain_of(scene, comparison.study.hierarchy)),
        second=pair.second.key,
        second_name=_word_model_name(pair.second, ()),
        mean=total.mean,
        error=total.error,
        resolved=total.mean_is_resolved,
        spread=total.spread,
        low=total.low,
        low_error=total.low_error,
        low_phases=total.low_phases,
        high=total.high,
        high_error=total.high_error,
        high_phases=total.high_phases,
        phases_per_axis=total.phases_per_axis,
        points=total.asked - total.unanswered,
        independent=total.independent,
        resolved_share=total.resolved,
        beyond_error=total.beyond_error,
        maximum=largest.total.size,
        maximum_error=largest.total.error,
        maximum_phases=largest.phases,
        maximum_model=largest.total.model,
        effects=effects,
        causes=tuple(effect.effect for effect in causes),
        main_cause=find_main_cause(effects, causes),
        like_for_like=alike.maximum if alike else NAN,
        like_for_like_met=alike.agrees if alike else None,
        like_for_like_ratio=alike.ratio if alike else NAN,
        supremum_mean=supremum.mean if supremum else NAN,
        supremum_error=supremum.error if supremum else NAN,
        supremum_maximum=supremum.high if supremum else NAN,
        supremum_phases=supremum.high_phases if supremum else (NAN, NAN),
        engines=word_engines(comparison),
        sentence="",
    )
    return replace(numbers, sentence=word_headline(numbers))


def word_engines(comparison: BodyComparison) -> tuple[str, ...]:
    """Return a sentence for each engine of the user, also for one without a value to compare."""
    study, scene = comparison.study, comparison.scene
    compared, left_out = {pair.key: pair for pair in comparison.pairs}, study.left_out(scene)
    sentences = []
    for engine in models_of(scene, study.hierarchy):
        if engine.side != "user":
            continue
        if engine.key in compared:
            like = compared[engine.key].first
            sentences.append(word_engine(comparison.rows[engine.key], engine.title, like.title))
            continue
        like = partner_of(engine, scene, study.hierarchy)
        missing, name = (engine, name_engine(engine.title)) if engine.key in left_out else (like, f"the {like.title}")
        outcomes = count_outcomes(comparison.surfaces, scene.name, missing)
        sentences.append(word_engine_without_values(engine.title, like.title, name, outcomes))
    return tuple(sentences)


def compute_effects(comparison: BodyComparison) -> tuple[Effect, ...]:
    """Return the effect that each model adds to the one before, in the order of the models."""
    total, rows = comparison.total, comparison.rows
    effects = []
    for row in comparison.consecutive_rows:
        key, order = SAME_EFFECT_PAIRS.get(row.pair, ("", ""))
        other, suprema = rows.get(key), rows.get(SUPREMUM_PAIRS.get(row.pair, ""))
        effects.append(
            Effect(
                effect=row.effect,
                model=row.second,
                mean=row.mean,
                error=row.error,
                share=row.mean / total.mean if total.mean_is_resolved else NAN,
                resolved=row.mean_is_resolved,
                elsewhere=other.mean if other else NAN,
                order=order if other else "",
                interaction=other.mean - row.mean if other else NAN,
                supremum=suprema.mean if suprema else NAN,
            )
        )
    return tuple(effects)


def select_causes(effects: Sequence[Effect], total: Difference) -> list[Effect]:
    """
    Return the effects that are named as causes of the total difference, the largest first.

    They are resolved (their means exceed their errors, see `Effect`) and above a fifth of the total. There is none if
    the total itself is not resolved.
    """
    if not total.mean_is_resolved:
        return []
    named = [effect for effect in effects if effect.resolved and abs(effect.mean) > NAMED_SHARE * abs(total.mean)]
    return sorted(named, key=lambda effect: -abs(effect.mean))


def find_main_cause(effects: Sequence[Effect], causes: Sequence[Effect]) -> str:
    """Return the name of the largest effect; "" if it is not in `causes`, or if errors leave open which it is."""
    first, second = (sorted([*effects, NO_EFFECT, NO_EFFECT], key=lambda effect: -abs(effect.mean)))[:2]
    told = abs(first.mean) - abs(second.mean) > math.hypot(first.error, second.error)
    return first.effect if told and first in causes else ""


def _word_model_name(model: Model, chain: Sequence[Model]) -> str:
    """Return the name of a model in a sentence. chain: models of the scene, of which the first is the paper's."""
    if model.side == "engine":
        return f"Exudyn ({model.title.replace(' engine', '')})"
    return "the paper's equations" if chain and model is chain[0] else f"the {model.title}"
