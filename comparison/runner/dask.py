"""
Execution of tasks on an existing Dask cluster.

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

from comparison.runner.environment import fingerprint_environment
from comparison.runner.processes import Call, ExecutorLostError, WorkerDiedError, Workers
from reference.problem import SceneError

if TYPE_CHECKING:
    from distributed import Client

CONNECT_TIMEOUT = 10.0  # s that the scheduler has for its answer
MAX_CONNECT_SECONDS = 12.0  # s that a connection attempt may take: a silent listener takes longer than CONNECT_TIMEOUT
MAX_MESSAGE_LETTERS = 200  # largest number of letters shown of a Dask error message
MAX_SECONDS_WITHOUT_WORKERS = 60.0  # s without any worker after which the run ends
RECOUNT_SECONDS = 2.0  # s between two counts of the workers, which may join or leave at any time
CONNECTION_LOST = "the connection to the scheduler was lost"  # message of ExecutorLostError

_ONE_CALL = threading.Lock()  # held during a call, so that a worker computes one at a time


@contextmanager
def connect_cluster(address: str, models: set[str]) -> Iterator[ClusterExecutor]:
    """Yield an executor on a cluster, which is left as it was. Raises SceneError if none answers or has other code."""
    refusal = partial(SceneError, "command line", "--scheduler", address)
    try:
        from distributed import Client
        from distributed.core import connect, send_recv
    except ImportError:
        raise refusal("needs Dask: pip install distributed") from None
    for name in ("asyncio", *logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("asyncio", "distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)  # this program reports the error itself, in one line

    async def knock() -> None:
        """Open a connection, ask who answers and close it; raise if no scheduler does."""
        comm = await connect(address, timeout=CONNECT_TIMEOUT)
        try:
            answer = await send_recv(comm, op="identity", reply=True)
        finally:
            comm.abort()
        if not (isinstance(answer, dict) and answer.get("type") == "Scheduler"):
            raise ValueError("what answers is none")

    try:
        # A client whose scheduler does not answer would leave threads behind
        _finish_call(lambda: asyncio.run(knock()))
        client = Client(address, timeout=CONNECT_TIMEOUT, set_as_default=False)
    except MemoryError:  # Dask raises it for text that it takes for the length of a message.
        raise refusal("no scheduler answers there: another protocol is spoken: give tcp://HOST:PORT of one") from None
    # Dask raises errors of many types if something else answers, or for TLS without a configuration.
    except Exception as error:
        raise refusal(f"no scheduler answers there: {' '.join(str(error).split())[:MAX_MESSAGE_LETTERS]}") from None
    try:
        _refuse_other_code(client, models, refusal)
        yield ClusterExecutor(client)
    finally:
        client.close(timeout=1.0)


def _finish_call(call: Call) -> None:
    """Make a call and raise what it raises; raise TimeoutError if it does not end, which leaves a thread behind."""
    ended: Future[Any] = Future()

    def run() -> None:
        """Make the call in a thread and keep its result or error."""
        try:
            ended.set_result(call())
        except BaseException as error:
            ended.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
    if not wait([ended], MAX_CONNECT_SECONDS).done:
        raise TimeoutError(f"silent for {MAX_CONNECT_SECONDS:g} s")
    ended.result()


class ClusterExecutor(Executor):
    """Executor on all workers of a cluster, with one task at a time in each, whatever its number of threads."""

    def __init__(self, client: Client) -> None:
        """Take over the client, which is connected to the cluster."""
        self._client, self._inner = client, client.get_executor(pure=False)
        self._count, self._counted, self._seen = 0, -RECOUNT_SECONDS, time.monotonic()

    @property
    def width(self) -> int:
        """Return the present number of workers. Raises ExecutorLostError without scheduler or, for long, workers."""
        now = time.monotonic()
        if now - self._counted > RECOUNT_SECONDS:
            self._count, self._counted = _count_workers(self._client), now
        if self._count:
            self._seen = now
        elif now - self._seen > MAX_SECONDS_WITHOUT_WORKERS:
            raise ExecutorLostError(f"no worker on the cluster for {MAX_SECONDS_WITHOUT_WORKERS:.0f} s")
        return max(self._count, 1)

    def start(self, call: Call, seconds: float | None = None, group: str = "") -> Future[Any]:
        """Start a call on a worker; with a time limit in a process of its own, so that the worker survives it."""
        if self._client.status != "running":
            raise ExecutorLostError(CONNECTION_LOST)
        answer: Future[Any] = Future()
        answer.set_running_or_notify_cancel()
        remote = self._inner.submit(_call_one_at_a_time, call, seconds)
        remote.add_done_callback(lambda arrived: _copy_outcome(arrived, answer))
        return answer

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Do nothing, because the next sweep uses the cluster as well."""

    def abandon(self) -> None:
        """Cancel the calls that have not begun; a worker finishes the one it is computing."""
        if self._client.status == "running":
            self._inner.shutdown(wait=False)


def _call_one_at_a_time(call: Call, seconds: float | None) -> Any:
    """Call the function while no other thread of the worker does: engine and equations are not thread-safe."""
    with _ONE_CALL:
        if seconds is None:
            numba.set_num_threads(1)
            return call()
        # Dask's workers under a nanny are daemons, which may not start processes.
        multiprocessing.current_process().daemon = False
        return _get_child_workers().start(call, seconds).result()


@cache
def _get_child_workers() -> Workers:
    """Return the process of this worker for calls with a time limit."""
    return Workers(1)


def _copy_outcome(remote: Future[Any], answer: Future[Any]) -> None:
    """Give the result or the error of a remote call to the future that waits for it."""
    from distributed import KilledWorker

    try:
        error = remote.exception()
    except CancelledError:
        error = ExecutorLostError(CONNECTION_LOST)  # Only the loss of the connection cancels a call.
    if isinstance(error, KilledWorker):
        error = WorkerDiedError(str(error), error.allowed_failures + 1)
    if error is None:
        answer.set_result(remote.result())
    else:
        answer.set_exception(error)


def _count_workers(client: Client) -> int:
    """Return the number of workers of the scheduler; raise ExecutorLostError without connection."""
    with suppress(OSError, TimeoutError, CancelledError):
        if client.status == "running":
            return len(client.nthreads())
    raise ExecutorLostError(CONNECTION_LOST)


def _refuse_other_code(client: Client, models: set[str], refusal: Callable[[str], SceneError]) -> None:
    """Raise if a worker has other versions of packages or source, whose numbers must not be taken for ours."""
    try:
        client.wait_for_workers(1, timeout=MAX_SECONDS_WITHOUT_WORKERS)
        theirs = client.run(_collect_fingerprints, sorted(models), on_error="return")
    except TimeoutError:
        raise refusal(
            f"the scheduler has had no worker for {MAX_SECONDS_WITHOUT_WORKERS:.0f} s: start some with `dask worker`"
        ) from None
    except OSError as error:
        raise refusal(f"{CONNECTION_LOST}: {' '.join(str(error).split())}") from None
    ours = _collect_fingerprints(sorted(models))
    for worker, versions in theirs.items():
        if isinstance(versions, OSError):
            continue  # This worker has ended or left since it was counted.
        if isinstance(versions, Exception):
            raise refusal(f"worker {worker} cannot import this project ({versions}): install it there")
        for name, value in ours.items():
            if versions.get(name) != value:
                raise refusal(f"worker {worker} has {name} {versions.get(name)}, here it is {value}: install the same")


def _collect_fingerprints(models: list[str]) -> dict[str, str]:
    """Return versions and source hashes of a worker for all these models."""
    return {name: value for model in models for name, value in fingerprint_environment(model).items()}
