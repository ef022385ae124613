"""CalculiX's opinion on every row of a run: asked pin by pin, written, shown and told."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import click
from rich.console import Console

from fea.checks.calculix_compare import Opinion, second_opinions
from fea.core.peak import Peak
from pinstress.analysis.plan import Plan
from pinstress.model.tasks import Task
from reports.tables.calculix import print_second_opinion, write_second_opinion


class Opinions:
    """The opinions on a plan's rows so far."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.found: list[Opinion] = []

    def ask(
        self, task: Task, peaks: tuple[Peak, ...], progress: Callable[[str], None]
    ) -> tuple[Opinion, ...]:
        """Solve the rows of a task once more; for the task's own process."""
        distance = self.plan.asked.distance
        try:
            return second_opinions(
                task.pin, task.material, task.clamps, task.loads, peaks, distance, progress
            )
        except ArithmeticError as error:  # MeshError, SolveError: no mesh to compare on
            return tuple(
                Opinion(p.pin, p.case, p.max_von_mises, p.own_error, failure=str(error))
                for p in peaks
                if p.verdict != "rigid"
            )

    def hear(self, opinions: Iterable[Opinion]) -> None:
        """Take opinions from the tasks' processes, in any order."""
        pins, cases = list(self.plan.study.table.pin), list(self.plan.loads)
        self.found += opinions
        self.found.sort(key=lambda o: (pins.index(o.pin), cases.index(o.case)))

    def write(self, directory: Path) -> None:
        """second_opinion.csv."""
        system = self.plan.study.system
        path = directory / "second_opinion.csv"
        write_second_opinion(self.found, path, system.factor("stress"), system.stress)

    def show(self, console: Console) -> None:
        """The table, and what it says in a sentence."""
        system = self.plan.study.system
        print_second_opinion(self.found, console, system.factor("stress"), system.stress)

    def tell_disagreements(self) -> int:
        """Say on stderr where the programs differ; the exit status."""
        for o in self.found:
            if o.complaint:
                click.echo(
                    f"Second opinion differs: pin {o.pin} ({o.case}): {o.complaint}.", err=True
                )
        return int(any(o.complaint for o in self.found))
