"""The solver against the independent answers of `oracle_values.json` (made by oracle_values.py)."""

import json
from typing import Any

import numpy as np
import pytest
from oracle import answer
from oracle_cases import scene_of
from oracle_values import STORE

import reference

VALUES: list[dict[str, Any]] = json.loads(STORE.read_text())
TOLERANCE = 1e-7
# a resolved peak is read where |v| passes the cutoff: it is as good as that instant, not as good as a maximum
CUTOFF_LOSS = 10.0


@pytest.mark.parametrize("entry", VALUES, ids=lambda entry: entry["name"])
def test_amplification_is_the_oracle_s(entry, within):
    """Supremum (or smooth law), and the resolved peak at every cutoff, each body."""
    law = entry["equations"], entry["regularization"], TOLERANCE
    for cutoff, mu, error in zip(entry["cutoff"], entry["mu"], entry["error"], strict=True):
        # by the solver, even where a sum of motions would do
        found = reference.amplification(
            scene_of(entry["scene"]), [entry["phase"]], *law, cutoff=cutoff or None, full=True
        )
        assert found.status[0] == "ok"
        slack = CUTOFF_LOSS if cutoff else 1.0
        allowed = np.array(error) + slack * TOLERANCE * np.array(mu)
        within((np.abs(found.mu[0] - mu) / allowed).max(), 1.0)


@pytest.mark.parametrize("entry", [e for e in VALUES if e["regularization"] is None], ids=lambda entry: entry["name"])
def test_trajectory_ends_and_rests_as_the_oracle_says(entry):
    scene = scene_of(entry["scene"])
    run = reference.trajectory(scene, entry["phase"], entry["equations"], tolerance=TOLERANCE, times=[scene.duration])
    assert run.status == "ok"
    swing = entry["swing"] * scene.radius
    np.testing.assert_allclose(run.position[0, :, :2], entry["position"], atol=1e3 * TOLERANCE * swing)
    if entry["same_rests"] and scene.friction_coefficient > 0.0 and not scene.lubricated:
        found, wanted = np.array(run.stick), np.array(entry["rests"])
        assert found.shape == wanted.shape
        # the end of a rest is a root of a curve that may be flat: digits halve
        np.testing.assert_allclose(found, wanted, atol=10.0 * TOLERANCE**0.5)


@pytest.mark.long
@pytest.mark.parametrize("entry", VALUES[::8], ids=lambda entry: entry["name"])
def test_the_stored_values_are_what_the_oracle_says(entry):
    law = tuple(entry["phase"]), entry["equations"], entry["regularization"]
    found = answer(scene_of(entry["scene"]), *law, 1e-8, entry["cutoff"])
    np.testing.assert_allclose(found.mu, entry["mu"], rtol=3e-6)
