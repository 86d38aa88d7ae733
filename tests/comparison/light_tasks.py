"""Tasks of worker processes, in a module that imports next to nothing: a worker that runs them starts quickly."""

import itertools
import os
import signal
import time
from pathlib import Path


def _mark(place: str) -> None:
    """Leave a trace of the call."""
    (Path(place).parent / f"{Path(place).name}-{os.getpid()}-{time.monotonic_ns()}").touch()


def doubled(place: str) -> int:
    _mark(place)
    return 2


def hangs_in_compiled_code(place: str) -> int:
    """No line of Python is reached any more, so that no handler of a signal runs."""
    _mark(place)
    return sum(itertools.repeat(0))


def raises(place: str) -> int:
    raise RuntimeError("singular")


def counted(path: str) -> str:
    """Leaves a mark of every call; the one named "kills" dies at its first, "kills always" at each."""
    place = Path(path)
    calls = len(list(place.parent.glob(f"{place.name}-*")))
    (place.parent / f"{place.name}-{calls}").touch()
    if place.name == "kills always" or (place.name == "kills" and calls == 0):
        os.kill(os.getpid(), signal.SIGKILL)
    return place.name
