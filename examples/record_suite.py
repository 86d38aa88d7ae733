"""A suite of recorded motions at several intensities: median and spread of a demand (incremental dynamic analysis)."""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from comparison.analyses.ensemble.command import main

MOTIONS = 6


def write_suite(folder: Path) -> None:
    """Write noise that rises and decays, in place of recorded motions. A suite is a folder of CSV files."""
    folder.mkdir(exist_ok=True)
    time = np.arange(0.0, 10.0, 0.02)
    for number in range(MOTIONS):
        noise = np.random.default_rng(number).normal(0.0, 1.0, (2, 101))
        shape = (time / 2.0) ** 2 * np.exp(2.0 - time)
        along = [shape * np.interp(time, np.linspace(0.0, 10.0, 101), row) for row in noise]
        table = np.column_stack([time, *along])
        np.savetxt(
            folder / f"motion-{number}.csv", table, "%.6g", ",", header="time [s],ax [m/s^2],ay [m/s^2]", comments=""
        )


def draw(ensemble: Path, picture: str) -> None:
    """Draw median and fractiles of two demands over the scale of the motions."""
    stripes = json.loads(ensemble.read_text(encoding="utf-8"))["stripes"]
    figure, axes = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
    for axis, quantity in zip(axes, ("displacement", "drift")):
        rows = [row for row in stripes if row["quantity"] == quantity and row["body"] in (None, 2)]
        scales = [row["scale"] for row in rows]
        low, median, high = (
            [np.nan if row["fractiles"][k]["value"] is None else 1e3 * row["fractiles"][k]["value"] for row in rows]
            for k in range(3)
        )
        axis.fill_between(scales, low, high, alpha=0.3, label="16 % to 84 %")
        axis.plot(scales, median, label="median")
        axis.set(xlabel="scale of the motions", ylabel=f"{quantity} [mm]", ylim=(0, None))
    axes[0].legend()
    figure.savefig(picture, dpi=100)


if __name__ == "__main__":  # the worker processes of a study import this script, and must not start the study again
    write_suite(Path("suite"))
    words = "fig3-I --suite suite --scales 0.5 3 6 --engine 0 --out ensemble"
    code = main(words.split())
    draw(Path("ensemble/summary.json"), "record_suite.png")
    raise SystemExit(code)
