"""The claims of the paper: in the report."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from comparison.analyses.claims.peaks_and_valleys import LEAST_SHARE, MOST_SHARE, SHARE
from comparison.analyses.claims.result import Claim, Claims, ClaimVerdict
from comparison.analyses.claims.spike import PHASES
from comparison.analyses.claims.table import SIGNS, ClaimTable
from comparison.analyses.claims.table import Claims as ClaimAnalysis
from comparison.report.plots import Panel, plain
from comparison.report.section import Feature, Report, Section


def _listed(table: ClaimTable) -> Claims:
    return Claims(
        grid=table.grid,
        readings=[reading.name for reading in table.readings],
        origins=[reading.origin for reading in table.readings],
        spike=table.spike,
        reproduced=[table.held(column) for column in range(len(table.readings))],
        best=[reading.name for reading in table.best],
        never=[f"{claim.figure}: {claim.says}" for claim in table.never],
        claims=[
            Claim.model_validate(
                {
                    "figure": claim.figure,
                    "says": claim.says,
                    "rule": claim.rule,
                    "weaker": claim.weaker,
                    "proof": claim.proof,
                    "verdicts": list(row),
                }
            )
            for claim, row in zip(table.claims, table.verdicts)
        ],
    )


def claim_heat(claims: Claims) -> list[dict[str, Any]]:
    """How many claims about each figure each reading reproduces; level: 0 (none) to 4 (all)."""
    counted = [claim for claim in claims.claims if not claim.weaker]
    rows = []
    for figure in dict.fromkeys(claim.figure for claim in counted):
        about = [claim for claim in counted if claim.figure == figure]
        held = [
            sum(claim.verdicts[column].finding in ("reproduced", "as drawn") for claim in about)
            for column in range(len(claims.readings))
        ]
        cells = [{"held": h, "claims": len(about), "level": math.ceil(4 * h / len(about))} for h in held]
        rows.append({"figure": figure, "cells": cells})
    return rows


def spike_panels(claims: Claims) -> list[Panel]:
    """mu_1 of the literal integration over its step, with and without the instants at which slip begins."""
    if not claims.spike.steps:
        return []
    spike = claims.spike
    series: list[dict[str, Any]] = []
    for number, phases in enumerate(PHASES):
        place = f"({phases[0]:g}, {phases[1]:g})"
        for words, values, dashed in (
            ("spike counted", [row[number] for row in spike.counted], False),
            ("left out", [row[number] for row in spike.left_out], False),
            ("reference", [spike.limit[number]] * len(spike.steps), True),
        ):
            line = {
                "x": spike.steps,
                "y": plain(values),
                "color": number,
                "marks": not dashed,
                "dash": "5 4" if dashed else "",
            }
            series.append({"name": f"{place}, {words}", **line})
    plot = {
        "label": "mu_1 of the literal integration over its step, with and without the instants at which slip begins",
        "x": {"title": "step, s", "log": True},
        "y": {"title": "μ_1"},
        "series": series,
    }
    starts = [
        {
            "name": f"({phases[0]:g}, {phases[1]:g})",
            "x": spike.steps,
            "y": [row[number] for row in spike.starts],
            "color": number,
            "marks": True,
        }
        for number, phases in enumerate(PHASES)
    ]
    counts = {
        "label": "How often slip begins over the step",
        "x": {"title": "step, s", "log": True},
        "y": {"title": "beginnings of slip", "log": True},
        "series": starts,
    }
    return [{"title": "fig3-I, literal (4.6)", "plot": plot}, {"title": "How often slip begins", "plot": counts}]


def _claim_findings(claim: Claim) -> list[tuple[ClaimVerdict, list[int]]]:
    """What the checks of a claim found, each different answer once, with the numbers of its readings from 1 on."""
    groups: dict[tuple[str, str], tuple[ClaimVerdict, list[int]]] = {}
    for number, verdict in enumerate(claim.verdicts, start=1):
        groups.setdefault((verdict.finding, verdict.found), (verdict, []))[1].append(number)
    return list(groups.values())


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    claims: Claims = report.results.of("claims")
    return {
        "claim_heat": claim_heat(claims),
        "spike_panels": spike_panels(claims),
        "claim_findings": _claim_findings,
        "claim_signs": SIGNS,
        "peak_share": SHARE,
        "peak_shares": (LEAST_SHARE, MOST_SHARE),
    }


FEATURE = Feature(
    "claims",
    Claims,
    "the paper's statements about its figures; null unless every scene of the paper was studied",
    analysis=ClaimAnalysis(),
    summary=_listed,
    section=Section(
        "claims",
        "The paper's claims",
        "claims/section.html.j2",
        ("claims",),
        "python -m comparison.run with every scene of the paper makes it, and python -m comparison.claims alone",
        _context,
        verifies=True,
    ),
)
