"""Workers on a dask.distributed cluster: somebody's, or one of our own."""

import asyncio
import logging
import signal
import socket
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from multiprocessing import resource_tracker
from tempfile import TemporaryDirectory
from typing import Any
from urllib.parse import urlsplit

from laglab.errors import RefusedError
from laglab.extras import SPREADING, require
from laglab.studies.workers import MOST_DEATHS, Executor, cores

OURS = "local"
SCHEMES = ("tcp", "tls")
PATIENCE = 5.0
"""[s] A scheduler that has not answered by then is not there."""


@contextmanager
def cluster(address: str, workers: int = 0) -> Iterator[Executor]:
    """The workers of the scheduler at this address, or of one that is ours and gone at the end.

    Raises: MissingExtraError; RefusedError: nobody answers there.
    """
    require(SPREADING)
    import distributed

    for name in ("distributed", "distributed.client"):  # we say ourselves what breaks
        logging.getLogger(name).setLevel(logging.CRITICAL)
    with ExitStack() as stack:
        if address == OURS:
            folder = stack.enter_context(TemporaryDirectory(prefix="laglab-dask-"))
            with _spared():
                address = stack.enter_context(_own(workers, folder)).scheduler_address
        else:
            _look_for(address)
        try:
            client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError) as error:
            raise _nobody(address) from error
        stack.enter_context(client)
        yield client.get_executor(pure=False)


def is_killed_worker(error: BaseException) -> bool:
    """Whether dask has given a job up at which several of its workers died."""
    distributed = sys.modules.get("distributed")
    return distributed is not None and isinstance(error, distributed.KilledWorker)


def _look_for(address: str) -> None:
    """Raises RefusedError where no scheduler is: dask itself would try again and again."""
    parts = urlsplit(address)
    try:
        if parts.scheme not in SCHEMES or not parts.hostname or not parts.port:
            raise RefusedError(
                f"--scheduler {address}: must be `local` or tcp://HOST:PORT, as `dask scheduler` "
                "tells it"
            )
        socket.create_connection((parts.hostname, parts.port), PATIENCE).close()
        asyncio.run(asyncio.wait_for(_greet(address), PATIENCE))
    except (OSError, ValueError, TimeoutError) as error:
        raise _nobody(address) from error


async def _greet(address: str) -> None:
    """Fails where something else listens, to which `Client` would talk for ever."""
    from distributed.comm.core import connect

    comm = await connect(address, timeout=PATIENCE)
    await comm.close()


def _nobody(address: str) -> RefusedError:
    return RefusedError(
        f"--scheduler {address}: no dask scheduler answers there: start one with `dask scheduler`, "
        "or say --scheduler local"
    )


@contextmanager
def _spared() -> Iterator[None]:
    """What is started within hears nothing of a Ctrl-C in the terminal, or of its end: we do."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    ours = {signal.SIGINT, signal.SIGHUP}
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ours)
    try:
        resource_tracker.ensure_running()  # else a worker makes it, and SIGINT passes
        signal.pthread_sigmask(signal.SIG_BLOCK, ours)
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _own(workers: int, folder: str) -> Any:
    """What its workers put aside goes into the folder."""
    import distributed

    return distributed.LocalCluster(
        n_workers=workers or cores(),
        threads_per_worker=1,
        local_directory=folder,
        dashboard_address="127.0.0.1:0",  # without one it would take a fixed port, and warn
        scheduler_kwargs={"dashboard": False, "allowed_failures": MOST_DEATHS - 1},
        silence_logs=logging.CRITICAL,
    )
