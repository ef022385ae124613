"""A design's rows against runs of the changed study, and what is solved again for one."""

from __future__ import annotations

import math

import numpy as np
import pytest

import pinstress
from pinbase.memo import Memo
from pinstress import InputError, Study, changed_study, load_study, shipped_studies, study_from
from pinstress.analysis.solve import solutions
from pinstress.explore.sweep.evaluate import Evaluator, Recent
from pinstress.explore.sweep.number import number_at
from pinstress.study.model.cases import CaseLoads, case_loads
from tests.support.programs.swept import DIAMETER, FORCE, ONE_PIN, STRENGTH

MODULUS = "material.AISI 4340.youngs_modulus"


def _evaluator(study: Study, *keys: str) -> tuple[Evaluator, list[float]]:
    numbers = [number_at(study, key) for key in keys]
    return Evaluator(study, numbers), [number.nominal for number in numbers]


def test_rows_are_those_of_a_run_of_the_changed_study() -> None:
    """To the last bit: a dimension, a load and a strength, one after the other and together."""
    study = study_from(ONE_PIN)
    evaluator, at = _evaluator(study, DIAMETER, FORCE, STRENGTH)
    stress = study.system.factor("stress")
    for scales in [(1.0, 1.0, 1.0), (1.1, 1.0, 1.0), (1.1, 1.3, 1.0), (1.1, 1.3, 0.9)]:
        values = [s * x for s, x in zip(scales, at, strict=True)]
        (row,) = evaluator.rows(values)
        changes = {
            n.key: n.in_study(n.shown(v)) for n, v in zip(evaluator.numbers, values, strict=True)
        }
        found = pinstress.run(changed_study(study, changes)).pins[0]
        assert row.max_von_mises is not None
        assert row.max_von_mises / stress == found.max_von_mises
        assert row.error_estimate is not None
        assert row.error_estimate / stress == found.error_estimate
        assert row.safety_factor == found.safety_factor
        assert (row.pin, row.case, row.verdict) == ("B", "landing", found.verdict)
        assert (row.reason, row.code, row.governing_time) == ("", "", None)


def test_loads_and_strength_alone_mesh_nothing_again() -> None:
    evaluator, (force, strength) = _evaluator(study_from(ONE_PIN), FORCE, STRENGTH)
    evaluator.rows([force, strength])
    meshes = evaluator.memo.made
    assert meshes == 3
    rows = [evaluator.rows([force * f, strength * s])[0] for f in (0.5, 2.0) for s in (1.0, 1.5)]
    assert evaluator.memo.made == meshes
    assert len({row.safety_factor for row in rows}) == 4


def test_strengths_decide_where_a_pin_with_a_hardened_surface_governs() -> None:
    """Its hardened band has the larger stress, its root the lower strength: designs kept the place,
    and the strength, of the first one.
    """
    hard = 'hardened = { surface = "300 ksi", core = "290 ksi", depth = 0.05 }'
    study = study_from(ONE_PIN.replace('connection = "B"', f'connection = "B", {hard}'))
    assert study.text.count("hardened") == 1
    evaluator, _ = _evaluator(study, STRENGTH)
    strong, weak = (evaluator.rows([x])[0] for x in (3e9, 1.5e7))
    (alone,) = _evaluator(study, STRENGTH)[0].rows([1.5e7])
    assert weak == alone
    assert weak.max_von_mises != strong.max_von_mises
    assert (weak.safety_factor or 0.0) * (weak.max_von_mises or 0.0) == pytest.approx(1.5e7)


def test_stress_is_proportional_to_a_load_and_does_not_depend_on_the_modulus() -> None:
    evaluator, (force, modulus) = _evaluator(study_from(ONE_PIN), FORCE, MODULUS)
    one, twice, stiff = (
        evaluator.rows(x)[0].max_von_mises
        for x in ([force, modulus], [2.0 * force, modulus], [force, 2.0 * modulus])
    )
    assert one is not None
    assert twice == pytest.approx(2.0 * one, rel=1e-12)
    assert stiff == pytest.approx(one, rel=1e-9)


def test_the_order_of_designs_changes_no_bit() -> None:
    """Nor does what was solved before, or kept no longer."""
    study = study_from(ONE_PIN)
    evaluator, (diameter, force) = _evaluator(study, DIAMETER, FORCE)
    designs = [(d * diameter, f * force) for d in (1.0, 1.2) for f in (1.0, 1.4)]
    forward = [evaluator.rows(d) for d in designs]
    other, _ = _evaluator(study, DIAMETER, FORCE)
    other.memo = Memo(0)
    assert [other.rows(d) for d in reversed(designs)] == forward[::-1]


def test_a_design_that_cannot_be_is_a_row_with_its_reason() -> None:
    evaluator, (diameter, force) = _evaluator(study_from(ONE_PIN), DIAMETER, FORCE)
    (negative,) = evaluator.rows([-diameter, force])
    assert (negative.verdict, negative.max_von_mises) == ("failed", None)
    assert negative.code == "not-positive"
    assert negative.reason == "pin.B.profile[2].diameter: must be positive"
    (close,) = evaluator.rows([0.1, force])  # the fillet does not fit into the step
    assert (close.verdict, close.code) == ("failed", "fillet-too-large")
    assert close.mass is None
    (right,) = evaluator.rows([diameter, force])
    assert right.verdict == "converged"


def test_lengths_of_pins_count_where_only_a_design_has_a_load_out_of_the_plane() -> None:
    """As the study is, they place nothing: later designs had the moments of the first length."""
    text = shipped_studies()["slider_crank"].read_text(encoding="utf-8")
    text = text.replace('"motion"', '"static"').replace("samples = 241", "")
    study = study_from(text.replace('"0 N"]', '"0 N", "0 N"]'))
    evaluator, _ = _evaluator(study, "case.turn.apply[1].force[3]", "pin.O.profile[1].length")
    moments = []
    for length in (0.010, 0.020):
        values = [200.0, length]
        loads = evaluator.loads_of(evaluator.changed(values), values)["turn"]
        assert isinstance(loads, CaseLoads)
        moments.append(loads.reactions.moments)
    assert np.abs(moments[1] - moments[0]).max() > 0.1 * np.abs(moments[0]).max()


def test_the_mass_is_that_of_the_shape() -> None:
    """Two cylinders and a fillet of the shipped pin, by hand."""
    evaluator, (diameter,) = _evaluator(study_from(ONE_PIN), DIAMETER)
    (row,) = evaluator.rows([diameter])
    inch, r = 0.0254, 0.4
    fillet = (1 - math.pi / 4) * r**2
    # centroid of the fillet's section from the corner, r (10 - 3 pi) / (12 - 3 pi)
    ring = 2 * math.pi * (1.0 + r * (10 - 3 * math.pi) / (12 - 3 * math.pi)) * fillet
    volume = (math.pi * (4.0 * 1.5 + 1.0 * 2.0) + ring) * inch**3
    assert row.mass == pytest.approx(0.2836 * 0.45359237 / inch**3 * volume, rel=1e-9)


def test_a_study_that_cannot_run_is_refused() -> None:
    study = study_from(ONE_PIN.replace('clamp = ["start"]', 'clamp = ["B"]'))
    with pytest.raises(InputError):
        Evaluator(study, [])


def test_pins_that_a_number_does_not_touch_are_solved_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of the shipped linkage: loads by the impulse are found anew, the motion of others is not."""
    import pinstress.explore.sweep.evaluate as module

    study = load_study(shipped_studies()["grenier2008"])
    times = number_at(study, "case.landing.apply.impulse.impulse_time")
    width = number_at(study, "pin.B.profile[1].diameter")
    evaluator = Evaluator(study, [times, width], pins=["B", "E"])
    solved: list[str] = []
    cases: list[str] = []
    whole, loads = solutions, case_loads

    def counted(study: Study, task: object, *more: object) -> object:
        solved.append(getattr(task, "pin").name)  # noqa: B009
        return whole(study, task, *more)  # type: ignore[arg-type]

    def noted(study: Study, name: str, *more: object) -> object:
        cases.append(name)
        return loads(study, name, *more)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "solutions", counted)
    monkeypatch.setattr(module, "case_loads", noted)
    rows = [evaluator.rows([times.nominal, s * width.nominal]) for s in (1.0, 1.01, 1.02)]
    assert solved.count("E") == 1
    assert solved.count("B") == 3
    assert cases == ["retract", "landing"]
    assert [len({r[k].max_von_mises for r in rows}) for k in range(4)] == [3, 3, 1, 1]
    half = evaluator.rows([2.0 * times.nominal, width.nominal])
    assert cases == ["retract", "landing", "landing"]
    assert (half[3].safety_factor or 0.0) > (rows[0][3].safety_factor or 0.0)
    assert half[2] == rows[0][2]


def test_what_was_asked_for_last_is_remembered() -> None:
    known = Recent[int, str](2)
    for key in (1, 2):
        known.put(key, str(key))
    assert known.get(1) == "1"
    known.put(3, "3")
    assert (known.get(1), known.get(2), known.get(3)) == ("1", None, "3")


def test_meshes_are_kept_within_their_memory() -> None:
    """All that is kept of them counts, of which stress is a fifth."""
    evaluator, (diameter, force) = _evaluator(study_from(ONE_PIN), DIAMETER, FORCE)
    evaluator.memo = Memo(2_000_000)
    for k in range(8):
        evaluator.rows([diameter * (1.0 + 0.01 * k), force])
    solved = evaluator.memo.made
    evaluator.rows([diameter * 1.07, 2.0 * force])
    assert evaluator.memo.made == solved  # the last one is known
    evaluator.rows([diameter, 2.0 * force])
    assert evaluator.memo.made > solved
