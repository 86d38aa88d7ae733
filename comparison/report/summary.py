"""summary.json: the numbers of a report for programs. VERSION grows when a key changes its meaning or goes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from comparison.analysis.claims_and_trends import claims_summary, trends_summary
from comparison.analysis.errata import ERRATA
from comparison.analysis.surfaces import largest_cap_share, outcome_counts
from comparison.analysis.verdicts import verdict
from comparison.report.findings import Findings
from comparison.study.models import models_of
from reference.problem import Scene

SCHEMA = "phase-resonance/summary"
VERSION = 3


def summary(findings: Findings) -> dict[str, Any]:
    """
    Everything a program needs to judge a run without the report. NaN is written as null.

    Every key stands with its meaning in summary.schema.json.
    """
    study = findings.study
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "run": dict(findings.run),
        "grid": study.grid,
        "tolerance": study.tolerance,
        "models": [
            {"key": model.key, "title": model.title, "adds": model.adds, "settings": dict(model.settings)}
            for model in study.hierarchy
        ],
        "scenes": [_scene(findings, scene) for scene in study.scenes],
        "errata": None
        if "errata" in findings.absent
        else [
            {
                "where": erratum.where,
                "printed": erratum.printed,
                "corrected": erratum.corrected,
                "why": erratum.why,
                "none": erratum.none,
                "effects": [_finite(asdict(effect)) for effect in findings.effects if effect.erratum == number],
            }
            for number, erratum in enumerate(ERRATA)
        ],
        "assumptions": findings.assumptions and _finite(findings.assumptions.listed()),
        "claims": claims_summary(findings.claims),
        "scaling": _finite(trends_summary(findings.scaling)),
        "convergence": _finite(trends_summary(findings.convergence)),
        "extremes": findings.extremes and _finite(asdict(findings.extremes)),
        "tradeoff": findings.tradeoff and [_finite(asdict(trade)) for trade in findings.tradeoff],
        "families": findings.families
        and [
            {
                "name": family.name,
                "key": family.key,
                "values": list(family.values),
                "scenes": [scene.name for scene in family.scenes],
            }
            for family in findings.families
        ],
        "unanswered": [asdict(one) for one in findings.unanswered],
        "broken": list(findings.broken),
        "faults": list(findings.faults),
    }


def _scene(findings: Findings, scene: Scene) -> dict[str, Any]:
    def own(rows: Sequence[Any]) -> list[dict[str, Any]]:
        return [_finite(asdict(row)) for row in rows if row.scene == scene.name]

    return {
        "name": scene.name,
        "title": scene.title,
        "digest": scene.digest(),
        "bodies": len(scene.bodies),
        "duration": scene.duration,
        "acceptance": scene.acceptance.model_dump(),
        "models": {
            model.key: {
                "phases_per_axis": len(findings.study.axis(model, scene)),
                "outcomes": outcome_counts(findings.surfaces, scene.name, model.key),
                "cap_share": _finite(largest_cap_share(findings.surfaces, scene.name, model.key)),
                "cost": float(findings.surfaces["cost"].sel(scene=scene.name, model=model.key)),
            }
            for model in models_of(scene, findings.study.hierarchy)
        },
        "verdict": _finite(asdict(verdict(findings.study, findings.surfaces, scene))),
        "differences": own(findings.rows),
        "budget": own(findings.budget),
        "effective": own(findings.effective),
    }


def _finite(value: Any) -> Any:
    """JSON knows no NaN: null instead."""
    if isinstance(value, dict):
        return {key: _finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
