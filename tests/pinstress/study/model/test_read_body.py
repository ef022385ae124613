"""Files of pins are read in processes of their own, within limits of time and memory."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from geometry import GeometryError, Pin, Segment
from geometry.imported.body_file import BodyFile, Place
from geometry.imported.imported_pin import SolidBody
from geometry.imported.recognise import recognised_profile
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from pinbase.platform import portable
from pinstress.study.model.imported_pin import apart, read_body, turned_apart
from tests.conftest import ROOT
from tests.support.pins.pin_files import MM, write_mesh, write_step
from tests.support.programs.limited_process import limited, start_server

PIN = Pin("P", (Segment(20.0, 30.0), Segment(40.0, 20.0)), fillet=4.0)  # in mm
ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()
FROM_FILE = """
geometry = "NAME"
[pin.B.band]
B = { z = [0.0, 1.0] }
"""


@pytest.fixture(scope="module", autouse=True)
def _server() -> None:
    start_server()


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, BodyFile]:
    """The same shape as a CAD file and as a mesh."""
    folder = tmp_path_factory.mktemp("bodies")
    metres = Pin("P", (Segment(0.02, 0.03), Segment(0.04, 0.02)), fillet=0.004)
    step = write_step(PIN, folder / "pin.step")
    mesh = write_mesh(solid_mesh(metres, MeshSize(across=2.5)), folder / "pin.msh")
    bands = (Place("B", (0.04, 0.06)),)
    return {p.suffix: BodyFile("P", p, MM, bands) for p in (step, mesh)}


def where(_: BodyFile) -> int:
    return os.getpid()


def beside_a_thread(work: object) -> object:
    """What a call returns while another thread runs, as in a notebook; or what it raises."""
    found: list[object] = []

    def call() -> None:
        try:
            found.append(work())  # type: ignore[operator]
        except Exception as error:
            found.append(error)

    thread = threading.Thread(target=call)
    thread.start()
    thread.join()
    return found[0]


@pytest.mark.parametrize("kind", [".step", ".msh"])
def test_every_reading_is_in_another_process(kind: str, files: dict[str, BodyFile]) -> None:
    assert apart(where, files[kind]) != os.getpid()
    if kind == ".msh":  # the kind makes no difference to how a process starts
        assert beside_a_thread(lambda: apart(where, files[kind])) != os.getpid()
    done: list[str] = []

    def watched(work: object, *arguments: object) -> object:
        done.append(work.__name__)  # type: ignore[attr-defined]
        return apart(work, *arguments)  # type: ignore[arg-type]

    body = SolidBody(files[kind], watched)
    body.mesh(MeshSize())
    assert body.volume > 0.0
    whole = ["cad_mesh", "cad_mesh", "cad_volume"]
    assert done == (whole if kind == ".step" else ["mesh_from_file"])


def test_what_is_read_there_is_what_is_read_here(files: dict[str, BodyFile]) -> None:
    file = files[".msh"]
    here = SolidBody(file)
    for found in (read_body(file), beside_a_thread(lambda: read_body(file))):
        assert isinstance(found, SolidBody)
        assert found == here
        assert (found.volume, found.ends, found.connections) == (
            here.volume,
            here.ends,
            here.connections,
        )
        assert found.band("B") == here.band("B")


@pytest.mark.slow
def test_what_is_recognised_there_is_what_is_recognised_here(files: dict[str, BodyFile]) -> None:
    here, file = recognised_profile(files[".step"]), files[".step"]
    assert turned_apart(file) == beside_a_thread(lambda: turned_apart(file)) == here
    assert read_body(file) == beside_a_thread(lambda: read_body(file))
    assert isinstance(read_body(file), Pin)


def test_errors_come_back_as_they_are(tmp_path: Path) -> None:
    (tmp_path / "text.step").write_text("Dear pin,\n")
    file = BodyFile("P", tmp_path / "text.step", MM, ())
    with pytest.raises(GeometryError) as caught:
        read_body(file)
    for error in (caught.value, beside_a_thread(lambda: read_body(file))):
        assert isinstance(error, GeometryError)
        assert error.code == "unreadable-geometry"
        assert "text.step" in str(error)


FAILS = """
import sys, threading
from pathlib import Path
from pinbase.processes.threads import hold_threads
hold_threads()
from geometry.imported.body_file import BodyFile, Place
from pinstress.study.model import imported_pin as module
from tests.support.programs import failing_readers

one = module.Limits(seconds=1, clock=600, memory=2**28)
module.CAD_LIMITS, module.LONG_LIMITS = one, module.Limits(seconds=600, clock=3, memory=2**28)

def read(work, name):
    try:
        print(name, work(BodyFile("P", Path(name), 1.0, (Place("B", (0.0, 1.0)),))))
    except ValueError as error:
        print(error.code, error)

def main():
    read(lambda file: module.apart(failing_readers.crash, file), "crash.msh")
    read(lambda file: module.apart(failing_readers.spin, file), "spin.step")
    read(lambda file: module.apart(failing_readers.sleep, file), "sleep.msh")
    read(lambda file: module.apart(failing_readers.swallow, file), "swallow.msh")
    read(module.read_body, sys.argv[1])

if sys.argv[2] == "thread":
    thread = threading.Thread(target=main)
    thread.start()
    thread.join()
else:
    main()
"""
SAID = (
    ("reading-crashed", "pin P: ", "crash.msh", "signal 6", "0.25 GB"),
    ("reading-crashed", "pin P: ", "spin.step", "1 s of processor time"),
    ("reading-crashed", "pin P: ", "sleep.msh", "3 s"),
    ("out-of-memory", "pin P: ", "swallow.msh", "0.25 GB"),
    ("out-of-memory", "pin P: ", "vast.vtk", "0.25 GB"),
)
SAID_ANYWHERE = (SAID[0][:-1], *SAID[1:3])  # without limits of memory


@pytest.mark.parametrize("where", ["thread"] if portable() else ["alone", "thread"])
def test_a_crash_or_a_limit_that_is_passed_there_is_an_error_here(
    where: str, tmp_path: Path
) -> None:
    """Forked, or beside another thread in a new Python, as always without fork. The last is a file
    of 100 bytes that says it has half a milliard nodes.
    """
    (tmp_path / "vast.vtk").write_bytes(
        b"# vtk DataFile Version 3.0\nvast\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
        b"POINTS 500000000 double\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", FAILS, str(tmp_path / "vast.vtk"), where],
        cwd=ROOT, capture_output=True, text=True, timeout=600,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == len(SAID)
    for line, (code, *named) in zip(lines, SAID_ANYWHERE if portable() else SAID, strict=False):
        assert line.startswith(f"{code} ")
        assert all(name in line for name in named), line


@pytest.mark.parametrize("what", ["pipe", "device", "large"])
@pytest.mark.parametrize("kind", ["study", "table", "pin.step", "pin.msh", "published"])
def test_only_regular_files_below_a_size_are_read(what: str, kind: str, tmp_path: Path) -> None:
    """Wherever the command line meets them: one message, no wait and no full memory."""
    study = tmp_path / "study.toml"
    begin, end = ONE_PIN.index("profile = ["), ONE_PIN.index("[case.")
    text = {
        "table": ONE_PIN.replace("forces = { B = [0.0, -988.86] }", 'table = "table"'),
        "published": ONE_PIN + '\n[published]\nsource = "a book"\npeaks = "published"\n',
    }.get(kind, ONE_PIN[:begin] + FROM_FILE.replace("NAME", kind) + ONE_PIN[end:])
    study.write_text(text)
    path = study if kind == "study" else tmp_path / kind
    path.unlink(missing_ok=True)
    if what == "pipe":
        os.mkfifo(path)
    elif what == "device":
        path.symlink_to("/dev/zero")
    else:
        path.touch()
        os.truncate(path, 2**31)  # a hole: it takes no room
    command = "run" if kind == "published" else "check"
    status, told = limited(study, command)
    assert status == 2, told
    assert path.name in told
    said = "is larger than" if what == "large" else "is a pipe or a device"
    assert said in told
    assert told.count("Error: ") == 1
