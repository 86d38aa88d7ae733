"""What a phase pair of a scene costs under a model on this machine: from the record, or from a pilot of the scene."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from comparison.study.accuracy_record import recorded
from comparison.study.batches import imported
from comparison.study.benchmark import machine_benchmark
from comparison.study.models import MODEL_HIERARCHY, REFERENCE_TOLERANCE, Model, at_samples
from reference.problem import Scene

USUAL = {"reference": REFERENCE_TOLERANCE, "engine": 1e-3}  # tolerances of the recorded seconds per point
# phase pairs of a scene that is not in the record; others go by these. Of 16 pairs of the reference every thread has
# one at a time, and each costs twice what it does in a batch
TRIAL_POINTS = {"reference": 96, "translational": 3}
TRIAL_SCENES = 2  # scenes that are tried: a family's others cost what these do
SEED = 4


def is_recorded(model: Model) -> bool:
    """Whether the model is the one of the record, and not another under its name."""
    return any(
        (entry.key, entry.amplification, entry.settings) == (model.key, model.amplification, model.settings)
        for entry in MODEL_HIERARCHY
    )


@dataclass(frozen=True)
class Costs:
    """
    seconds: processor time of a point at the usual tolerance, by name of the scene and key of the model, of the models
    of the record alone. measured: whether this machine was; else it is taken for that of the record. speed: how many
    times as long as there it takes, about.
    """

    seconds: Mapping[tuple[str, str], float]
    measured: bool
    speed: float = 1.0

    def of(self, scene: Scene, model: Model, tolerance: float) -> float | None:
        """Processor time of a point, s; None for a model that is not in the record."""
        usual = self.seconds.get((scene.name, model.key))
        return None if usual is None else usual * recorded().accuracy[model.key].cost(tolerance)


def costs(scenes: Sequence[Scene], hierarchy: Sequence[Model], measure: bool, full: bool = False) -> Costs:
    """
    Seconds per point of every model on every scene.

    A scene of the record costs what was recorded, times what a fixed piece of work takes here beside what it took then.
    Another is tried at a few phase pairs if `measure`, and else in proportion to its duration.

    Parameters
    ----------
    scenes : sequence of Scene
    hierarchy : sequence of Model
    measure : bool
        Whether this machine is measured, which takes a second or two.
    full : bool
        Whether nothing is reduced.

    Returns
    -------
    Costs
    """
    record, models = recorded(), [model for model in hierarchy if is_recorded(model)]
    now = machine_benchmark() if measure and models else record.machine_benchmark
    speed = {side: now[side] / record.machine_benchmark[side] for side in now}
    seconds: dict[tuple[str, str], float] = {}
    uncalibrated: list[Scene] = []
    for scene in scenes:
        recorded_seconds = record.seconds.get(scene.digest())
        if recorded_seconds is None or full:
            uncalibrated.append(scene)
            continue
        seconds |= {
            (scene.name, r.key): recorded_seconds[r.key] * speed[r.side]
            for r in models
            if r.key in recorded_seconds and r.applies(scene)
        }
    if uncalibrated and models:
        seconds |= _uncalibrated(uncalibrated, models, speed, measure, full)
    return Costs(seconds, measure and bool(models), float(np.mean(list(speed.values()))))


def _uncalibrated(
    scenes: Sequence[Scene], models: Sequence[Model], speed: Mapping[str, float], measure: bool, full: bool
) -> dict[tuple[str, str], float]:
    """Seconds per point of scenes that are not in the record."""
    usual = {model.key: _typical(model) * speed[model.side] for model in models}
    phased = [
        scene for scene in scenes if not scene.recorded
    ]  # a recorded motion has one point: trying it is all of it
    tried = [phased[place] for place in np.unique(np.linspace(0, len(phased) - 1, TRIAL_SCENES).astype(int)) if phased]
    factors: dict[str, list[float]] = {"reference": [1.0], "engine": [1.0]}
    trials: dict[tuple[str, str], float] = {}
    if measure:
        factors = {"reference": [], "engine": []}
        for scene in tried:
            for model in models:
                key = model.key if model.side == "engine" else "reference"
                if key in TRIAL_POINTS and model.applies(scene):
                    seconds = _trial_run(
                        scene, model, TRIAL_POINTS[key] if len(tried) == 1 else max(1, TRIAL_POINTS[key] // 2), full
                    )
                    trials[scene.name, model.key] = seconds
                    factors[model.side].append(seconds / (usual[model.key] * scene.duration / 20.0))
    factor = {side: float(np.mean(values)) if values else 1.0 for side, values in factors.items()}
    return {
        (scene.name, model.key): trials.get(
            (scene.name, model.key), usual[model.key] * factor[model.side] * scene.duration / 20.0 * at_samples(scene)
        )
        for scene in scenes
        for model in models
        if model.applies(scene)
    }


def _typical(model: Model) -> float:
    """Mean over the recorded scenes."""
    return float(np.mean([seconds[model.key] for seconds in recorded().seconds.values() if model.key in seconds]))


def _trial_run(scene: Scene, model: Model, points: int, full: bool) -> float:
    """Processor time of a point, s, from a few."""
    phases = np.random.default_rng(SEED).uniform(0.0, 2.0 * np.pi, (points, 2))
    asked = {**model.settings, "tolerance": USUAL[model.side], **({"full": True} if full else {})}
    answer = imported(model.amplification)
    answer(scene.with_values({"duration": min(0.2, scene.duration)}), phases[:1], **asked)
    clock = time.process_time()
    answer(scene, phases, **asked)
    return (time.process_time() - clock) / points
