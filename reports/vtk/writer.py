"""Writer of meshes with data as VTU files, by VTK's own writer, and of XML files that
combine them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from shutil import copyfileobj
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import Floats

VTK_CELL_TYPES = {
    **{"vertex": 1, "triangle": 5, "quad": 9, "tetra": 10, "wedge": 13},
    **{"triangle6": 22, "tetra10": 24, "wedge15": 26, "hexahedron20": 25},
}
Data = Mapping[str, "NDArray[Any] | Sequence[str]"]  # numbers, or texts


@dataclass(frozen=True)
class Block:
    """A mesh with data by name.

    points: (N, 3). cells: (M, k).
    whole: data of the whole block.
    more: cells of other types, by type.
    """

    points: Floats
    cells: NDArray[np.int64]
    cell_type: str
    point_data: Data = field(default_factory=dict)
    cell_data: Data = field(default_factory=dict)
    whole: Data = field(default_factory=dict)
    more: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)


def write_block(block: Block, path: Path) -> None:
    """Write a VTU file.

    Raises: OSError.
    """
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid(block))
    writer.SetWriteToOutputString(True)  # VTK itself would crash if the disk is full
    writer.SetDataModeToBinary()  # appended raw data is a quarter smaller; meshio cannot read it
    writer.SetHeaderTypeToUInt64()
    writer.SetCompressorTypeToZLib()
    writer.SetCompressionLevel(1)
    writer.Write()
    path.write_text(writer.GetOutputString(), encoding="utf-8", newline="\n")


def grid(block: Block) -> Any:
    """Return the block as a vtkUnstructuredGrid."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid

    vtk_grid, points, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(_numbers(block.points), deep=True))
    vtk_grid.SetPoints(points)
    parts = {block.cell_type: block.cells, **block.more}
    widths = np.concatenate([np.full(len(part), part.shape[1]) for part in parts.values()])
    ends = np.concatenate([[0], np.cumsum(widths)]).astype(np.int32)
    nodes = np.concatenate([part.ravel() for part in parts.values()]).astype(np.int32)
    cells.SetData(numpy_to_vtk(ends, deep=True), numpy_to_vtk(nodes, deep=True))
    types = np.repeat([VTK_CELL_TYPES[kind] for kind in parts], [len(x) for x in parts.values()])
    vtk_grid.SetCells(numpy_to_vtk(types.astype(np.uint8), deep=True), cells)
    for place, data in (
        (vtk_grid.GetPointData(), block.point_data),
        (vtk_grid.GetCellData(), block.cell_data),
        (vtk_grid.GetFieldData(), block.whole),
    ):
        for name, values in data.items():
            place.AddArray(_array(name, values, seven=data is not block.whole))
    return vtk_grid


def _array(name: str, values: NDArray[Any] | Sequence[str], seven: bool) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkStringArray

    if isinstance(values, np.ndarray):
        array = numpy_to_vtk(_numbers(values) if seven else values, deep=True)
    else:
        array = vtkStringArray()
        for text in values:
            array.InsertNextValue(text)
    array.SetName(name)
    return array


def _numbers(values: NDArray[Any]) -> NDArray[Any]:
    kind = np.float32 if values.dtype == np.float64 else None
    return np.ascontiguousarray(values, dtype=kind)


def add_field_data(path: Path, data: Mapping[str, NDArray[np.float64]]) -> None:
    """Add numbers as field data of the whole to a VTU or VTM file of this module.

    Raises: OSError.
    """
    arrays = "".join(
        f'<DataArray type="Float64" Name={quoteattr(name)} NumberOfTuples="{len(values)}" '
        f'format="ascii">{" ".join(map(repr, values.tolist()))}</DataArray>\n'
        for name, values in data.items()
    )
    whole = f"<FieldData>\n{arrays}</FieldData>\n"
    extended = path.with_name(path.name + ".extended")
    with (
        path.open(encoding="utf-8") as old,
        extended.open("w", encoding="utf-8", newline="\n") as new,
    ):
        for line in old:
            match line.strip():
                case "<FieldData>":
                    new.write(line + arrays)
                    break
                case "</VTKFile>":  # of a VTM file
                    new.write(whole + line)
                    break
                case text if text.startswith("<Piece "):
                    new.write(whole + line)
                    break
            new.write(line)
        copyfileobj(old, new)
    extended.replace(path)


def write_multiblock(blocks: Mapping[str, str], path: Path) -> None:
    """Write a VTM file. blocks: files in the same folder, by name."""
    lines = [
        f"    <DataSet index={quoteattr(str(i))} name={quoteattr(name)} file={quoteattr(file)}/>"
        for i, (name, file) in enumerate(blocks.items())
    ]
    _xml("vtkMultiBlockDataSet", lines, path)


def write_series(parts: Sequence[tuple[float, str, str]], path: Path) -> None:
    """Write a PVD file. parts: time, name and file (in the same folder) of each."""
    names = list(dict.fromkeys(name for _, name, _ in parts))
    lines = [
        f"    <DataSet timestep={quoteattr(repr(time))} part={quoteattr(str(names.index(name)))} "
        f"name={quoteattr(name)} file={quoteattr(file)}/>"
        for time, name, file in parts
    ]
    _xml("Collection", lines, path)


def _xml(kind: str, lines: Sequence[str], path: Path) -> None:
    text = [
        '<?xml version="1.0"?>',
        f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian">',
        f"  <{kind}>",
        *lines,
        f"  </{kind}>",
        "</VTKFile>",
    ]
    path.write_text("\n".join(text) + "\n", encoding="utf-8", newline="\n")
