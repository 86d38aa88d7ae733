"""A scene, what is asked of a run and the steps that it keeps, as tuples of numbers and arrays."""

from __future__ import annotations

from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from reference.problem import GRAVITY, Scene, exponents
from reference.solver.collocation import STAGES
from reference.solver.rows import Number

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# friction laws (friction.py)
SET_VALUED, REGULARIZED, LUBRICATED = 0, 1, 2
# conditions for rest
CONSISTENT, PRINTED = 0, 1
# numpy integers below: numba would build a function once more for every literal it is called with
PLATFORM = np.int64(0)  # its number among the bodies
# what the contact does
REST, SLIDING, CREEPING, LUBRICATED_SLIDING, STOPPING = cast("tuple[int, ...]", tuple(map(np.int64, range(5))))
# how the equations of one step, or a whole run, ended
SOLVED, UNSOLVED, RIM, PAINLEVE, OPEN, STEP_LIMIT, TRAVEL = cast("tuple[int, ...]", tuple(map(np.int64, range(7))))


class System(NamedTuple):
    """The paper's system in accelerations: link stiffness and damping over the mass of the body they act on."""

    small: bool  # equations (4.3) instead of (3.9)
    law: int
    rest_condition: int
    friction: float  # mu, at rest where it depends on the velocity, or f_c in s/m
    rise: float  # of mu from rest to high speed
    rate: float  # s/m, of that rise; 0 where mu is constant
    exponent: Any  # float, of the normal force over the weight, in mu; None where mu has neither that nor heating
    v_reg: float  # m/s, of the regularized law
    mass_ratio: float  # m_sum / m1
    radius: float  # m
    travel: float  # m, largest displacement of the platform; infinite without one
    gravity: float  # m/s^2
    below: Array  # (N, 2), k_{i,i-1} / m_i, zero for the platform
    above: Array  # (N, 2), k_{i+1,i} / m_i, zero for the last body
    damping_below: Array  # (N, 2), c_{i,i-1} / m_i, 1/s
    damping_above: Array  # (N, 2), c_{i+1,i} / m_i, 1/s
    amplitudes: Array  # (3, 2), m/s^2
    exponents: Complex  # (2,), 1/s
    record: Array  # (K, 4), s and m/s^2, knots of a recorded motion, between which it is linear; (0, 4) without one
    heat: Array  # (3,) initial temperature, degrees C, rise times m1, K s^2.5/m^2, and cover, m (Heat); (0,) without
    k_t: Array  # (K, 3 + S): s, start and length of pieces, and coefficients of k_T; (0, 3 + S) without
    kinks: Array  # (J, 1) s, instants from which k_T changes like a root of time
    duration: float  # s
    axes: int  # 1 for a motion in the plane of x and z: y stays exactly zero
    fastest: float  # rad/s, bound of the chain's natural frequencies and rates of decay
    damping_rate: float  # 1/s, bound of the rates of its dampers alone


class Ground(NamedTuple):
    """What time alone decides at one instant: acceleration of the ground, m/s^2, and k_T."""

    x: float  # xi''
    y: float  # eta''
    z: float  # zeta''
    k_t: float  # temperature factor of friction


class Load(NamedTuple):
    """Where the platform is and what acts on it, at one instant or at all stages of a step (equations.py)."""

    px: Number  # m
    py: Number
    fx: Number  # driving acceleration, m/s^2
    fy: Number
    ux: Number  # acceleration of the ground, m/s^2
    uy: Number
    uz: Number
    k_t: Number  # temperature factor of friction (contact/load.py)


class StepRecord(NamedTuple):
    """The steps of one motion for `trajectory` (samples.py); of capacity 0 when only the peaks are wanted."""

    start: Array  # (T,) s, time at the start of each step
    length: Array  # (T,) s, or of the stretched time near a stop
    contact: Array  # (T,)
    x: Array  # (T, N, 2) at the start
    v: Array  # (T, N, 2)
    a: Array  # (T, N, 2, S) acceleration at the stages
    position: Array  # (T, N, 2, S) near a stop
    velocities: Array  # (T, N, 2, S) near a stop
    clock: Array  # (T, S) time at the stages near a stop
    total: Array  # (T, N, 3, S)
    reaction: Array  # (T, S) over m1
    sticks: Array  # (T, 2) intervals of rest, or of creep below v_reg
    counts: NDArray[np.int64]  # (2,) steps and intervals made, which may be more than there is room for


class RunSettings(NamedTuple):
    """What is asked of one run."""

    tolerance: float  # of accelerations, relative
    unit: float  # m/s^2, the scale errors are measured against from below
    period: float  # s, in which forces change (time_scale)
    cutoff: float  # m/s, v_c of the resolved peak; 0 for the supremum
    step_limit: int
    early: bool  # whether a run ends where nothing asked for can come any more (look_ahead.py)
    damped_weight: float = 30.0  # of the error of a step that damps a vibration, over that of a step that follows it


def pack(scene: Scene, small: bool, v_reg: float | None, printed_rest: bool = False, axes: int = 2) -> System:
    """The scene in compiled form. `v_reg`, m/s, selects the regularized law; None the set-valued one."""
    masses = scene.masses
    (below, above), (damping_below, damping_above) = (
        _link_coefficients(masses, links) for links in (scene.stiffness, scene.damping)
    )
    damping_rate = float(2.0 * (damping_below + damping_above).max())
    # without friction the lubricated law with f_c = 0 says the same and has no corner
    dry = scene.dry_friction
    smooth = scene.lubricated or scene.friction_coefficient == 0.0
    heat = None if smooth else dry.heat
    return System(
        small=small,
        law=LUBRICATED if smooth else (SET_VALUED if v_reg is None else REGULARIZED),
        rest_condition=PRINTED if printed_rest else CONSISTENT,
        friction=dry.slow if dry.varies else scene.friction_coefficient,
        rise=dry.fast - dry.slow if dry.varies else 0.0,
        rate=dry.rate if dry.varies else 0.0,
        exponent=None if smooth or (dry.exponent == 0.0 and dry.heat is None) else dry.exponent,
        v_reg=0.0 if v_reg is None else float(v_reg),
        mass_ratio=float(scene.total_mass / masses[0]),
        radius=float(scene.radius),
        travel=float(np.inf if scene.isolator.travel is None else scene.isolator.travel),
        gravity=GRAVITY,
        below=below,
        above=above,
        damping_below=damping_below,
        damping_above=damping_above,
        amplitudes=np.zeros((3, 2)) if scene.recorded else scene.amplitudes,
        exponents=np.zeros(2, np.complex128) if scene.recorded else exponents(scene),
        record=scene.record,
        heat=np.array([] if heat is None else [heat.initial, heat.rise * masses[0], heat.cover]),
        k_t=np.zeros((0, 3 + STAGES)),
        kinks=np.zeros((0, 1)),
        duration=float(scene.duration),
        axes=axes,
        fastest=float(np.sqrt(2.0 * (below + above).max())) + damping_rate,  # Gershgorin's bounds
        damping_rate=damping_rate,
    )


def _link_coefficients(masses: Array, links: Array) -> tuple[Array, Array]:
    """Coefficients of the links, (N - 1, 2), over the mass of the body above and of the one below, (N, 2) each."""
    below, above = np.zeros((len(masses), 2)), np.zeros((len(masses), 2))
    below[1:] = links / masses[1:, None]
    above[:-1] = links / masses[:-1, None]
    return below, above


def allocate_record(capacity: int, bodies: int) -> StepRecord:
    """Room for so many steps."""
    t, n, s = capacity, bodies, STAGES
    return StepRecord(
        start=np.zeros(t),
        length=np.zeros(t),
        contact=np.zeros(t),
        x=np.zeros((t, n, 2)),
        v=np.zeros((t, n, 2)),
        a=np.zeros((t, n, 2, s)),
        position=np.zeros((t, n, 2, s)),
        velocities=np.zeros((t, n, 2, s)),
        clock=np.zeros((t, s)),
        total=np.zeros((t, n, 3, s)),
        reaction=np.zeros((t, s)),
        sticks=np.zeros((t, 2)),
        counts=np.zeros(2, np.int64),
    )
