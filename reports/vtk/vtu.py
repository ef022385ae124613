"""Reader of VTU files that reports.vtk.writer wrote, and of no others.

VTK's own reader trusts files, and crashes on offsets beyond their end.
"""

from __future__ import annotations

import math
import zlib
from base64 import b64decode
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import Floats
from pinbase.errors import Damaged
from reports.vtk.writer import VTK_CELL_TYPES

NODES_PER_CELL = {
    **{"vertex": 1, "triangle": 3, "quad": 4, "tetra": 4, "wedge": 6},
    **{"triangle6": 6, "tetra10": 10, "wedge15": 15, "hexahedron20": 20},
}
VTK_NUMBER_TYPES = {
    "Float32": "<f4",
    "Float64": "<f8",
    "Int32": "<i4",
    "Int64": "<i8",
    "UInt8": "<u1",
}
MAX_COUNT = 20_000_000  # points or cells
MAX_COMPONENTS = 9
HEADER_TYPE = np.dtype("<u8")
FILE_ATTRIBUTES = {
    "type": "UnstructuredGrid",
    "byte_order": "LittleEndian",
    "header_type": "UInt64",
    "compressor": "vtkZLibDataCompressor",
}
VTU_SECTIONS = "Points", "Cells", "PointData"


@dataclass(frozen=True)
class Vtu:
    """A mesh with cells of one type and data at its points.

    points: (N, 3). cells: (M, k), indices of points. data: (N,) or (N, c) by name.
    """

    points: Floats
    cells: NDArray[np.int64]
    cell_type: str
    data: Mapping[str, Floats]


def read_vtu(content: bytes, name: str) -> Vtu:
    """Return the mesh and the data at its points.

    Raises: Damaged.
    """
    try:
        reader = _Reader().read(content)
        points, cells = reader.count("NumberOfPoints"), reader.count("NumberOfCells")
        placed = reader.array("Points", None, points)
        data = {key: reader.array("PointData", key, points) for key in reader.names("PointData")}
        cell_type, nodes = _cells(reader, cells, points)
    except (expat.ExpatError, ValueError, zlib.error) as error:
        raise Damaged(f"{name} is damaged: {error}") from None
    if placed.shape != (points, 3) or not points:
        raise Damaged(f"{name} is damaged: its points have no three coordinates each")
    return Vtu(placed.astype(float), nodes, cell_type, data)


def _cells(reader: _Reader, count: int, points: int) -> tuple[str, NDArray[np.int64]]:
    kinds = reader.array("Cells", "types", count)
    names = [name for name, number in VTK_CELL_TYPES.items() if count and (kinds == number).all()]
    if not names:
        raise ValueError("its cells are not of one type that pinstress writes")
    width = NODES_PER_CELL[names[0]]
    ends = reader.array("Cells", "offsets", count)
    if not np.array_equal(ends, width * np.arange(1, count + 1)):
        raise ValueError(f"its cells have not {width} nodes each")
    nodes = reader.array("Cells", "connectivity", count * width).astype(np.int64)
    if nodes.min() < 0 or nodes.max() >= points:
        worst = nodes.min() if nodes.min() < 0 else nodes.max()
        raise ValueError(f"a cell has the node {worst:,} of {points:,}, counted from 0")
    return names[0], nodes.reshape(count, width)


class _Reader:
    """The parts of the file that are used: the attributes of the piece, and arrays with
    their text.
    """

    def __init__(self) -> None:
        self._piece: dict[str, str] | None = None
        self._arrays: dict[str, list[tuple[dict[str, str], list[str]]]] = {
            p: [] for p in VTU_SECTIONS
        }
        self._path: list[str] = []

    def read(self, content: bytes) -> _Reader:
        parser = expat.ParserCreate()
        parser.buffer_text = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = lambda _: self._path.pop()
        parser.CharacterDataHandler = self._text
        parser.StartDoctypeDeclHandler = self._doctype
        parser.Parse(content, True)
        if self._piece is None:
            raise ValueError("it has no piece of a mesh")
        return self

    def names(self, part: str) -> list[str]:
        return [attributes.get("Name", "") for attributes, _ in self._arrays[part]]

    def count(self, name: str) -> int:
        assert self._piece is not None
        text = self._piece.get(name, "")
        if not (text.isascii() and text.isdecimal() and len(text) < 10 and int(text) <= MAX_COUNT):
            raise ValueError(f"{name} is {text[:20]!r}, not a number of up to {MAX_COUNT:,}")
        return int(text)

    def array(self, part: str, name: str | None, count: int) -> NDArray[Any]:
        """Return an array of a section by its name, (count,) or (count, components).

        name: None for the first array.
        Raises: ValueError if there is none.
        """
        for attributes, texts in self._arrays[part]:
            if name is None or attributes.get("Name") == name:
                return _decoded(attributes, "".join(texts), count)
        raise ValueError(f"it has no array {name or part!r}")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self._path.append(name)
        if len(self._path) == 1:
            self._require_ours(name, attributes)
        elif name == "Piece":
            if self._piece is not None:
                raise ValueError("it has more than one piece")
            self._piece = attributes
        elif name == "DataArray" and self._path[-2] in VTU_SECTIONS:
            self._arrays[self._path[-2]].append((attributes, []))

    def _require_ours(self, name: str, attributes: dict[str, str]) -> None:
        for key, value in FILE_ATTRIBUTES.items():
            if name != "VTKFile" or attributes.get(key) != value:
                raise ValueError(f"it is no VTU file as pinstress writes them ({key}: {value})")

    def _text(self, text: str) -> None:
        if self._path[-1] == "DataArray" and self._path[-2] in VTU_SECTIONS:
            self._arrays[self._path[-2]][-1][1].append(text)

    def _doctype(self, *_: object) -> None:
        raise ValueError("it declares a document type, as pinstress does not")


def _decoded(attributes: Mapping[str, str], text: str, count: int) -> NDArray[Any]:
    shown = attributes.get("Name", "")[:60]
    kind, many = attributes.get("type", ""), attributes.get("NumberOfComponents", "1")
    if kind not in VTK_NUMBER_TYPES or attributes.get("format") != "binary":
        raise ValueError(f"array {shown!r} is not of numbers as pinstress writes them")
    if not (many.isascii() and many.isdecimal() and 0 < int(many[:3]) <= MAX_COMPONENTS):
        raise ValueError(f"array {shown!r} has {many[:20]!r} components")
    dtype, width = np.dtype(VTK_NUMBER_TYPES[kind]), int(many)
    content = _unpacked(text.strip(), count * width * dtype.itemsize, shown)
    values = np.frombuffer(content, dtype)
    return values if width == 1 else values.reshape(count, width)


def _unpacked(text: str, size: int, shown: str) -> bytes:
    """Return the blocks that zlib compressed, `size` bytes in total.

    A header with the sizes precedes the blocks; in base64 header and blocks are encoded separately.
    Raises: ValueError if the sizes do not match.
    """
    most = f"array {shown!r} is not {size:,} bytes long"
    blocks, block, last = _integers(text[: _coded(3)], 3, shown)
    whole = blocks if last == 0 else blocks - 1
    if blocks > size or block > size + HEADER_TYPE.itemsize * 2**20 or whole * block + last != size:
        raise ValueError(most)
    lengths = _integers(text[: _coded(3 + blocks)], 3 + blocks, shown)[3:]
    packed = b64decode(text[_coded(3 + blocks) :], validate=True)
    if sum(lengths) != len(packed):
        raise ValueError(f"array {shown!r} ends too early")
    parts, at = [], 0
    for k, length in enumerate(lengths):
        unpack, expected = zlib.decompressobj(), block if k < whole else last
        parts.append(unpack.decompress(packed[at : at + length], expected + 1))
        if len(parts[-1]) != expected or not unpack.eof:
            raise ValueError(most)
        at += length
    return b"".join(parts)


def _coded(numbers: int) -> int:
    """Return the number of base64 characters of a header of `numbers` integers."""
    return 4 * math.ceil(numbers * HEADER_TYPE.itemsize / 3)


def _integers(text: str, count: int, shown: str) -> list[int]:
    content = b64decode(text, validate=True)
    if len(content) != count * HEADER_TYPE.itemsize:
        raise ValueError(f"array {shown!r} has no header")
    return [int(x) for x in np.frombuffer(content, HEADER_TYPE)]
