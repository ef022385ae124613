"""Pins from CAD files and meshes: what is found on them, and what must be refused."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

from fea.solid.assembly import Discretisation
from fea.solid.boundary import Patch, surface
from geometry import CutPin, GeometryError, Hole, Pin, Segment
from geometry.imported import cad_mesh as cad
from geometry.imported.body_file import BodyFile, Place
from geometry.imported.imported_pin import SolidBody
from geometry.imported.meshing import solid_mesh as any_mesh
from geometry.mesh.elements import with_element
from geometry.mesh.gmsh_session import gmsh_model, silence
from geometry.mesh.solid_mesh import MeshError, MeshSize, SolidMesh, solid_mesh
from geometry.mesh.tet10 import refined
from tests.support.each import each
from tests.support.errors import raises
from tests.support.pins.pin_files import MM, write_mesh, write_step

SHAFT = (Segment(20.0, 30.0), Segment(40.0, 20.0))
STEPPED = Pin("P", SHAFT, fillet=4.0)  # in mm
IN_METRES = Pin(
    "P",
    (Segment(0.02, 0.03), Segment(0.02, 0.02), Segment(0.02, 0.02, connection="B")),
    fillet=0.004,
)

BAND = Place("B", (0.04, 0.06))


def body(path: Path, *places: Place) -> SolidBody:
    return SolidBody(BodyFile("P", path, MM, places or (BAND,)))


@pytest.fixture(scope="module")
def step(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_step(STEPPED, tmp_path_factory.mktemp("step") / "pin.step")


def test_a_step_file_is_measured(step: Path) -> None:
    """Its band ends between two of the file's own edges, which splitting makes: 40 to 50 mm."""
    found = body(step, Place("B", (0.04, 0.05)), Place("root", (0.0, 0.01), connection=False))
    assert found.volume == pytest.approx(STEPPED.volume * 1e-9, rel=1e-9)
    assert found.length == pytest.approx(0.06)
    assert found.connections == ("B",)
    band = found.band("B")
    assert (band.z0, band.z1, band.middle) == (0.04, 0.05, 0.045)
    assert band.radius == pytest.approx(0.01, rel=1e-3)
    assert band.area == pytest.approx(2 * math.pi * 0.01 * 0.01, rel=1e-3)
    assert found.band("root").radius == pytest.approx(0.015, rel=1e-3)
    assert not found.revolved
    solid = found.mesh(MeshSize())
    space = Discretisation(solid.mesh)
    assert space.weights.sum() == pytest.approx(found.volume, rel=3e-4)
    z = space.nodes[surface(space).corners][
        np.isin(surface(space).facets, solid.mesh.boundaries["B"])
    ][..., 2]
    assert z.min() == pytest.approx(0.04)
    assert z.max() == pytest.approx(0.05)
    area = Patch(space, surface(space), "start").area
    assert area == pytest.approx(math.pi * 0.015**2, rel=1e-3)


def test_surfaces_of_a_step_file_have_its_names(step: Path, tmp_path: Path) -> None:
    """gmsh does not hand them on; the fourth face here is the fillet."""
    parts = step.read_text().split("ADVANCED_FACE('',")
    named = tmp_path / "named.stp"
    faces = ["start", "head", "shoulder", "neck", "shaft", "tip"]
    assert len(parts) == len(faces) + 1
    text = parts[0]
    for name, part in zip(faces, parts[1:], strict=True):
        text += f"ADVANCED_FACE('{name}',{part}"
    named.write_text(text)
    found = body(named, Place("B", (0.04, 0.05)), Place("neck", surface="neck", connection=False))
    band = found.band("neck")
    assert (band.z0, band.z1) == pytest.approx((0.02, 0.024))
    assert 0.01 < band.radius < 0.014
    assert set(found.mesh(MeshSize(across=3.0)).mesh.boundaries) == {*faces, "B", "end"}
    with raises(GeometryError, "unknown-surface", "'nack'", "head"):
        body(named, Place("B", surface="nack"))


def test_an_end_face_is_not_taken_for_the_side_of_splines_that_it_closes(tmp_path: Path) -> None:
    """Mirroring makes splines of all faces; the rim of an end face is on the side, too."""
    path = tmp_path / "mirrored.step"
    with gmsh_model("mirrored") as gmsh, silence():
        occ = gmsh.model.occ
        shank = occ.addCylinder(0.0, 0.0, 0.0, 0.0, 0.0, 80.0, 10.0)
        head = occ.addCylinder(0.0, 0.0, 80.0, 0.0, 0.0, 20.0, 14.0)
        occ.mirror(occ.fuse([(3, shank)], [(3, head)])[0], 1.0, 0.0, 0.0, 0.0)
        occ.synchronize()
        gmsh.write(str(path))
    places = [Place(f"face{k}", surface=f"face {k}", connection=False) for k in range(1, 6)]
    found = body(path, BAND, *places)
    areas = [2.0 * 14.0 * 20.0, 14.0**2, 14.0**2 - 10.0**2, 2.0 * 10.0 * 80.0, 10.0**2]
    for place, area in zip(places, areas, strict=True):
        assert found.band(place.name).area == pytest.approx(math.pi * area * 1e-6, rel=0.1)


@pytest.fixture(scope="module")
def solid() -> SolidMesh:
    return solid_mesh(IN_METRES, MeshSize(), (0.04, 0.06))


@pytest.mark.parametrize("ending", ["vtk", "msh", "inp"])
@pytest.mark.parametrize("linear", [False, True])
def test_a_mesh_is_taken_as_it_is(
    ending: str, linear: bool, solid: SolidMesh, tmp_path: Path
) -> None:
    """And halved: eight times the elements, the same volume. Straight sides cut 2 % off it."""
    path = write_mesh(solid, tmp_path / f"pin.{ending}", linear)
    found = body(path)
    assert found.meshed
    assert found.volume == pytest.approx(IN_METRES.volume, rel=2e-2 if linear else 3e-4)
    assert found.band("B").area == pytest.approx(
        IN_METRES.band("B").area, rel=2e-2 if linear else 1e-3
    )
    one, two = found.mesh(MeshSize()), found.mesh(MeshSize().finer(2.0))
    assert one.mesh.nelements == solid.mesh.nelements
    assert two.mesh.nelements == 8 * one.mesh.nelements
    assert len(two.mesh.boundaries["B"]) == 4 * len(one.mesh.boundaries["B"])
    volumes = [Discretisation(m.mesh).weights.sum() for m in (one, two)]
    assert volumes[1] == pytest.approx(volumes[0], rel=1e-5)


@pytest.mark.parametrize("pin", [IN_METRES, Pin("P", (Segment(0.06, 0.02, connection="B"),))])
def test_what_straight_sides_cut_off_is_told(pin: Pin, tmp_path: Path) -> None:
    """Within a quarter of it, beside the volume of the same mesh with curved sides."""
    curved = solid_mesh(pin, MeshSize())
    straight = replace(curved, mesh=with_element(curved.mesh, "straight"))
    whole, less = (
        body(write_mesh(m, tmp_path / f"{i}.msh")) for i, m in enumerate((curved, straight))
    )
    assert whole.cut_off == 0.0
    lost = 1.0 - less.volume / whole.volume
    assert lost > 0.01
    assert less.cut_off == pytest.approx(lost, rel=0.25)
    assert body(write_mesh(curved, tmp_path / "2.vtk", linear=True)).cut_off == pytest.approx(
        less.cut_off
    )


def test_a_box_has_no_round_surface(tmp_path: Path) -> None:
    with gmsh_model("box") as gmsh:
        gmsh.model.occ.addBox(-5, -5, 0, 10, 10, 30)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 3.0)
        gmsh.model.addPhysicalGroup(2, [6], name="top")
        gmsh.model.addPhysicalGroup(3, [1], name="box")
        gmsh.model.mesh.generate(3)
        gmsh.write(str(tmp_path / "box.msh"))
    assert body(tmp_path / "box.msh", Place("B", surface="top")).cut_off == 0.0


def test_refining_keeps_the_curved_shape() -> None:
    mesh = solid_mesh(IN_METRES, MeshSize(across=2.5)).mesh
    coarse, fine = Discretisation(mesh), Discretisation(refined(mesh))
    for name in mesh.boundaries:
        areas = [Patch(s, surface(s), name).area for s in (coarse, fine)]
        assert areas[1] == pytest.approx(areas[0], rel=1e-5)
    assert set(fine.mesh.boundary_facets()) == set(
        np.concatenate(list(fine.mesh.boundaries.values()))
    )


def test_surfaces_of_a_mesh_have_its_names(tmp_path: Path) -> None:
    """Physical groups of a .msh file, and sets of nodes."""
    path = tmp_path / "box.msh"
    with gmsh_model("box") as gmsh:
        gmsh.model.occ.addBox(-5, -5, 0, 10, 10, 30)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 3.0)
        for _, face in gmsh.model.getEntities(2):
            at = gmsh.model.occ.getCenterOfMass(2, face)
            gmsh.model.addPhysicalGroup(2, [face], name="top" if at[2] > 29 else f"side {face}")
        gmsh.model.addPhysicalGroup(3, [1], name="box")
        gmsh.model.mesh.generate(3)
        gmsh.write(str(path))
    found = body(path, Place("lid", surface="top"))
    assert found.band("lid").area == pytest.approx(1e-4)
    assert found.volume == pytest.approx(3e-6)
    mesh = meshio.read(path)
    nodes = np.flatnonzero(mesh.points[:, 2] < 1e-9)
    only = [(b.type, b.data) for b in mesh.cells if b.type == "tetra"]
    sets = tmp_path / "box.inp"
    meshio.write(sets, meshio.Mesh(mesh.points, only, point_sets={"foot": nodes}))
    assert body(sets, Place("B", surface="foot")).band("B").area == pytest.approx(1e-4)


def test_the_outermost_surface_is_without_holes(tmp_path: Path) -> None:
    """A tube with a cross hole: its band is the outside less the hole, not the bore."""
    pin = Pin("P", (Segment(0.06, 0.02, bore=0.01, connection="B"),))
    solid = solid_mesh(CutPin(pin, (Hole(0.03, 0.004),)), MeshSize())
    found = body(write_mesh(solid, tmp_path / "tube.vtk"), Place("B", (0.0, 0.06)))
    outside = np.sort(found.mesh(MeshSize()).mesh.boundaries["B"])
    assert len(outside) == len(solid.mesh.boundaries["B"])
    space = Discretisation(solid.mesh)
    assert found.band("B").area == pytest.approx(Patch(space, surface(space), "B").area, rel=1e-9)


def test_meshes_that_are_no_pin(tmp_path: Path) -> None:
    """Two bodies, nodes that are not there or nowhere, and junk of every ending."""
    whole = meshio.read(write_mesh(solid_mesh(IN_METRES, MeshSize(across=2.0)), tmp_path / "a.vtk"))
    points, cells, path = whole.points, whole.cells[0].data, tmp_path / "bad.vtk"

    def refuse(code: str, x: np.ndarray, t: np.ndarray) -> None:
        meshio.write(path, meshio.Mesh(x, [("tetra10", t)]))
        with raises(GeometryError, code, "bad.vtk"):
            body(path)

    two = np.concatenate([points, points + np.array([0.0, 0.0, 60.0])])
    refuse("several-pieces", two, np.concatenate([cells, cells + len(points)]))
    refuse("unknown-nodes", points, np.where(cells == 5, 10**6, cells))
    refuse("unknown-nodes", points, np.where(cells == 5, -3, cells))
    for wrong in (np.nan, np.inf, 1e308):
        refuse("bad-nodes", np.where(points > 59.0, wrong, points), cells)
    for ending in ("msh", "inp", "vtk", "vtu", "med", "bdf", "mesh", "xdmf", "doc"):
        for junk in (b"", b"\0" * 1000, bytes(range(256)) * 20, "Stöße\n".encode("latin-1") * 50):
            (tmp_path / f"junk.{ending}").write_bytes(junk)
            with pytest.raises(GeometryError) as error:
                body(tmp_path / f"junk.{ending}")
            assert error.value.code in ("unreadable-geometry", "no-volume")


def test_bad_files(tmp_path: Path, step: Path) -> None:
    def refuse(path: Path, code: str, *places: Place, named: str = "") -> None:
        with raises(GeometryError, code, path.name if not places else "band B", named):
            body(path, *places)

    refuse(tmp_path / "gone.step", "no-such-file")
    for ending in ("step", "msh", "vtk", "doc"):
        (tmp_path / f"text.{ending}").write_text("Dear pin,\n")
        refuse(tmp_path / f"text.{ending}", "unreadable-geometry")
    sheet = tmp_path / "sheet.step"
    with gmsh_model("sheet") as gmsh:
        gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.write(str(sheet))
    refuse(sheet, "no-volume")
    pair = tmp_path / "pair.step"
    with gmsh_model("pair") as gmsh:
        for x in (0, 5):
            gmsh.model.occ.addBox(x, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.write(str(pair))
    refuse(pair, "several-pieces", named="2 solids")
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    meshio.write(tmp_path / "s.stl", meshio.Mesh(square, [("triangle", [[0, 1, 2], [0, 2, 3]])]))
    refuse(tmp_path / "s.stl", "no-volume", named="triangle")
    cube = np.concatenate([square, square + np.array([0.0, 0.0, 1.0])])
    meshio.write(tmp_path / "h.vtk", meshio.Mesh(cube, [("hexahedron", [list(range(8))])]))
    refuse(tmp_path / "h.vtk", "no-volume", named="hexahedron")
    refuse(step, "band-not-found", Place("B", (0.07, 0.08)), named="from z = 0 to 60")
    refuse(step, "z-reversed", Place("B", (0.02, 0.01)))
    found = body(step)
    with raises(GeometryError, "unknown-surface", "'Q'"):
        found.surface("Q")
    with raises(GeometryError, "unknown-surface", "'Q'"):
        found.band("Q")


CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
TETRAHEDRON = ("tetra", [[0, 1, 2, 4]])


@each(
    ("cells", "error", "code"),
    [
        ([TETRAHEDRON, ("hexahedron", [[0, 1, 3, 2, 4, 5, 7, 6]])], GeometryError,
         "unsupported-elements"),
        ([TETRAHEDRON, ("tetra10", [[0, 1, 2, 4, 3, 5, 6, 7, 1, 2]])], GeometryError,
         "mixed-elements"),
        ([("tetra10", [[0, 3, 5, 6, 7, 4, 2, 1, 0, 3]])], MeshError,
         "inverted-elements"),
        ([("tetra", [[0, 1, 2, 4], [0, 1, 2, 7]])], MeshError,
         "overlapping-elements"),
    ],
)  # fmt: skip
def test_bad_meshes(
    cells: list[tuple[str, list[list[int]]]], error: type[Exception], code: str, tmp_path: Path
) -> None:
    path = tmp_path / "bad.vtk"
    meshio.write(path, meshio.Mesh(CUBE, cells))
    with raises(error, code, "pin P: bad.vtk: "):
        body(path, Place("B", (0.0, 1e-3)))


def test_a_mesh_of_other_elements_stands_on_the_files_vertices(tmp_path: Path) -> None:
    """From curved sides of the file to straight and to linear ones; 2 % of a cylinder is lost."""
    solid = solid_mesh(IN_METRES, MeshSize(across=3.0), (0.04, 0.06))
    found = body(write_mesh(solid, tmp_path / "pin.vtu"))
    volumes = {}
    for element in ("curved", "straight", "linear"):
        mesh = any_mesh(found, MeshSize(), element=element).mesh
        assert mesh.nvertices == solid.mesh.nvertices
        assert "B" in mesh.boundaries
        volumes[element] = Discretisation(mesh).weights.sum()
    assert volumes["curved"] == pytest.approx(IN_METRES.volume, rel=2e-3)
    assert volumes["straight"] == pytest.approx(volumes["linear"], rel=1e-9)
    assert volumes["linear"] < 0.99 * volumes["curved"]


def test_a_file_that_gives_slivers_is_tried_thrice(
    step: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Finer each time, until its elements are good; or told, with how bad they were."""
    file = BodyFile("P", step, MM, (BAND,))
    tried: list[float] = []
    found = iter([0.05, 0.5])

    def meshed(_: BodyFile, size: MeshSize, most: float) -> SolidMesh:
        tried.append(size.across / MeshSize().across)
        return SolidMesh(solid_mesh(IN_METRES, MeshSize(across=2.0)).mesh, next(found), 0)

    monkeypatch.setattr(cad, "_mesh", meshed)
    assert cad.cad_mesh(file, MeshSize()).jacobian == 0.5
    found = iter([-0.3, 0.02, 0.05])
    with raises(MeshError, "bad-elements", "-0.3, 0.02, 0.05"):
        cad.cad_mesh(file, MeshSize())
    assert tried == pytest.approx([1.0, 1.15, 1.0, 1.15, 1.35])


def test_what_gmsh_cannot_mesh_is_told(step: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """gmsh's bare exceptions become ours; a mistake of our own stays what it is."""
    file = BodyFile("P", step, MM, (BAND,))

    def fails(error: Exception) -> None:
        def repair(_: object) -> None:
            raise error

        monkeypatch.setattr(cad, "repair", repair)
        cad.cad_mesh(file, MeshSize(across=2.0))

    with raises(MeshError, "gmsh-failed", "pin.step", "no luck"):
        fails(Exception("no luck"))
    with pytest.raises(KeyError):
        fails(KeyError("ours"))
