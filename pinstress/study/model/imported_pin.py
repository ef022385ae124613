"""The shape of a pin, read from its file in a separate process with limits of time and memory.

OpenCASCADE crashes on some damaged files and hangs on others, and a mesh file of a few bytes may
request more memory than there is.
"""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import Any

from geometry import CutPin, GeometryError, Pin, PinLike
from geometry.imported.body_file import BodyFile
from geometry.imported.imported_pin import MEASURING_MESH_SIZE, SolidBody
from geometry.imported.recognise import NotTurnedError, RecognisedProfile, recognised_profile
from geometry.mesh.solid_mesh import MeshError
from geometry.shape.polyline import Stripe, with_stripes
from loads import FileError, require_regular
from pinbase.platform import portable
from pinbase.processes.limits import MB, Limits
from pinbase.processes.pool import Job, ProcessDied, Tell, can_fork, in_parallel

CUT_KINDS = "hole", "flat", "slot", "passage", "recess"
MAX_BODY_SIZE = 1024 * MB
MAX_READER_MEMORY = 4096 * MB

Work = Callable[..., Any]

CAD_LIMITS = Limits(30, 300, MAX_READER_MEMORY)  # to measure a body; an intact one takes about 1 s
# To read a mesh file, and to mesh a CAD file more finely.
LONG_LIMITS = Limits(600, 6000, MAX_READER_MEMORY)


def read_body(file: BodyFile, clamps: Iterable[str] = ()) -> PinLike:
    """Return the body in a file.

    The result is a profile, with cuts, if the body is one and its bands and clamps are on it;
    otherwise a solid about the file's z-axis, with its bands measured.

    clamps: names of surfaces.

    Raises: GeometryError, MeshError as SolidBody; NotTurnedError if a band or a clamp is not on a
    profile about another axis than the file's z-axis; GeometryError if the file is not a regular
    file, is too large, or cannot be read within the limits.
    """
    require_readable(file)
    if file.meshed or not file.path.is_file():
        return SolidBody(file, apart)
    recognised = None
    try:
        recognised = turned_apart(file)
        return _profiled(file, recognised, set(clamps))
    except NotTurnedError as error:
        if recognised is not None and not recognised.upright:  # a solid is about the file's z-axis
            why = f"{error.why}{_axes(recognised, of_bands=True)}"
            raise NotTurnedError(file.name, file.path.name, why) from None
        return SolidBody(file, apart, f"{file.path.name} is taken as a solid, since {error.why}")


def turned_apart(file: BodyFile) -> RecognisedProfile:
    """Return `geometry.imported.recognise.recognised_profile` of a file, computed in another
    process.

    Raises: the errors of that function and of `apart`.
    """
    profile: RecognisedProfile = apart(recognised_profile, file)
    return profile


def require_readable(file: BodyFile) -> None:
    """Raise GeometryError if the file cannot be read, or is too large."""
    try:
        require_regular(file.path, MAX_BODY_SIZE)
    except FileError as error:
        raise GeometryError(f"pin {file.name}: {file.path.name} {error}", error.code) from None
    except FileNotFoundError:
        pass  # SolidBody reports a missing file


def _profiled(file: BodyFile, recognised: RecognisedProfile, clamps: set[str]) -> Pin | CutPin:
    """Return the recognised profile with its bands.

    Raises: NotTurnedError if a band or a clamp is not on the profile.
    """
    start, stripes = recognised.start * file.unit, []
    for place in file.places:
        at = recognised.surfaces.get(place.surface or "")
        if place.z is not None:
            at = place.z[0] - start, place.z[1] - start
        if at is None:
            why = f"surface {place.surface} of band {place.name} is no whole cylinder"
            raise NotTurnedError(file.name, file.path.name, why)
        stripes.append(Stripe(place.name, *at, place.connection))
    named = {place.name for place in file.places}
    stripes += [
        Stripe(c, *recognised.surfaces[c], False)
        for c in clamps - named
        if c in recognised.surfaces
    ]
    try:
        profile = with_stripes(recognised.pin(file.name), stripes, start)
        pin = CutPin(profile, recognised.cuts)
        for clamp in clamps:
            pin.surface(clamp)
    except GeometryError as error:
        why = str(error).removeprefix(f"pin {file.name}: ")
        raise NotTurnedError(file.name, file.path.name, why) from None
    counted = (
        (len(profile.segments), "segment"),
        *((sum(c.what == kind for c in recognised.cuts), kind) for kind in CUT_KINDS),
    )
    ending = {"recess": "es"}
    parts = ", ".join(f"{n} {what}{ending.get(what, 's') * (n > 1)}" for n, what in counted if n)
    source = f"{file.path.name} is taken as a profile: {parts}{_axes(recognised)}"
    profile = replace(profile, source=source)
    return replace(pin, profile=profile) if recognised.cuts else profile


def _axes(recognised: RecognisedProfile, of_bands: bool = False) -> str:
    """Return a text on the position of the profile's axes in the file; empty if they are the
    file's.

    of_bands: whether z is that of bands, which count from the file's origin.
    """
    axes, start = "", recognised.start
    if not recognised.upright:
        z, x = plain_vector(recognised.along), plain_vector(recognised.x)
        axes = f"; z is along {z} of the file, and x along {x}"
    if of_bands:
        return f"{axes}; z of bands counts from the file's origin"
    return axes + f"; z counts from its start face, at z = {start:g} of the file" * bool(start)


def plain_vector(v: tuple[float, float, float]) -> str:
    """Return a vector as text for people."""
    return f"({', '.join(f'{x:.6g}' for x in v)})"


def apart(work: Work, file: BodyFile, *arguments: object) -> Any:
    """Return the result of `work(file, ...)`, run in another process.

    Raises: the errors of the work; GeometryError if that process crashes or exceeds its limits.
    """
    quick = work is recognised_profile or arguments in ((), (MEASURING_MESH_SIZE,))
    limits = CAD_LIMITS if quick and not file.meshed else LONG_LIMITS
    job: Job[Any] = Job(
        f"pin {file.name}", partial(_read, work, file, arguments, limits.memory), limits
    )
    (result,) = in_parallel([job], 2, anew=not can_fork())
    if isinstance(result, ProcessDied):
        why = result.reason
        if result.status == -signal.SIGABRT and not portable():
            why += f"; its memory limit is {limits.memory / 2**30:g} GB"
        raise GeometryError(
            f"pin {file.name}: reading {file.path.name} failed ({why}): it is "
            "damaged, too large, or has very small faces or edges; repair and export it again, "
            "or mesh it in another program and give the mesh",
            "reading-crashed",
        )
    return result


def _read(work: Work, file: BodyFile, arguments: tuple[object, ...], memory: float, _: Tell) -> Any:
    """Run `work` in the other process.

    memory: limit of the process, bytes.
    """
    try:
        return work(file, *arguments)
    except (MemoryError, GeometryError, MeshError) as error:
        code = "out-of-memory"
        if getattr(error, "code", code) != code:  # gmsh's error of memory has this code, too
            raise
        raise GeometryError(
            f"pin {file.name}: reading {file.path.name} needs more than the limit of "
            f"{memory / 2**30:g} GB of memory; it is damaged, or too fine: give a coarser mesh",
            code,
        ) from None
