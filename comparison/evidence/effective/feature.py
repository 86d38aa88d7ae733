"""Report section of radius, friction and mass that a motion of the engine shows, beside those stated."""

from comparison.evidence.effective.analysis import (
    PHASES,
    EffectiveModelValues,
    EffectiveValues,
    word_effective,
)
from comparison.evidence.forced_ratios import ForcedRatio, compute_forced_ratios
from comparison.report.feature import Feature, Findings, SceneField
from comparison.report.section import Section
from reference.problem import Scene


def _effective_of_scene(findings: Findings, scene: Scene) -> list[EffectiveModelValues]:
    """Return the values that a scene states, and then those that the motion of each model shows."""
    return [each for each in findings.found.get(EffectiveValues.key) or [] if each.scene == scene.name]


# Field of each scene's results: radius, friction, mass and top link, as the scene states them and as motions show them
EFFECTIVE = SceneField(
    name=EffectiveValues.key,
    kind=list[EffectiveModelValues],
    meaning="the scene, then every model",
    compute=_effective_of_scene,
)
FORCED = SceneField(  # field of each scene's results: amplitude of each upper body over that of the platform
    name="forced",
    kind=list[ForcedRatio],
    meaning="one per axis, harmonic and body above the platform; empty under a recorded motion",
    compute=lambda findings, scene: compute_forced_ratios(scene),
)
FEATURE = Feature(  # effective values and amplitude ratios of each scene: result fields, analysis, report section
    EffectiveValues.key,
    scene_fields=(EFFECTIVE, FORCED),
    analysis=EffectiveValues(),
    section=Section(
        "Effective values",
        context=lambda report: {
            "effective": [values for scene in report.results.scenes for values in EFFECTIVE.read_from(scene)],
            "phases": PHASES,
        },
        verifies=True,
        verdict=lambda results: word_effective(
            [each for scene in results.scenes for each in EFFECTIVE.read_from(scene)]
        ),
    ),
)
