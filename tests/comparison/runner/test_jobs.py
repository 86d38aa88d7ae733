"""The numbers do not depend on how many workers compute them, nor on the order in which they finish."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import xarray as xr
from fake_models import fake_hierarchy

from comparison.runner.runner import Runner
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.surfaces.surfaces import labeled_surfaces
from comparison.surfaces.tasks import batch_results, surface_tasks
from reference.problem import load_scene


def test_results_are_the_same_bits_for_any_number_of_jobs() -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy("uneven", batch=1))
    tasks = surface_tasks(study)
    order: list[Task] = []
    surfaces = []
    for jobs in (1, 3):
        order.clear()
        results = TaskResults()
        put = results.put
        results.put = lambda task, result, put=put: (order.append(task), put(task, result))  # type: ignore[method-assign]
        Runner(results, jobs, ThreadPoolExecutor).run(tasks)
        surfaces.append(labeled_surfaces(study, study.batches(), batch_results(tasks, results)).drop_vars("cost"))
    assert sorted(order, key=tasks.index) == tasks != order, "the second time they finished in another order"
    xr.testing.assert_equal(*surfaces)  # values, not only close ones


def test_the_cut_into_batches_covers_every_phase_once() -> None:
    study = Study((load_scene("fig3-I"), load_scene("fig4-viscous")), 5, 1e-3, fake_hierarchy(batch=4))
    for model in study.hierarchy:
        for scene in study.scenes:
            batches = [
                batch for batch in study.batches() if batch.model == model.key and batch.scene.name == scene.name
            ]
            covered = [batch.first + i for batch in batches for i in range(len(batch.phases))]
            assert covered == (list(range(study.points(model))) if model.applies(scene) else [])
