"""Scenes that end early, where the loading is strongest."""

import numpy as np

from reference.problem import Scene, exponents


def shorten_scene(scene: Scene, periods: float) -> Scene:
    """Return the scene with its duration cut to at most `periods` periods of the slower harmonic of its loading."""
    longest = float(2.0 * np.pi / exponents(scene).imag.min())
    return scene.with_values({"duration": min(scene.duration, periods * longest)})
