"""
Readings of the paper: what it leaves open or may have meant, filled in one way each.

The paper gives neither the unit of the amplitudes nor the duration, nor f_c of the lubricated case, and does not say
whether the maximum in (5.1) is the supremum or what a numerical integration reaches. Some statements need other
parameters or equations than those printed: such a reading states the keys that it changes, and why.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Any, Literal

import numpy as np

from reference.problem import Scene, load_scene

SPEED = 1e-3  # m/s, v_c of the resolved peak and v_reg of the regularized one
EPSILON = 0.1  # the paper's: T_1, T_2 = T_c (1 -+ epsilon)
DECAY = 0.3  # the paper's lambda_i T_i
KEPT = 1024  # scenes of each kind: every reading asks for its own several times

Peak = Literal["supremum", "resolved", "regularised", "literal (4.6)"]


@dataclass(frozen=True)
class Reading:
    """
    One way to fill in what the paper leaves open, and changes of what it states.

    peak: the supremum of (5.1) with its one-sided limits at stops; or only what is reached at rest or while sliding
    faster than SPEED; or the peak with friction linear below SPEED; or (4.6) literally, as recorded.
    """

    amplitude: float = 1.0  # m/s^2, of the largest entry of (5.4)
    duration: float = 20.0  # s
    peak: Peak = "resolved"
    lubrication: float = 0.5  # f_c, s/m
    values: tuple[tuple[str, float | tuple[float, ...]], ...] = ()  # dotted keys; not dry friction where lubricated
    factors: tuple[tuple[str, float], ...] = ()  # dotted keys and what multiplies the printed values
    title: str = ""  # what the changes are
    reason: str = ""  # why anyone would read the paper so
    searched: int = 0  # how many readings had been tried where it was picked by its verdicts

    @property
    def name(self) -> str:
        """Its title and what it fills in."""
        words = [f"{self.title}: {self.amplitude:g} m/s²" if self.title else f"{self.amplitude:g} m/s²"]
        words += [f"{self.duration:g} s"] if self.duration != Reading.duration else []
        words += [f"f_c {self.lubrication:g} s/m"] if self.lubrication != Reading.lubrication else []
        return ", ".join([*words, self.peak])

    @property
    def origin(self) -> str:
        """Why anyone would read the paper so, and by what selection it was found."""
        picked = f"; picked for its verdicts among {self.searched} motions" if self.searched else ""
        return f"{self.reason}{picked}"


def loading_around(period: float) -> tuple[tuple[str, float | tuple[float, ...]], ...]:
    """Two harmonics at `period` (1 -+ EPSILON), s, that decay as the paper's."""
    periods = period * (1.0 - EPSILON), period * (1.0 + EPSILON)
    return ("excitation.periods", periods), ("excitation.decay", (DECAY / periods[0], DECAY / periods[1]))


SHORT = 6.0  # s: the loading is strongest in its first seconds
SEARCHED = 2353  # motions of an earlier search that found OWN_PERIOD and LIGHT_BODY
OPEN_UNITS = "the paper gives no unit of the amplitudes"
OWN_PERIOD = Reading(
    values=(("isolator.friction", 0.02), *loading_around(0.6)),
    title="loading around the short period, friction 0.02",
    reason="the text asks for harmonics close to resonance; T_c is no natural period of the chain, 0.6 s nearly is",
    searched=SEARCHED,
)
LIGHT_BODY = Reading(
    0.2,
    values=(("isolator.friction", 0.01), ("bodies.1.mass", 0.1)),
    factors=(("bodies.1.period", 3.0),),
    title="light, soft second body (m_2 = 0.1 m_1, 3 T_3), friction 0.01",
    reason="with a light second body the platform vibrates nearly as if alone, and its springs isolate that body",
    searched=SEARCHED,
)
LITERAL = Reading(
    peak="literal (4.6)",
    reason="(4.6) as printed decides when slip begins, its F_3 is the first direction of slip, and that instant counts",
)
READINGS = (
    Reading(0.3, peak="supremum", reason=f"{OPEN_UNITS}; the platform never slides"),
    Reading(0.6, reason=OPEN_UNITS),
    Reading(1.0, peak="supremum", reason="amplitudes in m/s²; (5.1) taken literally"),
    Reading(1.0, reason="amplitudes in m/s²; what a numerical integration of small steps reaches"),
    Reading(1.0, peak="regularised", reason="amplitudes in m/s²; friction rounded off at low speed, as codes do"),
    Reading(2.0, reason=OPEN_UNITS),
    Reading(duration=SHORT, reason="the paper gives no duration"),
    Reading(lubrication=0.1, reason="the paper gives no f_c"),
    Reading(lubrication=2.0, reason="the paper gives no f_c"),
    OWN_PERIOD,
    LIGHT_BODY,
    replace(LITERAL, amplitude=0.6),
    LITERAL,
)
PEAKS: tuple[Peak, ...] = ("supremum", "resolved", "regularised")
EVERY_READING = (
    *(
        Reading(amplitude, duration, peak)
        for amplitude in (0.3, 0.6, 1.0, 1.5, 2.0, 3.0)
        for duration in (Reading.duration, SHORT)
        for peak in PEAKS
    ),
    *(Reading(lubrication=lubrication) for lubrication in (0.05, 0.1, 0.2, 1.0, 2.0, 5.0)),
    *(replace(OWN_PERIOD, peak=peak) for peak in PEAKS),
    *(replace(LIGHT_BODY, peak=peak) for peak in PEAKS),
    *(replace(LITERAL, amplitude=amplitude) for amplitude in (0.6, 1.0, 1.5)),
)


def settings(scene: Scene, reading: Reading) -> dict[str, Any]:
    """What the reading asks of `reference.amplification`: nothing where friction has no corner."""
    if not has_stops(scene) or reading.peak == "supremum":
        return {}
    return {"cutoff" if reading.peak == "resolved" else "regularization": SPEED}


def has_stops(scene: Scene) -> bool:
    """Whether friction can hold the platform, so that it matters how a peak is read."""
    return not scene.lubricated and scene.friction_coefficient > 0.0


def without_effect(reading: Reading, scene: Scene) -> Reading:
    """The reading with what does not touch this scene set alike, so that readings share what they can."""
    if not scene.lubricated:
        reading = replace(reading, lubrication=Reading.lubrication)
    if not has_stops(scene):
        reading = replace(reading, peak="supremum")
    return replace(reading, title="", reason="", searched=0)


@lru_cache(KEPT)
def _read(name: str, reading: Reading) -> Scene:
    scene = load_scene(name, reading.amplitude)
    values: dict[str, Any] = {"name": name, "duration": reading.duration}
    values |= {key: value for key, value in reading.values if not (scene.lubricated and key == "isolator.friction")}
    for key, factor in reading.factors:
        stated: Any = scene.model_dump(exclude_none=True)
        for part in key.split("."):
            stated = stated[int(part) if part.isdecimal() else part]
        values[key] = np.multiply(factor, stated).tolist()
    if scene.lubricated:
        values["isolator.lubrication"] = reading.lubrication
    return scene.with_values(values)


@lru_cache(KEPT)
def _alone(name: str, oscillator: bool, reading: Reading) -> Scene:
    """
    The platform without what stands on it, under the loading as printed: close to its own resonance T_c.

    oscillator: instead without friction, of the period T_3x of the second body on its springs: far from both harmonics.
    """
    scene = _read(name, reading)
    soft: Any = scene.bodies[1].period
    kind, values = "alone", dict[str, Any](loading_around(float(scene.isolator.period or np.nan)))
    if oscillator:
        kind, values = "oscillator", {"isolator": {"period": soft[0], "friction": 0.0}}
    platform = scene.bodies[0].model_dump(exclude_none=True)
    return scene.with_values({"name": f"{name} {kind}", "bodies": [platform], **values})


CASES: Mapping[str, Callable[[Reading], Scene]] = {
    **{name: partial(_read, name) for name in ("fig3-I", "fig3-II", "fig4-dry", "fig4-viscous")},
    **{f"{name} alone": partial(_alone, name, False) for name in ("fig3-I", "fig3-II")},
    "fig3-II oscillator": partial(_alone, "fig3-II", True),
}
