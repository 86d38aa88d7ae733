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
    """Return radius, friction, mass and top link of one scene: as stated, then as each model's motion shows them."""
    return [each for each in findings.found.get(EffectiveValues.key) or [] if each.scene == scene.name]


EFFECTIVE = SceneField(  # each scene's results: radius, friction, mass, top link, as stated and as motions show them
    EffectiveValues.key, list[EffectiveModelValues], "the scene, then every model", _effective_of_scene
)
FORCED = SceneField(  # field of each scene's results: amplitude ratios under each harmonic
    "forced",
    list[ForcedRatio],
    "one per axis, harmonic and body above the platform; empty under a recorded motion",
    lambda findings, scene: compute_forced_ratios(scene),
)
FEATURE = Feature(  # result fields, analysis and report section
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
