"""Effective values: in the report."""

from comparison.analyses.effective_values.analysis import PHASES, Effective, EffectiveValues, ForcedRatio, forced_ratios
from comparison.report.section import Feature, SceneField, Section

FEATURE = Feature(
    "effective",
    analysis=EffectiveValues(),
    scene_fields={
        "effective": SceneField(
            list[Effective],
            "the scene, then every model",
            lambda findings, scene: [
                each for each in findings.found.get("effective") or [] if each.scene == scene.name
            ],
        ),
        "forced": SceneField(
            list[ForcedRatio],
            "one per axis, harmonic and body above the platform; empty under a recorded motion",
            lambda findings, scene: forced_ratios(scene),
        ),
    },
    section=Section(
        "Effective values",
        context=lambda report, figures: {
            "effective": [values for scene in report.results.scenes for values in scene.of("effective")],
            "phases": PHASES,
        },
        verifies=True,
        template="effective_values/section.html.j2",
    ),
)
