"""
Links of bars that give way in every direction: their stiffness half-way up, under the weight that they carry.

Half-way up the clamped bars of a link have no bending moment from sway: there shear and bending do not act on each
other. A model puts the stiffness between the two points half-way up, one fixed to either body. Where the bodies rotate
against each other by phi while these points stay together, the ends of the bars come closer by l phi^2 / 8. That lets
the weight N sink, which no bar does to first order: N l / 4 is added to the bending stiffness to make up for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reference.problem.tables import Body

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BarLink:
    """
    Stiffness of all bars of one link together.

    It acts between two points, one fixed to each body, that coincide half-way up the bars at rest. shear: N/m, without
    the effect of a weight that sinks as bars shorten. bending: N m, about either horizontal axis. tension: N/m.
    torsion: N m. pendulum: m, length of an upright rod, hinged at its foot, on whose top the body above would sink as
    much as it does while the bars shorten; 0 if they do not. load: N, the weight above.
    """

    shear: float
    bending: float
    tension: float
    torsion: float
    pendulum: float
    load: float


def bar_links(bodies: Sequence[Body], loads: Sequence[float], radius: float | None) -> list[BarLink | None]:
    """
    Return the stiffness of each link, lowest first; None for a link that is rigid in tension and bending.

    loads: N, weight that each link carries. radius: m, distance of the bars from the axis where none is stated.
    """
    links: list[BarLink | None] = []
    for body, load in zip(bodies[1:], loads):
        bars = body.bars
        if bars is None or bars.axial_stiffness is None:
            links.append(None)
            continue
        spread = bars.spread if bars.spread is not None else radius or 0.0
        factors, sway = bars.factors(load), bars.stiffness * bars.factors(load).sway
        pendulum = -bars.length / (3.0 * factors.sway_slope) if bars.load_effect == "shortening" else 0.0
        tension = bars.count * bars.axial_stiffness / bars.length
        bent = bars.count * bars.bending_stiffness / bars.length * factors.bending
        links.append(
            BarLink(
                shear=sway + (load / pendulum if pendulum else 0.0),
                bending=bent + 0.5 * tension * spread**2 + 0.25 * load * (bars.length - pendulum),
                tension=tension,
                torsion=bars.count * (bars.torsional_stiffness or 0.0) / bars.length + sway * spread**2,
                pendulum=pendulum,
                load=load,
            )
        )
    return links


def stands_upright(
    links: Sequence[BarLink | None], heights: Sequence[float], loads: Sequence[float], shear: Array
) -> bool:
    """
    Return True if the links hold the bodies upright against their weight, on a platform that does not move.

    heights: m, of the centers of mass of all bodies. loads: N, weight that each link carries. shear: (N - 1, 2), N/m.

    Two bodies D apart are displaced by u_1 and u_2 along one axis and rotated by theta_1 and theta_2. The two points
    half-way up are then apart by d = u_2 - u_1 - (theta_1 + theta_2) D / 2, and the weight N above sinks by
    D (theta_1^2 + theta_2^2) / 4 + d (theta_1 + theta_2) / 2. Bodies above and below a rigid link rotate as one. The
    bodies stay upright if the energy of all links less the work of the weights is positive for every such motion.
    """
    rotation = np.cumsum([0] + [link is not None for link in links])  # number of each body's rotation, from 1; 0: none
    count = len(links)
    size = count + int(rotation[-1])
    # Rows that pick a body's displacement or rotation out of the unknowns: displacements first, then rotations
    unit = np.eye(size + 1)[:, :size]  # last row: zeros, for the platform, which does not move
    moved = [unit[-1], *unit[:count]]
    rotated = [unit[-1] if number == 0 else unit[count + number - 1] for number in rotation]
    for axis in range(2):
        stiffness = np.zeros((size, size))
        for i, link in enumerate(links):
            apart, lower, upper = heights[i + 1] - heights[i], rotated[i], rotated[i + 1]
            mean, bent = 0.5 * (lower + upper), upper - lower
            sheared = moved[i + 1] - moved[i] - apart * mean
            stiffness += shear[i, axis] * np.outer(sheared, sheared)
            stiffness += (0.0 if link is None else _upright_bending(link)) * np.outer(bent, bent)
            sunk = 0.5 * apart * (np.outer(lower, lower) + np.outer(upper, upper))
            stiffness -= loads[i] * (sunk + np.outer(sheared, mean) + np.outer(mean, sheared))
        scale = np.sqrt(np.abs(np.diag(stiffness)))
        if not scale.all() or np.linalg.eigvalsh(stiffness / np.outer(scale, scale))[0] <= 0.0:
            return False
    return True


def _upright_bending(link: BarLink) -> float:
    """Return the bending stiffness, N m, of a link for `stands_upright`, where no rod lowers the body above it."""
    return link.bending + 0.25 * link.load * link.pendulum
