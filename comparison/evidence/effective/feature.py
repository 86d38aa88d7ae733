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
    """Return one scene's platform sphere radius, friction, mass, top body's link: stated, then by models' motions."""
    return [each for each in findings.found.get(EffectiveValues.key) or [] if each.scene == scene.name]


EFFECTIVE = SceneField(  # field: platform sphere radius, friction, mass, top body's link; as stated, as motions show
    EffectiveValues.key, list[EffectiveModelValues], "the scene, then every model", _effective_of_scene
)
FORCED = SceneField(  # field of each scene's results: amplitudes of upper bodies / the platform's, by harmonic
    "forced",
    list[ForcedRatio],
    "one per axis, harmonic and body above the platform; empty under a recorded motion",
    lambda findings, scene: compute_forced_ratios(scene),
)
FEATURE = Feature(  # radius, friction, mass, amplitude ratios of each scene: result fields, analysis, report section
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
