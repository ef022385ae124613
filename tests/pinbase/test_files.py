"""Files are complete or not there, though their writer is killed while it writes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from pinbase.files import create_file, replace_file
from tests.support.each import each

signal = pytest.importorskip("signal")
pytest.importorskip("resource")
# The kernel kills the writer at the 1025th byte.
KILLED = """
import resource, signal, sys
from pathlib import Path
from pinbase import files
signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
resource.setrlimit(resource.RLIMIT_FSIZE, (1024, 1024))
getattr(files, sys.argv[1])(Path("deck.inp"), b"whole" * 1000)
"""


@each(("writer", "before"), [("create_file", None), ("replace_file", b"before")])
def test_a_killed_writer_leaves_the_file_as_it_was(
    tmp_path: Path, writer: str, before: bytes | None
) -> None:
    """It left the first 1,024 bytes under the name of the file, which the next one refused."""
    file = tmp_path / "deck.inp"
    if before is not None:
        file.write_bytes(before)
    killed = subprocess.run([sys.executable, "-c", KILLED, writer], cwd=tmp_path)
    assert killed.returncode == -signal.SIGXFSZ
    assert (file.read_bytes() if file.exists() else None) == before
    {"create_file": create_file, "replace_file": replace_file}[writer](file, b"again")
    assert file.read_bytes() == b"again"
    assert [p.name for p in tmp_path.iterdir()] == ["deck.inp"]


def test_neither_the_file_nor_its_part_follows_a_link(tmp_path: Path) -> None:
    other = tmp_path / "other"
    other.write_bytes(b"other")
    (tmp_path / ".deck.partial").symlink_to(other)
    create_file(tmp_path / "deck", b"deck")
    (tmp_path / "link").symlink_to(other)
    with pytest.raises(FileExistsError):
        create_file(tmp_path / "link", b"deck")
    replace_file(tmp_path / "link", b"deck")
    assert other.read_bytes() == b"other"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["deck", "link", "other"]


def test_a_file_that_appears_meanwhile_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "deck"
    file.write_bytes(b"first")
    monkeypatch.setattr("os.path.lexists", lambda path: False)
    with pytest.raises(FileExistsError):
        create_file(file, b"second")
    assert file.read_bytes() == b"first"
    assert [p.name for p in tmp_path.iterdir()] == ["deck"]
