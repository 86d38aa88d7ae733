"""
Differences of mu_1 in both readings of (5.1), from the files of a report alone: nothing of the project is imported.

    python tests/oracles/reading_table.py REPORT

recomputes the means and largest sizes from surfaces.nc, prints them beside those of summary.json, and ends with 1 where
one differs in a printed digit.
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

GRID = 16  # phases per axis that all models of the default study have
PAIRS = (  # keys of the first and the second model; sizes are relative to the first
    ("small", "spatial"), ("small-resolved", "spatial"), ("small-resolved", "translational"),
    ("small", "small-resolved"), ("small", "exact"), ("small-resolved", "resolved"),
    ("small-resolved", "small-regularised"),
)  # fmt: skip


def recomputed(surfaces: xr.Dataset, scene: str, first: str, second: str, body: int, grid: int) -> tuple[float, float]:
    """Mean and largest size of second minus first over first on grid x grid phases."""
    mu = surfaces["mu"].sel(scene=scene, body=body)
    stride = mu.sizes["alpha1"] // grid
    one, other = (mu.sel(model=key).values[::stride, ::stride] for key in (first, second))
    size = (other - one) / one
    return float(np.nanmean(size)), float(np.nanmax(np.abs(size)))


def stated(scene: dict[str, Any], first: str, second: str, body: int, grid: int) -> tuple[float, float]:
    """The same from summary.json."""
    rows = [*scene["differences"], *scene["effects"]]
    row = next(r for r in rows if (r["first"], r["second"], r["base"], r["body"]) == (first, second, first, body))
    (found,) = (each for each in row["grids"] if each["phases_per_axis"] == grid)
    return found["mean"], found["maximum"]


def main(report: Path, grid: int = GRID) -> int:
    """Print the table of every dry scene; 1 where a printed digit differs."""
    summary = json.loads((report / "summary.json").read_text(encoding="utf-8"))
    wrong = 0
    with xr.open_dataset(report / "surfaces.nc", engine="h5netcdf") as surfaces:
        for scene in summary["scenes"]:
            for first, second in PAIRS if {"small", "small-resolved", "spatial"} <= set(scene["models"]) else ():
                for body in (1, 2):
                    pairs = [
                        f"{100.0 * mean:+.3f} % ({100.0 * largest:.2f})"
                        for mean, largest in (
                            recomputed(surfaces, scene["name"], first, second, body, grid),
                            stated(scene, first, second, body, grid),
                        )
                    ]
                    wrong += pairs[0] != pairs[1]
                    print(f"{scene['name']}, mu_{body}, {first} -> {second}: {pairs[0]}; summary.json {pairs[1]}")
    print(f"{wrong} differ")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
