"""Results of `pinstress.run`, which are also those that the command writes, with access from
notebooks.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from importlib import import_module
from typing import TYPE_CHECKING, Any

from fea.core.requirement import Model
from pinbase.memo import Memo
from pinbase.processes.pool import processes
from pinbase.processes.threads import one_thread
from pinstress.analysis.cache import OutcomeStore
from pinstress.analysis.gather.gather import results_of
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.row import Png, Row
from pinstress.analysis.solve import solve_tasks
from pinstress.analysis.stored import PinOutcome
from pinstress.study.reading.choices import require_count
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.extras import EXTRAS, require_fatigue
from pinstress.study.reading.file import Study
from pinstress.study.reading.inputs import inputs, require_unchanged
from pinstress.study.schema.shown import as_text
from reports.data.fields import Field
from reports.data.results import Results
from reports.format.words import headline
from reports.tables.all import load_tables, stress_tables
from reports.tables.column import Table
from reports.text.html import safety_factors_html

if TYPE_CHECKING:
    import pandas
    import polars
    import pyvista


@dataclasses.dataclass(frozen=True, repr=False)
class RunResults(Results):
    """Results in the study's units, with tables, frames, and fields by pin and case.

    fields: the fields that were kept.
    plan: the plan by which a pin without a kept field is solved again.
    """

    fields: dict[tuple[str, str], Field] = dataclasses.field(default_factory=dict)
    plan: Plan | None = None

    def __repr__(self) -> str:
        pins = len({row.pin for row in self.pins})
        counts = f"pins: {pins}, rows: {len(self.pins)}"
        return f"<{self.title}: {counts}. {headline(self)}".rstrip() + ">"

    def __getitem__(self, row: tuple[str, str]) -> Row:
        """Return the result of a pin in a case: results["E", "landing"].

        Raises: KeyError, which lists the existing pins and cases.
        """
        return Row.of(super().__getitem__(row), self, self.to_pyvista)

    def __len__(self) -> int:
        return len(self.pins)

    def __iter__(self) -> Iterator[Row]:
        """Iterate over all rows, a pin in a case each."""
        return (self[row.pin, row.case] for row in self.pins)

    def _repr_html_(self) -> str:
        return safety_factors_html(self)

    @property
    def tables(self) -> dict[str, Table[Any]]:
        """Return all tables of the run by name: columns, and rows with every digit."""
        return {t.name: t for t in (*stress_tables(self), *load_tables(self))}

    def frame(self, table: str = "safety_factors") -> pandas.DataFrame:
        """Return a table as a pandas frame, by default with a row for each pin and case.

        table: one of `tables`.

        Raises: ImportError without pandas, ValueError for an unknown table.
        """
        return self.to_pandas(table)

    def to_pandas(self, table: str = "safety_factors") -> pandas.DataFrame:
        """Return a table as a pandas frame.

        Raises: ImportError without pandas, ValueError for an unknown table.
        """
        content, library = self._table(table), _library("pandas")
        frame: pandas.DataFrame = library.DataFrame(list(content.cells()), columns=content.keys)
        return frame

    def to_polars(self, table: str = "safety_factors") -> polars.DataFrame:
        """Return a table as a polars frame.

        Raises: ImportError without polars, ValueError for an unknown table.
        """
        content, library = self._table(table), _library("polars")
        rows, columns = [list(row) for row in content.cells()], content.keys
        frame: polars.DataFrame = library.DataFrame(
            rows, schema=columns, orient="row", infer_schema_length=None
        )
        return frame

    def to_pyvista(self, pin: str, case: str) -> pyvista.UnstructuredGrid:
        """Return a pin's mesh with its fields at the governing instant, with the contents of its
        VTU file.

        Raises: ValueError if the pin has no field in the case.
        """
        import pyvista

        from reports.vtk.fields import block
        from reports.vtk.index import origin_data
        from reports.vtk.writer import grid

        content = block(self._field(pin, case), self.units)
        whole = {**content.whole, **origin_data(self, self[pin, case])}
        content = dataclasses.replace(content, whole=whole)
        mesh: pyvista.UnstructuredGrid = pyvista.wrap(grid(content))
        return mesh

    mesh = to_pyvista  # the earlier name

    def picture(self, pin: str, case: str) -> Png:
        """Return a picture of a pin coloured by its von Mises stress.

        Raises: ValueError as `to_pyvista`, RuntimeError if nothing can be drawn.
        """
        import tempfile
        from pathlib import Path

        from reports.vtk.render import render_pin
        from reports.vtk.renderer import renderer_problem

        field = self._field(pin, case)
        problem = renderer_problem()
        if problem is not None:
            raise RuntimeError(f"no picture of pin {pin}: {problem}")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "pin.png"
            render_pin(field, path, self.units, f"pin {pin}, {case} ({field.verdict})")
            return Png(path.read_bytes())

    def _table(self, name: str) -> Table[Any]:
        tables = self.tables
        if name not in tables:
            raise ValueError(f"this run has no table {name!r}; there are {', '.join(tables)}")
        return tables[name]

    def _field(self, pin: str, case: str) -> Field:
        if self.plan is not None and not any(row[0] == pin for row in self.fields):
            tasks = [task for task in self.plan.tasks if task.pin.name == pin]
            with one_thread():
                solve_tasks(dataclasses.replace(self.plan, tasks=tasks), self._keep)
        if (pin, case) not in self.fields:
            available = ", ".join(f"{p} in {c}" for p, c in self.fields) or "none"
            raise ValueError(f"no field of pin {pin} in {case}; there are {available}")
        return self.fields[pin, case]

    def _keep(self, field: Field) -> None:
        self.fields[field.pin, field.case] = field


def _library(name: str) -> Any:
    try:
        return import_module(name)
    except ImportError:
        extra = f", or the extra: pip install 'pinstress[{EXTRAS[name]}]'" if name in EXTRAS else ""
        raise ImportError(
            f"a frame needs {name}, which is not installed: pip install {name}{extra}", name=name
        ) from None


def run(
    study: Study,
    *,
    pins: Iterable[str] | None = None,
    cases: Iterable[str] | None = None,
    model: Model | None = None,
    tolerance: float | None = None,
    memory_limit: float | None = None,
    limit_load: bool = False,
    fields: bool = False,
    jobs: int | None = 1,
) -> RunResults:
    """Analyse a study.

    pins, cases: names; all by default.
    model, tolerance: override those of the study.
    memory_limit: limit for a mesh in MB, by default most of the free memory.
    limit_load: compute the limit load of every row that yields, however long it takes; otherwise
    the study decides, where "auto" gives each 20 s of processor time.
    fields: whether to keep every pin's field (about 10 MB each) for `to_pyvista` and `picture`,
    which otherwise solve the pin again.
    jobs: number of parallel processes (None: number of cores); 1, in this process, if fields are
    kept or other threads run.

    A pin whose solution fails has the verdict `failed`.

    Raises: InputError for bad input, and if a file of the study changes meanwhile.
    """
    require_count("jobs", jobs)
    with one_thread():
        before = inputs(study) if isinstance(study, Study) else {}
        plan = prepare(
            study,
            pins=pins,
            cases=cases,
            model=model,
            tolerance=tolerance,
            memory=memory_limit,
            limit_load=limit_load,
        )
    results = solve(plan, fields=fields, jobs=jobs)
    require_unchanged(study, before)
    return results


def solve(
    plan: Plan,
    *,
    fields: bool = False,
    jobs: int | None = 1,
    cache: OutcomeStore | None = None,
    memo: Memo | None = None,
) -> RunResults:
    """Solve the plan that `prepare` returned.

    fields, jobs: as in `run`.
    cache: where pins that were solved before are found, and the others stored.
    memo: parts of solutions that other runs in this process share.

    Raises: InputError if the study has [fatigue] and its extra is not installed, for an invalid
    number of jobs, and for an argument that is not a plan.
    """
    given: object = plan
    if not isinstance(given, Plan):
        text = f"{as_text(given)} is not a plan; pinstress.prepare makes one of a study"
        raise InputError(text, code="not-a-plan")
    require_fatigue(plan.study)
    kept_fields: dict[tuple[str, str], Field] = {}

    def keep(field: Field) -> None:
        kept_fields[field.pin, field.case] = field

    require_count("jobs", jobs)
    most = 1 if fields else processes(jobs)
    with one_thread():
        keeping = keep if fields else None
        outcomes = solve_tasks(plan, keeping, jobs=most, cache=cache, memo=memo)
        return run_results(plan, outcomes, kept_fields)


def run_results(
    plan: Plan, outcomes: list[PinOutcome], fields: dict[tuple[str, str], Field] | None = None
) -> RunResults:
    """Return the results of a plan from the outcomes of its tasks, with kept fields."""
    results = results_of(plan, outcomes)
    plain = {f.name: getattr(results, f.name) for f in dataclasses.fields(Results)}
    return RunResults(**plain, fields=fields or {}, plan=plan)
