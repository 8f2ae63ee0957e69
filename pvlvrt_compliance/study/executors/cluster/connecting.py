"""The way to a scheduler: one that runs somewhere, or one that is started here with its workers."""

import asyncio
import logging
import threading
import traceback
import warnings
from collections.abc import Iterator, Mapping
from concurrent import futures
from contextlib import ExitStack, contextmanager, suppress
from typing import Any, NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.study.job import LOCAL
from pvlvrt_compliance.texts import one_line

Client = Any
"""Of dask.distributed, which need not be there: a client of a scheduler."""

Future = Any
"""Likewise: a task that was given to a client."""

EXTRA = "pip install 'pvlvrt-compliance[cluster]'"

_LOGGERS = ("distributed", "distributed.client", "distributed.gc", "bokeh", "tornado", "tornado.application")
_CLOSING_S = 5.0
_FETCH_S = 120.0  # for the result of a task to come
_GREETING_S = 10.0  # for an address to answer as a scheduler, unless dask's own settings say how long
_OF_DASK_S = 30.0  # what they say where nobody has said anything


def check_installed() -> None:
    """See that dask.distributed is there.

    Raises
    ------
    UsageError
        When it is not; names the extra that brings it.
    """
    try:
        import dask.config

        _be_silent(dask.config)
        import distributed  # noqa: F401
    except ImportError:
        raise UsageError(f"a cluster needs the extra: {EXTRA}") from None


@contextmanager
def connected(address: str, workers: int) -> Iterator[Client]:
    """A client of a scheduler.

    Parameters
    ----------
    address : str
        Of the scheduler (``tcp://HOST:PORT``, ``tls://HOST:PORT``), or `LOCAL`.
    workers : int
        How many are started, of `LOCAL`.

    Raises
    ------
    UsageError
        When nothing answers there, or it cannot be spoken to.
    """
    check_installed()
    with ExitStack() as stack:
        stack.enter_context(warnings.catch_warnings())
        # Of versions, which `identity` compares, and of the size of what is sent.
        warnings.simplefilter("ignore")
        target = stack.enter_context(_local(workers)) if address == LOCAL else address
        client = _client(target, named(address))
        try:
            yield client
        finally:
            with suppress(Exception):  # the scheduler may have gone
                client.close(timeout=_CLOSING_S)


def named(address: str) -> str:
    """How a message names a cluster: by its address, which is typed, on one line."""
    return f"cluster {one_line(address)}"


def _client(target: Any, named: str) -> Client:
    from distributed import Client
    from distributed.comm.addressing import get_address_host_port

    try:
        if isinstance(target, str):  # what can be seen before: a client that is half made is slow to go
            get_address_host_port(target)
            _refuse_without_keys(target)
            _greet(target)
        return Client(target, name="pvlvrt-check", set_as_default=False)
    except Exception as error:  # of address, TLS, network, or of the answer of what is no scheduler
        raise UsageError(f"{named}: no scheduler can be reached there: {_first_line(error)}") from None


def _greet(address: str) -> None:
    """See that a scheduler answers: of what takes a connection and says nothing dask waits for ever.

    Raises
    ------
    OSError
        When nothing answers there, or not in time.
    ValueError
        When something else does.
    """
    import dask.config
    from dask.utils import parse_timedelta

    asked_s: float = parse_timedelta(dask.config.get("distributed.comm.timeouts.connect"))
    patience_s = _GREETING_S if asked_s == _OF_DASK_S else asked_s
    asked: futures.Future[Mapping[str, Any]] = futures.Future()

    def ask() -> None:
        try:
            asked.set_result(asyncio.run(_answer(address, patience_s)))
        except Exception as error:
            asked.set_exception(error)

    # A notebook has a loop of its own in this thread, and nobody waits for an answer whom Ctrl-C has ended.
    threading.Thread(target=ask, daemon=True).start()
    answer = asked.result()
    if answer.get("type") != "Scheduler":
        raise ValueError(f"what answers there is no scheduler but {answer.get('type', 'something else')}")


async def _answer(address: str, patience_s: float) -> Mapping[str, Any]:
    from distributed.comm import connect
    from distributed.core import send_recv
    from distributed.security import Security

    async def asked() -> Mapping[str, Any]:
        # Of two bounds on the same time either might be told.
        comm = await connect(address, timeout=2 * patience_s, **Security().get_connection_args("client"))
        try:
            said = await send_recv(comm, op="identity", reply=True)
            return said if isinstance(said, Mapping) else {}
        finally:
            comm.abort()

    try:
        return await asyncio.wait_for(asked(), patience_s)
    except OSError as error:  # an answer that does not come in time among them
        if error.args:
            raise
        raise OSError(f"nothing answers within {patience_s:g} s") from None
    except Exception:  # of words that are not dask's
        return {}


def _refuse_without_keys(address: str) -> None:
    """Refuse what dask's own settings of security do not allow.

    Raises
    ------
    ValueError
        With the settings that are missing, or forbid it.
    """
    from distributed.security import Security

    security, is_tls = Security(), address.startswith("tls://")
    if is_tls and security.get_connection_args("client").get("ssl_context") is None:
        raise ValueError(
            "dask's settings name no certificates (distributed.comm.tls: ca-file, client.cert, client.key)"
        )
    if security.require_encryption and not is_tls:
        raise ValueError(
            "dask's settings demand encryption (distributed.comm.require-encryption): name a tls:// address"
        )


@contextmanager
def _local(workers: int) -> Iterator[Any]:
    """Scheduler and workers, which nobody else on this machine can speak to: they run whatever they are sent."""
    import dask.config
    from distributed import LocalCluster
    from distributed.security import Security

    from pvlvrt_compliance.controllers.process.scratch import job_folder

    # A folder that dask leaves in the system's temporary one else.
    with job_folder() as folder, dask.config.set({"temporary-directory": str(folder)}):
        cluster = LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            security=Security.temporary(),
            dashboard_address=None,
            memory_limit=None,
            silence_logs=logging.CRITICAL,
        )
        try:
            yield cluster
        finally:
            with suppress(Exception):
                cluster.close(timeout=_CLOSING_S)


def _be_silent(config: Any) -> None:
    """Have dask log nothing, unless its own settings say what it logs: what is wrong is told in words of ours."""
    if config.get("logging", None) is None and config.get("distributed.logging", None) is None:
        config.set({"distributed.logging": dict.fromkeys(_LOGGERS, "critical")})


def _first_line(error: Exception) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0]


class Outcome(NamedTuple):
    """What has become of a task."""

    value: Any = None
    error: str = ""  # that it has raised
    is_lost: bool = False  # whether its worker is, or what it had given


def outcome_of(future: Future) -> Outcome:
    """What a task has given that is done."""
    from distributed import KilledWorker
    from distributed.client import FutureCancelledError

    try:
        return Outcome(future.result(timeout=_FETCH_S))
    except (KilledWorker, FutureCancelledError, TimeoutError, OSError):
        return Outcome(is_lost=True)
    except Exception as error:
        return Outcome(error="".join(traceback.format_exception_only(error)).strip())


def go_on_without_us(future: Future) -> None:
    """Have a task done though nobody waits for it."""
    from distributed import fire_and_forget

    fire_and_forget(future)


def patience_of_settings_s() -> float | None:
    """How long a task waits for a worker by dask's own settings (s); None where they do not say."""
    import dask.config
    from dask.utils import parse_timedelta

    found: float | None = parse_timedelta(dask.config.get("distributed.scheduler.no-workers-timeout", None))
    return found
