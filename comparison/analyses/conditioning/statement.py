"""Sentences on how amplification mu_i depends on the smallest slip speed that counts, and on a yield displacement."""

import math
from collections.abc import Sequence

from comparison.analyses.conditioning.analysis import ConditioningCurve
from comparison.wording import word_difference
from reference.problem.readings import AS_INTEGRATED, DEFAULT_V_C, LITERAL_SUPREMUM

# m/s, speeds below which no instrument (the first) and no computation (the second) resolves sliding
LOW_V_C, LOWEST_V_C = 1e-6, 1e-12
ILL_CONDITIONED_CHANGE = 1e-3  # amplification is ill-conditioned if slip below LOW_V_C changes it by this share
MODEL_WORDS = {"translational": "in translation", "spatial": "with bodies that turn"}  # Exudyn's models in words


def conditioning_line(result: Sequence[ConditioningCurve] | None) -> str:
    """
    Return a sentence on the scene and body whose amplification changes most if sliding slower than LOW_V_C counts, too.

    It is empty without a scene that has phases and dry friction. The sizes in it are relative to the literal supremum,
    and their errors contain that of sampling.
    """
    found = [curve for curve in result or () if curve.grid and curve.speed == "v_c" and _reaches_deepest_speed(curve)]
    if not found:
        return ""
    curve = max(found, key=lambda each: abs(_relative_mean_at(each, LOW_V_C)[0]))
    size, error = _relative_mean_at(curve, LOW_V_C)
    pairs = f"{curve.grid} × {curve.grid} phases"
    integrated, deep, deepest = (_write_size(*_relative_mean_at(curve, v)) for v in (DEFAULT_V_C, LOW_V_C, LOWEST_V_C))
    values = (
        f"relative to it, mu_{curve.body} of {curve.scene} is {integrated} where speeds "
        f"above {speed_text(DEFAULT_V_C)} m/s count (as integrated), {deep} above {speed_text(LOW_V_C)} m/s, "
        f"{deepest} above {speed_text(LOWEST_V_C)} m/s (mean of {pairs})"
    )
    if abs(size) >= ILL_CONDITIONED_CHANGE and abs(size) > error:
        return f"The literal supremum is ill-conditioned: {values}{_word_engine_change(curve, result or ())}."
    if abs(size) + error < ILL_CONDITIONED_CHANGE:
        return f"The literal supremum is well-conditioned: {values}."
    return f"Whether the literal supremum is ill-conditioned, {pairs} do not tell: {values}."


def yielding_line(result: Sequence[ConditioningCurve] | None) -> str:
    """
    Return sentences on the amplification mu_1 of scenes with a yield displacement, at this and at other values of it.

    They are empty without such a scene. The sizes in them are relative to the literal supremum of rigid friction at the
    same phases.
    """
    lines = []
    for scene in dict.fromkeys(curve.scene for curve in result or () if curve.speed == "u_y"):
        curves = [c for c in result or () if (c.scene, c.body, c.speed) == (scene, 1, "u_y") and c.pairs]
        suprema = {curve.damping for curve in curves if curve.reading == LITERAL_SUPREMUM}
        known = [curve for curve in curves if curve.reading != LITERAL_SUPREMUM and curve.damping in suprema]
        lines += [_word_yielding(curve) for curve in known if curve.damping is None]
        lines += [_word_other_damping(curve) for curve in known if curve.damping is not None]
    return " ".join(lines)


def _word_yielding(curve: ConditioningCurve) -> str:
    """Return a sentence on the amplification mu_1 at the scene's own yield displacement, and its range over others."""
    assert curve.own is not None
    place = curve.v.index(curve.own)
    mean, largest = (
        f"{values[place]:.5g} ± {errors[place]:.1g}"
        for values, errors in ((curve.mean, curve.mean_error), (curve.largest, curve.largest_error))
    )
    size = _write_size(curve.relative_mean[place], curve.relative_error[place])
    return (
        f"Friction of {curve.scene} yields at {speed_text(curve.own)} m: mu_1 is {mean} in the mean of "
        f"{curve.grid} × {curve.grid} phases and {largest} at most, the mean {size} from the literal supremum of rigid "
        f"friction; {_word_range(curve)}."
    )


def _word_other_damping(curve: ConditioningCurve) -> str:
    """Return a sentence on the range of mean amplification over yield displacements with other damping of the links."""
    return f"With {name_damping(curve)}, {_word_range(curve)}."


def _word_range(curve: ConditioningCurve) -> str:
    """Return in words the range of the mean amplification over yield displacements, relative to rigid friction."""
    low, high = (f(range(len(curve.v)), key=lambda place: curve.relative_mean[place]) for f in (min, max))
    least, most = (_write_size(curve.relative_mean[place], curve.relative_error[place]) for place in (low, high))
    return (
        f"over yield displacements from {speed_text(curve.v[0])} to {speed_text(curve.v[-1])} m the mean is between "
        f"{least} (at {speed_text(curve.v[low])} m) and {most} (at {speed_text(curve.v[high])} m) from it"
    )


def name_damping(curve: ConditioningCurve) -> str:
    """
    Return in words how the links are damped in the computation of a curve.

    >>> from types import SimpleNamespace
    >>> name_damping(SimpleNamespace(damping=0.05)), name_damping(SimpleNamespace(damping=None))
    ('links damped by 5 %', 'links as stated')
    """
    return "links as stated" if curve.damping is None else f"links damped by {100.0 * curve.damping:g} %"


def speed_text(speed: float) -> str:
    """
    Return a speed (or displacement) as text such as "1e-6".

    >>> speed_text(1e-6), speed_text(0.0003)
    ('1e-6', '3e-4')
    """
    return f"{speed:.0e}".replace("e-0", "e-")


def _reaches_deepest_speed(curve: ConditioningCurve) -> bool:
    """Return whether mean amplification is known at cutoff speeds DEFAULT_V_C, LOW_V_C and LOWEST_V_C, m/s."""
    return curve.reading == AS_INTEGRATED and all(
        math.isfinite(_relative_mean_at(curve, v)[0]) for v in (DEFAULT_V_C, LOW_V_C, LOWEST_V_C)
    )


def _relative_mean_at(curve: ConditioningCurve, speed: float) -> tuple[float, float]:
    """Return the mean relative difference of the amplification at cutoff `speed` from its limit at 0, and its error."""
    place = curve.v.index(speed)
    return curve.relative_mean[place], curve.relative_error[place]


def _word_engine_change(curve: ConditioningCurve, result: Sequence[ConditioningCurve]) -> str:
    """Say, by engine model, how mean amplification changes between the two smallest regularization speeds."""
    engines = [
        each
        for each in result
        if (each.scene, each.body) == (curve.scene, curve.body)
        and each.model in MODEL_WORDS
        and all(map(math.isfinite, each.mean[-2:]))
    ]
    pairs = max((each.pairs for each in engines), default=0)
    compared = [each for each in engines if each.pairs == pairs]
    changes = [f"{_write_size(*_last_change(each))} {MODEL_WORDS[each.model]}" for each in compared]
    if not changes:
        return ""
    before, after = engines[0].v[-2:]
    steps = f"as v_reg falls from {speed_text(before)} to {speed_text(after)} m/s"
    return f"; {steps}, Exudyn's mean of {pairs} phase pairs still changes by {', by '.join(changes)}"


def _last_change(curve: ConditioningCurve) -> tuple[float, float]:
    """Return the relative change of the mean from the second lowest slip speed to the lowest, and its error."""
    (before, after), errors = curve.mean[-2:], curve.mean_error[-2:]
    return after / before - 1.0, sum(errors) / before


def _write_size(size: float, error: float) -> str:
    """Return a relative difference with its error in words."""
    return word_difference(size, error) + ("" if math.isfinite(error) else " (error unknown)")
