"""The keys of a cluster, for encrypted connections of scheduler, workers and pinstress.

Only those who have the keys can communicate with the cluster. All parties of a cluster have the
same certificate, signed by the cluster's own authority. The key of the authority is not stored
anywhere, so that no further certificate can ever be issued.
"""

from __future__ import annotations

import datetime
import os
import secrets
import shlex
import ssl
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pinstress.study.reading.errors import InputError, cannot_write
from pinstress.study.reading.extras import require_package

if TYPE_CHECKING:
    from cryptography import x509
    from cryptography.hazmat.primitives.asymmetric import ec

VALID_DAYS = 5 * 365
CLOCK_DIFFERENCE = 1  # largest difference of the clocks of two computers, days
COMMAND = "pinstress cluster-keys"
CERTIFICATE_MARK, KEY_MARK = "-----BEGIN CERTIFICATE-----", "PRIVATE KEY-----"


@dataclass(frozen=True)
class KeyFiles:
    """The three files of a cluster in a folder."""

    folder: Path

    @property
    def authority(self) -> Path:
        """The file of the authority's certificate."""
        return self.folder / "ca.pem"

    @property
    def certificate(self) -> Path:
        """The file of the certificate."""
        return self.folder / "cert.pem"

    @property
    def key(self) -> Path:
        """The file of the certificate's key."""
        return self.folder / "key.pem"

    @property
    def dask_options(self) -> str:
        """The options of Dask's commands for these files, quoted for a shell."""
        options = ("--tls-ca-file", self.authority, "--tls-cert", self.certificate)
        return shlex.join(map(str, (*options, "--tls-key", self.key)))

    def context(self) -> ssl.SSLContext:
        """Return the settings of an encrypted connection to a scheduler. As in Dask, whoever has a
        certificate of the authority is trusted, whatever the name of the host.

        Raises: InputError if a file is missing or has the wrong content.
        """
        self._require(self.authority, CERTIFICATE_MARK, "a certificate")
        self._require(self.certificate, CERTIFICATE_MARK, "a certificate")
        self._require(self.key, KEY_MARK, "a key")
        try:
            context = ssl.create_default_context(ssl.Purpose.SERVER_AUTH, cafile=self.authority)
            context.load_cert_chain(self.certificate, self.key, password=str)
        except ssl.SSLError as error:
            why = str(error.reason or error).replace("_", " ").lower()
            raise InputError(
                f"--tls: {self.certificate} and {self.key} are not a certificate and its key in "
                f"PEM without a password ({why}); copy the three files that {COMMAND} wrote",
                code="bad-key",
            ) from None
        context.check_hostname = False
        return context

    def _require(self, path: Path, mark: str, kind: str) -> None:
        try:
            text = path.read_text(encoding="ascii", errors="replace")
        except OSError as error:
            raise InputError(
                f"--tls: {path} cannot be read ({error.strerror}); {COMMAND} {self.folder} writes "
                "ca.pem, cert.pem and key.pem, of which scheduler, workers and pinstress need the "
                "same",
                code="no-keys",
            ) from None
        if mark not in text:
            raise InputError(
                f"--tls: {path} is not {kind} in PEM; copy the three files that {COMMAND} wrote",
                code="bad-key",
            )


def write_keys(folder: Path) -> KeyFiles:
    """Write the keys of a new cluster into a folder, which is created if necessary.

    Only the owner can read the key.

    Raises: InputError if any of the three files exists or cannot be written.
    """
    require_package("cryptography", "cluster-keys")
    files = KeyFiles(folder)
    paths = files.authority, files.certificate, files.key
    if existing := [path.name for path in paths if os.path.lexists(path)]:
        raise InputError(
            f"{folder} has {', '.join(existing)} already; keys are never overwritten: choose "
            "another folder, or delete the old ones",
            code="exists",
        )
    written: list[Path] = []
    new_folders = [path for path in (folder, *folder.parents) if not os.path.lexists(path)]
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        for path, content in zip(paths, _new_keys(), strict=True):
            mode = 0o600 if path == files.key else 0o644
            with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "wb") as file:
                written.append(path)
                file.write(content)
    except BaseException as error:
        for path in written:
            with suppress(OSError):
                path.unlink()
        for path in new_folders:
            with suppress(OSError):
                path.rmdir()
        if not isinstance(error, OSError):
            raise
        raise cannot_write(error.filename or folder, error) from None
    return files


def _new_keys() -> tuple[bytes, bytes, bytes]:
    """Return an authority's certificate, a certificate signed by it, and the key of the latter, in
    PEM.
    """
    from cryptography import x509
    from cryptography.hazmat.primitives import serialization
    from cryptography.hazmat.primitives.asymmetric import ec
    from cryptography.x509.oid import ExtendedKeyUsageOID

    authority_key, key = (ec.generate_private_key(ec.SECP256R1()) for _ in range(2))
    name = f"pinstress cluster {secrets.token_hex(4)}"
    authority = _certificate(
        f"{name} authority", authority_key, f"{name} authority", authority_key,
        x509.BasicConstraints(ca=True, path_length=0), _key_usage(signs=True),
    )  # fmt: skip
    both = [ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH]
    certificate = _certificate(
        name, key, f"{name} authority", authority_key,
        x509.BasicConstraints(ca=False, path_length=None), _key_usage(signs=False),
        x509.ExtendedKeyUsage(both),
        x509.SubjectAlternativeName([x509.DNSName("pinstress-cluster")]),
    )  # fmt: skip
    pem = serialization.Encoding.PEM
    return (
        authority.public_bytes(pem),
        certificate.public_bytes(pem),
        key.private_bytes(
            pem, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
        ),
    )  # fmt: skip


def _certificate(
    name: str,
    key: ec.EllipticCurvePrivateKey,
    issuer: str,
    issuer_key: ec.EllipticCurvePrivateKey,
    *extensions: x509.ExtensionType,
) -> x509.Certificate:
    """Return a certificate.

    name, key: of the owner.
    issuer, issuer_key: of the authority that signs the certificate.
    extensions: in addition to the two key identifiers; usage and constraints are critical.
    """
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes

    now = datetime.datetime.now(datetime.UTC)
    builder = (
        x509.CertificateBuilder()
        .subject_name(_named(name))
        .issuer_name(_named(issuer))
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - datetime.timedelta(days=CLOCK_DIFFERENCE))
        .not_valid_after(now + datetime.timedelta(days=VALID_DAYS))
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
        .add_extension(
            x509.AuthorityKeyIdentifier.from_issuer_public_key(issuer_key.public_key()),
            critical=False,
        )
    )
    for extension in extensions:
        critical = isinstance(extension, x509.BasicConstraints | x509.KeyUsage)
        builder = builder.add_extension(extension, critical=critical)
    return builder.sign(issuer_key, hashes.SHA256())


def _named(name: str) -> x509.Name:
    from cryptography import x509

    return x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, name)])


def _key_usage(signs: bool) -> x509.KeyUsage:
    """Return the permitted use of a key: to sign certificates if `signs`, else to authenticate."""
    from cryptography import x509

    return x509.KeyUsage(
        digital_signature=not signs,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=signs,
        crl_sign=signs,
        encipher_only=False,
        decipher_only=False,
    )
