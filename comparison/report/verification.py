"""
Tests of each code alone, which precede the comparison of both; the report lists them with their test files.

Agreement of two codes proves little if either could be wrong by itself in the same way.
"""

import re
from typing import NamedTuple


class CodeCheck(NamedTuple):
    """Test of one code alone."""

    side: str  # which code: "reference" or "engine"
    file: str  # path in tests/
    against: str  # what it is compared with
    closeness: str  # how well it agrees, and what limits that
    test: str  # name of the test function


# Tests of each code, by test file. A row has: what is compared with | agreement and what limits it | name of the test
CHECKS_TABLE = """
reference: reference/test_closed_form_motions.py
  free decay under dry friction: turning points, stops, rest | 1e-7, ten times the tolerance asked |
    test_free_coulomb_decay_of_the_small_equations
  planar slide down and up the sphere with the centripetal part of the contact force | 1e-7 in angle, 2e-7 in energy |
    test_swing_down_and_up_the_cap_with_friction
  conical pendulum: rate, circle, contact force | 1e-6, a hundred times the tolerance, over many turns |
    test_conical_pendulum_turns_at_its_frequency
  Den Hartog's forced oscillation with friction | 1.1e-6, a hundred times the tolerance and what the sphere adds |
    test_den_hartog_s_oscillation_goes_on_as_it_was_begun
  surface without friction, by superposed modes | within the error each value states |
    test_frictionless_surface_is_the_closed_form_to_its_error
reference: reference/test_manufactured_motion.py
  manufactured motion: circles of a chain over friction; order 8 inside steps | 1e-10, a hundredth of the tolerance |
    test_circles_over_friction_are_kept
reference: reference/test_natural_modes.py
  frequencies and shapes of a uniform chain | 1e-12, rounding | test_uniform_chain_has_its_closed_form
reference: reference/test_energy_balance.py
  energy balance along every run | 1e-6, the tolerance asked | test_energy_is_balanced
reference: reference/test_oracle_values.py
  another program: SciPy, event by event, from the same physics | the sum of both errors |
    test_amplification_is_the_oracle_s
reference: reference/test_heated_friction.py
  friction that heat lowers: another program, by constant steps | the error of its steps |
    test_a_heated_motion_is_that_of_constant_steps
  friction that heat lowers: loops of a bearing published for MASTODON | 6e-3 of the force, 5e-4 without heat |
    test_the_law_meets_the_published_loops_of_a_bearing
reference: reference/test_printed_matrices.py
  the matrices (3.9)-(3.13) written from the print, errata corrected | 1e-4, peaks read every 2 ms |
    test_the_mended_matrices_are_the_exact_equations
reference: comparison/evidence/test_benchmarks.py
  numbers published elsewhere: code_aster, ANSYS, Chopra, Den Hartog, Newmark | the error of both |
    test_the_equations_meet_every_published_number
engine: multibody/test_contact.py
  static penetration N/k_c | 1e-6, Newton's tolerance | test_the_weight_presses_the_contact_in
  creep of a held platform, v_reg F / (mu N) | 2e-6, the slope of the sphere squared |
    test_a_held_platform_creeps_as_v_reg_says
  straight slide that stops after v^2 / (2 mu g) | 2e-5 | test_sliding_stops_after_v_squared_over_two_mu_g
  planar slide on the sphere with friction | 1e-4, the square of the step |
    test_planar_sliding_follows_the_closed_form
  large-angle period without friction; conical pendulum | 1e-5 |
    test_a_conical_pendulum_keeps_its_circle_at_its_own_rate
engine: multibody/test_orders_of_accuracy.py
  manufactured motion: circles of a chain over friction; second order in the step | 0.03 of the order |
    test_a_motion_without_stops_is_of_second_order
engine: multibody/test_energy.py
  energy along a whole run of the chain | 2e-5 of the energy lost |
    test_energy_equals_the_plate_s_work_less_friction
engine: multibody/test_like_for_like.py
  halved steps until two runs agree, at every point of every surface | the error each value states |
    test_no_finer_run_contradicts_an_answer
engine: comparison/evidence/test_benchmarks.py
  numbers published elsewhere, where friction sticks against the equations with its friction | the error of both |
    test_the_engine_meets_all_published_numbers
"""
# Tests of each code alone: a block of CHECKS_TABLE begins with "side: file"; each further row, which may go on in the
# next line, is one test.
CHECKS = tuple(
    CodeCheck(*block[:2], *map(str.strip, row.split("|")))
    for block in re.findall(r"^(\w+): (\S+)\n((?:  .*\n)+)", CHECKS_TABLE, re.MULTILINE)
    for row in re.split(r"\n(?=  \S)", block[2].rstrip())
)
