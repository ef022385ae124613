"""The connection to an existing cluster: the address of its scheduler, and the keys.

Whoever can talk to a scheduler can run code on it and on its workers. A connection beyond this
machine must therefore be encrypted with keys that both sides have.
"""

from __future__ import annotations

import ipaddress
import socket
import ssl
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from pinstress.explore.sweep.keys import COMMAND, KeyFiles
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.extras import require_package

RETRY_INTERVAL = 0.2  # time between two attempts to connect, s
# Options without Dask's dashboard; the rest of its server is unencrypted, and only local
NO_PAGES = "--no-dashboard --dashboard-address 127.0.0.1:0"
SAME_KEYS = f"give scheduler, workers and --tls the same three files that {COMMAND} wrote"
ENCRYPTED_EXAMPLE = "tls://HOST:8786"


@dataclass(frozen=True)
class ClusterConnection:
    """A scheduler and the keys for it.

    address: with its scheme, tls:// or tcp://.
    keys: None for a connection that is not encrypted.
    """

    address: str
    host: str
    port: int
    keys: KeyFiles | None = None

    @property
    def scheduler_command(self) -> str:
        """The command that starts such a scheduler."""
        if self.keys is None:
            return f"dask scheduler --host 127.0.0.1 {NO_PAGES}"
        return f"dask scheduler --protocol tls {self.keys.dask_options} {NO_PAGES}"

    @property
    def worker_command(self) -> str:
        """The command that starts a worker of this scheduler."""
        options = "" if self.keys is None else f" {self.keys.dask_options}"
        return f"dask worker {self.address}{options} --nthreads 1 {NO_PAGES}"

    @property
    def security(self) -> Any:
        """The keys in the form that Dask takes; None without keys."""
        from distributed import Security

        if self.keys is None:
            return None
        return Security(
            tls_ca_file=str(self.keys.authority),
            tls_client_cert=str(self.keys.certificate),
            tls_client_key=str(self.keys.key),
            require_encryption=True,
        )

    def require_answer(self, timeout: float) -> None:
        """Try the keys once, because Dask itself reports only that it could not connect.

        timeout: time within which a scheduler must answer, s.

        Raises: InputError if nothing answers, or if the keys of the two sides do not match.
        """
        if self.keys is None:
            return
        context = self.keys.context()
        with self._explained(), self._socket(time.monotonic() + timeout) as plain:
            plain.settimeout(timeout)
            with context.wrap_socket(plain) as encrypted:
                if not encrypted.recv(1):  # a scheduler refuses a certificate at the first read
                    raise self._refused("it closed the connection")

    def no_scheduler(self, reason: str) -> InputError:
        """Return the error that no scheduler answers.

        reason: what happened instead.
        """
        encrypted = "" if self.keys else (
            f"; one that was started with --protocol tls answers at {ENCRYPTED_EXAMPLE} only, with "
            "--tls"
        )  # fmt: skip
        return InputError(
            f"--scheduler: no scheduler of dask answers at {self.address} ({reason}); start one "
            f"with: {self.scheduler_command}{encrypted}",
            code="no-scheduler",
        )

    def _refused(self, reason: str) -> InputError:
        """Return the error that the scheduler does not accept the certificate."""
        assert self.keys is not None
        return InputError(
            f"--tls: the scheduler at {self.address} refuses {self.keys.certificate} ({reason}); "
            f"{SAME_KEYS}",
            code="refused-certificate",
        )

    def _socket(self, deadline: float) -> socket.socket:
        """Connect, also to a scheduler that is still starting. deadline: by time.monotonic()."""
        while True:
            try:
                left = max(deadline - time.monotonic(), RETRY_INTERVAL)
                return socket.create_connection((self.host, self.port), left)
            except OSError:
                if time.monotonic() + RETRY_INTERVAL > deadline:
                    raise
                time.sleep(RETRY_INTERVAL)

    @contextmanager
    def _explained(self) -> Iterator[None]:
        """Turn errors of the first connection into InputErrors that explain them."""
        assert self.keys is not None
        try:
            yield
        except ssl.SSLCertVerificationError as error:
            if "expired" in error.verify_message:
                why = f"the certificate of the scheduler at {self.address} has expired; make new "
                why += f"keys with {COMMAND}, and {SAME_KEYS}"
            else:
                why = f"the scheduler at {self.address} has a certificate of another authority than"
                why += f" {self.keys.authority} ({error.verify_message}); {SAME_KEYS}"
            raise InputError(f"--tls: {why}", code="other-authority") from None
        except ssl.SSLError as error:
            reason = (error.reason or "").replace("_", " ").lower()
            if "alert" not in reason:  # the answer is not TLS
                raise InputError(
                    f"--scheduler: what answers at {self.address} does not encrypt ({reason}); "
                    f"start it with: {self.scheduler_command}",
                    code="not-encrypted",
                ) from None
            raise self._refused(reason) from None
        except OSError as error:
            raise self.no_scheduler(str(error) or type(error).__name__) from None


def connection_to(
    scheduler: str | None,
    tls: Path | str | None = None,
    insecure: bool = False,
    jobs: int | None = None,
) -> ClusterConnection | None:
    """Return the connection that the options of a command describe; None without a scheduler.

    scheduler: address of the scheduler.
    tls: the folder with the keys.
    insecure: whether a connection beyond this machine may be unencrypted.
    jobs: number of processes of this machine, which cannot be combined with a cluster.

    Raises: InputError for options that contradict each other, keys that cannot be used, or a
    connection that is not encrypted.
    """
    if scheduler is None:
        for option, given in (("--tls", tls is not None), ("--insecure", insecure)):
            if given:
                raise InputError(
                    f"{option}: is for a cluster; name its scheduler with --scheduler "
                    f"{ENCRYPTED_EXAMPLE}, or leave it out",
                    code="needs-scheduler",
                )
        return None
    require_package("distributed", "--scheduler")
    if jobs is not None:
        raise InputError(
            "--jobs: is for processes of this machine, and --scheduler solves on the workers of a "
            "cluster instead; leave out one of them",
            code="jobs-and-scheduler",
        )
    scheme, host, port = _parts(scheduler)
    address = scheduler if "://" in scheduler else f"{scheme}://{scheduler}"
    if scheme == "tls":
        return ClusterConnection(address, host, port, _keys(address, tls, insecure))
    if tls is not None:
        raise InputError(
            f"--tls: {scheduler} is not encrypted; write {ENCRYPTED_EXAMPLE} for a scheduler that "
            "was started with --protocol tls",
            code="not-encrypted",
        )
    if not insecure and not _is_loopback(host):
        raise InputError(
            f"--scheduler: the connection to {scheduler} is not encrypted, and anybody on the way "
            f"could read it and run code on the cluster; make keys with {COMMAND} DIR, start "
            f"scheduler and workers with them, and use {ENCRYPTED_EXAMPLE} --tls DIR (or "
            "--insecure, on a network where everybody is trusted)",
            code="not-encrypted",
        )
    return ClusterConnection(address, host, port)


def _keys(address: str, tls: Path | str | None, insecure: bool) -> KeyFiles:
    """Return the keys for an encrypted connection."""
    if insecure:
        raise InputError(
            f"--insecure: {address} is encrypted; leave it out", code="insecure-and-encrypted"
        )
    if tls is None:
        raise InputError(
            f"--scheduler: {address} needs --tls DIR, the folder with the ca.pem, cert.pem and "
            f"key.pem of the cluster, which {COMMAND} DIR writes",
            code="needs-keys",
        )
    keys = KeyFiles(Path(tls))
    keys.context()
    return keys


def _parts(address: str) -> tuple[str, str, int]:
    """Return scheme, host and port of a scheduler's address; the default scheme is tcp.

    Raises: InputError for text that is not an address.
    """
    try:
        parts = urlsplit(address if "://" in address else f"tcp://{address}")
        host, port, rest = parts.hostname, parts.port, parts._replace(scheme="", netloc="").geturl()
        if host and port and not rest and parts.scheme in ("tls", "tcp") and "@" not in address:
            return parts.scheme, host, port
    except ValueError:  # no number as port, half a bracket
        pass
    raise InputError(
        f"--scheduler: {address} is not the address of a scheduler; write it as "
        f"{ENCRYPTED_EXAMPLE}, as dask scheduler prints it",
        code="not-an-address",
    )


def _is_loopback(host: str) -> bool:
    """Whether a host is the loopback address of this machine, which no network can reach."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
