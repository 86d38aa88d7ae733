"""
A sweep on an existing Dask cluster.

Dask starts the tasks of a worker that died on another one by itself, `distributed.scheduler.allowed-failures` times (3
unless the scheduler is told otherwise); then the task is taken for the culprit.
"""

from __future__ import annotations

import asyncio
import logging
import multiprocessing
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, Future, wait
from contextlib import contextmanager, suppress
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numba

from comparison.runner.environment import environment_fingerprint
from comparison.runner.processes import Call, ExecutorLostError, WorkerDiedError, Workers
from reference.problem import SceneError

if TYPE_CHECKING:
    from distributed import Client

CONNECT_TIMEOUT = 10.0  # s for the scheduler to answer
LONGEST_KNOCK = 12.0  # s for the attempt to end: what accepts a connection and stays silent takes longer
LONGEST = 200  # letters that are shown of what Dask says when it does not answer
PATIENCE = 60.0  # s without any worker, before the run ends
RECOUNT = 2.0  # s between counts of the workers: some may join, or leave, at any time
GONE = "the connection to the scheduler was lost"

_ONE = threading.Lock()


@contextmanager
def connect_cluster(address: str, models: set[str]) -> Iterator[ClusterExecutor]:
    """An executor on a cluster, which is left as it was. Raises SceneError if none answers or has other code."""
    refusal = partial(SceneError, "command line", "--scheduler", address)
    try:
        from distributed import Client
        from distributed.comm import connect
    except ImportError:
        raise refusal("needs Dask: pip install distributed") from None
    for name in ("asyncio", *logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("asyncio", "distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)  # what goes wrong is said here, in one line

    async def knock() -> None:
        await (await connect(address, timeout=CONNECT_TIMEOUT)).close()

    try:
        _finish_call(lambda: asyncio.run(knock()))  # a client that reaches nobody leaves threads behind
        client = Client(address, timeout=CONNECT_TIMEOUT, set_as_default=False)
    except MemoryError:  # what Dask takes for the length of a message is text
        raise refusal("no scheduler answers there: another protocol is spoken: give tcp://HOST:PORT of one") from None
    except Exception as error:  # whatever Dask makes of what it is told, and of TLS without a configuration
        raise refusal(f"no scheduler answers there: {' '.join(str(error).split())[:LONGEST]}") from None
    try:
        _refuse_other_code(client, models, refusal)
        yield ClusterExecutor(client)
    finally:
        client.close(timeout=1.0)


def _finish_call(call: Call) -> None:
    """Make a call, and raise what it raises; TimeoutError where it does not end, which costs a thread."""
    ended: Future[Any] = Future()

    def run() -> None:
        try:
            ended.set_result(call())
        except BaseException as error:
            ended.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
    if not wait([ended], LONGEST_KNOCK).done:
        raise TimeoutError(f"silent for {LONGEST_KNOCK:g} s")
    ended.result()


class ClusterExecutor(Executor):
    """Tasks on all workers of a cluster, one at a time in each, whatever its number of threads."""

    def __init__(self, client: Client) -> None:
        self._client, self._inner = client, client.get_executor(pure=False)
        self._count, self._counted, self._seen = 0, -RECOUNT, time.monotonic()

    @property
    def width(self) -> int:
        """Workers there are now. Raises ExecutorLostError if there has been none for PATIENCE or no scheduler."""
        now = time.monotonic()
        if now - self._counted > RECOUNT:
            self._count, self._counted = _count_workers(self._client), now
        if self._count:
            self._seen = now
        elif now - self._seen > PATIENCE:
            raise ExecutorLostError(f"no worker on the cluster for {PATIENCE:.0f} s")
        return max(self._count, 1)

    def start(self, call: Call, seconds: float | None = None, group: str = "") -> Future[Any]:
        """Make a call on a worker; with a limit in a process of its own, so that the worker outlives the call."""
        if self._client.status != "running":
            raise ExecutorLostError(GONE)
        answer: Future[Any] = Future()
        answer.set_running_or_notify_cancel()
        remote = self._inner.submit(_one_at_a_time, call, seconds)
        remote.add_done_callback(lambda arrived: _pass_on(arrived, answer))
        return answer

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Nothing: the next sweep uses the cluster too."""

    def abandon(self) -> None:
        """Take back what has not begun; a worker finishes what it is in."""
        if self._client.status == "running":
            self._inner.shutdown(wait=False)


def _one_at_a_time(call: Call, seconds: float | None) -> Any:
    """Run in a worker process: the engine and the compiled reference are used by one thread each."""
    with _ONE:
        if seconds is None:
            numba.set_num_threads(1)
            return call()
        multiprocessing.current_process().daemon = False  # a worker under a nanny may not start processes otherwise
        return _child_workers().start(call, seconds).result()


@cache
def _child_workers() -> Workers:
    """The process of this worker for calls with a limit."""
    return Workers(1)


def _pass_on(remote: Future[Any], answer: Future[Any]) -> None:
    from distributed import KilledWorker

    try:
        error = remote.exception()
    except CancelledError:
        error = ExecutorLostError(GONE)  # nobody else cancels
    if isinstance(error, KilledWorker):
        error = WorkerDiedError(str(error), error.allowed_failures + 1)
    if error is None:
        answer.set_result(remote.result())
    else:
        answer.set_exception(error)


def _count_workers(client: Client) -> int:
    with suppress(OSError, TimeoutError, CancelledError):
        if client.status == "running":
            return len(client.nthreads())
    raise ExecutorLostError(GONE)


def _refuse_other_code(client: Client, models: set[str], refusal: Callable[[str], SceneError]) -> None:
    """Numbers from other code must not be taken for ours."""
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
        theirs = client.run(_all_fingerprints, sorted(models), on_error="return")
    except TimeoutError:
        raise refusal(f"the scheduler has had no worker for {PATIENCE:.0f} s: start some with `dask worker`") from None
    except OSError as error:
        raise refusal(f"{GONE}: {' '.join(str(error).split())}") from None
    ours = _all_fingerprints(sorted(models))
    for worker, versions in theirs.items():
        if isinstance(versions, OSError):
            continue  # this worker died or left meanwhile
        if isinstance(versions, Exception):
            raise refusal(f"worker {worker} cannot import this project ({versions}): install it there")
        for name, value in ours.items():
            if versions.get(name) != value:
                raise refusal(f"worker {worker} has {name} {versions.get(name)}, here it is {value}: install the same")


def _all_fingerprints(models: list[str]) -> dict[str, str]:
    return {name: value for model in models for name, value in environment_fingerprint(model).items()}
