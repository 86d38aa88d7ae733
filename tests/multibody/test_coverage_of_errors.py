"""Stated errors of the engine, on random scenes whose factors another program knows (random_truths.json)."""

import numpy as np
from random_truths import LIKE_FOR_LIKE, beyond_and_ratios, case_of

import multibody


def test_errors_cover_the_truth_and_are_not_far_too_large() -> None:
    """Of 128 values none is beyond its error; stated over true error is 76 in the median."""
    truths, found = LIKE_FOR_LIKE[::2], []
    for truth in truths:
        scene, phase, v_reg, tolerance = case_of(truth["seed"])
        found.append(multibody.amplification(scene, [phase], regularization=v_reg, tolerance=tolerance))
    beyond, ratios = beyond_and_ratios(truths, found)
    assert len(ratios) > 100
    assert np.mean(beyond) <= 0.01
    assert 50.0 <= np.median(ratios) <= 115.0
