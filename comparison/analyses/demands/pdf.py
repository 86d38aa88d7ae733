"""The demands of every scene as rows of report.pdf: largest values of the first model and of the last one."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

from comparison.analyses.demands.analysis import DemandStatistics, PhaseExtreme
from comparison.analyses.motions.result import MotionDemands
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.result_types import UncertainNumber
from comparison.wording import shortened

HEADINGS = (
    "scene", "model", "isolator, mm", "residual, mm", "base shear, N", "platform, m/s²", "top, m/s²", "drift, mm",
    "contact force, N",
)  # fmt: skip
MILLI = 1e3


def demand_rows(results: Results) -> list[list[str]]:
    """Cells under HEADINGS of the first and last model of every scene, over all phases or the stored motions."""
    titles = {model.key: model.title for model in results.models}
    with_demands = [scene for scene in results.scenes if scene.of("demand_statistics") or scene.of("demands")]
    return [
        [shortened(scene.name, 40), titles[key], *cells]
        for scene in with_demands
        for key, cells in _of_two_models(scene, titles)
    ]


def demands_note(results: Results) -> str:
    """Which motions the rows are of."""
    if any(scene.of("demand_statistics") for scene in results.scenes):
        return "Largest values over all phases; of the contact force, the smallest."
    return "Largest values over the stored motions of index.html; of the contact force, the smallest."


def _of_two_models(scene: SceneResult, titles: dict[str, str]) -> Iterator[tuple[str, list[str]]]:
    held = {row.model for row in (scene.of("demand_statistics") or scene.of("demands"))}
    keys = [key for key in titles if key in held]
    for key in dict.fromkeys((keys[0], keys[-1])):
        if scene.of("demand_statistics"):
            yield key, _over_phases([row for row in scene.of("demand_statistics") if row.model == key], scene.bodies)
        else:
            yield key, _over_motions([motion for motion in scene.of("demands") if motion.model == key])


def _over_phases(rows: Sequence[DemandStatistics], bodies: int) -> list[str]:
    def largest(quantity: str, body: int = 0, factor: float = 1.0) -> str:
        return _text([row.highest.value for row in rows if (row.quantity, row.body) == (quantity, body)], factor)

    drifts = [row.highest.value for row in rows if row.quantity == "drift"]
    smallest = [row.lowest.value for row in rows if row.quantity == "contact_force_min"]
    platform, top = largest("acceleration", 1), largest("acceleration", bodies)
    rests = [row.highest for row in rows if row.quantity == "residual"]
    isolator = largest("displacement", factor=MILLI), _with_error(rests)
    return [*isolator, largest("base_shear"), platform, top, _text(drifts, MILLI), _text(smallest, pick=min)]


def _over_motions(motions: Sequence[MotionDemands]) -> list[str]:
    def largest(numbers: Sequence[UncertainNumber], factor: float = 1.0) -> str:
        return _text([number.value for number in numbers], factor)

    return [
        largest([motion.displacement for motion in motions], MILLI),
        _with_error([motion.residual for motion in motions]),
        largest([motion.base_shear for motion in motions]),
        largest([motion.acceleration[0] for motion in motions if motion.acceleration]),
        largest([motion.acceleration[-1] for motion in motions if motion.acceleration]),
        largest([drift for motion in motions for drift in motion.drift], MILLI),
        _text([motion.contact_force_min.value for motion in motions], pick=min),
    ]


def _with_error(numbers: Sequence[PhaseExtreme | UncertainNumber]) -> str:
    """The largest residual with its error, which includes the creep of regularized friction, in mm."""
    known = [number for number in numbers if math.isfinite(number.value)]
    largest = max(known, key=lambda number: number.value, default=None)
    if largest is None:
        return ""
    return f"{MILLI * largest.value:.4g}" + (f" ± {MILLI * largest.error:.1g}" if largest.error >= 0.0 else "")


def _text(values: Sequence[float], factor: float = 1.0, pick: Callable[[Sequence[float]], float] = max) -> str:
    """The largest of the known values, or the one to pick."""
    known = [value for value in values if math.isfinite(value)]
    return f"{factor * pick(known):.4g}" if known else ""
