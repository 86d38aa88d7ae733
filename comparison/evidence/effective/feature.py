"""Effective values: in the report."""

from comparison.evidence.effective.analysis import (
    PHASES,
    Effective,
    EffectiveValues,
    ForcedRatio,
    forced_ratios,
    word_effective,
)
from comparison.report.section import Feature, Findings, SceneField, Section
from reference.problem import Scene


def _effective(findings: Findings, scene: Scene) -> list[Effective]:
    return [each for each in findings.found.get("effective") or [] if each.scene == scene.name]


FORCED = "one per axis, harmonic and body above the platform; empty under a recorded motion"
FEATURE = Feature(
    "effective",
    analysis=EffectiveValues(),
    scene_fields={
        "effective": SceneField(list[Effective], "the scene, then every model", _effective),
        "forced": SceneField(list[ForcedRatio], FORCED, lambda findings, scene: forced_ratios(scene)),
    },
    section=Section(
        "Effective values",
        context=lambda report, figures: {
            "effective": [values for scene in report.results.scenes for values in scene.of("effective")],
            "phases": PHASES,
        },
        verifies=True,
        verdict=lambda results: word_effective([each for scene in results.scenes for each in scene.of("effective")]),
    ),
)
