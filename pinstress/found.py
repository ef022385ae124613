"""What `pinstress.run` returns: the results that the command writes, with what a notebook wants."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

from pinstress.pipeline import prepare, results_of
from pinstress.solving import solve_tasks
from pinstress.study import Study
from reports.all_tables import load_tables, stress_tables
from reports.html_table import safety_factors_html
from reports.results import Field, Results
from reports.summary import summary
from reports.table import Table

if TYPE_CHECKING:
    import pandas
    import polars
    import pyvista


class Picture:
    """A PNG that notebooks show."""

    def __init__(self, png: bytes) -> None:
        self.png = png

    def _repr_png_(self) -> bytes:
        return self.png


@dataclasses.dataclass(frozen=True, repr=False)
class Found(Results):
    """Results with tables, frames, and, where they were kept, fields by pin and case."""

    fields: Mapping[tuple[str, str], Field] = dataclasses.field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<{self.title}: {summary(self)}>"

    def _repr_html_(self) -> str:
        return safety_factors_html(self)

    @property
    def tables(self) -> dict[str, Table]:
        """All tables of the run by name: columns, and rows with every digit."""
        return {t.name: t for t in (*stress_tables(self), *load_tables(self))}

    def to_pandas(self, table: str = "safety_factors") -> pandas.DataFrame:
        """A table as a pandas frame. Raises: ImportError without pandas, ValueError."""
        found, library = self._table(table), _library("pandas")
        frame: pandas.DataFrame = library.DataFrame(list(found.rows), columns=list(found.columns))
        return frame

    def to_polars(self, table: str = "safety_factors") -> polars.DataFrame:
        """A table as a polars frame. Raises: ImportError without polars, ValueError."""
        found, library = self._table(table), _library("polars")
        rows, columns = [list(row) for row in found.rows], list(found.columns)
        frame: polars.DataFrame = library.DataFrame(
            rows, schema=columns, orient="row", infer_schema_length=None
        )
        return frame

    def mesh(self, pin: str, case: str) -> pyvista.UnstructuredGrid:
        """A pin's mesh with its fields at the governing instant, as its VTU file has them.

        Raises: ValueError when the run kept no such field.
        """
        import pyvista

        from reports.vtk import block
        from reports.vtk_file import grid

        content = block(self._field(pin, case), self.units)
        made: pyvista.UnstructuredGrid = pyvista.wrap(grid(content))
        return made

    def picture(self, pin: str, case: str) -> Picture:
        """A pin coloured by its von Mises stress.

        Raises: ValueError as `mesh`, RuntimeError where nothing can be drawn.
        """
        import tempfile
        from pathlib import Path

        from reports.picture import render_pin
        from reports.renderer import renderer_problem

        field = self._field(pin, case)
        problem = renderer_problem()
        if problem is not None:
            raise RuntimeError(f"no picture of pin {pin}: {problem}")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "pin.png"
            render_pin(field, path, self.units, f"pin {pin}, {case} ({field.verdict})")
            return Picture(path.read_bytes())

    def _table(self, name: str) -> Table:
        tables = self.tables
        if name not in tables:
            raise ValueError(f"this run has no table {name!r}; there are {', '.join(tables)}")
        return tables[name]

    def _field(self, pin: str, case: str) -> Field:
        if not self.fields:
            raise ValueError("this run kept no fields: pinstress.run(study, fields=True) does")
        if (pin, case) not in self.fields:
            there = ", ".join(f"{p} in {c}" for p, c in self.fields)
            raise ValueError(f"no field of pin {pin} in {case}; there are {there}")
        return self.fields[pin, case]


def _library(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError:
        raise ImportError(
            f"to_{name} needs {name}, which is not installed: pip install {name}", name=name
        ) from None


def run(study: Study, *, fields: bool = False, jobs: int = 1, **chosen: Any) -> Found:
    """Analyse a study.

    fields: whether to keep every pin's field, for `mesh` and `picture` (some 10 MB each). chosen:
    pins, cases (names; all by default), model, tolerance (instead of the study's). jobs: pins at a
    time, each in a process of its own; 1, in this process, where fields are kept. A pin whose
    numerics fail has the verdict `failed`.

    Raises: InputError for bad input.
    """
    kept: dict[tuple[str, str], Field] = {}

    def keep(field: Field) -> None:
        if fields:
            kept[field.pin, field.case] = field

    plan = prepare(study, **chosen)
    results = results_of(plan, solve_tasks(plan, keep, jobs=1 if fields else jobs))
    plain = {f.name: getattr(results, f.name) for f in dataclasses.fields(Results)}
    return Found(**plain, fields=kept)
