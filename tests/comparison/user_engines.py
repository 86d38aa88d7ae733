"""Engines of a user: good ones and bad ones. Workers import them by name."""

import os
import sys
import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from reference.problem import Scene

NUMBER = 3
told: dict[str, Any] = {}


def plain(scene: Scene, phases: np.ndarray) -> np.ndarray:
    """As `fake_models.smooth`, without what that imports: importing counts as time of a call."""
    shape = 2.0 + np.cos(phases[:, 0]) + np.sin(phases[:, 1])
    return shape[:, None] + np.arange(1, len(scene.bodies) + 1)


def answering(answer: Callable[[np.ndarray], Any]) -> Callable[[Scene, np.ndarray], Any]:
    """An engine that makes its answer of the amplification of `plain`."""

    def engine(scene: Scene, phases: np.ndarray) -> Any:
        return answer(plain(scene, phases))

    return engine


as_list = answering(lambda mu: mu.tolist())
with_error = answering(lambda mu: (mu, 1e-3 * mu))
off = answering(lambda mu: 1.021 * mu)
off_with_error = answering(lambda mu: (1.021 * mu, 7e-3 * mu))
vague = answering(lambda mu: (mu, mu))
as_object = answering(lambda mu: SimpleNamespace(mu=mu))
misshapen = answering(lambda mu: np.zeros(3))
texts = answering(lambda mu: [["a", "b"]] * len(mu))
nothing_at_all = answering(lambda mu: None)
three_parts = answering(lambda mu: (mu, mu, mu))
complex_numbers = answering(lambda mu: mu + 1j)
truths = answering(lambda mu: mu > 0.0)
too_few_outcomes = answering(lambda mu: SimpleNamespace(mu=mu, status=["ok"]))


def with_one_error(scene: Scene, phases: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return plain(scene, phases), np.where(phases.any(axis=1)[:, None], np.nan, 1e-3 * plain(scene, phases))


def takes_all(scene: Scene, phases: np.ndarray, **settings: Any) -> np.ndarray:
    told.update(settings)
    return plain(scene, phases)


def as_full_object(scene: Scene, phases: np.ndarray) -> SimpleNamespace:
    mu, count = plain(scene, phases), len(phases)
    instant, displacement = [3.2] * count, [0.1] * count
    return SimpleNamespace(mu=mu, error=1e-3 * mu, status=["ok"] * count, instant=instant, displacement=displacement)


def listens(scene: Scene, phases: np.ndarray, tolerance: float, *, regularization: float | None) -> np.ndarray:
    told.update(tolerance=tolerance, regularization=regularization)
    return plain(scene, phases)


def half(scene: Scene, phases: np.ndarray) -> np.ndarray:
    mu = plain(scene, phases)
    mu[0] = np.inf, -1.0
    return mu


def zeros(scene: Scene, phases: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A building that does not move, known exactly."""
    phases[:] = 0.0
    return np.zeros((len(phases), 2)), np.zeros((len(phases), 2))


def own_words(scene: Scene, phases: np.ndarray) -> SimpleNamespace:
    return SimpleNamespace(mu=np.full((len(phases), 2), np.nan), status=["rim reached", "the matrix is singular"])


def raises(scene: Scene, phases: np.ndarray) -> None:
    _solve()


def _solve() -> None:
    raise RuntimeError("the matrix is singular")


def raises_in_scipy(scene: Scene, phases: np.ndarray) -> None:
    from scipy.optimize import brentq

    brentq(lambda x: 1 / 0, 0.0, 1.0)


def asks_us_wrongly(scene: Scene, phases: np.ndarray) -> None:
    import reference

    reference.amplification(scene, phases, equations="none")


def exits(scene: Scene, phases: np.ndarray) -> None:
    sys.exit(0)


def with_three(scene: Scene, phases: np.ndarray, needed: float) -> None: ...


def prints(scene: Scene, phases: np.ndarray) -> np.ndarray:
    print("noise")
    os.write(1, b"noise\n")
    os.system("echo noise; echo noise >&2")
    return plain(scene, phases)


def waits_for_ever(scene: Scene, phases: np.ndarray) -> None:
    time.sleep(1e9)


def leaves(scene: Scene, phases: np.ndarray) -> None:
    os._exit(7)


def computes_for_ever(scene: Scene, phases: np.ndarray) -> None:
    while True:
        pass


def spoils_its_process(scene: Scene, phases: np.ndarray) -> np.ndarray:
    mu = plain(scene, phases)
    os.chdir("/")
    os.environ.clear()
    np.linspace = None  # type: ignore[assignment]
    return mu


def as_reference(scene: Scene, phases: np.ndarray) -> np.ndarray:
    """The equations with friction linear below 1e-3 m/s, off by 1e-3."""
    import reference

    return 1.001 * reference.amplification(scene, phases, regularization=1e-3).mu


def saying(status: str) -> Callable[[Scene, np.ndarray], SimpleNamespace]:
    """An engine that calls every point so: values nine times too large, with a small error."""

    def engine(scene: Scene, phases: np.ndarray) -> SimpleNamespace:
        mu = 9.0 * plain(scene, phases)
        return SimpleNamespace(mu=mu, error=1e-3 * mu, status=[status] * len(mu), displacement=[9.0] * len(mu))

    return engine


not_converged, tolerance_not_met = saying("not converged"), saying("tolerance not met")
ok_after_all = saying("ok after 17 iterations")


def once_not_converged(scene: Scene, phases: np.ndarray) -> SimpleNamespace:
    """Values that say nothing at the first phase pair, those of `plain` elsewhere."""
    mu, first = plain(scene, phases), (phases == 0.0).all(axis=1)
    status = np.where(first, "not converged", "ok")
    return SimpleNamespace(mu=np.where(first[:, None], 9.0 * mu, mu), error=1e-3 * mu, status=status)


huge = answering(lambda mu: np.full_like(mu, 1e308))
large = answering(lambda mu: np.full_like(mu, 1e300))
infinite = answering(lambda mu: np.full_like(mu, np.inf))
no_number = answering(lambda mu: np.full_like(mu, np.nan))
negative = answering(lambda mu: -mu)
lowest = answering(lambda mu: np.full_like(mu, -1.7e308))
longer = answering(lambda mu: np.full(mu.shape, np.longdouble("1e4000")))
huge_error = answering(lambda mu: (mu, np.full_like(mu, 1e308)))
infinite_error = answering(lambda mu: (mu, np.full_like(mu, np.inf)))
wide = answering(
    lambda mu: SimpleNamespace(mu=mu, error=1e-3 * mu, displacement=[1e308] * len(mu), instant=[np.inf] * len(mu))
)
at_the_end_of_the_range = answering(lambda mu: np.full_like(mu, 9e11))
tiny = answering(lambda mu: np.full_like(mu, 5e-324))
