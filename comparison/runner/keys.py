"""What batches and tasks are found by in the cache: all that their numbers depend on."""

from __future__ import annotations

import hashlib
import json

import numpy as np

from comparison.runner.cache import Cache, Key
from comparison.runner.environment import environment_fingerprint, task_environment_fingerprint
from comparison.runner.task import Task, fingerprint, named
from comparison.study.batches import Batch, BatchResult, ok_without_numbers

BATCH, ANALYSIS = "tile", "answer"  # kinds of results


def batch_key(batch: Batch) -> Key:
    """
    What a batch is found by: scene (not its name or title), model, settings, versions, the models' source, phases.

    Parameters
    ----------
    batch : Batch

    Returns
    -------
    Key
    """
    about = {
        "scene": batch.scene.digest(),
        "model": batch.amplification,
        "settings": dict(batch.settings),
        "environment": environment_fingerprint(batch.amplification),
    }
    phases = hashlib.sha256(np.ascontiguousarray(batch.phases).tobytes()).hexdigest()
    return Key(json.dumps(about, indent=1, sort_keys=True), phases, BATCH)


def task_key(task: Task) -> Key:
    """
    What a task is found by: function, argument, versions and the source of all that computes it.

    Parameters
    ----------
    task : Task

    Returns
    -------
    Key
    """
    about = {
        "answers of": named(task.function),
        "about": fingerprint(task.about),
        "environment": task_environment_fingerprint(task.function.__module__),
    }
    return Key(json.dumps(about, indent=1, sort_keys=True), task.key, ANALYSIS)


def cached_batch(cache: Cache, batch: Batch) -> BatchResult | None:
    """
    The stored answer to a batch.

    Parameters
    ----------
    cache : Cache
    batch : Batch

    Returns
    -------
    BatchResult or None
        None if there is none that fits its phases and bodies, or if one is ok without numbers.
    """
    answer = cache.get(batch_key(batch), BatchResult)
    if answer is None:
        return None
    points, bodies = len(batch.phases), len(batch.scene.bodies)
    shapes = answer.mu.shape, answer.error.shape, (len(answer.status),), answer.instant.shape, answer.displacement.shape
    if shapes != ((points, bodies), (points, bodies), (points,), (points,), (points,)):
        return None
    return None if ok_without_numbers(batch, answer.mu, answer.error, answer.status) else answer
