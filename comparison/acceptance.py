"""The limits a scene states for the like-for-like pair, held against what was found."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr

from comparison.differences import Difference
from comparison.ladder import pairs_of
from comparison.study import Study
from reference.problem import Scene


def broken_limits(study: Study, surfaces: xr.Dataset, rows: Sequence[Difference]) -> list[str]:
    """One line per limit of [acceptance] that is broken: scene, body, key, value found, limit. Empty: all hold."""
    lines: list[str] = []
    for scene in study.scenes:
        limits = {"median": scene.acceptance.median, "maximum": scene.acceptance.maximum}
        for row in rows:
            if row.scene != scene.name or row.pair != "like-for-like":
                continue
            for key, limit in limits.items():
                found = getattr(row, key)
                if limit is not None and not found <= limit:  # NaN, no point to compare, breaks the limit
                    lines.append(
                        f"{scene.name}: body {row.body}: acceptance.{key}: {found:.3g} found, {limit:.3g} allowed"
                    )
        without, allowed = _unanswered(study, scene, surfaces), scene.acceptance.failed
        if without > allowed:
            lines.append(f"{scene.name}: acceptance.failed: {without} points without an answer, {allowed} allowed")
    return lines


def _unanswered(study: Study, scene: Scene, surfaces: xr.Dataset) -> int:
    """Points without an answer in the two models compared like for like, counted on both sides together."""
    pair = next(pair for pair in pairs_of(scene, study.ladder) if pair.key == "like-for-like")
    mu = surfaces["mu"].sel(scene=scene.name, model=[pair.first.key, pair.second.key])
    return int(mu.isel(body=slice(len(scene.bodies))).isnull().any("body").sum())
