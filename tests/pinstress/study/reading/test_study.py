"""Study files: units at the door, provenance, and every way of getting it wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from loads import ArgumentError
from pinstress import InputError, load_study
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.schema.units import (
    DIMENSION_EXPONENTS,
    UNIT_SYSTEMS,
    USUAL_UNITS,
    _by_pint,
    to_si,
)
from tests.conftest import INCH, LBF, PSI, ROOT
from tests.support.each import each
from tests.support.errors import raises
from tests.support.study_text import study_file

ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()


@each("name", ["one_pin", "grenier2008"])
def test_shipped_studies_are_valid(name: str) -> None:
    assert load_study(ROOT / "studies" / f"{name}.toml").name == name


@each(
    ("text", "dimension", "system", "si"),
    [
        (2.0, "length", "in-lbf-s", 2 * INCH),
        ("2", "length", "in-lbf-s", 2 * INCH),
        ("2 in", "length", "m-N-s", 2 * INCH),
        ("1 mm", "length", "in-lbf-s", 1e-3),
        ("225 ksi", "stress", "mm-N-s", 225e3 * PSI),
        ("28.4e6 psi", "stress", "m-N-s", 28.4e6 * PSI),
        (210e3, "stress", "mm-N-s", 210e9),
        ("0.2836 lb/in^3", "density", "m-N-s", 0.2836 * 0.45359237 / INCH**3),
        (7.34544e-4, "density", "in-lbf-s", 7.34544e-4 * LBF / INCH**4),
        ("7850 kg/m^3", "density", "mm-N-s", 7850.0),
        (7.85e-9, "density", "mm-N-s", 7850.0),
        ("32.2 ft/s^2", "acceleration", "in-lbf-s", 32.2 * 0.3048),
        ("7.8 kg/dm^3", "density", "mm-N-s", 7800.0),
        ("12 daN m", "moment", "mm-N-s", 120.0),
        ("5 l", "volume", "m-N-s", 5e-3),
        ("15 nm", "length", "m-N-s", 15e-9),
        ("3 \N{GREEK SMALL LETTER MU}m", "length", "m-N-s", 3e-6),
        ("2 feet", "length", "in-lbf-s", 0.6096),
        ("60 mph", "velocity", "in-lbf-s", 26.8224),
        ("-5 kip", "force", "in-lbf-s", -5000 * LBF),
        (1.0, "inertia", "in-lbf-s", LBF * INCH),
    ],
)
def test_units(text: object, dimension: str, system: str, si: float) -> None:
    assert to_si(text, dimension, UNIT_SYSTEMS[system]) == pytest.approx(si, rel=1e-14)


@each("unit", USUAL_UNITS)
def test_the_usual_units_are_pints(unit: str) -> None:
    dimension, factor = USUAL_UNITS[unit]
    assert factor == pytest.approx(_by_pint(unit, dimension, unit), rel=1e-15)


@each("dimension", DIMENSION_EXPONENTS)
def test_the_examples_in_messages_are_right(dimension: str) -> None:
    assert to_si(DIMENSION_EXPONENTS[dimension][1], dimension, UNIT_SYSTEMS["m-N-s"]) > 0.0


@each(
    ("value", "code", "named"),
    [
        ("2 inn", "unknown-unit", "'in'"),
        ("2 MM", "unknown-unit", "'mm'"),
        ("2 ksi", "wrong-dimension", "'2 ksi'"),
        ("two", "not-a-number", "'two'"),
        ("2 in**", "unreadable-unit", "'2 in**'"),
        ("2,5 in", "decimal-comma", "'2,5 in'"),
        ("1_000 in", "not-a-number", "underscore"),  # asked "did you mean 'g_0'?" or the like
        ("\N{ARABIC-INDIC DIGIT THREE} in", "not-a-number", "0 to 9"),  # was read as 3
        ("2 in^\N{SUPERSCRIPT THREE}", "unreadable-unit", "'2 in"),
        ("2 in^\N{ARABIC-INDIC DIGIT ONE}", "not-a-number", "0 to 9"),
        (True, "not-a-quantity", "true"),
        ([1], "not-a-quantity", "a list"),
        (float("nan"), "not-finite", "nan"),
        ("1e400 m", "not-finite", "'1e400 m'"),
    ],
)
def test_bad_quantities(value: object, code: str, named: str) -> None:
    with raises(ArgumentError, code, named):
        to_si(value, "length", UNIT_SYSTEMS["in-lbf-s"])


def test_values_carry_their_provenance() -> None:
    gear = load_study(ROOT / "studies" / "grenier2008.toml")
    by_key = {s.key: s for s in gear.provenance}
    assert by_key["mechanism.joint.F.at"].kind == "derived"
    assert by_key["pin.B.profile[1]"].kind == "given"
    assert by_key["mechanism.joint.F.at"].value == "[1.28734, -13.6896]"
    assert by_key['material."AISI 4340".yield_strength'].value == "225 ksi"
    assert by_key["pin.B.profile[1]"].value.startswith("length ")
    # every dimension of linkage and pins says where it is from
    mechanism = gear.table.mechanism
    assert mechanism is not None
    for joint in mechanism.joint:
        assert f"mechanism.joint.{joint}.at" in by_key
    for body in mechanism.body:
        assert {f"mechanism.body.{body}.weight", f"mechanism.body.{body}.centre"} <= set(by_key)
    for name, pin in gear.table.pin.items():
        for i in range(len(pin.profile or ())):
            assert f"pin.{name}.profile[{i + 1}]" in by_key


@each(
    ("old", "new", "code", "named"),
    [
        ("diameter = 2.0,", "diametre = 2.0,", "unknown-key", "profile[2]: unknown key 'diametre'"),
        ("title =", "titel =", "unknown-key", "did you mean 'title'?"),
        ("[analysis]", "[analyses]", "unknown-key", "did you mean 'analysis'?"),
        ('units = "in-lbf-s"', 'units = "inch"', "not-a-choice", "units: "),
        ('units = "in-lbf-s" ', "", "missing-key", "units: "),
        ("poisson_ratio = 0.30", "poisson_ratio = 0.5", "out-of-range", "poisson_ratio: "),
        ("length = 2.0", "length = -2.0", "not-positive", "profile[2].length: "),
        ("length = 2.0", "length = 1e300", "too-large", "profile[2].length: 1e+300"),
        ("length = 2.0", "length = 1e9", "out-of-range", "profile[2].length: "),
        ("length = 2.0", "length = nan", "not-finite", "profile[2].length: "),
        ('"28400 ksi"', '"28400 s"', "wrong-dimension", "youngs_modulus: '28400 s'"),
        ("fillet = 0.4", "fillet = 1.1", "fillet-too-large", "pin B: "),
        ('clamp = ["start"]', 'clamp = ["strat"]', "unknown-surface", "did you mean 'start'?"),
        ('material = "AISI 4340"', 'material = "AISI 430"', "unknown-material", "'AISI 4340'"),
        ("forces = { B =", "forces = { D =", "unknown-connection", "'D'"),
        ("-988.86]", "-988.86, 0, 0]", "list-too-long", "forces.B: "),
        ("-988.86]", "inf]", "not-finite", "forces.B[2]: "),
        ("forces = { B =", "moments = { D =", "unknown-connection", "case.landing.moments: "),
        ("forces = { B = [0.0,", "moments = { B = ['1 N',", "wrong-dimension", "moments.B[1]: "),
        ("forces = { B = [0.0, -988.86] }", "moments = {}", "empty", "moments"),
        ("forces = { B = [0.0, -988.86] }", "", "give-one", "case.landing: "),
        ("forces =", "table = 't.csv'\nmoments =", "give-one", "case.landing: "),
        ('kind = "given"', 'kind = "motion"', "unknown-key", "'forces'"),
        ('kind = "given"', 'kind = "gven"', "not-a-choice", "case.landing.kind: "),
        ("tolerance = 0.05", "tolerance = 2", "out-of-range", "tolerance: "),
        ("[pin.B]", '[pin."a/b"]', "unusable-name", "'a/b'"),
        ("title =", "title = = ", "not-toml", ":"),
        (
            "fillet = 0.4",
            "fillet = { value = 0.4, provenance = 'guess' }",
            "not-a-choice",
            "fillet: ",
        ),
    ],
)
def test_each_mistake_is_told(tmp_path: Path, old: str, new: str, code: str, named: str) -> None:
    assert old in ONE_PIN
    path = study_file(tmp_path, ONE_PIN.replace(old, new))
    with raises(InputError, code, str(path), named):
        pin_of(load_study(path), "B")


def test_moments_go_to_the_pin_with_the_forces(tmp_path: Path) -> None:
    """Stated, or in a table, in the study's units; at a clamped band they are left out."""
    from pinstress.analysis.plan import prepare

    text = ONE_PIN.replace('name = "root"', 'connection = "R"').replace('["start"]', '["R"]')
    stated = 'forces = { R = [7, 8] }\nmoments = { R = [1, 2, 3], B = ["0 N m", 500.0] }'
    text = text.replace("forces = { B = [0.0, -988.86] }", stated)
    text += '\n[case.table]\nkind = "given"\ntable = "t.csv"\n'
    (tmp_path / "t.csv").write_text("connection,fx,fy,my\nB,0,0,500\nR,7,8,0\n")
    (task,) = prepare(load_study(study_file(tmp_path, text))).tasks
    assert task.left_out == {"landing": ("R",), "table": ("R",)}
    for loads in task.loads:
        assert loads.surfaces == ("B",)
        assert loads.forces.tolist() == [[[0.0, 0.0, 0.0]]]
        assert loads.moments[0, 0] == pytest.approx([0.0, 500.0 * LBF * INCH, 0.0])


def test_a_beam_check_is_for_forces_alone(tmp_path: Path) -> None:
    from pinstress.analysis.plan import prepare

    text = ONE_PIN.replace("forces =", "moments = { B = [0, 1] }\nforces =")
    text += '\n[beam_check]\npin = "B"\ncase = "landing"\naxis_bore = 0.1\n'
    with pytest.raises(InputError, match="on one band, by forces alone, to be a cantilever"):
        prepare(load_study(study_file(tmp_path, text)))


@each(
    "force",
    [
        "[0, 1e400]",
        "[0, nan]",
        "[0, '100 kg']",
        "[0, '1,000 N']",
        "[0, true]",
        "[1000]",
        "[1, 2, 3, 4]",
    ],
)
def test_a_wrong_force_is_the_only_error(tmp_path: Path, force: str) -> None:
    """Of a case with one force nothing remains without it; that it is empty only follows."""
    text = ONE_PIN.replace("[0.0, -988.86]", force)
    assert text != ONE_PIN
    with pytest.raises(InputError) as caught:
        load_study(study_file(tmp_path, text))
    assert len(caught.value.lines) == 1, caught.value.lines
    assert "case.landing.forces.B" in caught.value.lines[0]


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with raises(InputError, "no-such-file", "gone.toml"):
        load_study(tmp_path / "gone.toml")


GEAR = (
    (ROOT / "studies" / "grenier2008.toml")
    .read_text()
    .replace('"grenier2008/', f'"{ROOT}/studies/grenier2008/')  # its tables, from anywhere
)


@each(
    ("old", "new", "code", "named"),
    [
        ('A = "AE" }', 'A = "AF" }', "unknown-body", "joint.A.connections.A: no body 'AF'"),
        ('joints = ["H", "G"]', 'joints = ["H", "K"]', "unknown-joint", "slider.HG.joints: "),
        ('slider = "HG"', 'slider = "GH"', "unknown-slider", "there are HG"),
        ('body = "tyre"', 'body = "tire"', "unknown-body", "did you mean 'tyre'?"),
        ('connections = ["G1", "G3"]', 'connections = ["G1", "G4"]', "unknown-connection", "'G4'"),
        (
            'connections = ["G1", "G3"]',
            'connections = ["E1", "E2"]',
            "sharing-idle",
            "D1, D2, G1, G3",
        ),
        ("value = 41.96,", "value = 44.0,", "dead-point", "HG = 44 in"),
        ('connections = { B = "BC" }', 'connections = { BB = "BC" }', "unknown-connection", "'B'"),
        ('fixed_in = "EBJ"', 'fixed_in = "EJB"', "unknown-body", "joint.B.fixed_in: no body 'EJB'"),
    ],
)
def test_each_mistake_in_a_mechanism_is_told(
    tmp_path: Path, old: str, new: str, code: str, named: str
) -> None:
    from pinstress.analysis.plan import prepare

    assert old in GEAR
    path = study_file(tmp_path, GEAR.replace(old, new, 1))
    with raises(InputError, code, named):
        prepare(load_study(path))


def test_the_pivot_of_a_motion_check_must_be_fixed(tmp_path: Path) -> None:
    from pinstress.analysis.plan import prepare

    study = load_study(study_file(tmp_path, GEAR.replace('pivot = "D"', 'pivot = "C"', 1)))
    with pytest.raises(InputError, match=r": motion_check\.pivot: C "):
        prepare(study)


def test_without_a_sharing_rule_the_connections_are_named(tmp_path: Path) -> None:
    from pinstress.analysis.plan import all_loads
    from tests.support.described import describe

    start, end = GEAR.index("[[mechanism.sharing]]"), GEAR.index("[mechanism.joint.A]")
    study = load_study(study_file(tmp_path, GEAR[:start] + GEAR[end:]))
    for ask in (lambda: all_loads(study, ["landing"]), lambda: describe(study)):
        with raises(InputError, "statically-indeterminate", "D1, D2, G1, G3"):
            ask()
