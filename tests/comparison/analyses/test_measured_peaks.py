"""Measured peaks beside the models: synthetic data made by one model, and what fails."""

import math
from dataclasses import replace

import pytest
from known_analyses import collected

import reference
from comparison.analyses.measured import analysis
from comparison.analyses.measured.analysis import MeasuredPeaks, _compare_peak, verdict_line, word_measured
from comparison.study import batches
from comparison.study.models import EXACT, EXACT_AS_INTEGRATED, MODEL_HIERARCHY, REGULARIZED, SMALL, TRANSLATIONAL
from comparison.study.study import Study
from comparison.study.user_models import make_user_model
from reference.problem import Scene, load_scene

PHASES = (0.3, 1.1)
PLAIN = load_scene("fig3-I").with_values({"duration": 3.0, "bodies.1.height": None, "bodies.1.size": None})


def peak(quantity: str, value: float, uncertainty: float, body: int | None = None, **more) -> dict:
    table = {"quantity": quantity, "body": body, "value": value, "uncertainty": uncertainty, "phases": list(PHASES)}
    return {key: each for key, each in {**table, **more}.items() if each is not None}


def compared(scene: Scene, *hierarchy):
    return collected(MeasuredPeaks(), Study((scene,), 1, 1e-3, hierarchy))


def synthetic(noise: float) -> Scene:
    """Peaks of the exact equations, each larger by `noise` uncertainties of a hundredth of itself."""
    numbers = reference.demands(reference.trajectory(PLAIN, PHASES))
    mu = reference.amplification(PLAIN, [PHASES]).mu[0]
    values = [("mu", mu[1], 2), ("displacement", numbers.displacement.value, None)]
    values += [("acceleration", numbers.acceleration[0].value, 1), ("drift", numbers.drift[0].value, 2)]
    values += [("base_shear", numbers.base_shear.value, None)]
    return PLAIN.with_values(
        {"measured": [peak(name, (1.0 + 0.01 * noise) * value, 0.01 * value, body) for name, value, body in values]}
    )


@pytest.mark.parametrize(("noise", "exceeds"), [(0.0, False), (0.9, False), (-1.1, True)])
def test_a_difference_exceeds_the_sum_of_both_uncertainties(noise, exceeds):
    peaks = compared(synthetic(noise), EXACT)
    assert [each.quantity for each in peaks] == ["mu", "displacement", "acceleration", "drift", "base_shear"]
    for each in peaks:
        (computed,) = each.computed
        assert computed.exceeds is exceeds
        assert computed.difference == pytest.approx(-0.01 * noise * computed.value, abs=1e-4 * computed.value)


def test_both_sides_stand_beside_a_measured_peak():
    absent = replace(EXACT, key="absent", amplification="nowhere:amplification", trajectory="nowhere:trajectory")
    peaks = compared(synthetic(0.0), SMALL, EXACT, EXACT_AS_INTEGRATED, TRANSLATIONAL, absent)
    assert [each.model for each in peaks[0].computed] == ["small", "exact", "resolved", "translational", "absent"]
    *others, engine, bad = peaks[1].computed
    assert [each.model for each in others] == ["small", "exact"], "one motion, read twice"
    assert others[1].exceeds is False
    assert bad.exceeds is None
    assert math.isnan(bad.value)
    assert engine.value == pytest.approx(peaks[1].value, rel=0.02), "friction linear below v_reg"
    assert 0.0 < engine.error < 1e-2 * engine.value


def test_a_motion_that_ends_early_has_no_peaks_and_says_why():
    ends = {"isolator.travel": 1e-3, "measured": [peak("displacement", 0.03, 0.001)]}
    lacks = {"measured": [peak("torsion", 0.01, 0.001, 1)]}
    for values, status in ((ends, "travel reached"), (lacks, "the model has no such value")):
        (only,) = compared(PLAIN.with_values(values), EXACT)
        assert (only.computed[0].status, only.computed[0].exceeds) == (status, None)


def test_both_functions_of_a_model_have_its_tolerance_and_law(monkeypatch):
    asked = []
    monkeypatch.setattr(batches, "import_function", lambda path: lambda *given, **settings: asked.append(settings))
    for quantity in ("mu", "drift"):
        with pytest.raises((AttributeError, TypeError)):  # None is no answer
            analysis.compute_peaks_at_phases((PLAIN, REGULARIZED, 1e-4, (0.0, 0.0), ((quantity, 2),)))
    assert asked == [{"tolerance": 1e-4, **REGULARIZED.settings}] * 2


def test_a_record_is_compared_without_phases():
    scene = load_scene("synthetic-pair").with_values({"duration": 3.0})
    stated = peak("displacement", 0.01, 0.001)
    del stated["phases"]
    (only,) = compared(scene.with_values({"measured": [stated]}), EXACT)
    assert math.isnan(only.phases[0])
    assert math.isfinite(only.computed[0].value)


def test_every_model_with_motions_is_asked_what_a_test_measured_at_its_phases():
    other = peak("drift", 0.01, 0.001, 2, phases=[1.0, 2.0])
    scene = PLAIN.with_values({"measured": [peak("mu", 3.0, 0.1, 1), other]})
    study = Study((scene,), 1, 1e-3, (EXACT, make_user_model("mine", {"function": "nowhere:mu"})))
    asked = [(task.argument[1].key, *task.argument[3:]) for task in MeasuredPeaks().tasks(study)]
    assert asked == [("exact", PHASES, [("mu", 1)]), ("exact", (1.0, 2.0), [("drift", 2)])]
    nothing = Study((PLAIN,), 1, 1e-3, MODEL_HIERARCHY)
    assert MeasuredPeaks().tasks(nothing) == []
    assert collected(MeasuredPeaks(), nothing) is None


def test_what_is_not_known_exceeds_nothing():
    scene = PLAIN.with_values({"measured": [peak("mu", 1.0, 0.1, 1)]})
    [stated] = scene.measured
    known = {"near": (1.15, 0.1), "far": (0.75, 0.1), "none": (math.nan, math.nan)}
    found = _compare_peak(scene, stated, [(key, {("mu", 1): (*numbers, "ok")}) for key, numbers in known.items()])
    assert [each.exceeds for each in found.computed] == [False, True, None], "0.15 < 0.1 + 0.1 < 0.25"
    assert [each.difference for each in found.computed[:2]] == pytest.approx([0.15, -0.25])
    assert [found.word(each) for each in found.computed] == ["met", "not met (by −25 %)", "not compared: ok"]
    line = word_measured([found])
    counts = "3 comparisons: 1 met, 1 not met, 1 not compared"
    assert line == f"1 measured peak stands beside the models ({counts})"
    largest = f"largest: {scene.name}, mu of body 1, far, −25 %"
    assert verdict_line([found]) == counts.replace("1 not met", f"1 not met ({largest})")
    [none] = PLAIN.with_values({"measured": [peak("drift", 0.0, 0.1, 2)]}).measured
    drift = _compare_peak(scene, none, [("a", {("drift", 2): (0.3, 0.1, "ok")})])
    assert drift.word(drift.computed[0]) == "not met (by +0.3 m)"
