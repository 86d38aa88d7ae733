"""Causes why a model has no answer at an extreme, by model and extreme."""

_ENGINE = "translational", "spatial"  # keys of the models of Exudyn
# Texts used more than once in CAUSES: why a model does not reach the accuracy asked, or the end of such a text
_LONG_CHAIN = "the fastest swing of the chain sets the step: the steps take more processor time than a cell may"
_QUICK = "within a time that the contact, as stiff as rounding allows, cannot follow"  # part of _FRICTION, _RELAXATION
_FRICTION = f"friction stops so light a platform {_QUICK}"  # why Exudyn misses the accuracy with a light platform
# Cause if v_reg, the sliding speed below which friction is linear, is so small that the contact cannot follow a stop
_RELAXATION = f"friction relaxes at a stop {_QUICK}, and a larger v_reg has another answer"
_LIGHT = (  # why the equations miss the accuracy with a platform much lighter than the bodies above: rounding errors
    "the weight of the tower is so much more than the platform's that the force which starts a slide is less than the "
    "rounding of those which balance at its start"
)
# Known causes why a model does not reach the accuracy asked, by (quantity, its extreme value), then by key of the model
CAUSES: dict[tuple[str, str], dict[str, str]] = {
    ("v_reg, m/s", "1e-06"): {"spatial": _RELAXATION},
    ("v_reg, m/s", "1e-07"): dict.fromkeys(_ENGINE, _RELAXATION),
    ("v_reg, m/s", "1e-08"): dict.fromkeys(_ENGINE, _RELAXATION),
    ("amplitude, m/s^2", "1e-09"): dict.fromkeys(
        _ENGINE,
        "the contact force rounds by 1e-15 of the weight over its penetration, which is as much as the accelerations",
    ),
    ("rho, m", "0.001"): {
        "spatial": "heights of a thousand rho: their rounding makes that of the contact force a share of the peaks"
    },
    ("bodies N", "100"): {"translational": _LONG_CHAIN},
    ("bodies N", "1000"): {"translational": _LONG_CHAIN},
    ("platform's share of the mass", "1e-06"): {
        **dict.fromkeys(("exact", "regularised"), _LIGHT),
        **dict.fromkeys(_ENGINE, _FRICTION),
    },
    ("platform's share of the mass", "0.001"): {"spatial": _FRICTION},
    ("link periods, s", "0.001"): {"spatial": _LONG_CHAIN},
    ("load over the buckling load of bars", "0.0001"): {
        "spatial": "the swing of so stiff a link asks for a contact that damps none of it: the levels within the work "
        "of a cell do not reach the tolerance"
    },
    ("decay, 1/s", "1e+06"): {
        "translational": "mu_2 is so small beside mu_1 that the levels within the work of a cell do not reach the "
        "tolerance: the next one does"
    },
    ("duration, s", "0.001"): dict.fromkeys(
        _ENGINE,
        "mu_2 is so small beside mu_1 that a contact stiff enough not to change it rounds by as much, and a softer "
        "one changes it",
    ),
    ("relative error asked", "1e-06"): {
        "translational": "the error estimate of the engine counts 1e-6 of a peak at least: less is not measured"
    },
}
