"""Ask the equations and the engine about the building, and print what they answer: `python study.py --help`."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

import multibody
import reference

SCENE = Path(__file__).with_name("building.toml")


def main() -> None:
    """Print the range of the amplification, and for the worst phases the values by both codes and the demands."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--grid", type=int, default=12, help="phases per axis (default %(default)s)")
    grid = parser.parse_args().grid

    scene = reference.load_scene(SCENE)
    phases = reference.phase_grid(grid)  # rad, one pair per row
    answer = reference.amplification(scene, phases, tolerance=1e-6)  # answer.mu: a row per pair, a column per body
    worst = int(np.nanargmax(answer.mu[:, -1]))
    print(f"{scene.title}: {len(phases)} phase pairs, status {', '.join(sorted(set(answer.status)))}")
    for body, (low, high) in enumerate(zip(np.nanmin(answer.mu, axis=0), np.nanmax(answer.mu, axis=0)), start=1):
        print(f"  body {body}: mu from {low:.3f} to {high:.3f}")

    # equations and engine with the same friction law, at the phases where the top's amplification is largest
    v_reg, pair = 1e-3, phases[worst : worst + 1]  # speed below which friction is linear, m/s; worst phases, rad
    equations = reference.amplification(scene, pair, regularization=v_reg)
    engine = multibody.amplification(scene, pair, regularization=v_reg)
    print(f"phases {pair[0].round(3).tolist()} rad, like for like:")
    for body in range(len(scene.bodies)):
        print(
            f"  body {body + 1}: equations {equations.mu[0, body]:.4f} ± {equations.error[0, body]:.1g}, "
            f"engine {engine.mu[0, body]:.4f} ± {engine.error[0, body]:.1g}"
        )

    demands = reference.demands(reference.trajectory(scene, pair[0]))
    print(f"  displacement {demands.displacement.value:.4f} m, base shear {demands.base_shear.value / 1e3:.1f} kN")
    print("  drifts " + ", ".join(f"{drift.value * 1e3:.2f}" for drift in demands.drift) + " mm")


if __name__ == "__main__":
    main()
