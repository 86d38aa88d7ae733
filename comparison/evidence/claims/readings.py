"""The two readings of (5.1), and the scenes of the paper's statements with the parameters as printed."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial
from typing import Any

from comparison.study import models
from reference.problem import Scene, load_scene, readings


@dataclass(frozen=True)
class PeakReading:
    """Reading of (5.1): a definition of the peak acceleration, by the sliding speeds at which accelerations count."""

    name: str  # name of the definition in tables
    model: str  # key of the model of the small-vibration equations that has this definition
    cutoff: float | None  # m/s, lowest sliding speed at which accelerations count; None: all count


# Definition of the peak acceleration (5.1): accelerations count at rest and at sliding speeds above v_c = 1 mm/s
AS_INTEGRATED = PeakReading(
    name=readings.AS_INTEGRATED, model=models.SMALL_AS_INTEGRATED.key, cutoff=readings.DEFAULT_V_C
)
# Definition of the peak acceleration (5.1): any sliding speed counts, also the limit as it falls to 0 before a stop
LITERAL_SUPREMUM = PeakReading(name=readings.LITERAL_SUPREMUM, model=models.SMALL.key, cutoff=None)
READINGS = (AS_INTEGRATED, LITERAL_SUPREMUM)  # both definitions of the peak acceleration (5.1), in the order of tables


def effective_reading(reading: PeakReading, scene: Scene) -> PeakReading:
    """Return the given reading of (5.1), or LITERAL_SUPREMUM in a scene without dry friction, where both agree."""
    return reading if models.has_dry_friction(scene) else LITERAL_SUPREMUM


@cache
def _make_platform_scene(name: str, oscillator: bool) -> Scene:
    """
    Return the paper's scene `name` with its platform alone, whose period T_c is close to those of the loading.

    oscillator: without friction, and with the period T_3x of the second body on its springs, far from both harmonics.
    """
    scene = load_scene(name)
    kind, values = "alone", dict[str, Any]()
    if oscillator:
        link_periods: Any = scene.bodies[1].period  # s, along x and y
        kind, values = "oscillator", {"isolator": {"period": link_periods[0], "friction": 0.0}}
    platform = scene.bodies[0].model_dump(exclude_none=True)
    return scene.with_values({"name": f"{name} {kind}", "bodies": [platform], **values})


# Functions that make the scenes on which the paper's statements are checked, by name of the scene
STATEMENT_CASES: Mapping[str, Callable[[], Scene]] = {
    **{name: partial(load_scene, name) for name in ("fig3-I", "fig3-II", "fig4-dry", "fig4-viscous")},
    **{f"{name} alone": partial(_make_platform_scene, name, False) for name in ("fig3-I", "fig3-II")},
    "fig3-II oscillator": partial(_make_platform_scene, "fig3-II", True),
}
