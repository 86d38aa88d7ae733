"""
The errands of a study, each from the store if it is there, else computed and stored at once.

The analyses ask an executor, see `sweep`; one made by `Answers.on` knows what has been fetched before. So everything
that a study can ask at once goes through the workers in one sweep, without a pause between one analysis and the next.
"""

from __future__ import annotations

import io
import json
import os
import pickle
from collections import defaultdict
from collections.abc import Callable, Iterable
from concurrent.futures import Executor, Future
from contextlib import suppress
from dataclasses import dataclass, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from comparison.sweep.errands import Errand, Fetched, fingerprint, named
from comparison.sweep.surroundings import answer_surroundings
from comparison.sweep.tile_store import MARK, TileStore, key_of

FORMAT = 1  # of a stored answer
NUMPY = {"_reconstruct", "dtype", "ndarray", "scalar"}  # what arrays are put together from


@dataclass
class Part:
    """What one stage cost: its tasks, how many of them an earlier run had stored, s of processor time of all."""

    tasks: int = 0
    stored: int = 0
    seconds: float = 0.0


class Answers:
    """
    What errands gave, in memory and in `store`; nothing is read from there if `fresh`. parts: what each stage cost.
    """

    def __init__(self, store: TileStore, fresh: bool = False) -> None:
        self._store, self._fresh = store, fresh
        self._known: dict[str, Any] = {}
        self.parts: dict[str, Part] = defaultdict(Part)

    def missing(self, errands: Iterable[Errand]) -> list[Errand]:
        """Those that must be computed; the others are read."""
        return [errand for errand in errands if not (errand.key in self._known or self._read(errand))]

    def holds(self, errand: Errand) -> bool:
        """Whether there is a file for it, whatever its state."""
        return not self._fresh and self._place(errand).exists()

    def put(self, errand: Errand, fetched: Fetched | None) -> None:
        """
        Keep what came back, None if nothing did. Raises StoreError.

        An answer that says it went wrong is not stored: the next run tries it again.
        """
        if fetched is None:
            return
        self._know(errand, fetched)
        if not faulty(fetched.result):
            content = pickle.dumps(fetched, protocol=4)
            self._store.write(self._place(errand), content, _described(errand), "a finished analysis")
            self._store.others += 1

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
        place = self._place(errand)
        try:
            fetched = _Unpickler(io.BytesIO(self._store.read(place))).load()
        except (OSError, ValueError, KeyError, AttributeError, EOFError, ImportError, pickle.UnpicklingError):
            return False
        with suppress(OSError):
            os.utime(place.parent)  # lately used
        self._know(errand, fetched)
        self.parts[errand.stage].stored += 1
        self._store.others += 1
        return True

    def _place(self, errand: Errand) -> Path:
        return self._store.folder / key_of(_described(errand)) / f"{errand.key[:24]}.answer"


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


class _Unpickler(pickle.Unpickler):
    """Makes nothing but this study's records and arrays, whatever the file says."""

    def find_class(self, module: str, name: str) -> Any:
        found = getattr(import_module(module), name) if module.split(".")[0] in ("comparison", "numpy") else None
        if (isinstance(found, type) and is_dataclass(found)) or (module.startswith("numpy") and name in NUMPY):
            return found
        raise pickle.UnpicklingError(f"{module}.{name} has no place in a stored answer")


def faulty(result: Any) -> bool:
    """Whether a result, or a part of it, names a fault."""
    if isinstance(result, tuple | list):
        return any(map(faulty, result))
    return bool(getattr(result, "fault", ""))


def _described(errand: Errand) -> str:
    content = {
        "what": MARK,
        "format": FORMAT,
        "answers of": named(errand.solve),
        "about": fingerprint(errand.about),
        "surroundings": answer_surroundings(errand.solve.__module__),
    }
    return json.dumps(content, indent=1, sort_keys=True)
