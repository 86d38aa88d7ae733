"""
Readings of the paper: what it leaves open, filled in one way each, and the cases that its claims speak about.

The paper gives neither the unit of the amplitudes nor the duration, nor f_c of the lubricated case, and does not say
whether the maximum in (5.1) is the supremum or what a numerical integration reaches.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from reference.problem import Scene, load_scene

SPEED = 1e-3  # m/s, v_c of the resolved peak and v_reg of the regularized one

Peak = Literal["supremum", "resolved", "regularised"]


@dataclass(frozen=True)
class Reading:
    """
    One way to fill in what the paper leaves open.

    amplitude: m/s^2, of the largest entry of (5.4). duration: s. peak: the supremum of (5.1) with its one-sided limits
    at stops; or only what is reached at rest or while sliding faster than SPEED; or the peak of the motion with
    friction linear below SPEED. lubrication: f_c, s/m.
    """

    amplitude: float = 1.0
    duration: float = 20.0
    peak: Peak = "resolved"
    lubrication: float = 0.5

    @property
    def name(self) -> str:
        """The values of the reading in words."""
        words = [f"{self.amplitude:g} m/s²"]
        words += [f"{self.duration:g} s"] if self.duration != Reading.duration else []
        words += [f"f_c {self.lubrication:g} s/m"] if self.lubrication != Reading.lubrication else []
        return ", ".join([*words, self.peak])


SHORT = 6.0  # s: the loading is strongest in its first seconds
READINGS = (
    Reading(0.3, peak="supremum"),  # the platform never slides
    Reading(0.6, peak="supremum"),
    Reading(0.6),
    Reading(1.0, peak="supremum"),
    Reading(1.0),
    Reading(1.0, peak="regularised"),
    Reading(2.0),
    Reading(duration=SHORT),
    Reading(lubrication=0.1),
    Reading(lubrication=2.0),
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
)


def _read(name: str, reading: Reading) -> Scene:
    scene = load_scene(name, reading.amplitude).with_values({"name": name, "duration": reading.duration})
    if not scene.lubricated:
        return scene
    return scene.with_values({"isolator": {"period": scene.isolator.period, "lubrication": reading.lubrication}})


def _alone(name: str, reading: Reading) -> Scene:
    """The platform without what stands on it."""
    scene = _read(name, reading)
    return scene.with_values({"name": f"{name} alone", "bodies": [scene.bodies[0].model_dump(exclude_none=True)]})


def _oscillator(name: str, reading: Reading) -> Scene:
    """One body without friction, of the period T_3x of the second body on its springs: far from both harmonics."""
    scene = _alone(name, reading)
    second = load_scene(name).bodies[1].period
    assert second is not None
    return scene.with_values({"name": f"{name} oscillator", "isolator": {"period": second[0], "friction": 0.0}})


CASES: Mapping[str, Callable[[Reading], Scene]] = {
    "fig3-I": lambda reading: _read("fig3-I", reading),
    "fig3-II": lambda reading: _read("fig3-II", reading),
    "fig4-dry": lambda reading: _read("fig4-dry", reading),
    "fig4-viscous": lambda reading: _read("fig4-viscous", reading),
    "fig3-I alone": lambda reading: _alone("fig3-I", reading),
    "fig3-II alone": lambda reading: _alone("fig3-II", reading),
    "fig3-II oscillator": lambda reading: _oscillator("fig3-II", reading),
}


def settings(scene: Scene, reading: Reading) -> dict[str, Any]:
    """What the reading asks of `reference.amplification`: nothing where friction has no corner."""
    if scene.lubricated or scene.friction_coefficient == 0.0 or reading.peak == "supremum":
        return {}
    return {"cutoff" if reading.peak == "resolved" else "regularization": SPEED}


def without_effect(reading: Reading, scene: Scene) -> Reading:
    """The reading with what does not touch this scene set alike, so that readings share what they can."""
    if not scene.lubricated:
        reading = replace(reading, lubrication=Reading.lubrication)
    return reading if settings(scene, reading) else replace(reading, peak="supremum")
