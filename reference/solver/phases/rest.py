"""Contact phase of rest: the platform stays where it is while friction can hold it; the bodies above vibrate."""

from __future__ import annotations

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.friction import static_limit
from reference.solver.contact.platform import load_at_stages, rest_excess
from reference.solver.events import excess_at, expand_drive, locate_onset
from reference.solver.rows import put
from reference.solver.step_control import begin_from_state
from reference.solver.steps import solve_rest_step
from reference.solver.system import REST, SLIDING, System
from reference.solver.work import REACTION, Workspace

# Largest share by which the squared tangential force exceeds the squared friction limit at the onset that is located;
# with no excess at all, rounding would decide the direction of the slide
ONSET_EXCESS = 1e-12
MIN_ONSET_EXCESS = 0.1 * ONSET_EXCESS  # smallest share by which squared force exceeds squared limit at a located onset
ONSET_DIFFERENCE = 1e-4  # time before an onset, as share of the time up to it, for a difference quotient of the force
ONSET_ITERATIONS = 8  # largest number of Newton iterations that locate the onset of sliding


@compiled
def begin_rest(system: System, work: Workspace) -> float:
    """Prepare the first step of a phase of rest; return the time, s, from which the platform is at rest."""
    work.v[0, 0] = work.v[0, 1] = 0.0
    begin_from_state(system, work, REST)
    since = work.time + work.early_rest
    work.early_rest = 0.0
    return since


@compiled
def shorten_step_to_onset(system: System, work: Workspace, h: float) -> tuple[float, int]:
    """Return the length of a solved step of rest, h, s, up to an onset of sliding in it, and the next contact state.

    If there is an onset, the step is solved again, to end just behind it.
    """
    # The slide that follows begins in the direction that its own acceleration does not turn; this direction depends on
    # the excess over the friction limit. At the limit itself that direction is undefined, so the onset is located
    # between MIN_ONSET_EXCESS and ONSET_EXCESS. The onset found on the polynomials of the long step is off by their
    # error. Newton's method with a slope taken from them locates it on steps that end there.
    onset = locate_onset(system, work)
    if onset > 1.0 or work.hold_time > 0.0:
        return h, REST
    if onset <= 0.0:
        return 0.0, SLIDING
    width = ONSET_DIFFERENCE * onset
    slope = (excess_at(system, work, onset) - excess_at(system, work, onset - width)) / (width * h)
    end = h * onset
    reaction: float = work.stage[REACTION, STAGES - 1]
    # the friction limit hardly changes in the iteration
    limit = static_limit(system, work.ground[3, STAGES - 1], reaction) ** 2
    for _ in range(ONSET_ITERATIONS):
        solve_rest_step(system, work, end)
        expand_drive(work)
        excess = excess_at(system, work, 1.0)
        if not slope > 0.0 or MIN_ONSET_EXCESS * limit < excess <= ONSET_EXCESS * limit:
            break
        end = min(max(end + (0.5 * ONSET_EXCESS * limit - excess) / slope, 0.5 * end), h)
    set_reaction(system, work)
    return end, SLIDING


@compiled
def set_reaction(system: System, work: Workspace) -> None:
    """Set the reaction of the contact, over m1, at the stages of a step at rest, in work.stage."""
    _, reaction = rest_excess(system, load_at_stages(work))
    put(work.stage, REACTION, reaction)
