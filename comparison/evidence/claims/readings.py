"""The two readings of (5.1), and the scenes that the paper's statements are about, with the parameters as printed."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial
from typing import Any

from comparison.study import models
from reference.problem import Scene, load_scene, readings


@dataclass(frozen=True)
class PeakReading:
    """Reading of the maximum of (5.1). model: key of the study's model; cutoff: v_c, m/s, None for the supremum."""

    name: str
    model: str
    cutoff: float | None


AS_INTEGRATED = PeakReading(readings.AS_INTEGRATED, models.SMALL_RESOLVED.key, readings.DEFAULT_V_C)
LITERAL_SUPREMUM = PeakReading(readings.LITERAL_SUPREMUM, models.SMALL.key, None)
READINGS = (AS_INTEGRATED, LITERAL_SUPREMUM)


def effective_reading(reading: PeakReading, scene: Scene) -> PeakReading:
    """Return the supremum where friction cannot hold the platform: both readings are the same there."""
    return reading if models.has_dry_friction(scene) else LITERAL_SUPREMUM


@cache
def _platform_alone(name: str, oscillator: bool) -> Scene:
    """
    Return a scene of the paper without what stands on its platform, which the loading meets close to its period T_c.

    oscillator: instead without friction, of the period T_3x of the second body on its springs: far from both harmonics.
    """
    scene = load_scene(name)
    kind, values = "alone", dict[str, Any]()
    if oscillator:
        soft: Any = scene.bodies[1].period
        kind, values = "oscillator", {"isolator": {"period": soft[0], "friction": 0.0}}
    platform = scene.bodies[0].model_dump(exclude_none=True)
    return scene.with_values({"name": f"{name} {kind}", "bodies": [platform], **values})


CASES: Mapping[str, Callable[[], Scene]] = {
    **{name: partial(load_scene, name) for name in ("fig3-I", "fig3-II", "fig4-dry", "fig4-viscous")},
    **{f"{name} alone": partial(_platform_alone, name, False) for name in ("fig3-I", "fig3-II")},
    "fig3-II oscillator": partial(_platform_alone, "fig3-II", True),
}
