"""Run of the engine at a constant step from a stored state, without output on the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from multibody.models.engine import MAX_DENSE_COORDINATES, exudyn
from multibody.models.state import EngineState
from multibody.models.system import EngineModel

Array = NDArray[np.float64]

# Spectral radius of generalized alpha at infinite frequency (Chung and Hulbert 1993): it damps the ringing of the
# contact and hardly damps slower motions.
SPECTRAL_RADIUS = 0.8

# Largest factor by which the engine may reduce a step that it cannot solve, as where contacts close or slip reverses.
MAX_STEP_REDUCTION = 1e4

# If an iteration of modified Newton leaves more than this share of the error before it, the engine computes the
# Jacobian anew; with this value runs take least time (measured).
MAX_CONTRACTIVITY = 0.2

# Explicit integrators: names for callers, and the engine's names.
EXPLICIT_INTEGRATORS = {"RK44": "RK44", "velocity Verlet": "VelocityVerlet"}
INITIAL_CONFIGURATION = exudyn.ConfigurationType.Initial  # the engine's name for the start of a run
INTEGRATORS = ("generalized alpha", "trapezoidal", *EXPLICIT_INTEGRATORS)  # integrators that a caller may name


class EngineMotion(NamedTuple):
    """
    Motion in one run, one row for each step, in units of the model, relative to the plate; the first row is the start.

    time: instants, (T,). coordinates, velocities, accelerations: values of all coordinates, (T, n). contact: gap, slip
    speed and two unused entries of each contact, (T, 4 K). force: force vector and normal of each contact, (T, 6 K), or
    (T, 0) unless recorded.
    """

    time: Array
    coordinates: Array
    velocities: Array
    accelerations: Array
    contact: Array
    force: Array

    @property
    def gap(self) -> Array:
        """Gap of each contact, (T, K), negative where the contact is closed."""
        return self.contact[:, 0::4]

    @property
    def slip(self) -> Array:
        """Slip speed of each contact, (T, K)."""
        return self.contact[:, 1::4]

    @property
    def load(self) -> Array | None:
        """Normal force of each contact in units of its share of the weight, (T, K); None unless forces are recorded."""
        if not self.force.shape[1]:
            return None
        vectors = self.force.reshape(len(self.time), -1, 2, 3)
        load: Array = vectors.shape[1] * np.abs((vectors[:, :, 0] * vectors[:, :, 1]).sum(axis=-1))
        return load

    def cut_at(self, row: int) -> EngineMotion:
        """Return the motion up to and including `row`."""
        return self if row == len(self.time) - 1 else EngineMotion(*[column[: row + 1] for column in self])

    @staticmethod
    def concatenate(chunks: list[EngineMotion]) -> EngineMotion:
        """Join chunks of a motion, each of which starts with the last row of the chunk before."""
        whole, *rest = chunks
        columns = zip(whole, *(tuple(column[1:] for column in chunk) for chunk in rest))
        return EngineMotion(*map(np.concatenate, columns))

    @staticmethod
    def empty(model: EngineModel) -> EngineMotion:
        """Return a motion without rows, of a model whose contact forces are recorded."""
        size, contacts = model.coordinates, len(model.recorders.contact)
        widths = size, size, size, 4 * contacts, 6 * contacts
        return EngineMotion(np.empty(0), *(np.empty((0, width)) for width in widths))

    def state_at(self, row: int) -> EngineState:
        """Return the state of the engine at `row`, with the rates of slip and load since the row before."""
        row = range(len(self.time))[row]
        near = EngineMotion(*[column[max(row - 1, 0) : row + 1] for column in self])
        slip, load = near.slip, near.load
        rates: list[Array | None] = [None, None]
        if row > 0:
            span = self.time[row] - self.time[row - 1]
            rates = [None if each is None else (each[1] - each[0]) / span for each in (slip, load)]
        return EngineState(
            coordinates=self.coordinates[row],
            velocities=self.velocities[row],
            contact=self.contact[row],
            slip_rate=rates[0],
            load=None if load is None else load[-1],
            load_rate=rates[1],
        )


@contextmanager
def silence_engine() -> Iterator[None]:
    """Keep the engine from writing on the terminal: the status of a run reports failed steps."""
    before = exudyn.config.printToConsole
    exudyn.config.printToConsole = False
    try:
        yield
    finally:
        exudyn.config.printToConsole = before


def set_initial_state(model: EngineModel, state: EngineState) -> None:
    """Set `state` as the initial state of the engine's next run."""
    data = model.mbs.systemData
    if state.accelerations is not None:
        data.SetODE2Coordinates_tt(state.accelerations, configuration=INITIAL_CONFIGURATION)
    data.SetODE2Coordinates(state.coordinates, configuration=INITIAL_CONFIGURATION)
    data.SetODE2Coordinates_t(state.velocities, configuration=INITIAL_CONFIGURATION)
    data.SetDataCoordinates(state.contact, configuration=INITIAL_CONFIGURATION)


class EngineSolver:
    """
    Exudyn's solver for one model, with its integrator and tolerances.

    newton: tolerance of a step's equations, relative to their first residual. residual: absolute tolerance of these
    equations, in units of force. integrator: one of INTEGRATORS. discontinuous: tolerance of the iteration over
    contacts that open or reverse their slip within a step; None takes that of Newton's iteration.
    """

    def __init__(
        self,
        model: EngineModel,
        newton: float,
        residual: float,
        integrator: str = "generalized alpha",
        discontinuous: float | None = None,
    ) -> None:
        """Make Exudyn's solver, with its settings, for `model`."""
        self.model = model
        self.settings = _solver_settings(newton, residual)
        if model.coordinates > MAX_DENSE_COORDINATES:
            self.settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
        if discontinuous is not None:
            self.settings.timeIntegration.discontinuous.iterationTolerance = discontinuous
        # where contacts may open, the engine must shorten no step with an opening or slip reversal: it might never end
        self.settings.timeIntegration.discontinuous.useRecommendedStepSize = not model.allows_liftoff
        self.settings.timeIntegration.generalizedAlpha.useNewmark = integrator == "trapezoidal"
        self.explicit = EXPLICIT_INTEGRATORS.get(integrator)
        if self.explicit:
            kind = getattr(exudyn.DynamicSolverType, self.explicit)
            self.settings.timeIntegration.solverType = kind
        self.integration = self.settings.timeIntegration
        kind = exudyn.MainSolverExplicit if self.explicit else exudyn.MainSolverImplicitSecondOrder
        self.solver = kind()
        self.sensors: list[list[Any]] = [getattr(model.recorders, group.name) for group in fields(model.recorders)]
        self.newton_iterations = 0
        self.stopped = False

    def run(self, state: EngineState, begin: float, step: float, count: int) -> EngineMotion | None:
        """
        Integrate `count` steps from `state` at time `begin`; return None if the engine could not solve one of them.

        Where friction yields, the engine reduces no step: the first step that it cannot solve ends the run (`stopped`).
        """
        springs = self.model.springs
        set_initial_state(self.model, state)
        self.model.ground.begin(begin)
        if springs is not None:
            springs.begin(state)
        if self.model.friction is not None:
            if springs is not None:
                self.model.friction.coefficient_ratios = springs.coefficient_ratios(state)
            self.model.friction.begin(self.model.mbs, state, begin)
        integration = self.integration
        integration.startTime = begin
        integration.endTime = begin + count * step
        integration.numberOfSteps = count
        integration.minimumStepSize = step / (1.5 if springs is not None else MAX_STEP_REDUCTION)
        integration.generalizedAlpha.computeInitialAccelerations = state.accelerations is None
        try:
            self.stopped = not self.solver.SolveSystem(self.model.mbs, self.settings)
        except (exudyn.ExudynError, RuntimeError, ValueError):
            self.stopped = True
        finally:
            self.newton_iterations = int(self.solver.it.newtonStepsCount)
        if self.stopped and springs is None:
            return None
        motion = self._read_sensors()
        return motion if len(motion.time) > 1 else None

    def _read_sensors(self) -> EngineMotion:
        """Return the recorded motion at the engine's own instants: the engine halves steps that it cannot solve."""
        stored = self.model.mbs.GetSensorStoredData
        tables = [[stored(sensor) for sensor in sensors] for sensors in self.sensors]
        time = tables[0][0][:, 0]
        coordinates, velocities, accelerations, contact = [_join_tables(group) for group in tables[:4]]
        force = _join_tables(tables[4]) if tables[4] else np.empty((len(time), 0))
        return EngineMotion(time, coordinates, velocities, accelerations, contact, force)


def _join_tables(tables: list[Array]) -> Array:
    """Join the value columns of tables (T, 1 + C) whose first column is the time. A single table is not copied."""
    if len(tables) == 1:
        return tables[0][:, 1:]
    return np.concatenate([tables[0], *[table[:, 1:] for table in tables[1:]]], axis=1)[:, 1:]


def _solver_settings(newton: float, residual: float) -> Any:
    """Return settings of the implicit solver: `newton` is its relative tolerance, `residual` the absolute one."""
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    every_step = 0.0
    settings.solution.sensors.writePeriod = every_step
    integration = settings.timeIntegration
    integration.verboseMode = 0
    integration.newton.relativeTolerance = newton
    integration.newton.absoluteTolerance = residual
    integration.newton.useModifiedNewton = True
    integration.newton.modifiedNewtonContractivity = MAX_CONTRACTIVITY
    integration.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
    integration.discontinuous.iterationTolerance = newton
    integration.discontinuous.ignoreMaxIterations = False
    return settings
