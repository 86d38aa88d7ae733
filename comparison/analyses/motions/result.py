"""What single motions show: effective values, and demands on isolator and structure."""

from __future__ import annotations

from comparison.result_types import Number, Part, Phases, Text, UncertainNumber


class Residual(UncertainNumber):
    """A displacement at rest, which a motion may not have."""

    reason: Text
    """why there is no value although the motion lasts as long as the scene; empty otherwise"""


class FloorSpectra(Part):
    """Floor response spectra of one motion: largest displacement of an oscillator times its squared frequency."""

    period: list[float]
    """natural periods of the oscillator, s"""
    damping: float
    """damping ratio of the oscillator"""
    acceleration: list[list[list[Number]]]
    """pseudo-acceleration, m/s^2, by body, direction x and y, and period"""
    error: list[list[list[Number]]]
    """estimated absolute error"""


class MotionDemands(Part):
    """What one stored motion demands of isolator and structure; no value where the motion ended early."""

    model: str
    """key of the model"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""
    why: Text
    """why this phase pair was chosen; empty for one of an even spread"""
    status: str
    """how the motion ended"""
    displacement: UncertainNumber
    """largest horizontal displacement of the isolator, m"""
    residual: Residual
    """horizontal displacement at which the platform comes to rest, m; null where it moves at the end; its error has
    the creep of regularized friction"""
    cap_share: UncertainNumber
    """largest horizontal displacement over rho"""
    travel_share: UncertainNumber | None
    """largest horizontal displacement over the isolator's travel; null without a travel"""
    acceleration: list[UncertainNumber]
    """largest absolute acceleration of every body, m/s^2"""
    base_shear: UncertainNumber
    """largest horizontal force through the isolator, N"""
    drift: list[UncertainNumber]
    """largest horizontal displacement of every body relative to the one below, from body 2 on, m"""
    contact_force_min: UncertainNumber
    """smallest normal force of the isolator, N"""
    contact_force_max: UncertainNumber
    """largest normal force of the isolator, N"""
    support_force_min: UncertainNumber | None
    """smallest normal force of a single support, N; null in a model without single supports"""
    support_force_max: UncertainNumber | None
    """largest normal force of a single support, N; null in a model without single supports"""
    torsion: list[UncertainNumber] | None
    """largest rotation of every body about the vertical, rad; null where the bodies do not turn"""
    stops: UncertainNumber
    """number of intervals of rest, or of creep below v_reg, after the first slip"""
    support_displacement: UncertainNumber | None
    """largest displacement of a support with the platform's rotation, m; null where the bodies do not turn"""
    uplift: UncertainNumber | None
    """largest gap of a support that has lifted off, m; null in a model without single supports"""
    friction_energy: UncertainNumber
    """energy that friction dissipates, J"""
    damping_energy: UncertainNumber | None
    """energy that dampers of the links dissipate, J; null without dampers, and where bodies turn"""
    energy_balance: UncertainNumber | None
    """work of the ground less the energy dissipated and stored, J: zero but for errors; null where bodies turn"""
    spectra: FloorSpectra | None
    """floor response spectra; null where the motion ended early"""
