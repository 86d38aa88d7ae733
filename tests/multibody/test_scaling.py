"""Loading and friction scaled together by s: the sphere's curvature fades like s^2, and with it all but numerics."""

import numpy as np
from scenes_at_hand import changed

import multibody
import reference
from reference.problem import load_scene


def test_the_gap_to_the_small_equations_falls_as_a_square() -> None:
    full = changed(load_scene("fig3-I"), duration=6.0)
    phase, gaps = [(0.3, 1.1)], []
    for scale in (1.0, 0.5):
        scene = changed(full.with_amplitude(scale), isolator={"friction": scale * full.friction_coefficient})
        v_reg = scale * 2e-3
        engine = multibody.amplification(scene, phase, regularization=v_reg, tolerance=1e-4)
        small = reference.amplification(scene, phase, equations="small", regularization=v_reg)
        gaps.append(np.abs(engine.mu / small.mu - 1.0)[0])
    # of the gap, 4 % (platform) and 0.1 % at full scale, the next order takes (x1 / rho)^2 = 1 %, numerics 1e-5
    np.testing.assert_allclose(np.log2(gaps[0] / gaps[1]), 2.0, atol=0.1)
    assert (gaps[1] > 2e-4).all()
