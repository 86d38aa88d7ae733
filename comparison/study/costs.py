"""
What a phase pair of a scene costs under a model: recorded, guessed from what was recorded, or tried.

The record (accuracy_record.json) is the one table of costs. Scenes that are not in it are guessed from those that are;
a guess may be wrong by much, so `--plan` tries such scenes at a few phase pairs.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparison.study.accuracy_record import recorded
from comparison.study.batches import imported
from comparison.study.models import MODEL_HIERARCHY, REFERENCE_TOLERANCE, Model
from comparison.study.speedup import speedup
from reference.problem import Scene, SceneError, load_scene

USUAL = {"reference": REFERENCE_TOLERANCE, "engine": 1e-3}  # tolerances of the recorded seconds per point
DURATION, BODIES = 20.0, 2  # of the recorded scenes
STEPS_AT_SAMPLES = 6.0  # times the cost of a point, for the shipped records: steps end at their samples
TYPICAL = "fig3-I"  # scene from which nothing is left out but what is left out of every scene
# phase pairs of a scene that is tried. Of 16 pairs of the reference every thread has one at a time, and each costs
# twice what it does in a batch
TRIAL_POINTS = {"reference": 96, "engine": 2}
# of processor time, for the pairs of a trial beyond the first: links of 10 us take seconds each
MAX_TRIAL_SECONDS = 4.0
TRIAL_SCENES = 2  # scenes that are tried: a family's others cost what these do
SEED = 4


def at_samples(scene: Scene) -> float:
    """How many times more a motion costs whose steps end at the samples of a record."""
    return STEPS_AT_SAMPLES if scene.recorded else 1.0


def is_recorded(model: Model) -> bool:
    """
    Whether the model is one of the record, and not another under its name.

    Whatever work it may take, and whether its bars are softened.
    """
    settings = {key: value for key, value in model.settings.items() if key not in ("max_work", "softened")}
    return any(
        (entry.key, entry.amplification, entry.settings) == (model.recorded_key, model.amplification, settings)
        for entry in MODEL_HIERARCHY
    )


def seconds_per_point(scene: Scene, model: Model, full: bool = False) -> float:
    """
    Processor time of a phase pair at the usual tolerance, s, without computing one.

    Parameters
    ----------
    scene : Scene
    model : Model
        Another model under a recorded key is taken for that of the record.
    full : bool
        Whether nothing is reduced.

    Returns
    -------
    float
        As recorded, or guessed: in proportion to the duration and the number of bodies.
    """
    in_scene = recorded().seconds.get(scene.digest(), {})
    key = model.recorded_key
    if key in in_scene and not full:
        return in_scene[key]
    alike = [seconds[key] for seconds in recorded().seconds.values() if key in seconds]
    saved = speedup(load_scene(TYPICAL), model) / (1.0 if full else speedup(scene, model))
    size = scene.duration / DURATION * len(scene.bodies) / BODIES
    return float(np.mean(alike or [1.0])) * saved * size * at_samples(scene)


def tried_costs(
    scenes: Sequence[Scene], hierarchy: Sequence[Model], full: bool = False
) -> dict[tuple[str, str], float]:
    """
    Processor time of a phase pair of the scenes that are not in the record, measured at a few pairs.

    Parameters
    ----------
    scenes : sequence of Scene
    hierarchy : sequence of Model
        Models that are not those of the record are not tried.
    full : bool
        Whether nothing is reduced.

    Returns
    -------
    dict
        s by name of the scene and key of the model. Of many scenes the first and the last are tried; the others cost
        what the guess says, corrected by these.
    """
    unknown = [scene for scene in scenes if full or scene.digest() not in recorded().seconds]
    if not unknown:
        return {}
    places = np.unique(np.linspace(0, len(unknown) - 1, TRIAL_SCENES).astype(int))
    seconds: dict[tuple[str, str], float] = {}
    for model in filter(is_recorded, hierarchy):
        tried = {
            scene.name: _trial_run(scene, model, full) for scene in (unknown[n] for n in places) if model.applies(scene)
        }
        guessed = {scene.name: seconds_per_point(scene, model, full) for scene in unknown if model.applies(scene)}
        factor = float(np.mean([tried[name] / guessed[name] for name in tried])) if tried else 1.0
        seconds |= {(name, model.key): tried.get(name, factor * guess) for name, guess in guessed.items()}
    return seconds


def _trial_run(scene: Scene, model: Model, full: bool) -> float:
    """Processor time of a phase pair, s, from as many as the trial may take, or the first alone."""
    points = 1 if scene.recorded else TRIAL_POINTS[model.side]
    phases = np.random.default_rng(SEED).uniform(0.0, 2.0 * np.pi, (points, 2))
    asked = {**model.settings, "tolerance": USUAL[model.side], **({"full": True} if full else {})}
    answer = imported(model.amplification)
    try:
        answer(scene.with_values({"duration": min(0.2, scene.duration)}), phases[:1], **asked)
    except SceneError:  # softened bars that buckle: refused before any step
        return 0.0
    seconds = _seconds(answer, scene, phases[:1], asked)
    if seconds * points <= MAX_TRIAL_SECONDS:
        return _seconds(answer, scene, phases, asked) / points
    others = phases[1 : int(MAX_TRIAL_SECONDS / seconds)]
    if len(others):
        seconds += _seconds(answer, scene, others, asked)
    return seconds / (1 + len(others))


def _seconds(answer: Callable[..., Any], scene: Scene, phases: NDArray[np.float64], asked: Mapping[str, Any]) -> float:
    """Processor time of one call, s."""
    clock = time.process_time()
    answer(scene, phases, **asked)
    return time.process_time() - clock
