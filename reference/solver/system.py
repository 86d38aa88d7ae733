"""Data of compiled code, as named tuples: the scene, the settings of a run and the record of its steps."""

from __future__ import annotations

from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from reference.problem import GRAVITY, DryFriction, Scene, exponents
from reference.solver.collocation import STAGES
from reference.solver.rows import Number

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

# Integer codes of the friction laws (contact/friction.py)
SET_VALUED, REGULARIZED, LUBRICATED, YIELDING = 0, 1, 2, 3
# Integer codes of the condition for rest: tangential force <= static friction limit, or (4.6) with the paper's misprint
CONSISTENT, PRINTED = 0, 1
# The integers below are NumPy's, since numba compiles a function anew for every literal integer it is called with.
PLATFORM = np.int64(0)  # index of the platform among the bodies
# Integer codes of the states of the contact: rest; sliding; creep, which is slower than v_reg under the regularized
# law; sliding under the lubricated law; a slide near its stop, in stretched time (near_stop.py); friction that yields
# (contact/yielding.py), below its limit or at it.
REST, SLIDING, CREEPING, LUBRICATED_SLIDING, STOPPING, ELASTIC, PLASTIC = cast(
    "tuple[int, ...]", tuple(map(np.int64, range(7)))
)
# Integer codes of outcomes, of the equations of one step or of a whole run: solved; not solved; at the rim of the
# surface (4.1); at Painleve's paradox, where no acceleration exists; contact opens; too many steps; end of the
# isolator's travel.
SOLVED, UNSOLVED, RIM, PAINLEVE, OPEN, STEP_LIMIT, TRAVEL = cast("tuple[int, ...]", tuple(map(np.int64, range(7))))


class System(NamedTuple):
    """Scene (N bodies, isolator, loading) for compiled code; all forces are divided by the mass they act on."""

    small: bool  # True for the small-vibration equations (4.3), False for the exact ones (3.9)
    law: int  # friction law: SET_VALUED, REGULARIZED, LUBRICATED or YIELDING
    rest_condition: int  # condition for rest: CONSISTENT (friction cone) or PRINTED ((4.6) with the paper's misprint)
    # Friction coefficient at speed 0, or f_c in s/m of a lubricated contact; only contact/friction.py reads it
    friction: float
    rise: float  # increase of the friction coefficient from rest to high speed
    rate: float  # s/m, rate at which the friction coefficient goes to its high-speed value; 0 where it is constant
    exponent: Any  # exponent n of (N / W)^n in the friction coefficient; None if neither load nor heat changes it
    stiffness: float  # 1/s^2, elastic stiffness of friction that yields, over m1; infinite for any other friction
    v_reg: float  # m/s, speed below which friction is linear in the speed, under the regularized law
    mass_ratio: float  # total mass m_sum over that of the platform, m1
    radius: float  # m, pendulum radius rho
    travel: float  # m, largest displacement that the isolator permits; infinite without such a limit
    gravity: float  # m/s^2, acceleration of gravity
    below: Array  # (N, 2), 1/s^2, stiffness along x, y of the link below body i over its mass; zero for the platform
    above: Array  # (N, 2), 1/s^2, stiffness along x, y of the link above body i over its mass; zero for the last body
    damping_below: Array  # (N, 2), 1/s, damping along x, y of the link below body i over the body's mass
    damping_above: Array  # (N, 2), 1/s, damping along x, y of the link above body i over the body's mass
    amplitudes: Array  # (3, 2), m/s^2, amplitudes of the two harmonics along x, y, z
    exponents: Complex  # (2,), 1/s, complex exponents -decay + i frequency of the two harmonics
    record: Array  # (K, 4), s and m/s^2, samples of a recorded motion, linear between them; (0, 4) without a record
    # (3,) temperature at first, degrees C; its rise per friction power, times m1, K s^2.5/m^2; displacement, m, at
    # which the slider uncovers the center of the concave surface. (0,) without heating
    heat: Array
    # (K, 3 + S) friction's temperature factor k_T in K pieces of time: start and length, s, then its coefficients in
    # the elapsed share of the piece, lowest power first. K is 0 without heating
    k_t: Array
    kinks: Array  # (J, 1) s, times from which k_T, the temperature factor of friction, changes like a root of time
    duration: float  # s, duration of the computed motion
    axes: int  # 1 for a motion in the plane of x and z, where y stays exactly zero; otherwise 2
    fastest: float  # rad/s, upper bound on natural frequencies and decay rates of the chain of bodies
    damping_rate: float  # 1/s, upper bound on the decay rates that the dampers between the bodies alone cause


class Ground(NamedTuple):
    """Acceleration of the ground, m/s^2, and temperature factor of friction at one instant."""

    x: float  # m/s^2, acceleration of the ground along x, xi'' of (5.3)
    y: float  # m/s^2, acceleration of the ground along y, eta''
    z: float  # m/s^2, acceleration of the ground along the vertical, zeta''
    k_t: float  # factor by which temperature changes the friction coefficient


class Load(NamedTuple):
    """Position of the platform and what acts on it, at one instant (floats) or all stages of a step (rows, rows.py)."""

    px: Number  # m, position of the platform relative to the ground plate
    py: Number
    fx: Number  # m/s^2, driving acceleration: force of body 2 over m1 minus ground acceleration
    fy: Number
    ux: Number  # m/s^2, acceleration of the ground
    uy: Number
    uz: Number
    k_t: Number  # temperature factor of friction (contact/load.py)


class StepRecord(NamedTuple):
    """Up to T time steps of one motion of N bodies, with S stages each; T is 0 if only the peaks are wanted."""

    start: Array  # (T,) s, time at the start of each step
    length: Array  # (T,) s, length of each step; near a stop in stretched time tau (dt = speed dtau)
    contact: Array  # (T,) state of the contact in each step
    x: Array  # (T, N, 2) m, positions of the bodies at the start of each step
    v: Array  # (T, N, 2) m/s, velocities of the bodies at the start of each step
    a: Array  # (T, N, 2, S) m/s^2, accelerations of the bodies at the stages of each step
    position: Array  # (T, N, 2, S) m, positions of the bodies at the stages of steps near a stop
    velocities: Array  # (T, N, 2, S) m/s, velocities of the bodies at the stages of steps near a stop
    clock: Array  # (T, S) s, time at the stages of steps near a stop
    total: Array  # (T, N, 3, S) m/s^2, absolute accelerations of the bodies at the stages of each step
    reaction: Array  # (T, S) N/kg, reaction of the contact over m1 at the stages of each step
    sticks: Array  # (T, 2) s, start and end of intervals of rest, creep (friction linear in speed) or elastic contact
    counts: NDArray[np.int64]  # (2,) numbers of steps and of intervals as in `sticks`, those without room included


class RunSettings(NamedTuple):
    """Settings of one run: accuracy, scales, what counts as a peak, and when it ends."""

    tolerance: float  # largest relative error of the accelerations inside a step
    unit: float  # m/s^2, size of the loading: errors of smaller accelerations are measured against a share of it
    period: float  # s, time in which forces change (time_scale of reference/surface.py)
    cutoff: float  # m/s, slip speed v_c above which accelerations count for the peak; 0 for the supremum
    step_limit: int  # number of steps after which the run ends with STEP_LIMIT
    early: bool  # True if the run ends as soon as no larger peak can follow (look_ahead.py)
    damped_weight: float = 30.0  # factor on the error of a step too long to resolve a vibration (docs/decisions/0002)


def pack_scene(scene: Scene, small: bool, v_reg: float | None, printed_rest: bool = False, axes: int = 2) -> System:
    """Pack a scene for compiled code; dry friction is regularized below the speed v_reg, m/s, set-valued if None."""
    masses = scene.masses
    (below, above), (damping_below, damping_above) = (
        _link_coefficients(masses, links) for links in (scene.stiffness, scene.damping)
    )
    damping_rate = float(2.0 * (damping_below + damping_above).max())
    shear = float(scene.dry_friction.stiffness / masses[0]) if scene.dry_friction.elastic else 0.0
    return System(
        small=small,
        rest_condition=PRINTED if printed_rest else CONSISTENT,
        **_pack_friction(scene, v_reg),
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
        k_t=np.zeros((0, 3 + STAGES)),
        kinks=np.zeros((0, 1)),
        duration=float(scene.duration),
        axes=axes,
        # upper bound on eigenvalues by Gershgorin's circles
        fastest=float(np.sqrt(2.0 * (below + above).max() + shear)) + damping_rate,
        damping_rate=damping_rate,
    )


def _pack_friction(scene: Scene, v_reg: float | None) -> dict[str, Any]:
    """Return, by name, the fields of `System` that describe friction."""
    # A scene without friction gets the lubricated law with f_c = 0: the same motion, by a smooth law.
    dry, mass = scene.dry_friction, scene.masses[0]
    smooth = dry.largest == 0.0
    heat = None if smooth else dry.heat
    law = YIELDING if dry.elastic else SET_VALUED if v_reg is None else REGULARIZED
    return {
        "law": LUBRICATED if smooth else law,
        "friction": scene.friction_coefficient if scene.lubricated else dry.slow,
        "rise": dry.fast - dry.slow if dry.varies else 0.0,
        "rate": dry.rate if dry.varies else 0.0,
        "exponent": dry.exponent if dry.depends_on_load and not smooth else None,
        "stiffness": float(dry.stiffness / mass),
        "v_reg": 0.0 if v_reg is None else float(v_reg),
        "heat": np.array([] if heat is None else [heat.initial, heat.rise * mass, heat.cover]),
    }


def dry_friction_of(system: System) -> DryFriction:
    """Return the dry friction law of a system at k_T = 1, that is without the effect of temperature."""
    return DryFriction(
        slow=system.friction, fast=system.friction + system.rise, rate=system.rate, exponent=system.exponent
    )


def _link_coefficients(masses: Array, links: Array) -> tuple[Array, Array]:
    """Return the coefficients of the link below each body, and of the link above it, over its mass: (N, 2) each.

    links (N - 1, 2): stiffness or damping along x and y of the link between each body and the next.
    """
    below, above = np.zeros((len(masses), 2)), np.zeros((len(masses), 2))
    below[1:] = links / masses[1:, None]
    above[:-1] = links / masses[:-1, None]
    return below, above


def allocate_record(capacity: int, bodies: int) -> StepRecord:
    """Return an empty record with room for `capacity` time steps."""
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
