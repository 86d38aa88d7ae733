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

CONNECT_TIMEOUT = 10.0  # s, time limit given to Dask for the scheduler's answer when a connection is opened
MAX_CONNECT_SECONDS = 12.0  # s after which a connection attempt is given up even if Dask ignores CONNECT_TIMEOUT
MAX_MESSAGE_LETTERS = 200  # number of letters after which a Dask error message is cut off
MAX_SECONDS_WITHOUT_WORKERS = 60.0  # s without any worker on the cluster after which the run ends
RECOUNT_SECONDS = 2.0  # s after which the workers of the cluster are counted again, as they may join or leave
CONNECTION_LOST = "the connection to the scheduler was lost"  # error message when the cluster cannot be reached

_ONE_CALL = threading.Lock()  # held during a call: the threads of a worker make one call at a time


@contextmanager
def connect_cluster(address: str, models: set[str]) -> Iterator[ClusterExecutor]:
    """Yield an executor on a running Dask cluster. Raises SceneError if none answers or its workers have other code."""
    refusal = partial(SceneError, "command line", "--scheduler", address)
    try:
        from distributed import Client
        from distributed.core import connect, send_recv
    except ImportError:
        raise refusal("needs Dask: pip install distributed") from None
    for name in ("asyncio", *logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("asyncio", "distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)  # no messages of Dask: this program reports errors

    async def knock() -> None:
        """Open a connection, ask who answers and close it; raise ValueError if it is not a Dask scheduler."""
        comm = await connect(address, timeout=CONNECT_TIMEOUT)
        try:
            answer = await send_recv(comm, op="identity", reply=True)
        finally:
            comm.abort()
        if not (isinstance(answer, dict) and answer.get("type") == "Scheduler"):
            raise ValueError("what answers is none")

    try:
        # Check that a scheduler answers before a Client is made, because a Client leaves threads behind if none answers
        _finish_call(lambda: asyncio.run(knock()))
        client = Client(address, timeout=CONNECT_TIMEOUT, set_as_default=False)
    except MemoryError:  # raised if another program answers and Dask takes its text for the length of a message
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
    """Make a call in a thread; raise its error, or TimeoutError if it takes too long (the thread then runs on)."""
    ended: Future[Any] = Future()

    def run() -> None:
        """Make the call and keep its result or error."""
        try:
            ended.set_result(call())
        except BaseException as error:
            ended.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
    if not wait([ended], MAX_CONNECT_SECONDS).done:
        raise TimeoutError(f"silent for {MAX_CONNECT_SECONDS:g} s")
    ended.result()


class ClusterExecutor(Executor):
    """Executor that runs tasks on all workers of a Dask cluster, one at a time in each worker."""

    def __init__(self, client: Client) -> None:
        """Use this client, which is connected to the cluster."""
        self._client, self._inner = client, client.get_executor(pure=False)
        self._count, self._counted, self._seen = 0, -RECOUNT_SECONDS, time.monotonic()

    @property
    def width(self) -> int:
        """Return the number of workers. Raises ExecutorLostError if scheduler or, for long, all workers are gone."""
        now = time.monotonic()
        if now - self._counted > RECOUNT_SECONDS:
            self._count, self._counted = _count_workers(self._client), now
        if self._count:
            self._seen = now
        elif now - self._seen > MAX_SECONDS_WITHOUT_WORKERS:
            raise ExecutorLostError(f"no worker on the cluster for {MAX_SECONDS_WITHOUT_WORKERS:.0f} s")
        return max(self._count, 1)

    def start(self, call: Call, seconds: float | None = None, group: str = "") -> Future[Any]:
        """
        Start a call on a worker.

        seconds: limit of its processor time. A call with a limit runs in a separate process, which the worker survives.
        group: has no effect here.
        """
        if self._client.status != "running":
            raise ExecutorLostError(CONNECTION_LOST)
        answer: Future[Any] = Future()
        answer.set_running_or_notify_cancel()
        remote = self._inner.submit(_call_one_at_a_time, call, seconds)
        remote.add_done_callback(lambda arrived: _copy_outcome(arrived, answer))
        return answer

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Do nothing: the cluster remains in use."""

    def abandon(self) -> None:
        """Cancel the calls that no worker has begun; calls that have begun are finished."""
        if self._client.status == "running":
            self._inner.shutdown(wait=False)


def _call_one_at_a_time(call: Call, seconds: float | None) -> Any:
    """Return what a call returns, made while no other thread of the worker computes: the codes are not thread-safe."""
    with _ONE_CALL:
        if seconds is None:
            numba.set_num_threads(1)
            return call()
        # Dask marks its worker processes as daemons, which may not start processes: remove the mark.
        multiprocessing.current_process().daemon = False
        return _get_child_workers().start(call, seconds).result()


@cache
def _get_child_workers() -> Workers:
    """Return the pool of one process in which this worker makes calls that have a time limit."""
    return Workers(1)


def _copy_outcome(remote: Future[Any], answer: Future[Any]) -> None:
    """Copy the result or the error of a call on the cluster to the future `answer` that waits for it."""
    from distributed import KilledWorker

    try:
        error = remote.exception()
    except CancelledError:
        error = ExecutorLostError(CONNECTION_LOST)  # A call is only canceled when the connection is lost.
    if isinstance(error, KilledWorker):
        error = WorkerDiedError(str(error), error.allowed_failures + 1)
    if error is None:
        answer.set_result(remote.result())
    else:
        answer.set_exception(error)


def _count_workers(client: Client) -> int:
    """Return the number of workers of the cluster; raise ExecutorLostError if the connection is lost."""
    with suppress(OSError, TimeoutError, CancelledError):
        if client.status == "running":
            return len(client.nthreads())
    raise ExecutorLostError(CONNECTION_LOST)


def _refuse_other_code(client: Client, models: set[str], refusal: Callable[[str], SceneError]) -> None:
    """Raise an error if a worker has other versions of packages or source code, as its results could differ."""
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
            continue  # This worker has left the cluster: it need not be checked.
        if isinstance(versions, Exception):
            raise refusal(f"worker {worker} cannot import this project ({versions}): install it there")
        for name, value in ours.items():
            if versions.get(name) != value:
                raise refusal(f"worker {worker} has {name} {versions.get(name)}, here it is {value}: install the same")


def _collect_fingerprints(models: list[str]) -> dict[str, str]:
    """Return the versions of packages and hashes of source code in this process, as far as these models use them."""
    return {name: value for model in models for name, value in fingerprint_environment(model).items()}
