"""The limits that a scene states before the run, held against what was found."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr

from comparison.account.budget import closure, steps
from comparison.account.differences import Difference
from comparison.account.surfaces import common_phases
from comparison.plan.ladder import pairs_of
from comparison.plan.study import Study
from reference.problem import Scene


def broken_limits(study: Study, surfaces: xr.Dataset, rows: Sequence[Difference]) -> list[str]:
    """One line per limit of [acceptance] that is broken: scene, body, key, value found, limit. Empty: all hold."""
    lines: list[str] = []
    for scene in study.scenes:
        stated = scene.acceptance
        if "like-for-like" not in {pair.key for pair in pairs_of(scene, study.ladder)}:
            lines.append(
                f"{scene.name}: acceptance: no engine in this study, so that nothing is compared like for like"
            )
            continue
        for body in range(1, len(scene.bodies) + 1):
            row = next(r for r in rows if (r.scene, r.body, r.pair) == (scene.name, body, "like-for-like"))
            held = {
                "median": (row.median, stated.median),
                "maximum": (row.maximum, stated.maximum),
                "ratio": (row.ratio, stated.ratio),
                "closure": (closure(steps(study, surfaces, scene.name, body)), stated.closure),
            }
            lines += [
                f"{scene.name}: body {body}: acceptance.{key}: {found:.3g} found, {limit:.3g} allowed"
                for key, (found, limit) in held.items()
                if limit is not None and not found <= limit  # NaN, no point to compare, breaks the limit
            ]
        without, allowed = _unanswered(study, scene, surfaces), stated.failed
        if without > allowed:
            lines.append(f"{scene.name}: acceptance.failed: {without} points without an answer, {allowed} allowed")
    return lines


def _unanswered(study: Study, scene: Scene, surfaces: xr.Dataset) -> int:
    """Points without an answer in the two models compared like for like, counted on both sides together."""
    pair = next(pair for pair in pairs_of(scene, study.ladder) if pair.key == "like-for-like")
    return sum(
        int(
            common_phases(surfaces, scene.name, [model])["mu"]
            .sel(model=model)
            .isel(body=slice(len(scene.bodies)))
            .isnull()
            .any("body")
            .sum()
        )
        for model in (pair.first.key, pair.second.key)
    )
