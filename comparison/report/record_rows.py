"""What stands in place of a surface under a recorded motion: one row per model."""

from __future__ import annotations

from typing import Any

from comparison.report.findings import Findings
from comparison.study.models import models_of
from comparison.wording import significant
from reference.problem import Scene


def record_rows(found: Findings, scene: Scene, body: int) -> list[dict[str, Any]]:
    """mu of one body by every model with its error, status and step; nothing for a scene with phases."""
    if not scene.recorded:
        return []
    data = found.surfaces.sel(scene=scene.name, body=body).isel(alpha1=0, alpha2=0)
    steps = {entry.step: entry for entry in found.budget if (entry.scene, entry.body) == (scene.name, body)}
    rows = []
    for model in models_of(scene, found.study.hierarchy):
        mu, error = (float(data[name].sel(model=model.key)) for name in ("mu", "error"))
        status = str(data["status"].sel(model=model.key).item())
        row = {"model": model.title, "mu": significant(mu), "error": error, "status": status}
        rows.append({**row, "step": steps.get(model.key)})
    return rows
