"""From histories of stress to damage under the study's spectrum."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from math import inf

from fea.core.peak import decides
from fea.fatigue.assess import FatigueMaterial, Spectrum, assess
from fea.fatigue.records import PointFatigue
from fea.joint.lugs.lug import Lug
from fea.strength.margin import RATIO, Margin, PinMargin
from pinstress.analysis.plan import Plan
from pinstress.analysis.stored import Solved
from pinstress.model.fatigue import fatigue_material, spectrum
from pinstress.model.sequence import complete
from pinstress.schema.fatigue import FatigueTable
from reports.data.results import Fatigue

FACTORS = (
    "Factors for surface, size, temperature, corrosion and surface treatment are not applied: the "
    "S-N data must include them."
)
ZERO = "Every case begins and ends at zero load, and so does every motion."
SUPPORT = "Support by the stress gradient and the size of the highly stressed surface is left out."


def fatigue_of(plan: Plan, found: list[Solved]) -> Fatigue | None:
    """Of all critical points, the worst first; None without a spectrum."""
    table = plan.study.table.fatigue
    if table is None:
        return None
    asked = spectrum(table)
    installed = find_spec("pylife") is not None
    points = sorted(
        _points(plan, found, asked) if installed else (),
        key=lambda p: (-p.damage, -float(p.amplitudes.max(initial=0.0))),
    )
    left_out = _left_out(plan, found, table)
    if not installed:
        left_out = ("Nothing is assessed: pylife is not installed (pip install pylife).", *left_out)
    return Fatigue(
        unit=table.unit,
        occurrences=dict(table.occurrences),
        method=table.method,
        probability=table.failure_probability,
        life=table.life,
        points=tuple(points),
        left_out=left_out,
    )


def fatigue_margins(found: Fatigue | None) -> Iterator[PinMargin]:
    """Of each pin's worst point: damage per unit against what the design life allows."""
    if found is None or not found.life:
        return
    worst: dict[str, PointFatigue] = {}
    for point in found.points:
        worst.setdefault(point.pin, point)
    for pin, point in worst.items():
        allowed = 1.0 / found.life
        margin = Margin(
            "fatigue life",
            point.method,
            "limit",
            point.damage,
            allowed,
            1.0,
            RATIO,
            at=f"point {point.point}",
            basis=f"damage per {found.unit}",
        )
        yield PinMargin(pin, "", margin)


def _material(plan: Plan, pin: str) -> FatigueMaterial:
    table = plan.study.table
    return fatigue_material(table.material[table.pin[pin].material])


def _points(plan: Plan, found: list[Solved], asked: Spectrum) -> Iterator[PointFatigue]:
    for made in found:
        for history in made.histories:
            point = assess(history, asked, _material(plan, history.pin))
            if point is not None:
                yield point


def _pressed(lugs: Iterable[Lug]) -> bool:
    """Whether any is an interference fit."""
    return any(lug.clearance < 0.0 for lug in lugs)


def _left_out(plan: Plan, found: list[Solved], table: FatigueTable) -> tuple[str, ...]:
    needs_fkm = table.method == "fkm-p-ram"
    pins = dict.fromkeys(task.pin.name for task in plan.tasks)
    data = {pin: _material(plan, pin) for pin in pins}
    without = [p for p, m in data.items() if (m.fkm if needs_fkm else m.curve) is None]
    there = {*plan.loads, *complete(plan.study, plan.loads)}
    missing = [case for case in table.occurrences if case not in there]
    apart = [p for p in pins if sum(task.pin.name == p for task in plan.tasks) > 1]
    singular = dict.fromkeys(p.pin for made in found for p in made.peaks if p.verdict == "singular")
    yields = [
        task.pin.name
        for task, made in zip(plan.tasks, found, strict=True)
        if not needs_fkm
        and any(decides(p, task.material.yield_strength or inf) is False for p in made.peaks)
    ]
    tight = dict.fromkeys(t.pin.name for t in plan.tasks if _pressed(t.lugs))
    left = dict.fromkeys(t.pin.name for t in plan.tasks if _pressed(t.given) and not t.lugs)
    sentences = [
        ("No fatigue data of the material: pin", without),
        ("Not run, so that damage is too low: case", missing),
        ("Solved with different clamps, whose damage does not add up here: pin", apart),
        ("Beyond yield, where elastic stress understates the damage: pin", dict.fromkeys(yields)),
        (
            "Assembly stress of interference fits is taken as gone between cases, which "
            "overstates ranges: pin",
            tight,
        ),
        (
            "Assembly stress of interference fits is left out where loads are prescribed: pin",
            left,
        ),
        ("Cracks may start in singular zones, where stress is not evaluated: pin", singular),
    ]
    said = [f"{text} {', '.join(names)}." for text, names in sentences if names]
    return (*said, ZERO, SUPPORT if needs_fkm else FACTORS)
