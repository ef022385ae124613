"""Entries of the cache: never trusted when damaged, packed to the last bit, never in the way."""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fea.core.peak import Maximum
from pinbase.records import pack
from pinstress.analysis import cache as cache_module
from pinstress.analysis.cache import Cache, user_cache
from pinstress.analysis.stored import PinOutcome
from pinstress.explore.sweep.versions import OWN_PACKAGES
from reports.data.row import PinResult
from tests.support.each import each
from tests.support.programs.folder_contents import contents, flipped


def rigid(note: str = "why") -> PinOutcome:
    """The outcome of a pin in one case, without a number."""
    return PinOutcome((PinResult(Maximum("P", "c", "beam", "rigid", note)),))


def large(size: int) -> PinOutcome:
    """An entry of about so many bytes."""
    return rigid("w" * size)


@each("damage", [flipped, lambda d: d[:-1], lambda d: d[:40], lambda _: b"", lambda d: d + b"\0"])
def test_a_damaged_entry_is_none_and_is_replaced(
    tmp_path: Path, damage: Callable[[bytes], bytes]
) -> None:
    cache, value = (
        Cache(tmp_path, ""),
        rigid(),
    )
    key = cache.key("question")
    cache.write(key, value)
    assert cache.read(key, PinOutcome) == value
    sound = (tmp_path / key).read_bytes()
    (tmp_path / key).write_bytes(damage(sound))
    assert cache.read(key, PinOutcome) is None
    cache.write(key, value)
    assert contents(tmp_path) == {key: sound}


@each("room", OWN_PACKAGES)
def test_a_change_in_the_source_is_another_program(
    room: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also in that of loads: what was swept or sampled is known by the study alone."""
    (tmp_path / "pinstress" / "analysis").mkdir(parents=True, exist_ok=True)
    (tmp_path / room / "core").mkdir(parents=True, exist_ok=True)
    module = tmp_path / "pinstress" / "analysis" / "cache.py"
    monkeypatch.setattr(cache_module, "__file__", str(module))
    seen = set()
    for source in ("x = 1", "x = 2"):
        (tmp_path / room / "core" / "stress.py").write_text(source)
        seen.add(cache_module.program())
    assert len(seen) == 2


def test_no_name_leaves_a_folder(tmp_path: Path) -> None:
    cache = Cache(tmp_path / "cache", "")
    for key in ("../" * 22 + "a", "a" * 63 + "/", "A" * 64, "", "a" * 65):
        with pytest.raises(ValueError, match="not the name of an entry"):
            cache.read(key, PinOutcome)


def test_the_longest_unused_go_first_and_nothing_else_goes(tmp_path: Path) -> None:
    cache = Cache(tmp_path, "", limit=3000)
    keys = [cache.key(i) for i in range(4)]
    other = tmp_path / "letter.txt"
    other.write_text("not ours " * 1000)
    left = tmp_path / f"{keys[0]}abc_1.partial"  # by a run that was killed
    left.write_bytes(b"\0" * 900)
    os.utime(left, (1.0, 1.0))
    for i, key in enumerate(keys):
        cache.write(key, large(700))
        os.utime(tmp_path / key, (10.0 + i, 10.0 + i))
    assert cache.read(keys[0], PinOutcome) is not None  # used now
    size = (tmp_path / keys[0]).stat().st_size
    assert 2 * size <= cache.limit < 3 * size
    cache.trim()
    assert {p.name for p in tmp_path.iterdir()} == {keys[0], keys[3], "letter.txt"}
    cache.write(keys[1], large(5000))  # more than all may be
    assert not (tmp_path / keys[1]).exists()


def test_what_other_programs_name_by_hashes_stays(tmp_path: Path) -> None:
    """A store of theirs that PINSTRESS_CACHE names by mistake; links and folders as well."""
    cache = Cache(tmp_path / "store", "program")
    cache.write("a" * 64, large(700))
    assert cache.read("a" * 64, PinOutcome) is not None
    (tmp_path / "thesis.doc").write_text("years of work")
    (tmp_path / "store" / ("b" * 64)).write_bytes(b"blob" * 1000)
    (tmp_path / "store" / ("c" * 64)).symlink_to(tmp_path / "thesis.doc")
    (tmp_path / "store" / ("d" * 64)).mkdir()
    Cache(tmp_path / "store", "program", limit=0).trim()
    left = sorted(p.name[0] for p in (tmp_path / "store").iterdir())
    assert left == ["b", "c", "d"]
    assert (tmp_path / "thesis.doc").read_text() == "years of work"


def test_where_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for off in ("", "off", "OFF"):
        monkeypatch.setenv("PINSTRESS_CACHE", off)
        assert user_cache() is None
    monkeypatch.setenv("PINSTRESS_CACHE", str(tmp_path / "here"))
    found = user_cache()
    assert found is not None
    assert found.folder == tmp_path / "here"
    monkeypatch.delenv("PINSTRESS_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    found = user_cache()
    assert found is not None
    assert found.folder == tmp_path / "xdg" / "pinstress"
    assert list(tmp_path.iterdir()) == []  # nothing is made before it is written


class Payload:
    """What a pickle of it does when it is read."""

    def __init__(self, path: str) -> None:
        self.path = path

    def __reduce__(self) -> tuple[Callable[[str], None], tuple[str]]:
        return os.mkdir, (self.path,)


def test_nothing_is_pickled(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="cannot be packed"):
        pack(np.array([{}], dtype=object))
    with pytest.raises(TypeError, match="cannot be packed"):
        pack(Path("x"))
    cache, trap = Cache(tmp_path, ""), tmp_path / "trap"
    key = cache.key("plot")
    file = io.BytesIO()
    text = np.frombuffer(b'["Solved",[["Peak","a",0]]]', np.uint8)
    np.savez(file, **{"0": np.array([Payload(str(trap))], dtype=object), "text": text})  # type: ignore[arg-type]
    seal = hashlib.sha256(key.encode() + file.getvalue()).digest()
    (tmp_path / key).write_bytes(seal + file.getvalue())  # as sound as a forger can make it
    assert cache.read(key, PinOutcome) is None
    assert not trap.exists()
