"""One run of an assembled model for one phase pair: at a level of accuracy, or at a constant step."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from multibody.integration.adaptive import Integration, run_adaptively
from multibody.integration.balance import find_balanced_start
from multibody.integration.constant_step import EngineSolver
from multibody.integration.engine_run import Budget, EngineRun, Ground, absolute_accelerations, begin_run
from multibody.integration.level import Level
from multibody.integration.look_ahead import can_look_ahead, run_with_look_ahead
from multibody.integration.peak import PeakReader
from multibody.integration.termination import find_termination
from multibody.models.state import EngineState
from multibody.models.system import EngineModel
from reference.problem import Outcome, Scene, State, ground_acceleration
from reference.problem.excitation import acceleration_of_ground

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PhasePair:
    """
    Scene, assembled model and initial phases (2,), rad, of the ground motion for which the engine is run.

    initial: state from which the motion starts; None is at rest. in_full: whether every run without an early stop takes
    accurate steps to the end of the motion.
    """

    scene: Scene
    model: EngineModel
    phase: Array
    initial: State | None = None
    in_full: bool = False

    @property
    def end(self) -> float:
        """Duration of the motion, in the model's unit of time."""
        return self.scene.duration / self.model.units.time

    @cached_property
    def ground(self) -> Ground:
        """Acceleration of the ground plate under the bearings as a function of time, in units of the model."""
        units, acceleration = self.model.units, acceleration_of_ground(self.scene, self.phase)
        return lambda time: acceleration(time * units.time) / units.acceleration

    def run_level(
        self, level: Level, budget: Budget, stop: float = math.inf, *, keep: bool = False, residual: float | None = None
    ) -> EngineRun:
        """
        Run the model at a level of accuracy, up to `stop` or, unless `keep`, until no large value can come.

        keep: whether the run keeps its motion. residual: absolute tolerance of the forces, in weights; None takes that
        of the level.
        """
        solver = EngineSolver(self.model, level.newton, level.residual if residual is None else residual)
        self.model.set_contact(level.penetration, level.warping_compliance)
        if self.model.springs is not None:
            self.model.springs.set_slide_end(level.slide_end)
        start = self._find_start(level.penetration)
        if start is None:
            return begin_run(self.model, stop).terminate(Outcome.SOLVER_FAILED, 0.0)
        integration = Integration(solver, self.ground, self.end, level, budget, keep)
        if stop == math.inf and not (keep or self.in_full) and can_look_ahead(self.model, level):
            return run_with_look_ahead(integration, start)
        return run_adaptively(integration, start, stop)

    def run_constant_step(
        self,
        count: int,
        penetration: float,
        newton: float,
        residual: float,
        integrator: str,
        discontinuous: float | None,
    ) -> EngineRun:
        """Run the model in `count` equal steps and keep the motion; the other arguments are those of `single_run`."""
        model, solver = self.model, EngineSolver(self.model, newton, residual, integrator, discontinuous)
        model.set_contact(penetration)
        start = self._find_start(penetration)
        motion = None if start is None else solver.run(start, 0.0, self.end / count, count)
        result = EngineRun(PeakReader(len(model.bodies), model.corner), math.inf, work=count)
        if motion is None or not np.isfinite(motion.accelerations).all():
            return result.terminate(Outcome.SOLVER_FAILED, 0.0)
        outcome, row, instant = find_termination(motion, model)
        motion = motion.cut_at(row)
        result.chunks.append(motion)
        result.peaks.add(motion.time, absolute_accelerations(model, motion, self.ground), motion.slip)
        return result if outcome == Outcome.OK else result.terminate(outcome, instant)

    def _find_start(self, penetration: float) -> EngineState | None:
        """Find the state at time zero, in balance if the motion starts at rest; None if no balance is found."""
        self.model.ground.set_phase(self.phase)
        acceleration = ground_acceleration(self.scene, self.phase, [0.0])[0]
        start = self.model.start(self.initial, acceleration, penetration)
        if self.initial is not None:
            return start
        return find_balanced_start(self.model, start, acceleration / self.model.units.acceleration, penetration)
