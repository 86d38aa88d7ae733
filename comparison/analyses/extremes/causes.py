"""Why a model has no answer at an extreme, in one sentence for each limit that is known."""

from __future__ import annotations

_TINY = (
    "mu_2 is so small beside mu_1 that a contact stiff enough not to change it rounds by as much, and a softer one "
    "changes it"
)
_LONG_CHAIN = "the fastest swing of the chain sets the step: the steps take more processor time than a cell may"
_LIGHT_PLATFORM = (
    "the weight of the tower is so much more than the platform's that the force which starts a slide is less than the "
    "rounding of those which balance at its start"
)
_QUICK_FRICTION = (
    "friction stops so light a platform within a time that the contact, as stiff as rounding allows, cannot follow"
)

_QUICK_RELAXATION = (
    "friction relaxes at a stop within a time that the contact, as stiff as rounding allows, cannot follow, and a "
    "larger v_reg has another answer"
)

_STIFF_LINK = (
    "the swing of so stiff a link asks for a contact that damps none of it: the levels within the work of a cell do "
    "not reach the tolerance"
)

# by quantity and extreme; by key of the model
CAUSES: dict[tuple[str, str], dict[str, str]] = {
    ("v_reg, m/s", "1e-06"): {"spatial": _QUICK_RELAXATION},
    ("v_reg, m/s", "1e-07"): dict.fromkeys(("translational", "spatial"), _QUICK_RELAXATION),
    ("v_reg, m/s", "1e-08"): dict.fromkeys(("translational", "spatial"), _QUICK_RELAXATION),
    ("amplitude, m/s^2", "1e-09"): dict.fromkeys(
        ("translational", "spatial"),
        "the contact force rounds by 1e-15 of the weight over its penetration, which is as much as the accelerations",
    ),
    ("rho, m", "0.001"): {
        "spatial": "heights of a thousand rho: their rounding makes that of the contact force a share of the peaks"
    },
    ("bodies N", "100"): {"translational": _LONG_CHAIN},
    ("bodies N", "1000"): {"translational": _LONG_CHAIN},
    ("platform's share of the mass", "1e-06"): {
        **dict.fromkeys(("exact", "regularised"), _LIGHT_PLATFORM),
        **dict.fromkeys(("translational", "spatial"), _QUICK_FRICTION),
    },
    ("platform's share of the mass", "0.001"): {"spatial": _QUICK_FRICTION},
    ("link periods, s", "0.001"): {"spatial": _LONG_CHAIN},
    ("load over the buckling load of bars", "0.0001"): {"spatial": _STIFF_LINK},
    ("duration, s", "0.001"): dict.fromkeys(("translational", "spatial"), _TINY),
    ("relative error asked", "1e-06"): {
        "translational": "the error estimate of the engine counts 1e-6 of a peak at least: less is not measured"
    },
}
