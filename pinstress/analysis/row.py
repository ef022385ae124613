"""A row of the results of `pinstress.run`, and pictures, as notebooks show them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from reports.data.results import Results
from reports.data.row import PinResult
from reports.text.pin_sentence import pin_sentence

if TYPE_CHECKING:
    import os

    import pyvista


class Png:
    """A PNG that notebooks show."""

    def __init__(self, png: bytes) -> None:
        self.png = png

    def _repr_png_(self) -> bytes:
        return self.png

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the picture into a file; return its path."""
        Path(path).write_bytes(self.png)
        return Path(path)


class Svg:
    """An SVG that notebooks show."""

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the drawing into a file; return its path."""
        Path(path).write_text(self.svg, encoding="utf-8", newline="\n")
        return Path(path)


class Row(PinResult):
    """One pin in one case, as `results["E", "landing"]` returns it; equal to the `PinResult`."""

    _results: Results
    _mesh: Callable[[str, str], pyvista.UnstructuredGrid]

    @classmethod
    def of(
        cls, row: PinResult, results: Results, mesh: Callable[[str, str], pyvista.UnstructuredGrid]
    ) -> Row:
        """Return the row of a run.

        results: the results to which it belongs. mesh: function that returns the field of a pin in
        a case.
        """
        bound = cls(**{f.name: getattr(row, f.name) for f in fields(row)})
        object.__setattr__(bound, "_results", results)
        object.__setattr__(bound, "_mesh", mesh)
        return bound

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, PinResult):
            return NotImplemented
        compared = (f.name for f in fields(self) if f.compare)
        return all(getattr(self, name) == getattr(other, name) for name in compared)

    __hash__ = PinResult.__hash__

    def _repr_html_(self) -> str:
        sentence = pin_sentence(self, self.units)
        drawing = self.plot().svg if self.max_von_mises else ""
        return (
            f"<p><b>Pin {escape(self.pin)}, {escape(self.case)}: {escape(self.outcome)}</b></p>"
            f"<p>{escape(sentence)}</p>{drawing}"
        )

    def plot(self) -> Svg:
        """Return a drawing of the pin, with the stress along it if it has a profile.

        Raises: ValueError for a pin from a file, whose field `to_pyvista` returns.
        """
        from reports.page.row_drawing import draw_row

        drawing = draw_row(self._results, self)
        if not drawing:
            raise ValueError(f"pin {self.pin} has no profile to draw; to_pyvista has its field")
        return Svg(drawing)

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """Return the pin's mesh with its fields at the governing instant, with the contents of its
        VTU file.

        Raises: ValueError if the row has no field.
        """
        return self._mesh(self.pin, self.case)
