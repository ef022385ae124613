"""Fields on meshes as VTU files for ParaView, with loads and bands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assess.plastic.records import FlowField
from reports.data.fields import BandLoad, Field, Volume
from reports.data.row import Units
from reports.vtk.writer import Block, write_block, write_multiblock, write_series

# Order of our components xx, yy, zz, yz, xz, xy in VTK's symmetric tensors XX YY ZZ XY YZ XZ.
VTK_TENSOR_ORDER = (0, 1, 2, 5, 3, 4)
TETRAHEDRON_FACES = {  # local nodes: corners, then the midpoints of the edges
    "tetra10": ((0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (0, 3, 2, 7, 9, 6)),
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
}
QUADS_AROUND_BAND = 60

Arrays = dict[str, NDArray[Any]]


def point_data(field: Field, units: Units) -> Arrays:
    """Return the arrays at the nodes, under names with units.

    They are: displacement (N, 3); stress (N, 6: XX, YY, ZZ, XY, YZ, XZ, ParaView's components of a
    symmetric tensor); von Mises (N,); von Mises envelope (N,; NaN inside and where a lug always
    presses); with a yield strength the safety factor by the envelope; and for a pin in lugs the
    mean pressure of each contact cell and whether the node is pressed (0 or 1).
    """
    stress = units.stress
    data: Arrays = {
        f"displacement [{units.length}]": field.displacement,
        f"stress [{stress}]": field.stress[:, VTK_TENSOR_ORDER],
        f"von Mises [{stress}]": field.von_mises,
        f"von Mises envelope [{stress}]": field.envelope,
    }
    if field.yield_strength is not None:
        lowest = np.finfo(np.float32).tiny * field.yield_strength  # keeps the factor finite
        data["factor of safety"] = field.yield_strength / np.maximum(field.envelope, lowest)
    if field.contact_pressure is not None:
        data[f"cell mean pressure [{stress}]"] = field.contact_pressure
    return data | _pressed(field.pressed)


def _pressed(pressed: NDArray[np.bool_] | None) -> Arrays:
    return {} if pressed is None else {"pressed": pressed.astype(np.uint8)}


def write_vtu(field: Field, path: Path, units: Units) -> None:
    """Write a VTU file with results at the nodes, and its time."""
    write_block(block(field, units), path)


def block(field: Field, units: Units) -> Block:
    """Return the part of a field that its own VTU file contains."""
    # VTK reads the time of a file from "TimeValue".
    whole: Arrays = {} if field.time is None else {"TimeValue": np.array([field.time])}
    if field.beneath is not None:
        stress, place = field.beneath
        whole[f"beneath [{units.stress}]"] = np.array([stress])
        whole[f"beneath at [{units.length}]"] = np.array([place])
    return Block(field.points, field.cells, field.cell_type, point_data(field, units), whole=whole)


def write_pin(field: Field, name: str, directory: Path, units: Units) -> None:
    """Write NAME.vtu, and NAME.vtm, which adds loads, bands, volume and local solids (NAME/*.vtu).

    Without loads only NAME.vtu is written. With stills, NAME.pvd contains the pin, loads and bands
    along the motion.
    """
    write_vtu(field, directory / f"{name}.vtu", units)
    if not field.loads:
        return
    folder = directory / name
    folder.mkdir()
    # Texts are here and not in the field's own file, because meshio reads no file with texts.
    texts = {"pin": [field.pin], "case": [field.case], "verdict": [field.verdict]}
    write_block(replace(_loads(field.loads, units), whole=texts), folder / "loads.vtu")
    write_block(_bands(field.loads, units), folder / "bands.vtu")
    kinds = ["loads", "bands"]
    if field.volume is not None:
        write_block(_volume(field.volume, units), folder / "solid.vtu")
        kinds.append("solid")
    if field.solids:
        write_vtu(local_solids(field), folder / "local.vtu", units)
        kinds.append("local")
    blocks = {kind: f"{name}/{kind}.vtu" for kind in kinds}
    write_multiblock({"pin": f"{name}.vtu", **blocks}, directory / f"{name}.vtm")
    if field.stills:
        parts = _write_stills(surface(field), folder, units)
        write_series(
            [(time, kind, f"{name}/{file}") for time, kind, file in parts],
            directory / f"{name}.pvd",
        )


def write_flow(flow: FlowField, path: Path, units: Units) -> None:
    """Write the plastic flow of a pin at its limit load as a VTU file."""
    data = {
        f"displacement [{units.length}]": flow.displacement,
        "equivalent plastic strain": flow.plastic_strain,
        f"von Mises [{units.stress}]": flow.von_mises,
    }
    whole = {"load factor": np.array([flow.factor])}
    write_block(Block(flow.points, flow.cells, "hexahedron20", data, whole=whole), path)


def _volume(volume: Volume, units: Units) -> Block:
    data: Arrays = {
        f"displacement [{units.length}]": volume.displacement,
        f"stress [{units.stress}]": volume.stress[:, VTK_TENSOR_ORDER],
        f"von Mises [{units.stress}]": volume.von_mises,
    }
    data |= _pressed(volume.pressed)
    return Block(volume.points, volume.cells, volume.cell_type, data, more=volume.more)


def _write_stills(field: Field, directory: Path, units: Units) -> list[tuple[float, str, str]]:
    parts: list[tuple[float, str, str]] = []
    for i, still in enumerate(field.stills):
        data: Arrays = {
            f"displacement [{units.length}]": still.displacement,
            f"von Mises [{units.stress}]": still.von_mises,
        }
        data |= _pressed(still.pressed)
        pin, loads = f"pin_{i:03d}.vtu", f"loads_{i:03d}.vtu"
        write_block(Block(field.points, field.cells, field.cell_type, data), directory / pin)
        write_block(_loads(still.loads, units), directory / loads)
        files = (("pin", pin), ("loads", loads), ("bands", "bands.vtu"))
        parts += [(still.time, kind, file) for kind, file in files]
    return parts


def _loads(loads: Sequence[BandLoad], units: Units) -> Block:
    """Return a point at the middle of every band with the force and moment that act there."""
    return Block(
        np.array([load.middle for load in loads]),
        np.arange(len(loads))[:, None],
        "vertex",
        {
            f"force [{units.force}]": np.array([load.force for load in loads]),
            f"moment [{units.force} {units.length}]": np.array([load.moment for load in loads]),
            "held": np.array([load.held for load in loads], dtype=np.int8),
            "connection": [load.connection for load in loads],
        },
    )


def _bands(loads: Sequence[BandLoad], units: Units) -> Block:
    """Return a cylinder for every band, each cell with its name and load."""
    angle = 2.0 * np.pi * np.arange(QUADS_AROUND_BAND) / QUADS_AROUND_BAND
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(QUADS_AROUND_BAND)], axis=1)
    points = [load.radius * circle + np.array([0.0, 0.0, z]) for load in loads for z in load.z]
    j = np.arange(QUADS_AROUND_BAND)
    k = (j + 1) % QUADS_AROUND_BAND
    ring = np.stack([j, k, k + QUADS_AROUND_BAND, j + QUADS_AROUND_BAND], axis=1)
    cells = [ring + 2 * QUADS_AROUND_BAND * i for i in range(len(loads))]
    cell_loads = [load for load in loads for _ in range(QUADS_AROUND_BAND)]
    return Block(
        np.concatenate(points),
        np.concatenate(cells),
        "quad",
        cell_data={
            f"force [{units.force}]": np.array([load.force for load in cell_loads]),
            "held": np.array([load.held for load in cell_loads], dtype=np.int8),
            "connection": [load.connection for load in cell_loads],
        },
    )


def surface(field: Field) -> Field:
    """Return the outside of a solid: the faces that belong to one tetrahedron only, and their
    nodes.

    A field that is a surface already is returned unchanged.
    """
    if field.cell_type not in TETRAHEDRON_FACES:
        return field
    faces = np.concatenate(
        [field.cells[:, list(face)] for face in TETRAHEDRON_FACES[field.cell_type]]
    )
    _, first, count = np.unique(
        np.sort(faces[:, :3], axis=1), axis=0, return_index=True, return_counts=True
    )
    outer = faces[np.sort(first[count == 1])]
    return _part(field, outer, {6: "triangle6", 3: "triangle"}[outer.shape[1]])


def local_solids(field: Field) -> Field:
    """Return the part of the surface that was computed by local solids about cuts."""
    z = field.points[field.cells, 2]
    near = 1e-9 * float(np.ptp(field.points[:, 2]))
    ends = [(z >= low - near).all(axis=1) & (z <= high + near).all(axis=1)
            for low, high in field.solids]  # fmt: skip
    return _part(field, field.cells[np.any(ends, axis=0)], field.cell_type)


def _part(field: Field, cells: NDArray[np.int64], cell_type: str) -> Field:
    """Return a field with some of the cells, and their nodes."""
    nodes, numbers = np.unique(cells, return_inverse=True)

    def own(values: Any) -> Any:
        return None if values is None else values[nodes]

    return replace(
        field,
        points=field.points[nodes],
        cells=numbers.reshape(cells.shape),
        cell_type=cell_type,
        displacement=field.displacement[nodes],
        stress=field.stress[nodes],
        von_mises=field.von_mises[nodes],
        envelope=field.envelope[nodes],
        contact_pressure=own(field.contact_pressure),
        pressed=own(field.pressed),
        stills=tuple(
            replace(
                s,
                displacement=s.displacement[nodes],
                von_mises=s.von_mises[nodes],
                pressed=own(s.pressed),
            )
            for s in field.stills
        ),
    )
