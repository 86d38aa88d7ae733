"""
The errands of a study, each from the cache if it is there, else computed and stored at once.

The analyses ask an executor, see `sweep`; one made by `Answers.on` knows what has been fetched before. So everything
that a study can ask at once goes through the workers in one sweep, without a pause between one analysis and the next.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from typing import Any, get_type_hints

from comparison.execution.cache import Cache
from comparison.execution.keys import errand_key
from comparison.execution.task import Errand, Fetched


@dataclass
class Part:
    """What one stage cost: its tasks, how many of them an earlier run had stored, s of processor time of all."""

    tasks: int = 0
    stored: int = 0
    seconds: float = 0.0


class Answers:
    """
    What errands gave, in memory and in `cache`; nothing is read from there if `fresh`. parts: what each stage cost.
    """

    def __init__(self, cache: Cache, fresh: bool = False) -> None:
        self._cache, self._fresh = cache, fresh
        self._known: dict[str, Any] = {}
        self.parts: dict[str, Part] = defaultdict(Part)

    def missing(self, errands: Iterable[Errand]) -> list[Errand]:
        """Those that must be computed; the others are read."""
        return [errand for errand in errands if not (errand.key in self._known or self._read(errand))]

    def holds(self, errand: Errand) -> bool:
        """Whether there is a file for it, whatever its state."""
        return not self._fresh and self._cache.holds(errand_key(errand))

    def put(self, errand: Errand, fetched: Fetched | None) -> None:
        """
        Keep what came back, None if nothing did. Raises StoreError.

        An answer that says it went wrong is not stored: the next run tries it again.
        """
        if fetched is None:
            return
        self._know(errand, fetched)
        self._cache.put(errand_key(errand), (fetched.result, fetched.cost))

    def on(self, make: Callable[[int], Executor]) -> Callable[[int], Executor]:
        """An executor for N jobs that answers what is known at once and hands on the rest to that of `make`."""
        return lambda jobs: _Knowing(self._known, make, jobs)

    def _know(self, errand: Errand, fetched: Fetched) -> None:
        self._known[errand.key] = fetched.result
        self.parts[errand.stage].tasks += 1
        self.parts[errand.stage].seconds += fetched.cost

    def _read(self, errand: Errand) -> bool:
        if self._fresh:
            return False
        declared: Any = get_type_hints(errand.solve)["return"]
        stored = self._cache.get(errand_key(errand), tuple[declared, float])
        if stored is None:
            return False
        self._know(errand, Fetched(*stored))
        self.parts[errand.stage].stored += 1
        return True


class _Knowing(Executor):
    """Answers what is known; the executor for the rest is made when there is any."""

    def __init__(self, known: dict[str, Any], make: Callable[[int], Executor], jobs: int) -> None:
        self._known, self._make, self._jobs = known, make, jobs
        self._inner: Executor | None = None

    def submit(self, solve: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        key = Errand("", solve, args[0], 0.0).key
        if key not in self._known:
            return self._executor().submit(solve, *args, **kwargs)
        answer: Future[Any] = Future()
        answer.set_result(self._known[key])
        return answer

    def _executor(self) -> Executor:
        if self._inner is None:
            self._inner = self._make(self._jobs)
        return self._inner

    def __getattr__(self, name: str) -> Any:
        """What the executor has beyond the usual, if it has it; all may be known, so none is made to be asked."""
        if name == "width" and self._inner is None:
            return self._jobs
        if name in ("abandon", "width") and self._inner is not None:
            return getattr(self._inner, name)
        raise AttributeError(name)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        if self._inner is not None:
            self._inner.shutdown(wait=wait, cancel_futures=cancel_futures)
