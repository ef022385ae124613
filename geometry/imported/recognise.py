"""Recognition of a CAD body as a turned profile with drilled and milled cuts.

Faces of revolution about one axis give straight and circular parts of the section's outline, which
form a chain from end to end; a prism gives the cylinder through its edges. All other faces must
belong to cuts. If the volume of the result agrees with that of the body, nothing was overlooked.
Otherwise each solid that the body lacks of its profile is recognised on its own, as known cuts or
as a recess.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from geometry.imported.body_file import BodyFile
from geometry.imported.cad_mesh import face_names, solids_of
from geometry.imported.drilled_faces import near
from geometry.imported.outline_chain import MeridianSide, outlines
from geometry.imported.prisms import corner_side, prisms
from geometry.imported.recognised_cuts import CutFaces
from geometry.imported.removed_solids import removed_solids
from geometry.imported.sampled_face import FACE_TOLERANCE, Axis, SampledFace, sampled_face
from geometry.imported.solid_volume import solid_volume
from geometry.mesh.cut_pin import CutPin
from geometry.mesh.gmsh_session import MeshError, gmsh_model
from geometry.shape.band import GeometryError
from geometry.shape.features import Cut
from geometry.shape.milled import Flat
from geometry.shape.pin import Pin
from geometry.shape.polyline import Bend, pin_of_polyline
from geometry.shape.recess import Recess
from pinbase.arrays import Floats

VOLUME_TOLERANCE = 1e-5  # relative difference of the volumes
MAX_FACES = 400  # a body with more faces is not recognised
MAX_FLATS = 12  # largest number on a body; walls of splines that are not parallel look like more
DIMENSION_DIGITS = 7  # decimals, relative to the body's size, to which dimensions are rounded


class NotTurnedError(GeometryError):
    """The body is not a turned part with known cuts; `why` names the reason."""

    def __init__(self, pin: str, file: str, why: str) -> None:
        super().__init__(f"pin {pin}: {file}: {why}", "not-turned")
        self.why, self._arguments = why, (pin, file, why)

    def __reduce__(self) -> tuple[type[NotTurnedError], tuple[str, str, str]]:
        return NotTurnedError, self._arguments


@dataclass(frozen=True)
class RecognisedProfile:
    """A body that was recognised, m.

    outside, bore: corners of the outline and of the bore.
    cuts: cuts in the axes of the profile.
    start: position of the start face along the axis, from the point of the axis nearest to the
    file's origin, in the file's unit.
    along, x: directions, in the file's axes, of the pin's axis and of angle zero.
    surfaces: two z of each named cylinder, from the start face, m.
    """

    outside: tuple[Bend, ...]
    bore: tuple[Bend, ...]
    cuts: tuple[Cut, ...]
    start: float
    along: tuple[float, float, float]
    x: tuple[float, float, float]
    surfaces: dict[str, tuple[float, float]]

    @property
    def upright(self) -> bool:
        """Whether the pin's axis is along the file's z-axis."""
        return self.along == (0.0, 0.0, 1.0)

    def scaled(self, factor: float) -> RecognisedProfile:
        """The same profile in another unit of length: all lengths but `start` times `factor`."""
        outside, bore = (
            tuple(Bend(b.z * factor, b.r * factor, b.radius * factor) for b in line)
            for line in (self.outside, self.bore)
        )
        cuts = tuple(cut.scaled(factor) for cut in self.cuts)
        surfaces = {name: (a * factor, b * factor) for name, (a, b) in self.surfaces.items()}
        return replace(self, outside=outside, bore=bore, cuts=cuts, surfaces=surfaces)

    def pin(self, name: str) -> Pin:
        """The profile, without cuts. Raises: GeometryError where it is impossible."""
        return pin_of_polyline(name, self.outside, self.bore)


def recognised_profile(file: BodyFile) -> RecognisedProfile:
    """The profile and cuts of the body in a file, about any axis.

    Raises: NotTurnedError where the body is not recognised; GeometryError and MeshError as for
    `cad_mesh`.
    """
    with gmsh_model(f"{file.name}, {file.path.name}") as gmsh:
        solids = solids_of(gmsh, file)
        tags = [tag for _, tag in gmsh.model.getEntities(2)]
        if len(tags) > MAX_FACES:
            raise _not_turned(file, f"it has {len(tags)} faces")
        faces = [sampled_face(gmsh, *named) for named in face_names(file, tags).items()]
        x0, y0, z0, x1, y1, z1 = gmsh.model.getBoundingBox(-1, -1)
        centre = np.array([x0 + x1, y0 + y1, z0 + z1]) / 2.0
        size = float(math.dist((x0, y0, z0), (x1, y1, z1)))
        axis = _axis(file, faces, centre, size)
        inside = _reaches_axis(gmsh, faces, axis)
        volume = solid_volume(gmsh, solids[0]) * file.unit**3
    shaft, rest = _shaft(file, faces, axis, inside, size)
    digits = _digits(size)
    try:
        cuts = _cuts(file, rest, shaft, size) if rest else ()
        profile = replace(shaft, cuts=tuple(c.rounded(digits) for c in cuts)).scaled(file.unit)
        _require_volume(file, profile, volume)
    except NotTurnedError as error:
        all_cuts = _with_recesses(file, shaft, axis, size, error)
        rounded = (c if isinstance(c, Recess) else c.rounded(digits) for c in all_cuts)
        profile = replace(shaft, cuts=tuple(rounded)).scaled(file.unit)
    return profile


def _not_turned(file: BodyFile, why: str) -> NotTurnedError:
    """The error for a file whose body is not a turned part. why: the reason."""
    return NotTurnedError(file.name, file.path.name, why)


def _axis(file: BodyFile, faces: Sequence[SampledFace], centre: Floats, size: float) -> Axis:
    """The axis about which the largest area is a surface of revolution."""
    z_axis = Axis(np.zeros(3), np.array([0.0, 0.0, 1.0]))
    candidates = [z_axis, *(a for face in faces if (a := face.axis(centre, size)) is not None)]

    def revolved_area(axis: Axis) -> float:
        revolved = (f for f in faces if not f.plane and f.revolved(axis, size))
        return sum(f.area for f in revolved)

    # The file's z-axis is preferred to a face's axis with an equal area.
    areas = [revolved_area(axis) for axis in candidates]
    preference = [1.0 + FACE_TOLERANCE, *[1.0] * (len(candidates) - 1)]
    best = int(np.argmax(np.array(areas) * preference))
    if not areas[best]:
        raise _not_turned(file, "none of its faces is of revolution")
    axis = candidates[best]
    along = axis.along * math.copysign(1.0, axis.along[int(np.argmax(np.abs(axis.along)))])
    along = np.where(np.abs(along) < FACE_TOLERANCE, 0.0, along)
    along /= np.linalg.norm(along)
    return Axis(axis.point - (axis.point @ along) * along, along)


def _reaches_axis(gmsh: Any, faces: Sequence[SampledFace], axis: Axis) -> set[int]:
    """Tags of the plane faces through which the axis passes."""
    tags = set()
    for face in faces:
        normal = face.normals[0]
        if face.plane and abs(abs(normal @ axis.along) - 1.0) < FACE_TOLERANCE:
            at = axis.point + ((face.points[0] - axis.point) @ axis.along) * axis.along
            if gmsh.model.isInside(2, face.tag, at.tolist()):
                tags.add(face.tag)
    return tags


def _shaft(
    file: BodyFile, faces: Sequence[SampledFace], axis: Axis, inside: set[int], size: float
) -> tuple[RecognisedProfile, list[SampledFace]]:
    """The profile of a body without cuts, in the file's unit, and the faces not of revolution.

    These faces are in the axes of the profile.
    inside: tags of plane faces that reach the axis. size: size of the body.

    Raises: NotTurnedError where the faces of revolution form no profile.
    """
    frame = axis.frame()
    local = [_in_frame(face, axis.point, frame) for face in faces]
    upright = Axis(np.zeros(3), np.array([0.0, 0.0, 1.0]))
    sides, rest = [], []
    for face in local:
        if not face.revolved(upright, size):
            rest.append(face)
            continue
        side = MeridianSide.of(face, face.tag in inside, size)
        if side is None:
            raise _not_turned(
                file, f"{face.name} is neither plane, cylinder, cone, torus nor sphere"
            )
        sides.append(side)
    sides += [corner_side(prism) for prism in prisms(rest, near(size))]
    try:
        outside, bore = outlines(sides, FACE_TOLERANCE * size)
    except ValueError as error:
        raise _not_turned(file, str(error)) from None
    start = min(bend.z for bend in outside)
    down = np.array([0.0, 0.0, start])
    digits = _digits(size)
    profile = RecognisedProfile(
        tuple(_rounded(bend, start, digits) for bend in outside),
        tuple(_rounded(bend, start, digits) for bend in bore),
        (),
        round(start, digits) + 0.0,  # never -0
        _plain(frame[2]),
        _plain(frame[0]),
        _surfaces(sides, start, size),
    )
    return profile, [_in_frame(face, down, np.eye(3)) for face in rest]


def _digits(size: float) -> int:
    """The number of decimals to which dimensions are rounded. size: size of the body."""
    return DIMENSION_DIGITS - math.floor(math.log10(size))


def _in_frame(face: SampledFace, origin: Floats, frame: Floats) -> SampledFace:
    """A face in a frame at an origin (3,), with unit vectors as rows (3, 3)."""
    return replace(
        face,
        points=(face.points - origin) @ frame.T,
        normals=face.normals @ frame.T,
        rim=(face.rim - origin) @ frame.T,
    )


def _plain(vector: Floats) -> tuple[float, float, float]:
    """A vector as numbers, rounded to 12 decimals."""
    x, y, z = (round(float(v), 12) + 0.0 for v in vector)
    return x, y, z


def _rounded(bend: Bend, start: float, digits: int) -> Bend:
    """A corner with z from the start face, rounded to `digits` decimals."""
    z, r, radius = (round(x, digits) for x in (bend.z - start, bend.r, bend.radius))
    return Bend(z, r, radius)


def _cuts(
    file: BodyFile, rest: Sequence[SampledFace], shaft: RecognisedProfile, size: float
) -> tuple[Cut, ...]:
    """The cuts to which the faces not of revolution belong, in the file's unit.

    Raises: NotTurnedError where a face belongs to no known cut.
    """
    try:
        cuts = CutFaces(rest, size).cuts(shaft.pin(file.name))
    except ValueError as error:
        if isinstance(error, GeometryError):
            raise _not_turned(file, str(error)) from None
        why = f"{error} is neither of revolution nor of a hole, flat, slot or passage"
        raise _not_turned(file, why) from None
    if (flats := sum(isinstance(cut, Flat) for cut in cuts)) > MAX_FLATS:
        raise _not_turned(file, f"it has {flats} plane faces along its axis")
    return cuts


def _with_recesses(
    file: BodyFile, shaft: RecognisedProfile, axis: Axis, size: float, error: NotTurnedError
) -> tuple[Cut, ...]:
    """The cuts and recesses of a body, in the file's unit, from each removed solid on its own.

    error: the reason why its faces are not those of known cuts.

    Raises: NotTurnedError where this fails, too.
    """
    try:
        pin = shaft.pin(file.name)
        with gmsh_model(f"{file.name}, {file.path.name}") as gmsh:
            (body,) = solids_of(gmsh, file)
            frame, start = axis.frame(), axis.point + shaft.start * axis.along
            gmsh.model.occ.translate([body], *(-start).tolist())
            turn = Rotation.from_matrix(frame).as_rotvec()
            angle = float(np.linalg.norm(turn))
            if angle:
                gmsh.model.occ.rotate([body], 0, 0, 0, *turn.tolist(), angle)
            gmsh.model.occ.synchronize()
            removed = removed_solids(gmsh, body, pin)
        cuts = tuple(cut for one in removed for cut in one.cuts(pin, size))
        assert CutPin(pin, cuts).volume > 0.0
    except GeometryError as other:
        why = str(other) if other.code == "stands-out" else error.why
        raise _not_turned(file, why) from None
    except MeshError:
        raise error from None
    return cuts


def _surfaces(
    sides: Sequence[MeridianSide], start: float, size: float
) -> dict[str, tuple[float, float]]:
    """Two z, from the start face, of each cylinder whose faces all have one name, by this name."""
    names: dict[tuple[int, ...], set[str]] = {}
    ends: dict[tuple[int, ...], tuple[float, float]] = {}
    for side in (side for side in sides if side.cylinder):
        z0, z1 = sorted((side.start[1], side.end[1]))
        key = tuple(round(x / (10.0 * FACE_TOLERANCE * size)) for x in (side.start[0], z0, z1))
        names.setdefault(key, set()).add(side.name)
        ends[key] = z0 - start, z1 - start
    return {name: ends[key] for key, (name, *others) in names.items() if not others}


def _require_volume(file: BodyFile, profile: RecognisedProfile, volume: float) -> None:
    """Raise NotTurnedError unless the recognised body has the volume (m^3) of the file's body."""
    try:
        pin = profile.pin(file.name)
        recognised = pin.volume
        if profile.cuts:
            recognised = CutPin(pin, profile.cuts).volume
    except (GeometryError, MeshError) as error:
        raise _not_turned(file, f"as a profile with cuts it is impossible ({error})") from None
    if abs(recognised / volume - 1.0) > VOLUME_TOLERANCE:
        raise _not_turned(
            file,
            f"a profile of its faces of revolution has {recognised / volume:.6g} times its volume",
        )
