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


FREE = {"friction": 0.0}
RANDOM = np.random.default_rng(5).uniform(0.0, 2.0 * np.pi, (5, 2))
FEW = phase_grid(12)
LINK = {"mass": 0.5, "stiffness": [20.0, 20.0]}
PLANE = {"2 bodies": scene_of("fig4-dry"), "10 bodies": scene_of("fig4-dry", *([LINK] * 8))}
LAWS: tuple[dict[str, Any], ...] = ({"equations": "small"}, {}, {"regularization": 1e-3})
EQUATIONS, ENGINE = reference.amplification, multibody.amplification
CASES: list[tuple[Callable[..., Any], Scene, np.ndarray, np.ndarray, dict[str, Any], float]] = [
    # a sum of motions; threads of a linear algebra library that wait count as processor time
    *(
        (EQUATIONS, scene_of("fig3-II", *([LINK] * more), isolator=FREE), phase_grid(48), FEW, LAWS[0], 10.0)
        for more in (0, 8)
    ),
    *((EQUATIONS, scene, FEW, FEW, law, 1.0) for scene in PLANE.values() for law in LAWS),
    *(
        (ENGINE, scene, RANDOM, RANDOM, {"model": "translational"}, 1.0)
        for scene in (*PLANE.values(), scene_of("fig4-viscous"))
    ),
    *((ENGINE, level_platform(name), RANDOM, RANDOM, {"model": "spatial"}, 1.0) for name in ("fig3-I", "fig4-dry")),
]


@pytest.mark.long
@pytest.mark.parametrize(("answer", "scene", "many", "few", "options", "least"), CASES)
def test_what_a_scene_does_not_require_costs_less(
    answer: Callable[..., Any], scene: Scene, many: np.ndarray, few: np.ndarray, options: dict[str, Any], least: float
) -> None:
    """Cost of a point of `few` in full over that of one of `many` reduced: the fastest of ROUNDS each."""

    def seconds(phases: np.ndarray, **full: bool) -> float:
        begin = time.process_time()
        assert (answer(scene, phases, **options, **full).status == "ok").all()
        return (time.process_time() - begin) / len(phases)

    seconds(few[:1], full=True)  # compiled and loaded
    full, reduced = np.min([(seconds(few, full=True), seconds(many)) for _ in range(ROUNDS)], axis=0)
    print(f"\n{scene.title}, {options}: {full / reduced:.2f} times less")
    assert full / reduced > least
