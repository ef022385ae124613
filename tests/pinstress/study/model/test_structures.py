"""Structures in study files: solved without a drive, and what is told where one is missing."""

from __future__ import annotations

from pathlib import Path

import pytest

from pinstress import InputError, load_study
from pinstress.analysis.gather.gather import loads_only
from reports.files import write_loads
from reports.text.loads import remarks
from reports.text.loads_summary import load_parts
from tests.support.described import describe
from tests.support.each import each
from tests.support.errors import raises
from tests.support.study_text import study_file

ARCH = """
title = "An arch"
units = "m-N-s"

[mechanism]
gravity = [0, 0]

[mechanism.joint.A]
at = [0, 0]
fixed_in = "ground"
connections = { A = "left" }

[mechanism.joint.B]
at = [8, 0]
fixed_in = "ground"
connections = { B = "right" }

[mechanism.joint.C]
at = [4, 3]
connections = { C1 = "left", C2 = "right" }

[mechanism.body.left]
mass = 0
inertia = 0

[mechanism.body.right]
mass = 0
inertia = 0

[case.snow]
kind = "static"

[[case.snow.apply]]
body = "left"
at = [2, 2.5]
force = [0, -1200]
"""
WITHOUT_MASS = "mass = 0\ninertia = 0\n"
GEARS = """
title = "A locked gear"
units = "m-N-s"

[mechanism.joint.A]
at = [0, 0]
fixed_in = "ground"
connections = { A = "small" }

[mechanism.joint.B]
at = [0.3, 0]
fixed_in = "ground"
connections = { B = "large" }

[mechanism.body.small]
mass = 1
inertia = 0

[mechanism.body.large]
mass = 3
inertia = 0

[mechanism.gear.teeth]
bodies = ["small", "large"]
joints = ["A", "B"]
teeth = [10, 20]

[mechanism.stop.lock]
bodies = ["ground", "large"]

[case.locked]
kind = "static"
hold = ["lock"]

[[case.locked.apply]]
body = "small"
couple = 50
"""
DROP = """
[case.landing]
kind = "drop"
velocity = 1
mass = 90
lift = 1.0
unsprung = 10
body = "left"
at = "C"
forward = "left"
tyre = { at = [0.12, 18000], exponent = 1.2 }
"""


def test_a_structure_needs_no_drive(tmp_path: Path) -> None:
    """P = 1200 N a quarter of the way along a span of 8 m, with a rise of 3 m."""
    study = load_study(study_file(tmp_path, ARCH))
    summary, _, _ = describe(study)
    assert "no drive\nmobility 0\n" in summary
    results = loads_only(study)
    (case,) = results.reactions
    forces = dict(zip(case.connections, case.forces[0, :, :2].tolist(), strict=True))
    assert forces["A"] == pytest.approx([-400.0, -900.0])
    assert forces["C1"] == pytest.approx([400.0, -300.0])
    assert not results.drive
    assert "drive" not in " ".join(remarks(results))
    (part,) = load_parts(results)
    assert len(part.grids) == 1  # forces; no table of drives
    assert "linkage in its position" in write_loads(results, tmp_path / "out").read_text()


def forces(path: Path) -> list[float]:
    (case,) = loads_only(load_study(path)).reactions
    return [float(x) for x in case.forces[0].ravel()]


@each("text", [ARCH.replace(WITHOUT_MASS, ""), ARCH.replace("inertia = 0\n", "")])
def test_a_structure_at_rest_needs_no_inertia(text: str, tmp_path: Path) -> None:
    """Nor a mass, without gravity."""
    assert text != ARCH
    stated = forces(study_file(tmp_path, ARCH))
    assert forces(study_file(tmp_path, text)) == stated


def test_a_body_without_mass_needs_no_centre(tmp_path: Path) -> None:
    """The left rib has a third joint, with a strut to the ground."""
    strut = """
[mechanism.joint.D]
at = [2, 0]
fixed_in = "ground"
connections = { D = "strut" }

[mechanism.joint.E]
at = [2, 1.5]
connections = { E1 = "left", E2 = "strut" }

[mechanism.body.strut]
mass = 0
inertia = 0

[[mechanism.sharing]]
connections = ["A", "D", "B", "C1", "C2", "E1", "E2"]
stiffness = [1, 1, 1, 1, 1, 1, 1]
"""
    stated = ARCH.replace("mass = 0", "mass = 0\ncentre = [1, 1]", 1)
    assert forces(study_file(tmp_path, ARCH + strut)) == forces(
        study_file(tmp_path, stated + strut)
    )


def test_masses_count_under_gravity_and_in_motion(tmp_path: Path) -> None:
    bare = ARCH.replace(WITHOUT_MASS, "")
    for text in (
        bare.replace("gravity = [0, 0]\n", ""),
        bare.replace('kind = "static"', 'kind = "instant"'),
    ):
        with raises(InputError, "give-one", "body left: give one of weight, mass or bar"):
            describe(load_study(study_file(tmp_path, text)))
    moving = ARCH.replace("inertia = 0\n", "").replace('kind = "static"', 'kind = "instant"')
    with raises(InputError, "particle", "a body without inertia is a particle"):
        describe(load_study(study_file(tmp_path, moving)))


def test_a_wrong_static_case_alone_is_told(tmp_path: Path) -> None:
    """Not that its bodies have no inertia, which it needs as little as the right one."""
    wrong = ARCH.replace(WITHOUT_MASS, "").replace('kind = "static"', 'kind = "statik"')
    with raises(InputError, "not-a-choice", "must be") as caught:
        load_study(study_file(tmp_path, wrong))
    assert len(caught.value.lines) == 1


def test_a_locked_gear_needs_no_inertia(tmp_path: Path) -> None:
    bare = GEARS.replace("inertia = 0\n", "")
    assert forces(study_file(tmp_path, bare)) == forces(study_file(tmp_path, GEARS))


def test_an_instant_of_a_structure_is_a_case_at_rest(tmp_path: Path) -> None:
    at_rest, instant = (
        loads_only(load_study(study_file(tmp_path, text)))
        for text in (ARCH, ARCH.replace('"static"', '"instant"'))
    )
    assert (at_rest.reactions[0].forces == instant.reactions[0].forces).all()


def test_a_structure_lands_on_its_tyre(tmp_path: Path) -> None:
    """The ground's force is carried by both bars, 4 m wide and 3 m high: 5/6 of it in each."""
    heavy = ARCH.replace("gravity = [0, 0]\n", "")
    results = loads_only(load_study(study_file(tmp_path, heavy + DROP)))
    case = next(table for table in results.reactions if table.case == "landing")
    (drop,) = results.drops
    carried = {peak.connection: peak.force for peak in case.largest}
    assert carried["A"] == pytest.approx(drop.peaks["vertical"].value * 5.0 / 6.0, rel=1e-3)


def test_what_can_move_needs_a_drive_or_a_hold(tmp_path: Path) -> None:
    loose = ARCH.replace('C1 = "left", C2 = "right"', 'C2 = "right", C3 = "spare"')
    loose += "\n[mechanism.body.spare]\nmass = 0\ninertia = 0\n"
    with raises(InputError, "underconstrained", "no drive", "3 degrees of freedom", "left, right"):
        describe(load_study(study_file(tmp_path, loose)))
    with raises(InputError, "underconstrained", "no drive", "1 degree of freedom", "hold"):
        describe(load_study(study_file(tmp_path, GEARS.replace('hold = ["lock"]\n', ""))))


def test_a_lock_holds_a_gear_without_a_drive(tmp_path: Path) -> None:
    results = loads_only(load_study(study_file(tmp_path, GEARS)))
    (lock,) = results.drive
    assert (lock.name, lock.force[0]) == ("lock", pytest.approx(100.0))


def test_a_bracket_is_welded_to_a_bar(tmp_path: Path) -> None:
    """The load acts on the bracket as it would on the bar."""
    bracket = """
[mechanism.body.bracket]
mass = 0
inertia = 0
centre = [2, 2]
welded_to = "left"
"""
    on_bracket = ARCH.replace('body = "left"\nat', 'body = "bracket"\nat') + bracket
    results = loads_only(load_study(study_file(tmp_path, on_bracket)))
    bare = loads_only(load_study(study_file(tmp_path, ARCH)))
    assert results.reactions[0].forces == pytest.approx(bare.reactions[0].forces)
    wrong = on_bracket.replace('welded_to = "left"', 'welded_to = "lefft"')
    with raises(InputError, "unknown-body", "mechanism.body.bracket.welded_to", "left"):
        load_study(study_file(tmp_path, wrong))


def test_what_only_a_drive_has_is_refused_without_one(tmp_path: Path) -> None:
    for old, new, code, named in (
        ('kind = "static"', 'kind = "motion"', "motion-without-drive", "case.snow"),
        ('kind = "static"', 'kind = "static"\nposition = 2', "unknown-drive", "case.snow.position"),
        ('"static"', '"instant"\nvelocity = 2', "unknown-drive", "case.snow.velocity"),
        ('kind = "static"', 'kind = "static"\nhold = ["A"]', "unknown-stop", "case.snow.hold"),
    ):
        study = load_study if code == "unknown-stop" else lambda path: describe(load_study(path))
        with raises(InputError, code, named):
            study(study_file(tmp_path, ARCH.replace(old, new)))
