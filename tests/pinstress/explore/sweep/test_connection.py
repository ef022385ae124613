"""The options that say where a cluster is, and its keys: what is refused, and that keys work.

The independent side of a connection is Python's own `ssl`, with the settings that dask gives its
schedulers (distributed.Security), not a scheduler of ours.
"""

from __future__ import annotations

import os
import shutil
import socket
import ssl
import stat
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from cryptography.hazmat.primitives.serialization import (
    BestAvailableEncryption,
    Encoding,
    PrivateFormat,
    load_pem_private_key,
)
from cryptography.x509 import load_pem_x509_certificate
from distributed import Security

import pinstress.explore.sweep.keys as module
from pinstress.explore.sweep.connection import ClusterConnection, connection_to
from pinstress.explore.sweep.keys import KeyFiles, write_keys
from pinstress.study.reading.errors import InputError
from tests.support.each import each
from tests.support.programs.command_line import ONE_PIN, run_here

FILES = "ca.pem", "cert.pem", "key.pem"
TIMEOUT = 20.0  # s


def test_keys_are_written_once_and_the_key_for_its_owner_only(tmp_path: Path) -> None:
    made = run_here("cluster-keys", "a/keys", cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert made.stdout.split() == [f"a/keys/{name}" for name in FILES]
    assert "dask scheduler --protocol tls --tls-ca-file a/keys/ca.pem" in made.stderr
    folder = tmp_path / "a" / "keys"
    assert sorted(path.name for path in folder.iterdir()) == list(FILES)
    assert stat.S_IMODE((folder / "key.pem").stat().st_mode) == 0o600
    before = {name: (folder / name).read_bytes() for name in FILES}
    for kept in FILES:  # one of them is enough
        for name in FILES:
            (folder / name).unlink(missing_ok=True)
        (folder / kept).write_bytes(before[kept])
        again = run_here("cluster-keys", "a/keys", cwd=tmp_path)
        assert again.returncode == 2
        assert f"a/keys has {kept} already" in again.stderr
        assert [path.name for path in folder.iterdir()] == [kept]
        assert (folder / kept).read_bytes() == before[kept]


def test_the_key_of_the_authority_is_nowhere(tmp_path: Path) -> None:
    keys = write_keys(tmp_path)
    authority, certificate = (
        load_pem_x509_certificate(path.read_bytes()) for path in (keys.authority, keys.certificate)
    )
    certificate.verify_directly_issued_by(authority)
    assert sum(path.read_bytes().count(b"PRIVATE KEY") for path in tmp_path.iterdir()) == 2  # one
    key = load_pem_private_key(keys.key.read_bytes(), None)
    assert key.public_key() == certificate.public_key() != authority.public_key()


def test_keys_that_cannot_be_written_leave_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    made = run_here("cluster-keys", "file", cwd=tmp_path)
    assert made.returncode == 2
    assert made.stderr == "Error: file: cannot be written (File exists)\n"

    opened = os.open

    def full(path: Path, flags: int, mode: int) -> int:
        if path.name == "key.pem":
            raise OSError(28, "No space left on device", str(path))
        return opened(path, flags, mode)

    monkeypatch.setattr(os, "open", full)
    with pytest.raises(InputError, match=r"key\.pem: cannot be written \(No space left"):
        write_keys(tmp_path / "keys")
    assert not (tmp_path / "keys").exists()


REFUSED = [
    (("--scheduler", "tcp://10.0.0.5:8786"), "the connection to tcp://10.0.0.5:8786 is not encr"),
    (("--scheduler", "10.0.0.5:8786"), "the connection to 10.0.0.5:8786 is not encrypted"),
    (("--scheduler", "tcp://[2001:db8::1]:8786"), "is not encrypted"),
    (("--scheduler", "tcp://0.0.0.0:8786"), "is not encrypted"),  # all networks
    (("--scheduler", "tcp://localhost.example.org:8786"), "is not encrypted"),
    (("--scheduler", "tcp://127.0.0.1@10.0.0.5:8786"), "is not the address of a scheduler"),
    (("--scheduler", "tcp://127.0.0.1:8786/x"), "is not the address of a scheduler"),
    (("--scheduler", "nonsense"), "nonsense is not the address of a scheduler; write it as tls://"),
    (("--scheduler", "tls://host:port", "--tls", "keys"), "is not the address of a scheduler"),
    (("--scheduler", "ws://127.0.0.1:8786"), "is not the address of a scheduler"),
    (("--scheduler", "tls://10.0.0.5:8786"), "tls://10.0.0.5:8786 needs --tls DIR"),
    (("--scheduler", "tls://h:8786", "--tls", "keys", "--insecure"), "--insecure: tls://h:8786 is"),
    (("--scheduler", "127.0.0.1:8786", "--tls", "keys"), "127.0.0.1:8786 is not encrypted; write"),
    (("--scheduler", "tls://h:8786", "--tls", "none"), "none/ca.pem cannot be read (No such file"),
    (("--scheduler", "tls://h:8786", "--tls", "keys", "--jobs", "2"), "--jobs: is for processes"),
    (("--tls", "keys"), "--tls: is for a cluster; name its scheduler with --scheduler"),
    (("--insecure",), "--insecure: is for a cluster"),
]  # fmt: skip


@each(("options", "message"), REFUSED)
def test_options_that_cannot_be_followed_are_refused(
    tmp_path: Path, options: tuple[str, ...], message: str
) -> None:
    """Before the study is read, and without a connection."""
    if not (tmp_path / "keys").exists():
        write_keys(tmp_path / "keys")
        (tmp_path / "study.toml").write_text(ONE_PIN)
    for command in ("sweep", "reliability"):
        made = run_here(command, "study.toml", *options, cwd=tmp_path)
        assert made.returncode == 2
        assert message in made.stderr
        assert len(made.stderr.strip().splitlines()) == 1
        assert not (tmp_path / "out").exists()


def test_a_scheduler_of_this_machine_needs_no_keys_and_one_beyond_it_a_word(tmp_path: Path) -> None:
    for address in ("tcp://127.0.0.1:1", "127.0.0.2:1", "localhost:1", "tcp://[::1]:1"):
        connection = connection_to(address)
        assert connection is not None
        assert connection.keys is None
        assert connection.address.startswith("tcp://")
    assert connection_to("10.0.0.5:1", insecure=True) == ClusterConnection(
        "tcp://10.0.0.5:1", "10.0.0.5", 1
    )
    keys = write_keys(tmp_path / "keys")
    for given in (keys.folder, str(keys.folder)):
        assert connection_to("tls://h:1", given) == ClusterConnection("tls://h:1", "h", 1, keys)
    assert connection_to(None) is None


def _without(name: str) -> Callable[[Path, KeyFiles], None]:
    return lambda folder, _: (folder / name).unlink()


def _text(name: str) -> Callable[[Path, KeyFiles], None]:
    def change(folder: Path, _: KeyFiles) -> None:
        (folder / name).write_text("no key\n")

    return change


def _encrypted(folder: Path, _: KeyFiles) -> None:
    key = load_pem_private_key((folder / "key.pem").read_bytes(), None)
    content = key.private_bytes(
        Encoding.PEM, PrivateFormat.PKCS8, BestAvailableEncryption(b"a password")
    )
    (folder / "key.pem").write_bytes(content)


def _key_of(folder: Path, other: KeyFiles) -> None:
    shutil.copy(other.key, folder / "key.pem")


BROKEN = [
    *((_without(name), rf"{name} cannot be read \(No such file or directory\)") for name in FILES),
    *((_text(name), rf"{name} is not a (certificate|key) in PEM") for name in FILES),
    (_encrypted, "are not a certificate and its key in PEM without a password"),
    (_key_of, r"are not a certificate and its key .* \(key values mismatch\)"),
]


@each(("change", "message"), BROKEN)
def test_keys_that_cannot_be_used_are_named(
    tmp_path: Path, change: Callable[[Path, KeyFiles], None], message: str
) -> None:
    folder, other = tmp_path / "keys", tmp_path / "other"
    if not other.exists():
        write_keys(other)
    shutil.rmtree(folder, ignore_errors=True)
    write_keys(folder)
    assert connection_to("tls://127.0.0.1:1", folder)
    change(folder, KeyFiles(other))
    with pytest.raises(InputError, match=message):
        connection_to("tls://127.0.0.1:1", folder)


@contextmanager
def _answering(keys: KeyFiles | None, said: bytes = b"hello, a scheduler") -> Iterator[int]:
    """The port of a server that speaks first, as dask's do, encrypted like a scheduler's."""
    context: ssl.SSLContext | None = None
    if keys is not None:
        files = {"tls_scheduler_cert": str(keys.certificate), "tls_scheduler_key": str(keys.key)}
        security = Security(tls_ca_file=str(keys.authority), require_encryption=True, **files)
        context = security.get_listen_args("scheduler")["ssl_context"]
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def serve() -> None:
            with suppress(OSError):
                while True:
                    accepted, _ = listener.accept()
                    with accepted, suppress(OSError):
                        answer = context.wrap_socket(accepted, True) if context else accepted
                        answer.sendall(said)
                        if said:
                            answer.recv(1000)
                        answer.close()

        thread = threading.Thread(target=serve)
        thread.start()
        try:
            yield listener.getsockname()[1]
        finally:
            listener.shutdown(socket.SHUT_RDWR)
            thread.join()


def _connected(port: int, keys: Path) -> None:
    connection = connection_to(f"tls://127.0.0.1:{port}", keys)
    assert connection is not None
    connection.require_answer(TIMEOUT)


def test_both_sides_need_keys_of_the_same_cluster(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours, other, mixed, old = (tmp_path / name for name in ("ours", "other", "mixed", "old"))
    for folder in (ours, other, mixed):
        write_keys(folder)
    shutil.copy(ours / "ca.pem", mixed)
    with _answering(KeyFiles(ours)) as port:
        _connected(port, ours)
        with pytest.raises(InputError, match=r"of another authority than .*other/ca\.pem"):
            _connected(port, other)
        with pytest.raises(InputError, match=r"refuses .*mixed/cert\.pem"):
            _connected(port, mixed)
    with _answering(KeyFiles(ours), b"") as port, pytest.raises(InputError, match="it closed the"):
        _connected(port, ours)
    with _answering(None) as port, pytest.raises(InputError, match="does not encrypt"):
        _connected(port, ours)
    context = KeyFiles(ours).context()
    context.verify_flags |= ssl.VERIFY_X509_STRICT  # as Python does from 3.13 on, and dask not
    with (
        _answering(KeyFiles(ours)) as port,
        socket.create_connection(("127.0.0.1", port)) as plain,
        context.wrap_socket(plain) as encrypted,
    ):
        assert encrypted.recv(5) == b"hello"
    monkeypatch.setattr(module, "VALID_DAYS", -0.5)
    with _answering(write_keys(old)) as port, pytest.raises(InputError, match="has expired"):
        _connected(port, old)


def test_nobody_answers(tmp_path: Path) -> None:
    keys = write_keys(tmp_path)
    connection = connection_to("tls://127.0.0.1:1", keys.folder)
    assert connection is not None
    with pytest.raises(InputError, match=r"no scheduler of dask answers at tls://127\.0\.0\.1:1 "):
        connection.require_answer(0.3)
