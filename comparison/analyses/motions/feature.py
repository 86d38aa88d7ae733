"""Motions at chosen phase pairs: in the report."""

from __future__ import annotations

import math
from collections.abc import Sequence

from comparison.analyses.motions.analysis import Motions, StoredMotion
from comparison.analyses.motions.page_data import significant_digits
from comparison.analyses.motions.result import FloorSpectra, MotionDemands
from comparison.report.section import Feature, Findings, SceneField
from reference.measures import FloorSpectra as SpectraOfMotion
from reference.problem import Scene


def _demands(findings: Findings, scene: Scene) -> list[MotionDemands]:
    """Of every stored motion that was computed."""
    alpha1, alpha2 = (findings.surfaces[name].values for name in ("alpha1", "alpha2"))
    motions: Sequence[StoredMotion] = findings.found.get("motions") or []
    listed = []
    for motion in motions:
        place = motion.place
        if place.scene == scene.name and motion.demands is not None:
            phases = (math.nan, math.nan) if scene.recorded else (alpha1[place.row], alpha2[place.column])
            about = {"model": motion.model, "phases": phases, "why": place.why, "spectra": _spectra(motion.spectra)}
            listed.append(MotionDemands.model_validate(about | vars(motion.demands)))
    return listed


def _spectra(spectra: SpectraOfMotion | None) -> FloorSpectra | None:
    """Six digits of the values, two of their errors."""
    if spectra is None:
        return None
    return FloorSpectra(
        period=significant_digits(spectra.period, 6),
        damping=spectra.damping,
        acceleration=significant_digits(spectra.acceleration, 6),
        error=significant_digits(spectra.error, 2),
    )


FEATURE = Feature(
    "motions",
    analysis=Motions(),
    scene_fields={
        "demands": SceneField(
            list[MotionDemands], "one per stored phase pair and model; empty without stored motions", _demands
        )
    },
)
