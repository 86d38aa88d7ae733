"""
Tests of each code alone, before the two are compared. The report prints it; the tests named here do it.

Agreement of two codes proves little if either could be wrong by itself in the same way.
"""

from __future__ import annotations

from dataclasses import dataclass

REFERENCE, ENGINE = "reference", "engine"


@dataclass(frozen=True)
class Check:
    """One check of one side: against what, how closely and why not closer, and the test that does it."""

    side: str
    against: str
    closeness: str
    file: str  # below tests/
    test: str


_MOTIONS = "reference/test_closed_form_motions.py"
_CONTACT = "multibody/test_contact.py"
_BENCHMARKS = "comparison/analyses/test_benchmarks.py"

CHECKS: tuple[Check, ...] = (
    Check(
        REFERENCE,
        "free decay under dry friction: turning points, stops, rest",
        "1e-7, ten times the tolerance asked",
        _MOTIONS,
        "test_free_coulomb_decay_of_the_small_equations",
    ),
    Check(
        REFERENCE,
        "planar slide down and up the sphere with the centripetal part of the contact force",
        "1e-7 in angle, 2e-7 in energy",
        _MOTIONS,
        "test_swing_down_and_up_the_cap_with_friction_of_the_exact_equations",
    ),
    Check(
        REFERENCE,
        "conical pendulum: rate, circle, contact force",
        "1e-6, a hundred times the tolerance, over many turns",
        _MOTIONS,
        "test_conical_pendulum_turns_at_its_frequency_with_a_constant_contact_force",
    ),
    Check(
        REFERENCE,
        "Den Hartog's forced oscillation with friction",
        "1e-7, what the sphere adds at so weak a loading",
        _MOTIONS,
        "test_den_hartog_s_oscillation_goes_on_as_it_was_begun",
    ),
    Check(
        REFERENCE,
        "surface without friction, by superposed modes",
        "within the error each value states",
        _MOTIONS,
        "test_frictionless_surface_is_the_closed_form_within_the_error_it_states",
    ),
    Check(
        REFERENCE,
        "frequencies and shapes of a uniform chain",
        "rounding",
        "reference/test_natural_modes.py",
        "test_uniform_chain_frequencies_and_shapes_are_the_closed_form",
    ),
    Check(
        REFERENCE,
        "energy balance along every run",
        "the tolerance asked",
        "reference/test_energy_balance.py",
        "test_energy_is_balanced",
    ),
    Check(
        REFERENCE,
        "another program: SciPy, event by event, from the same physics",
        "the sum of both errors",
        "reference/test_oracle_values.py",
        "test_amplification_is_the_oracle_s",
    ),
    Check(
        REFERENCE,
        "the matrices (3.9)-(3.13) written from the print, errata corrected",
        "1e-4, peaks read every 2 ms",
        "comparison/analyses/test_errata.py",
        "test_the_mended_matrices_are_the_exact_equations",
    ),
    Check(
        REFERENCE,
        "numbers published elsewhere: code_aster, ANSYS, Chopra, Den Hartog, Newmark",
        "the error of both",
        _BENCHMARKS,
        "test_the_equations_meet_every_published_number",
    ),
    Check(
        ENGINE,
        "static penetration N/k_c",
        "1e-6, Newton's tolerance",
        _CONTACT,
        "test_the_weight_presses_the_contact_in_by_the_static_penetration",
    ),
    Check(
        ENGINE,
        "creep of a held platform, v_reg F / (mu N)",
        "2e-6, the slope of the sphere squared",
        _CONTACT,
        "test_a_held_platform_creeps_with_v_reg_times_force_over_friction_limit",
    ),
    Check(
        ENGINE,
        "straight slide that stops after v^2 / (2 mu g)",
        "2e-5",
        _CONTACT,
        "test_sliding_stops_after_v_squared_over_two_mu_g",
    ),
    Check(
        ENGINE,
        "planar slide on the sphere with friction",
        "1e-4, the square of the step",
        _CONTACT,
        "test_planar_sliding_follows_the_closed_form_with_the_centripetal_force",
    ),
    Check(
        ENGINE,
        "large-angle period without friction; conical pendulum",
        "1e-5",
        _CONTACT,
        "test_a_conical_pendulum_keeps_its_circle_at_its_own_rate",
    ),
    Check(
        ENGINE,
        "energy along a whole run of the chain",
        "stated in the test",
        "multibody/test_energy.py",
        "test_kinetic_spring_and_gravity_energy_equal_work_of_the_plate_less_friction",
    ),
    Check(
        ENGINE,
        "halved steps until two runs agree, at every point of every surface",
        "the error each value states",
        "multibody/test_like_for_like.py",
        "test_a_smaller_tolerance_is_met_by_refinement",
    ),
    Check(
        ENGINE,
        "numbers published elsewhere, where friction sticks against the equations with its friction",
        "the error of both",
        _BENCHMARKS,
        "test_the_engine_meets_all_published_numbers",
    ),
)
