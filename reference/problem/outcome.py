"""Named outcomes of one phase pair, shared by reference solver and engine, and advice for those that are not ok."""

from __future__ import annotations

from enum import StrEnum


class Outcome(StrEnum):
    """
    Outcome of the computed motion for one pair of initial phases of the loading.

    Anything but OK means that `mu` is NaN or its error above the tolerance. `ADVICE` has what to try.

    Examples
    --------
    >>> Outcome.RIM_REACHED == "rim reached"
    True
    """

    OK = "ok"
    TOLERANCE_NOT_MET = "tolerance not met"
    RIM_REACHED = "rim reached"
    TRAVEL_REACHED = "travel reached"
    CONTACT_LOST = "contact lost"
    OVERTURNED = "overturned"
    PAINLEVE = "painleve paradox"
    NON_FINITE_LOAD = "non-finite load"
    NO_GROUND_MOTION = "no ground motion"
    STEP_LIMIT = "step limit"
    SOLVER_FAILED = "solver failed"
    WORKER_DIED = "worker died"
    TIME_LIMIT = "time limit"
    NOT_ASKED = "not asked"
    VALUE_OUT_OF_RANGE = "value out of range"


ADVICE: dict[Outcome, str] = {  # what to try after each outcome
    Outcome.OK: "nothing to do",
    Outcome.TOLERANCE_NOT_MET: "the error shown is larger than asked: loosen the tolerance, or give a cutoff v_c",
    Outcome.RIM_REACHED: "the platform moved to the rim, x1^2 + y1^2 = rho^2 (4.1): lower the amplitude or "
    "enlarge the radius",
    Outcome.TRAVEL_REACHED: "the platform needs a larger displacement than isolator.travel: lower the amplitude or "
    "enlarge the travel",
    Outcome.CONTACT_LOST: "the contact force reached zero: lower the vertical amplitude, or use the spatial model",
    Outcome.OVERTURNED: "the tower fell over an edge of its supports: widen the ring or lower the amplitude",
    Outcome.PAINLEVE: "the mass matrix of (3.9) lost its sign, or no slide can begin: lower the friction coefficient "
    "or the swing, or take a heavier platform",
    Outcome.NON_FINITE_LOAD: "loads overflow double precision: rescale the scene",
    Outcome.NO_GROUND_MOTION: "(5.1) divides by the ground acceleration: give a nonzero amplitude",
    Outcome.STEP_LIMIT: "the steps or the work of one point are spent: shorten the duration; a looser tolerance may "
    "help the equations, not the engine",
    Outcome.SOLVER_FAILED: "the equations of a step could not be solved: loosen the tolerance or change v_reg",
    Outcome.WORKER_DIED: "the process that computed this point died: run the point alone",
    Outcome.TIME_LIMIT: "the processor time that one task may take was spent: allow more, or shorten the duration",
    Outcome.NOT_ASKED: "the engine hung or ended its process twice before: see what the solvers reported",
    Outcome.VALUE_OUT_OF_RANGE: "a value is negative, infinite or above 1e12, or its error is infinite or above that: "
    "correct the model",
}
