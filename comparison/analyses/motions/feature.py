"""Report section of the motions at chosen phase pairs."""

import math
from collections.abc import Sequence
from dataclasses import fields
from typing import Any

from pydantic import Field, create_model

from comparison.analyses.motions.analysis import Motions, StoredMotion
from comparison.analyses.motions.page_data import collect_motion_data, encode_motions, round_to_significant_digits
from comparison.report.feature import Feature, Findings, SceneField
from comparison.result_types import Number, Part, Phases, Text, UncertainNumber
from reference.measures import Demands, FloorSpectra
from reference.measures.peak_demands import PER_BODY, QUANTITIES
from reference.problem import Scene


class ResidualDisplacement(UncertainNumber):
    """Residual displacement, m, at which the platform stays at rest; or the reason why a motion has none."""

    reason: Text
    """why there is no value although the motion lasts as long as the scene; empty otherwise"""


class MotionSpectra(Part):
    """Floor response spectra of one motion: largest displacement of an oscillator times its squared frequency."""

    period: list[float]
    """natural periods of the oscillator, s"""
    damping: float
    """damping ratio of the oscillator"""
    acceleration: list[list[list[Number]]]
    """pseudo-acceleration, m/s^2, by body, direction x and y, and period"""
    error: list[list[list[Number]]]
    """estimated absolute error"""


class _StoredMotionDemandsSchema(Part):
    """Demands of one stored motion; null where the motion ended early."""

    model: str
    """key of the model"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""
    why: Text
    """why this phase pair was chosen; empty for one of an even spread"""
    status: str
    """how the motion ended"""


def _type_of_demand(annotation: str) -> Any:
    """
    Return the type that a field of `Demands` has in the JSON schema.

    It is a number with its error, or a list of these by body; null is allowed where the field may be None.
    """
    kind: Any = list[UncertainNumber] if annotation.startswith("tuple") else UncertainNumber
    return kind | None if annotation.endswith("None") else kind


def _meaning_of_demand(name: str) -> Any:
    """Return the description of a demand in the JSON schema: its meaning, its SI unit and the bodies that have it."""
    of = f"; by body, from body {PER_BODY[name] + 1} on" if name in PER_BODY else ""
    meaning, unit = QUANTITIES[name]
    return Field(description=f"{meaning}, {unit}{of}; null where the motion does not have it")


_DEMANDS: dict[str, Any] = {  # by demand: type and description in the JSON schema
    each.name: (
        ResidualDisplacement if each.name == "residual" else _type_of_demand(str(each.type)),
        _meaning_of_demand(each.name),
    )
    for each in fields(Demands)
    if each.name in QUANTITIES
}
_DEMANDS["spectra"] = MotionSpectra | None, Field(description="null where the motion ended early")
MotionDemands: Any = create_model(  # form in which summary.json holds the demands of a stored motion
    "MotionDemands", __base__=_StoredMotionDemandsSchema, __doc__=_StoredMotionDemandsSchema.__doc__, **_DEMANDS
)


def _demands_of_motions(findings: Findings, scene: Scene) -> list[MotionDemands]:
    """Return the demands of the stored motions of a scene, as summary.json holds them."""
    alpha1, alpha2 = (findings.surfaces[name].values for name in ("alpha1", "alpha2"))
    motions: Sequence[StoredMotion] = findings.found.get(Motions.key) or []
    listed = []
    for motion in motions:
        place = motion.place
        if place.scene == scene.name and motion.demands is not None:
            phases = (math.nan, math.nan) if scene.recorded else (alpha1[place.row], alpha2[place.column])
            about = {
                "model": motion.model,
                "phases": phases,
                "why": place.why,
                "spectra": _round_spectra(motion.spectra),
            }
            listed.append(MotionDemands.model_validate(about | vars(motion.demands)))
    return listed


def _round_spectra(spectra: FloorSpectra | None) -> MotionSpectra | None:
    """Return floor spectra rounded to six digits, their errors to two; None without spectra."""
    if spectra is None:
        return None
    return MotionSpectra(
        period=round_to_significant_digits(spectra.period, 6),
        damping=spectra.damping,
        acceleration=round_to_significant_digits(spectra.acceleration, 6),
        error=round_to_significant_digits(spectra.error, 2),
    )


DEMANDS = SceneField(  # field of summary.json on each scene: demands of its stored motions
    name="demands",
    kind=list[MotionDemands],
    meaning="one per stored phase pair and model; empty without stored motions",
    compute=_demands_of_motions,
)
# Registration of this analysis with the program: field of each scene, computation, and data for the page's script
FEATURE = Feature(
    key=Motions.key,
    scene_fields=(DEMANDS,),
    analysis=Motions(),
    needs="surfaces",  # the page shows motions below the plots of amplification over the phases, only with these
    page_data=collect_motion_data,
    packed_data=encode_motions,
)
