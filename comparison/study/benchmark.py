"""How fast this machine is beside the one of the record: a fixed piece of work of each side, in processor time."""

from __future__ import annotations

import time

import numpy as np

from comparison.study.batches import imported
from comparison.study.models import EXACT, TRANSLATIONAL, Model
from reference.problem import load_scene

SCENE = "fig3-I"
REFERENCE_POINTS, ENGINE_POINTS = 64, 1  # a quarter and half of a second
SEED = 3


def machine_benchmark() -> dict[str, float]:
    """Processor time of the fixed work of the "reference" and the "engine", s, after a warm-up."""
    return {
        "reference": _seconds(EXACT, 1e-6, REFERENCE_POINTS),
        "engine": _seconds(TRANSLATIONAL, 1e-3, ENGINE_POINTS),
    }


def _seconds(model: Model, tolerance: float, points: int) -> float:
    scene = load_scene(SCENE)
    phases = np.random.default_rng(SEED).uniform(0.0, 2.0 * np.pi, (points, 2))
    answer = imported(model.amplification)
    answer(scene.with_values({"duration": 0.2}), phases[:1], **model.settings, tolerance=1e-2)
    clock = time.process_time()
    answer(scene, phases, **model.settings, tolerance=tolerance)
    return time.process_time() - clock
