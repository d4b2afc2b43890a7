"""Workers on a dask.distributed cluster: somebody's, or one of our own."""

import logging
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

from laglab.errors import RefusedError
from laglab.extras import SPREADING, require
from laglab.studies.workers import Executor

OURS = "local"
PATIENCE = 10.0
"""[s] A scheduler that has not answered by then is not there."""


@contextmanager
def cluster(address: str, workers: int = 0) -> Iterator[Executor]:
    """The workers of the scheduler at this address, or of one that is started for the while.

    Raises: MissingExtraError; RefusedError: nobody answers there.
    """
    require(SPREADING)
    import distributed

    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # we say ourselves what breaks
    with ExitStack() as stack:
        if address == OURS:
            address = stack.enter_context(_own(workers)).scheduler_address
        try:
            client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError) as error:
            raise RefusedError(
                f"--scheduler {address}: no dask scheduler answers there: start one with `dask "
                "scheduler`, or say --scheduler local"
            ) from error
        stack.enter_context(client)
        yield client.get_executor(pure=False)


def _own(workers: int) -> Any:
    import distributed

    return distributed.LocalCluster(
        n_workers=workers or os.cpu_count() or 1,
        threads_per_worker=1,
        dashboard_address=None,
        silence_logs=logging.CRITICAL,
    )
