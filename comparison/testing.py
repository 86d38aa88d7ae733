"""
Gates for the tests of users: do the equations and an engine, Exudyn or the user's own, agree about a scene? Do the
demands of a building meet their limits?
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from comparison.study.batches import BatchResult, execute_batch
from comparison.study.models import MODEL_HIERARCHY, Model, Pair, pairs_of, with_steps_of_scenes
from comparison.study.study import STUDY_TOLERANCE, Study
from comparison.study.user_models import REFERENCE_MODEL_KEYS, make_user_model
from comparison.surfaces.missing_values import MissingValues, list_missing_values
from comparison.surfaces.model_difference import compute_difference
from comparison.surfaces.surfaces import label_surfaces
from reference.problem import Scene, load_family
from reference.problem.acceptance import DemandLimits
from reference.problem.keys import range_of
from reference.problem.ranges import TOLERANCE_RANGE
from reference.support.arguments import Range, check_choice, check_number, check_whole_number

# Admissible values of `assert_consistent`: relative differences, phases per axis, number of pairs without a value
LIMIT, GRID, FAILED = Range(0.0, 1e6), Range(1, 512), Range(0, 512**2)
STATISTICS = ("largest", "mean")  # statistics of a demand over the motions to which a limit may apply
ENGINE, ENGINE_TITLE = "engine", "your engine"  # key and title of the user's engine


def assert_consistent(
    scene: Scene | str | Path,
    *,
    like_for_like: float | None = None,
    total: float | None = None,
    like_for_like_maximum: float | None = None,
    total_maximum: float | None = None,
    grid: int = 4,
    tolerance: float = STUDY_TOLERANCE,
    engine: Callable[..., Any] | None = None,
    law: str = "regularised",
    failed: int = 0,
) -> None:
    """
    Raise AssertionError where amplifications by equations and engine differ beyond both errors together and a limit.

    Parameters
    ----------
    scene : Scene, str or Path
        A scene, the name of a built-in one, or a scene file; of a file in which values run every scene.
    like_for_like, like_for_like_maximum : float, optional
        Limits on the relative difference of amplification with the same geometry and friction law on both sides: on
        its median over the phases, and on its largest value, for each body.
    total, total_maximum : float, optional
        The same for the difference between the paper's printed equations and the most complete model of Exudyn.
    grid : int
        Phases per axis.
    tolerance : float
        Relative error asked of Exudyn, and of your engine.
    engine : callable, optional
        A function of your own, as `--model` takes it (docs/other-engines.md). The limits like_for_like are then on its
        difference from the equations with its law.
    law : {"regularised", "small-regularised", "resolved", "small-resolved", "exact", "small"}
        Key of the equations that your engine solves, as after "@" in `--model`.
    failed : int
        Phase pairs without a value that are allowed, of the models that are compared together.

    Raises
    ------
    AssertionError
        With one line for each limit that is broken: body, phase pair, both values and their errors. Also where more
        phase pairs than allowed have no value, and where none has both. A status of your engine that does not begin
        with "ok" is no value.
    SceneError, ValueError
        For a scene that cannot be used, an argument outside its range, or no limit at all.

    Notes
    -----
    A difference within the two error estimates together counts as zero. Everything is computed in this process. The
    spatial model is computed for the total difference only, if the scene has the data that it needs.

    Examples
    --------
    >>> from comparison.testing import assert_consistent
    >>> assert_consistent("fig4-dry", like_for_like=1e-3, grid=2)
    """
    __tracebackhide__ = True  # Hides this frame, so that pytest shows the line of the test.
    limits = {
        "like_for_like": like_for_like,
        "like_for_like_maximum": like_for_like_maximum,
        "total": total,
        "total_maximum": total_maximum,
    }
    stated = {name: check_number(name, limit, LIMIT) for name, limit in limits.items() if limit is not None}
    if not stated:
        raise ValueError(f"no limit: give one of {', '.join(limits)}")
    grid = check_whole_number("grid", grid, GRID)
    failed = check_whole_number("failed", failed, FAILED)
    tolerance = check_number("tolerance", tolerance, TOLERANCE_RANGE)
    law = check_choice("law", law, REFERENCE_MODEL_KEYS)
    scenes = [scene] if isinstance(scene, Scene) else load_family(scene).scenes
    broken = [line for each in scenes for line in _broken_limits(each, stated, grid, tolerance, engine, law, failed)]
    if broken:
        raise AssertionError("\n".join(broken))


def _broken_limits(
    scene: Scene,
    stated: Mapping[str, float],
    grid: int,
    tolerance: float,
    engine: Callable[..., Any] | None,
    law: str,
    failed: int,
) -> list[str]:
    """Return a line for each limit that one scene breaks, and for missing values."""
    with_total = any(name.startswith("total") for name in stated)
    hierarchy = [*(with_steps_of_scenes(MODEL_HIERARCHY, (scene,)) if with_total else MODEL_HIERARCHY)]
    if engine is not None:
        hierarchy.append(replace(make_user_model(ENGINE, {"function": engine}, law), title=ENGINE_TITLE))
    pairs = {pair.key: pair for pair in pairs_of(scene, hierarchy)}
    alike = "like-for-like" if engine is None else ENGINE
    asked = {name: pairs["total" if name.startswith("total") else alike] for name in stated}
    needed = {model.key for pair in asked.values() for model in (pair.first, pair.second)}
    study = Study((scene,), grid, tolerance, [model for model in hierarchy if model.key in needed])
    batches = study.batches()
    answers = [execute_batch(batch) for batch in batches]
    surfaces = label_surfaces(study, batches, answers)
    broken: list[str] = []
    for name, limit in stated.items():
        compared, maximum, _ = name.partition("_maximum")
        broken += _word_breaches(surfaces, scene, asked[name], compared, bool(maximum), limit)
    return broken + _word_missing_values(list_missing_values(study, surfaces), answers, failed)


def _word_missing_values(gaps: Sequence[MissingValues], answers: Sequence[BatchResult], failed: int) -> list[str]:
    """
    Return a line for each model with missing values, and the solvers' messages.

    There is no line if at most `failed` values are missing.
    """
    if not sum(gap.points + gap.unusable for gap in gaps) > failed:
        return []
    why = dict.fromkeys(answer.error_message for answer in answers if answer.error_message)
    return [f"{gap.sentence.removesuffix('.')}; {failed} allowed" for gap in gaps] + list(why)


def assert_demands(
    source: str | Path,
    *,
    suite: str | Path | None = None,
    bounds: tuple[float, float] | None = None,
    displacement: float | None = None,
    support_displacement: float | None = None,
    drift_ratio: float | None = None,
    uplift: float | None = None,
    base_shear: float | None = None,
    support_force_max: float | None = None,
    acceleration: float | None = None,
    residual: float | None = None,
    statistic: str | None = None,
    stored: str | Path | None = None,
    within: float = 0.01,
) -> None:
    """
    Raise AssertionError where demands under recorded motions exceed their limits, or differ from stored demands.

    Parameters
    ----------
    source : str or Path
        A scene file, or the name of an example with a record. Motions, scales and other values may run in it.
    suite : str or Path, optional
        Motions in place of those of the file, as after ``phase-resonance ensemble --suite``.
    bounds : tuple of two floats, optional
        Factors of friction of a lower and an upper bound, in place of `isolator.bounds` of the file.
    displacement, support_displacement, uplift, residual : float, optional, m
        Limits of the displacement of the isolator and of a support, of the gap of a support, and of the displacement
        that stays.
    support_force_max : float, optional, N
        Limit of the force of a support, by statics.
    acceleration : float, optional, m/s^2
        Limit of the acceleration of every floor, as integrated.
    drift_ratio, base_shear : float, optional
        Limits of the drift over the height of its story, and of the base shear over the weight.
    statistic : {"largest", "mean"}, optional
        What the limits are on, over the motions.
    stored : str or Path, optional
        Folder of an earlier ensemble, which ``phase-resonance ensemble --out`` wrote: its demands must be met again.
    within : float
        Share of a demand by which it may differ from the stored one besides both numerical errors.

    Raises
    ------
    AssertionError
        With a line for every demand that is not met, or not compared: bound, motion, both numbers, by how much.
    SceneError, ValueError
        For a scene that cannot be used, a folder without an ensemble, or no limit at all.

    Notes
    -----
    Limits that are not given are those of ``[acceptance.demands]`` in the file. Everything is computed in this process,
    by the exact equations. With a limit on the uplift or on the displacement of a support the spatial engine computes
    the motions that govern.

    Examples
    --------
    >>> from comparison.testing import assert_demands
    >>> assert_demands("synthetic-pair", displacement=0.2, base_shear=0.6)
    """
    __tracebackhide__ = True  # Hides this frame, so that pytest shows the line of the test.
    # Loaded on first use, because most tests do not need it
    from comparison.analyses.ensemble.gate import check_demands

    limits = {
        "displacement": displacement, "support_displacement": support_displacement, "drift_ratio": drift_ratio,
        "uplift": uplift, "base_shear": base_shear, "support_force_max": support_force_max,
        "acceleration": acceleration, "residual": residual,
    }  # fmt: skip
    given: dict[str, Any] = {
        name: check_number(name, limit, range_of(DemandLimits, name))
        for name, limit in limits.items()
        if limit is not None
    }
    given |= {} if statistic is None else {"statistic": check_choice("statistic", statistic, STATISTICS)}
    lines = check_demands(source, suite, bounds, given, stored, check_number("within", within, LIMIT))
    if lines:
        raise AssertionError("\n".join(lines))


def _word_breaches(
    surfaces: xr.Dataset, scene: Scene, pair: Pair, name: str, maximum: bool, limit: float
) -> Iterator[str]:
    """
    Yield a line for each body whose difference between two models (`pair`) exceeds the limit.

    name: what the difference is called in the line. maximum: whether its largest value counts, otherwise its median.
    """
    for body in range(1, len(scene.bodies) + 1):
        step = compute_difference(surfaces, scene.name, pair, body)
        if not step.known.any():
            both = f"{pair.first.title} and {pair.second.title}"
            yield f"{scene.name}, body {body}: {name}: no phase pair has a value by {both}"
            continue
        size = np.abs(np.where(step.known, step.size, np.nan))
        beyond = np.where(size <= step.uncertainty, 0.0, size)
        value = float(np.nanmax(beyond) if maximum else np.nanmedian(beyond))
        if value <= limit:
            continue
        row, column = np.unravel_index(np.nanargmax(beyond), beyond.shape)
        at = "under the record" if step.recorded else f"at ({step.alpha1[row]:.4f}, {step.alpha2[column]:.4f}) rad"
        place = surfaces.sel(scene=scene.name, body=body, alpha1=step.alpha1[row], alpha2=step.alpha2[column])
        values = ", ".join(_word_value(place, model) for model in (pair.first, pair.second))
        measure = "maximum" if maximum else "median"
        yield (
            f"{scene.name}, body {body}: {name}: {measure} difference {value:.3g}, allowed {limit:g}; "
            f"largest {beyond[row, column]:.3g} {at}: {values}"
        )


def _word_value(place: xr.Dataset, model: Model) -> str:
    """Return the amplification mu by a model with its error in words."""
    mu, error = (float(place[name].sel(model=model.key)) for name in ("mu", "error"))
    return f"{model.title} {mu:.6g} ± {error:.1g}" if np.isfinite(error) else f"{model.title} {mu:.6g} (error unknown)"
