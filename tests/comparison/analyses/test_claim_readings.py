"""Readings change what they say; the literal (4.6), forced ratios and proofs do what they say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from claims_literal import STEPS, literal_peaks, spike_over_the_step

from comparison.analyses.claims.evidence import Question, gathered
from comparison.analyses.claims.readings import CASES, LIGHT_BODY, LITERAL, OWN_PERIOD, Reading
from comparison.analyses.effective_values.analysis import forced_ratios
from reference import amplification, load_scene, modes
from reference.problem import ground_peak

PHASES = np.array([(0.3, 1.1), (2.0, 0.7)])


def test_readings_change_the_keys_they_name() -> None:
    light = CASES["fig4-dry"](LIGHT_BODY)
    assert light.masses.tolist() == [1.0, 0.1]
    assert light.bodies[1].period == pytest.approx([4.5, 4.5])
    assert light.friction_coefficient == 0.01
    assert light.largest_acceleration == pytest.approx(0.2)
    own = CASES["fig3-I"](OWN_PERIOD)
    assert own.excitation.periods == pytest.approx([0.54, 0.66])
    assert own.excitation.decay == pytest.approx([0.3 / 0.54, 0.3 / 0.66])
    assert np.abs(modes(own).period[:, 1] / 0.6 - 1.0).max() < 0.06, "the short natural periods"
    wet = CASES["fig4-viscous"](OWN_PERIOD)
    assert wet.lubricated
    assert wet.friction_coefficient == Reading.lubrication


def test_the_platform_alone_is_loaded_close_to_its_own_period() -> None:
    alone = CASES["fig3-I alone"](OWN_PERIOD)
    natural = float(modes(alone).period[0, 0])
    gaps = np.array(alone.excitation.periods) / natural - 1.0
    assert gaps == pytest.approx([-0.1, 0.1])


@pytest.mark.long
def test_the_literal_reading_tends_to_the_printed_rest() -> None:
    scene = CASES["fig3-I"](LITERAL)
    limit = amplification(scene, PHASES, "small", cutoff=1e-3, tolerance=1e-4, rest_condition="printed").mu
    steps = 1e-3, 5e-4, 2.5e-4
    gaps = [np.abs(literal_peaks(scene, PHASES, step, spike=False).mu / limit - 1.0).max() for step in steps]
    assert gaps[0] > gaps[1] > gaps[2]
    assert gaps[2] < 5e-3
    spikes = [literal_peaks(scene, PHASES, step).mu[:, 0] for step in (1e-3, 1.25e-4)]
    assert np.abs(spikes[0] / spikes[1] - 1.0).max() < 5e-3, "its height does not fade with its length"
    assert (spikes[1] > 1.8 * limit[:, 0]).all()


def test_the_literal_reading_rests_where_nothing_slides() -> None:
    scene = CASES["fig3-I"](replace(LITERAL, amplitude=0.2))
    peaks = literal_peaks(scene, PHASES, 5e-4)
    expected = amplification(scene, PHASES, "small", tolerance=1e-6).mu
    assert peaks.spikes.tolist() == [0, 0]
    assert np.abs(peaks.mu / expected - 1.0).max() < 1e-3


def test_the_spike_is_counted_once_for_every_beginning_of_slip() -> None:
    spike = spike_over_the_step(Reading(1.0, duration=3.0, peak="literal (4.6)"))
    counted, left_out, starts = map(np.array, (spike.counted, spike.left_out, spike.starts))
    assert counted.shape == left_out.shape == starts.shape == (len(STEPS), 3)
    assert (counted >= left_out).all()
    assert (starts > 0).all()


def test_forced_ratios_are_those_of_oscillator_and_chain() -> None:
    scene = load_scene("fig3-II")
    for each in forced_ratios(scene):
        soft = {"x": 1.5, "y": 1.2}[each.axis]
        s = complex(-0.3 / each.period, 2.0 * np.pi / each.period)
        assert each.steady == pytest.approx(1.0 / abs(1.0 - (soft / each.period) ** 2))
        assert each.ratio == pytest.approx(1.0 / abs(1.0 + (s * soft / (2.0 * np.pi)) ** 2))
    assert [round(each.steady, 2) for each in forced_ratios(scene) if each.axis == "y"] == [1.29, 5.26]
    body = scene.bodies[1].model_dump(exclude_none=True)
    light = scene.with_values({"bodies": [scene.bodies[0].model_dump(exclude_none=True), body, {**body, "mass": 1e-9}]})
    two = [each.ratio for each in forced_ratios(scene)]
    three = [each.ratio for each in forced_ratios(light)]
    assert three[::2] == pytest.approx(two, rel=1e-6)
    assert three[1::2] == pytest.approx([each**2 for each in two], rel=1e-6), "each body drives the next alike"
    assert forced_ratios(scene.with_values({"bodies": [scene.bodies[0].model_dump(exclude_none=True)]})) == []


def test_a_peak_in_a_corner_has_its_twin_in_the_center() -> None:
    """The proof that peaks cannot stand in corners alone, computed without any use of symmetry."""
    scene = CASES["fig3-II"](LIGHT_BODY).with_values({"duration": 6.0})
    phases = np.array([(0.1, 0.2), (5.9, 0.3)])
    pairs = [amplification(scene, phases + shift, "small", tolerance=1e-6, full=True).mu for shift in (0.0, np.pi)]
    assert np.abs(pairs[0] / pairs[1] - 1.0).max() < 1e-6


def test_the_fold_of_the_denominator_is_in_viscous_surfaces() -> None:
    """The proof that viscous friction cannot smooth them: second differences across it fall like the step alone."""
    evidence = gathered(Question("fig4-viscous", Reading(), 8))
    assert evidence.ground is not None
    assert evidence.ground.kind == "fold"
    scene, way = CASES["fig4-viscous"](Reading()), np.array([1.0, -1.0])
    near = np.array(evidence.ground.phases) + np.linspace(-0.1, 0.1, 4001)[:, None] * way
    center = near[1 + int(np.abs(np.diff(ground_peak(scene, near), 2)).argmax())]
    sizes = []
    for h in (0.02, 0.01, 0.005):
        line = center + np.array([-h, 0.0, h])[:, None] * way
        mu = amplification(scene, line, "small", tolerance=1e-8).mu
        ground = ground_peak(scene, line)[:, None]
        sizes.append([np.abs(np.diff(f, 2, axis=0)).max() for f in (ground, mu[:, :1], mu[:, 1:])])
    exponents = np.log2(np.array(sizes[:-1]) / np.array(sizes[1:]))
    assert (exponents[-1] < 1.5).all()
