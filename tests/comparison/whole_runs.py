"""A run of batches and of tasks beside and after them, which other processes repeat, and one that ends itself."""

import itertools
import os
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from fake_models import fake_hierarchy

from comparison.analyses.motions.analysis import Place, StoredMotion
from comparison.runner.cache import Cache
from comparison.runner.runner import Runner
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import BatchResult
from comparison.study.study import Study
from comparison.surfaces.surfaces import surface_tasks
from reference.problem import load_scene


def study() -> Study:
    """Two models, a file for every point of them."""
    hierarchy = [model for model in fake_hierarchy(batch=1) if model.key in ("small", "translational")]
    return Study((load_scene("fig3-I"),), 6, 1e-3, hierarchy)


def _tasks(first: int, count: int) -> list[Task]:
    return [Task(motion, number, "motions", 0.01, "about") for number in range(first, first + count)]


def motion(number: int) -> StoredMotion:
    """A motion like no other."""
    time.sleep(0.001)
    draw = np.random.default_rng(number)
    place = Place("fig3-I", number, 0, "why")
    return StoredMotion(place, "small", draw.random(7), draw.random((7, 2, 2)), draw.random((7, 2, 2)), ((0.1, 0.2),))


def whole_run(folder: Path) -> tuple[list[BatchResult], list[object], int, int]:
    """Batches with 24 tasks beside them and 24 after them; what was found, and how much of either was there before."""
    results = TaskResults(Cache(folder))
    runner = Runner(results, 2, ThreadPoolExecutor)
    batches = surface_tasks(study())
    runner.run([*batches, *_tasks(0, 24)])
    runner.run(_tasks(24, 24))
    motions = [results[task].value for task in _tasks(0, 48)]
    return (
        [results[task].value for task in batches],
        [(m.place, m.stick, *(x.tobytes() for x in (m.time, m.position, m.acceleration))) for m in motions],
        sum(task.key in results.stored for task in batches),
        results.parts["motions"].stored,
    )


def end_after(results: int, seconds: float) -> None:
    """Kill this process so many seconds after it has begun to store the result of this number: others would be late."""
    put, stored = Cache.put, itertools.count()

    def counted(cache: Cache, key: Any, value: Any) -> None:
        if next(stored) == results:
            threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGKILL)).start()
        put(cache, key, value)

    Cache.put = counted  # type: ignore[method-assign]
