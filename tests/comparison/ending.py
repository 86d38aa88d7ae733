"""A run that ends itself in the middle of its work: a process beside it, kept waiting by others, would be late."""

from __future__ import annotations

import itertools
import os
import signal
import threading
from typing import Any

from comparison.runner.cache import Cache
from comparison.runner.task import BATCH


def end_after(results: int, seconds: float, analyses: bool = False) -> None:
    """Kill this process so many seconds after it has begun to store the result, or analysis, of this number."""
    put, stored = Cache.put, itertools.count()

    def counted(cache: Cache, key: Any, value: Any) -> None:
        if not (analyses and key.kind == BATCH) and next(stored) == results:
            threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGKILL)).start()
        put(cache, key, value)

    Cache.put = counted  # type: ignore[method-assign]
