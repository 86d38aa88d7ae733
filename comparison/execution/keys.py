"""What tiles and errands are found by in the cache: all that their numbers depend on."""

from __future__ import annotations

import hashlib
import json

import numpy as np

from comparison.execution.cache import Cache, Key
from comparison.execution.environment import answer_surroundings, surroundings
from comparison.execution.task import Errand, fingerprint, named
from comparison.study.batches import Answer, Tile

TILE, ANSWER = "tile", "answer"  # kinds of results


def tile_key(tile: Tile) -> Key:
    """Scene (not its name or title), model, settings, versions and the models' source; and the phases."""
    about = {
        "scene": tile.scene.digest(),
        "model": tile.amplification,
        "settings": dict(tile.settings),
        "surroundings": surroundings(tile.amplification),
    }
    phases = hashlib.sha256(np.ascontiguousarray(tile.phases).tobytes()).hexdigest()
    return Key(json.dumps(about, indent=1, sort_keys=True), phases, TILE)


def errand_key(errand: Errand) -> Key:
    """Function, what the errand is about, versions and the source of all that computes it; and its task."""
    about = {
        "answers of": named(errand.solve),
        "about": fingerprint(errand.about),
        "surroundings": answer_surroundings(errand.solve.__module__),
    }
    return Key(json.dumps(about, indent=1, sort_keys=True), errand.key, ANSWER)


def stored_tile(cache: Cache, tile: Tile) -> Answer | None:
    """The stored answer to a tile, None if there is none that fits its phases and bodies."""
    answer = cache.get(tile_key(tile), Answer)
    if answer is None:
        return None
    points, bodies = len(tile.phases), len(tile.scene.bodies)
    shapes = answer.mu.shape, answer.error.shape, (len(answer.status),), answer.instant.shape
    return answer if shapes == ((points, bodies), (points, bodies), (points,), (points,)) else None
