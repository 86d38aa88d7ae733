"""Effective values: in the report."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from comparison.analyses.effective_values.analysis import PHASES, Effective, EffectiveValues, ForcedRatio, forced_ratios
from comparison.report.section import Feature, Findings, Report, SceneField, Section
from reference.problem import Scene


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    return {
        "effective": [values for scene in report.results.scenes for values in scene.of("effective")],
        "phases": PHASES,
    }


def _of_scene(findings: Findings, scene: Scene) -> list[Effective]:
    return [values for values in findings.found.get("effective") or [] if values.scene == scene.name]


FEATURE = Feature(
    "effective",
    analysis=EffectiveValues(),
    scene_fields={
        "effective": SceneField(list[Effective], "the scene, then every model", _of_scene),
        "forced": SceneField(
            list[ForcedRatio],
            "one per axis, harmonic and body above the platform; empty under a recorded motion",
            lambda findings, scene: forced_ratios(scene),
        ),
    },
    section=Section(
        "Effective values",
        context=_context,
        verifies=True,
        template="effective_values/section.html.j2",
    ),
)
