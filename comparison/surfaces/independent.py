"""How many phase pairs of a comparison tell something of their own, and how many are mirror images of others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from comparison.study.models import Model
from comparison.study.study import Study
from reference.problem import Scene


def independent_phases(
    study: Study, scene: Scene, models: Sequence[Model], known: NDArray[np.bool_], stride: int
) -> int:
    """
    Number of orbits of the `known` phase pairs (K, K) under the symmetries of all models, with and without --full
    alike.
    """
    if scene.recorded:
        return int(known.any())
    reduced = replace(study, full=False)
    axis = np.arange(0, study.grid, stride)
    places = (study.grid * axis[:, None] + axis)[known]
    orbits = np.empty((len(places), len(models)), dtype=np.intp)
    for column, model in enumerate(models):
        orbit = np.full(study.grid**2, -1)
        orbit[reduced.places(model, scene)] = reduced.sources(scene, model)
        orbits[:, column] = orbit[places]
    return len(np.unique(orbits, axis=0))
