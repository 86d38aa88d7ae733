"""Contact phases with smooth friction: lubricated sliding, and creep below v_reg under the regularized law."""

from __future__ import annotations

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.friction import decay_rate
from reference.solver.events import locate_level_crossing
from reference.solver.phases.sliding import squared_speed_in_state
from reference.solver.rows import row, row_maximum
from reference.solver.step_control import begin_from_state
from reference.solver.system import CREEPING, SLIDING, System
from reference.solver.work import SQUARED_SPEED, Workspace

LEVEL_TOLERANCE = 1e-9  # relative distance of squared speed from v_reg^2, creep's limit, at which it becomes a slide
EARLY_CROSSING = 1e-6  # creep that reaches v_reg within this share of a step becomes a slide at the step's start
NEAR_LEVEL_FRACTION = 0.8  # creep's end is looked for if the squared speed at a stage is above this share of v_reg^2
MAX_FIRST_DECAY = 2.0  # longest first step of creep, in times in which friction makes the velocity decay


@compiled
def begin_smooth(system: System, work: Workspace, contact: int) -> None:
    """Prepare a phase of lubricated sliding, or of creep, whose first step is at most MAX_FIRST_DECAY decay times."""
    begin_from_state(system, work, contact)
    if contact == CREEPING:
        work.length = min(work.length, MAX_FIRST_DECAY / decay_rate(system, contact))


@compiled
def limit_step_to_slide(system: System, work: Workspace, contact: int, h: float) -> tuple[float, int]:
    """Return the length of a step h, s, up to where creep becomes a slide, at v_reg, and the next contact state.

    The length is 0 if that happens at the start of the step. Lubricated sliding goes on.
    """
    level = system.v_reg * system.v_reg
    if contact != CREEPING:
        return h, contact
    if row_maximum(row(work.stage, SQUARED_SPEED)) > NEAR_LEVEL_FRACTION * level:
        start = min(squared_speed_in_state(system, work), level * (1.0 - LEVEL_TOLERANCE))
        crossing = locate_level_crossing(system, work, row(work.stage, SQUARED_SPEED), start, level)
        if crossing < EARLY_CROSSING and work.hold_time == 0.0:
            return 0.0, SLIDING
        if EARLY_CROSSING <= crossing < 1.0 - EARLY_CROSSING:
            return h * crossing, CREEPING
    return h, SLIDING if work.stage[SQUARED_SPEED, STAGES - 1] > level * (1.0 - LEVEL_TOLERANCE) else CREEPING
