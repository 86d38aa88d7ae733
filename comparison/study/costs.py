"""What a phase pair of a scene costs under a model on this machine: from the record, or from a pilot of the scene."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from comparison.study.accuracy_record import recorded
from comparison.study.batches import imported
from comparison.study.benchmark import yardsticks
from comparison.study.models import LADDER, REFERENCE_TOLERANCE, Rung, at_samples
from reference.problem import Scene

USUAL = {"reference": REFERENCE_TOLERANCE, "engine": 1e-3}  # tolerances of the recorded seconds per point
# phase pairs of a scene that is not in the record; others go by these. Of 16 pairs of the reference every thread has
# one at a time, and each costs twice what it does in a tile
PILOT = {"reference": 96, "translational": 3}
PILOTS = 2  # scenes that are tried: a family's others cost what these do
SEED = 4


def known(rung: Rung) -> bool:
    """Whether the model is the one of the record, and not another under its name."""
    return any(
        (own.key, own.amplification, own.settings) == (rung.key, rung.amplification, rung.settings) for own in LADDER
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

    def of(self, scene: Scene, rung: Rung, tolerance: float) -> float | None:
        """Processor time of a point, s; None for a model that is not in the record."""
        usual = self.seconds.get((scene.name, rung.key))
        return None if usual is None else usual * recorded().reach[rung.key].cost(tolerance)


def costs(scenes: Sequence[Scene], ladder: Sequence[Rung], measure: bool, full: bool = False) -> Costs:
    """
    Seconds per point of every model on every scene; `measure`: of this machine, which takes a second or two.

    A scene of the record costs what was recorded, times what a fixed piece of work takes here beside what it took then.
    Another is tried at a few phase pairs if `measure`, and else in proportion to its duration.
    """
    record, models = recorded(), [rung for rung in ladder if known(rung)]
    now = yardsticks() if measure and models else record.yardsticks
    speed = {side: now[side] / record.yardsticks[side] for side in now}
    found: dict[tuple[str, str], float] = {}
    strangers: list[Scene] = []
    for scene in scenes:
        own = record.seconds.get(scene.digest())
        if own is None or full:
            strangers.append(scene)
            continue
        found |= {(scene.name, r.key): own[r.key] * speed[r.side] for r in models if r.key in own and r.applies(scene)}
    if strangers and models:
        found |= _strangers(strangers, models, speed, measure, full)
    return Costs(found, measure and bool(models), float(np.mean(list(speed.values()))))


def _strangers(
    scenes: Sequence[Scene], models: Sequence[Rung], speed: Mapping[str, float], measure: bool, full: bool
) -> dict[tuple[str, str], float]:
    """Seconds per point of scenes that are not in the record."""
    usual = {rung.key: _typical(rung) * speed[rung.side] for rung in models}
    phased = [
        scene for scene in scenes if not scene.recorded
    ]  # a recorded motion has one point: trying it is all of it
    tried = [phased[place] for place in np.unique(np.linspace(0, len(phased) - 1, PILOTS).astype(int)) if phased]
    factors: dict[str, list[float]] = {"reference": [1.0], "engine": [1.0]}
    pilots: dict[tuple[str, str], float] = {}
    if measure:
        factors = {"reference": [], "engine": []}
        for scene in tried:
            for rung in models:
                key = rung.key if rung.side == "engine" else "reference"
                if key in PILOT and rung.applies(scene):
                    seconds = _pilot(scene, rung, PILOT[key] if len(tried) == 1 else max(1, PILOT[key] // 2), full)
                    pilots[scene.name, rung.key] = seconds
                    factors[rung.side].append(seconds / (usual[rung.key] * scene.duration / 20.0))
    factor = {side: float(np.mean(values)) if values else 1.0 for side, values in factors.items()}
    return {
        (scene.name, rung.key): pilots.get(
            (scene.name, rung.key), usual[rung.key] * factor[rung.side] * scene.duration / 20.0 * at_samples(scene)
        )
        for scene in scenes
        for rung in models
        if rung.applies(scene)
    }


def _typical(rung: Rung) -> float:
    """Mean over the recorded scenes."""
    return float(np.mean([own[rung.key] for own in recorded().seconds.values() if rung.key in own]))


def _pilot(scene: Scene, rung: Rung, points: int, full: bool) -> float:
    """Processor time of a point, s, from a few."""
    phases = np.random.default_rng(SEED).uniform(0.0, 2.0 * np.pi, (points, 2))
    asked = {**rung.settings, "tolerance": USUAL[rung.side], **({"full": True} if full else {})}
    answer = imported(rung.amplification)
    answer(scene.with_values({"duration": min(0.2, scene.duration)}), phases[:1], **asked)
    clock = time.process_time()
    answer(scene, phases, **asked)
    return (time.process_time() - clock) / points
