"""What a reader must know before trusting a number: refusals, broken limits, gaps, faults, wide swings. One place."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from comparison.report.findings import Findings
from comparison.study.models import Model, models_of
from comparison.surfaces.alert_result import Alert
from comparison.surfaces.surfaces import largest_cap_share, largest_travel_share
from reference.problem import Scene

NEARLY_ALL = 0.9  # of the travel, that a reader must know of
WIDE = 0.5  # of rho: a displacement of the platform from the middle that a reader must know of


def alerts(findings: Findings) -> list[Alert]:
    """
    Every alert of a run, red before amber, otherwise in the order of the kinds and scenes.

    Red: a model has no value at any phase pair, or an acceptance limit is broken. Amber: a model lacks a value at some
    phase pairs, a solver reported an error, or a platform moves so far that the report says so: over half of rho, or
    nearly its travel.
    """
    listed = [*_gaps(findings), *_limits(findings), *_faults(findings), *_swings(findings), *_travels(findings)]
    return sorted(listed, key=lambda alert: alert.level != "red")


def _gaps(findings: Findings) -> list[Alert]:
    rows = []
    for lacking in findings.unanswered:
        refused = lacking.points + lacking.unusable == lacking.asked
        rest = "" if lacking.used else "; comparisons leave this model out"
        outcomes = ", ".join(
            note.outcome if note.count == lacking.asked else f"{note.count} × {note.outcome}"
            for note in lacking.outcomes
        )
        rows.append(
            Alert(
                level="red" if refused else "amber",
                kind="refused" if refused else "lacking",
                scene=lacking.scene,
                text=f"{lacking.title}: {lacking.where}{f': {outcomes}' if outcomes else ''}{rest}",
                help="; ".join(note.advice for note in lacking.outcomes),
            )
        )
    return rows


def _limits(findings: Findings) -> list[Alert]:
    return [
        Alert(
            level="red",
            kind="limit",
            scene=limit.scene,
            text=text,
            help="read the cause of the difference, then correct the scene or the limit in its [acceptance] table",
        )
        for limit in findings.limits
        for text in limit.broken_texts
    ]


def _faults(findings: Findings) -> list[Alert]:
    return [
        Alert(level="amber", kind="fault", scene=fault.scene, text=fault.text, help="") for fault in findings.faults
    ]


def _swings(findings: Findings) -> list[Alert]:
    return _moving_far(
        findings,
        "swing",
        lambda scene, model: largest_cap_share(findings.surfaces, scene.name, model.key),
        WIDE,
        "moves up to {:.1f} % of rho from the middle",
        "the model assumes a cap that reaches so far: compare with the isolator that is to be built",
    )


def _travels(findings: Findings) -> list[Alert]:
    return _moving_far(
        findings,
        "travel",
        lambda scene, model: largest_travel_share(findings.surfaces, scene, model.key),
        NEARLY_ALL,
        "uses up to {:.1f} % of the isolator's travel",
        "a larger displacement ends the motion as travel reached",
    )


def _moving_far(
    findings: Findings,
    kind: Literal["swing", "travel"],
    share_of: Callable[[Scene, Model], float],
    limit: float,
    text: str,
    advice: str,
) -> list[Alert]:
    """Models whose platform moves by more than a share of what it may."""
    study = findings.study
    return [
        Alert(
            level="amber",
            kind=kind,
            scene=scene.name,
            text=f"{model.title}: the platform {text.format(100.0 * share)}",
            help=advice,
        )
        for scene in study.scenes
        for model in models_of(scene, study.hierarchy)
        if (share := share_of(scene, model)) > limit
    ]
