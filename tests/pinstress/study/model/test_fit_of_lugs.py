"""A fit of ISO 286 as the clearance of a lug, and `pinstress fits`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fea.support.lugs.lug import Lug
from pinstress import InputError, load_study, prepare, run
from pinstress.analysis.remedies.joint_parameters import joint_parameters
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import Study
from tests.pinstress.study.model.test_lugs import study as written
from tests.support.each import each


def fitted(folder: Path, pin: str, joints: str = "contact") -> Study:
    """A pin of 20 mm in three lugs."""
    return load_study(written(folder, pin, f'joints = "{joints}"'))


def middle_lug(study: Study) -> Lug:
    (task,) = prepare(study).tasks
    return next(lug for lug in task.lugs if lug.connection == "M")


def test_the_clearance_is_the_middle_of_the_fit_and_its_range_the_fit(tmp_path: Path) -> None:
    """H7/f7 at 20 mm: 0 to 21 and -41 to -20 micrometres (JIS B 0401)."""
    lug = middle_lug(fitted(tmp_path, 'lug.M = { fit = "H7/f7" }'))
    assert lug.clearance == pytest.approx(41e-6)
    assert lug.range.clearance == pytest.approx((20e-6, 62e-6))


def test_a_stated_range_and_interference(tmp_path: Path) -> None:
    lug = middle_lug(fitted(tmp_path, 'lug.M = { fit = "H7/p6", range = { clearance = [0, 0] } }'))
    assert lug.clearance == pytest.approx(-18e-6)  # 0 to 21, 22 to 35 micrometres
    assert lug.range.clearance == (0.0, 0.0)


def test_the_interference_of_a_bushing_is_the_middle_of_its_fit(tmp_path: Path) -> None:
    """H7/s6 at 24 mm: 0 to 21 and 35 to 48 micrometres."""
    bushing = 'bushing = { thickness = 2, material = "steel", fit = "H7/s6" }'
    lug = middle_lug(fitted(tmp_path, f"lug.M = {{ {bushing} }}"))
    assert lug.bushing is not None
    assert lug.bushing.interference == pytest.approx(31e-6)
    assert lug.range.interference == pytest.approx((14e-6, 48e-6))
    known = middle_lug(
        fitted(tmp_path, f"lug.M = {{ {bushing}, range.interference = [0.02, 0.03] }}")
    )
    assert known.range.interference == pytest.approx((20e-6, 30e-6))


def test_the_range_over_the_joint_is_over_the_fit(tmp_path: Path) -> None:
    pin = "".join(f'[pin.P.lug.{name}]\nfit = "H7/f7"\n' for name in "LMR")
    (row,) = run(fitted(tmp_path, pin, "foundation")).pins
    assert row.joint is not None
    assert row.joint.range is not None
    changes = [x.length for x in row.joint.range.variations if x.what == "clearance"]
    assert changes == pytest.approx([0.020, 0.062])


@each(
    ("lug", "message"),
    [
        ('fit = "H7/f7", clearance = 0', r"pin.P.lug.M: give fit or clearance, not both"),
        ('fit = "H7/zc7"', r"study.toml:\d+: pin.P.lug.M.fit: deviation zc is not included"),
        (
            'bushing = { thickness = 2, material = "steel", fit = "H7/k6" }',
            r"study.toml:\d+: lug M: bushing: fit H7/k6 may leave it without interference",
        ),
        (
            'bushing = { thickness = 2, material = "steel", fit = "H7/s6", interference = 0.03 }',
            r"pin.P.lug.M.bushing: give fit or interference, not both",
        ),
        (
            'bushing = { thickness = 2, material = "steel", interference = 0.05 }, '
            "range = { interference = [0.02, 0.03] }",
            r"study.toml:\d+: lug M: the bushing's interference is not within its range",
        ),
        (
            "range = { interference = [0.02, 0.03] }",
            r"study.toml:\d+: lug M: range.interference is of a bushing",
        ),
        ('fit = "f7"', r"study.toml:\d+: pin.P.lug.M.fit: 'f7' is not a fit"),
    ],
)
def test_what_is_refused(tmp_path: Path, lug: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        prepare(fitted(tmp_path, f"lug.M = {{ {lug} }}"))


def test_derivatives_are_within_one_step_of_sizes(tmp_path: Path) -> None:
    """At 30 mm, the end of a step: a pin that is thicker by a hair keeps its clearance."""
    path = written(tmp_path, 'lug.M = { fit = "H7/f7" }', 'joints = "contact"')
    path.write_text(path.read_text().replace("diameter = 20", "diameter = 30"))
    study = load_study(path)
    (task,) = prepare(study).tasks
    parameters = (x.of_joint for x in joint_parameters(study, task))
    diameter = next(x for x in parameters if "diameter" in x.key)
    _, _, lugs = diameter.changed(diameter.value * 1.001)
    assert [lug.clearance for lug in lugs] == [lug.clearance for lug in task.lugs]
    assert any(lug.clearance == pytest.approx(41e-6) for lug in lugs)


def test_the_command_prints_limits_in_the_unit_given(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line(["fits", "40", "H7/f7"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "H7/f7 at 40 mm: clearance fit (ISO 286-1)",
        "  hole H7    40.000 to 40.025 mm  (0 to 25 µm)",
        "  shaft f7   39.950 to 39.975 mm  (-50 to -25 µm)",
        "  clearance  0.025 to 0.075 mm    (25 to 75 µm)",
    ]
    assert run_command_line(["fits", "1.5 in", "H7/f7", "--json"]) == 0
    limits = json.loads(capsys.readouterr().out)
    assert (limits["size"], limits["unit"], limits["kind"]) == (1.5, "in", "clearance")
    assert [25.4e3 * x for x in limits["clearance"]] == pytest.approx([25, 75], abs=0.2)
    assert run_command_line(["fits", "40", "H7/p7x"]) == 2
    assert "'p7x' is not a tolerance class" in capsys.readouterr().err
