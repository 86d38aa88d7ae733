"""
What is saved where a scene does not require all of a model: processor time in full over that of the reduced one.

Run with `python -m pytest tests/benchmarks/test_reductions.py -m long -s`; reference/README.md has the figures.
Full and reduced runs alternate, and the fastest of each are compared:
other work on the machine only ever slows a run down.
"""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import multibody
import reference
from reference.problem import Scene, load_scene, phase_grid

ROUNDS = 3


def scene_of(name: str, *bodies: dict[str, Any], **tables: Any) -> Scene:
    """`name` with the tables changed, and further bodies."""
    table = load_scene(name).model_dump(exclude_none=True)
    for key, change in tables.items():
        table[key] |= change
    table["bodies"] += bodies
    return Scene.model_validate(table)


def level_platform(name: str) -> Scene:
    """The platform of `name` alone, its center of mass in the plane of the contacts' centers: it cannot turn."""
    table = load_scene(name).model_dump(exclude_none=True)
    return Scene.model_validate(table | {"bodies": [table["bodies"][0] | {"height": 0.0}]})


def seconds_per_point(answer: Callable[..., Any], scene: Scene, phases: np.ndarray, **options: Any) -> float:
    begin = time.process_time()
    assert (answer(scene, phases, **options).status == "ok").all()
    return (time.process_time() - begin) / len(phases)


def measured(answer: Callable[..., Any], scene: Scene, many: np.ndarray, few: np.ndarray, **options: Any) -> float:
    """Cost of a point of `few` in full over that of one of `many` reduced: the fastest of ROUNDS each."""
    answer(scene, few[:1], **options, full=True)  # compiled and loaded
    seconds = np.array(
        [
            [
                seconds_per_point(answer, scene, few, **options, full=True),
                seconds_per_point(answer, scene, many, **options),
            ]
            for _ in range(ROUNDS)
        ]
    )
    full, reduced = seconds.min(axis=0)
    rounds = np.round(seconds[:, 0] / seconds[:, 1], 2)
    print(f"\n{scene.title}, {options}: {full / reduced:.2f} times less, rounds {rounds}")
    return float(full / reduced)


FREE = {"friction": 0.0}
RANDOM = np.random.default_rng(5).uniform(0.0, 2.0 * np.pi, (5, 2))
LINK = {"mass": 0.5, "stiffness": [20.0, 20.0]}
SUPERPOSED = {
    "two bodies": scene_of("fig3-II", isolator=FREE),
    "ten bodies": scene_of("fig3-II", *([LINK] * 8), isolator=FREE),
}


@pytest.mark.long
@pytest.mark.parametrize("name", SUPERPOSED)
def test_a_sum_of_motions_costs_a_small_part_of_the_runs(name: str) -> None:
    scene = SUPERPOSED[name]
    ratio = measured(reference.amplification, scene, phase_grid(48), phase_grid(12), equations="small")
    assert ratio > 10.0  # threads of a linear algebra library that wait count as processor time


@pytest.mark.long
@pytest.mark.parametrize(
    "scene", [scene_of("fig4-dry"), scene_of("fig4-viscous"), scene_of("fig4-dry", *([LINK] * 4))], ids=str
)
def test_a_plane_costs_less_than_space(scene: Scene) -> None:
    ratio = measured(multibody.amplification, scene, RANDOM, RANDOM, model="translational")
    assert ratio > 1.0


@pytest.mark.long
@pytest.mark.parametrize("law", [{"equations": "small"}, {}, {"regularization": 1e-3}], ids=str)
@pytest.mark.parametrize("scene", [scene_of("fig4-dry"), scene_of("fig4-dry", *([LINK] * 8))], ids=["2", "10 bodies"])
def test_solving_in_a_plane_costs_less_than_in_space(scene: Scene, law: dict[str, Any]) -> None:
    assert measured(reference.amplification, scene, phase_grid(12), phase_grid(12), **law) > 1.0


@pytest.mark.long
@pytest.mark.parametrize("name", ["fig3-I", "fig4-dry"])
def test_a_level_platform_costs_less_than_one_that_turns(name: str) -> None:
    scene = level_platform(name)
    ratio = measured(multibody.amplification, scene, RANDOM, RANDOM, model="spatial")
    assert ratio > 1.0
