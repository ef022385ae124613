"""Study files: units at the door, provenance, and every way of getting it wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from pinstress import InputError, load_study
from pinstress.pins import pin as pin_of
from pinstress.units import DIMENSIONS, SYSTEMS, USUAL, _by_pint, to_si
from tests.conftest import INCH, LBF, PSI, ROOT

ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "study.toml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("name", ["one_pin", "grenier2008"])
def test_shipped_studies_are_valid(name: str) -> None:
    assert load_study(ROOT / "studies" / f"{name}.toml").name == name


@pytest.mark.parametrize(
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
        ("-5 kip", "force", "in-lbf-s", -5000 * LBF),
        (1.0, "inertia", "in-lbf-s", LBF * INCH),
    ],
)
def test_units(text: object, dimension: str, system: str, si: float) -> None:
    assert to_si(text, dimension, SYSTEMS[system]) == pytest.approx(si, rel=1e-14)


@pytest.mark.parametrize("unit", USUAL)
def test_the_usual_units_are_pints(unit: str) -> None:
    dimension, factor = USUAL[unit]
    assert factor == pytest.approx(_by_pint(unit, dimension, unit), rel=1e-15)


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_the_examples_in_messages_are_right(dimension: str) -> None:
    assert to_si(DIMENSIONS[dimension][1], dimension, SYSTEMS["m-N-s"]) > 0.0


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("2 inn", "unknown unit 'inn' in '2 inn'; did you mean 'in'"),
        ("2 ksi", "'2 ksi' is not a length; write for instance '2 in'"),
        ("two", "does not begin with a number"),
        ("2 in**", "cannot read the unit"),
        (True, "True is not a length"),
        ([1], "is not a length"),
        (float("nan"), "not finite"),
        ("1e400 m", "not finite"),
    ],
)
def test_bad_quantities(value: object, message: str) -> None:
    with pytest.raises(ValueError, match=message.replace("*", r"\*")):
        to_si(value, "length", SYSTEMS["in-lbf-s"])


def test_values_carry_their_provenance() -> None:
    gear = load_study(ROOT / "studies" / "grenier2008.toml")
    by_key = {s.key: s for s in gear.provenance}
    assert by_key["mechanism.joint.F.at"].kind == "derived"
    assert by_key["pin.B.profile[1]"].kind == "given"
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


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "diameter = 2.0,",
            "diametre = 2.0,",
            r"profile\[2\]: unknown key 'diametre'; did you mean",
        ),
        ("title =", "titel =", "unknown key 'titel'; did you mean 'title'"),
        ("[analysis]", "[analyses]", "unknown key 'analyses'; did you mean 'analysis'"),
        ('units = "in-lbf-s"', 'units = "inch"', "units: input should be 'in-lbf-s', 'mm-N-s'"),
        ('units = "in-lbf-s" ', "", "units: is missing"),
        ("poisson_ratio = 0.30", "poisson_ratio = 0.5", "poisson_ratio: input should be less than"),
        ("length = 2.0", "length = -2.0", r"profile\[2\].length: must be positive"),
        ("length = 2.0", "length = 1e300", r"profile\[2\].length: 1e\+300 is too large"),
        (
            "length = 2.0",
            "length = 1e9",
            r"profile\[2\].length: must lie between 1e-6 m and 1000 m",
        ),
        ("length = 2.0", "length = nan", r"profile\[2\].length: nan is not finite"),
        ('"28400 ksi"', '"28400 s"', "youngs_modulus: '28400 s' is not a stress"),
        ("fillet = 0.4", "fillet = 1.1", "fillet of 1.1 times the step does not fit"),
        (
            'clamp = ["start"]',
            'clamp = ["strat"]',
            "no surface 'strat'; it has start, end, root, B",
        ),
        ('material = "AISI 4340"', 'material = "AISI 430"', "did you mean 'AISI 4340'"),
        ("forces = { B =", "forces = { D =", "no pin has a connection 'D'"),
        ("-988.86]", "-988.86, 0, 0]", "forces.B: list should have at most 3 items"),
        ("-988.86]", "inf]", "forces.B.2.: inf is not finite"),
        ("forces = { B =", "moments = { D =", "case.landing.moments: no pin has a connection 'D'"),
        ("forces = { B = [0.0,", "moments = { B = ['1 N',", r"moments.B.1.: '1 N' is not a moment"),
        ("forces = { B = [0.0, -988.86] }", "moments = {}", "moments names no connection"),
        ("forces = { B = [0.0, -988.86] }", "", "give forces = .*, moments = .* or both, or else"),
        (
            "forces =",
            "table = 't.csv'\nmoments =",
            "give forces = .*, moments = .* or both, or else",
        ),
        ('kind = "given"', 'kind = "motion"', "unknown key 'forces'"),
        ('kind = "given"', 'kind = "gven"', "case.landing.kind: .*'given', 'motion', 'static'"),
        ("tolerance = 0.05", "tolerance = 2", "tolerance: input should be less than 1, not 2"),
        ("[pin.B]", '[pin."a/b"]', "'a/b' cannot be part of a file name"),
        ("title =", "title = = ", "not valid TOML"),
        (
            "fillet = 0.4",
            "fillet = { value = 0.4, provenance = 'guess' }",
            "fillet: provenance must",
        ),
    ],
)
def test_each_mistake_is_told(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in ONE_PIN
    path = write(tmp_path, ONE_PIN.replace(old, new))
    with pytest.raises(InputError, match=message) as caught:
        pin_of(load_study(path), "B")
    assert str(path) in str(caught.value)


def test_moments_go_to_the_pin_with_the_forces(tmp_path: Path) -> None:
    """Stated, or in a table, in the study's units; at a clamped band they are left out."""
    from pinstress.pipeline import prepare

    text = ONE_PIN.replace('name = "root"', 'connection = "R"').replace('["start"]', '["R"]')
    stated = 'forces = { R = [7, 8] }\nmoments = { R = [1, 2, 3], B = ["0 N m", 500.0] }'
    text = text.replace("forces = { B = [0.0, -988.86] }", stated)
    text += '\n[case.table]\nkind = "given"\ntable = "t.csv"\n'
    (tmp_path / "t.csv").write_text("connection,fx,fy,my\nB,0,0,500\nR,7,8,0\n")
    (task,) = prepare(load_study(write(tmp_path, text))).tasks
    assert task.left_out == {"landing": ("R",), "table": ("R",)}
    for loads in task.loads:
        assert loads.surfaces == ("B",)
        assert loads.forces.tolist() == [[[0.0, 0.0, 0.0]]]
        assert loads.moments[0, 0] == pytest.approx([0.0, 500.0 * LBF * INCH, 0.0])


def test_a_beam_check_is_for_forces_alone(tmp_path: Path) -> None:
    from pinstress.pipeline import prepare

    text = ONE_PIN.replace("forces =", "moments = { B = [0, 1] }\nforces =")
    text += '\n[beam_check]\npin = "B"\ncase = "landing"\naxis_bore = 0.1\n'
    with pytest.raises(InputError, match="on one band, by forces alone, to be a cantilever"):
        prepare(load_study(write(tmp_path, text)))


def test_all_mistakes_are_told_at_once(tmp_path: Path) -> None:
    text = ONE_PIN.replace("diameter = 2.0", "diameter = -2.0").replace("0.30", "0.7")
    with pytest.raises(InputError, match="2 errors") as caught:
        load_study(write(tmp_path, text))
    assert "poisson_ratio" in str(caught.value)
    assert "diameter" in str(caught.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"gone\.toml: no such file"):
        load_study(tmp_path / "gone.toml")


GEAR = (
    (ROOT / "studies" / "grenier2008.toml")
    .read_text()
    .replace('"grenier2008/', f'"{ROOT}/studies/grenier2008/')  # its tables, from anywhere
)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('A = "AE" }', 'A = "AF" }', "joint.A.connections.A: no body 'AF'; there are"),
        ('joints = ["H", "G"]', 'joints = ["H", "K"]', "slider.HG.joints: no joint 'K'"),
        ('slider = "HG"', 'slider = "GH"', "no slider 'GH'; there are HG"),
        ('body = "tyre"', 'body = "tire"', "no body 'tire'; did you mean 'tyre'"),
        ('connections = ["G1", "G3"]', 'connections = ["G1", "G4"]', "names connection 'G4'"),
        ('connections = ["G1", "G3"]', 'connections = ["E1", "E2"]', "does not determine them"),
        (
            "value = 41.96,",
            "value = 44.0,",
            r"dead point at HG = 43.2.* in \(wanted: HG = 44 in; drawn",
        ),
        (
            'connections = { B = "BC" }',
            'connections = { BB = "BC" }',
            "'B' is not in the mechanism",
        ),
        (
            'fixed_in = "EBJ"',
            'fixed_in = "EJB"',
            "joint.B.fixed_in: no body 'EJB'; did you mean 'EBJ'",
        ),
        ('pivot = "D"', 'pivot = "C"', "C is not fixed in the ground"),
    ],
)
def test_each_mistake_in_a_mechanism_is_told(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    from pinstress.pipeline import prepare

    assert old in GEAR
    path = write(tmp_path, GEAR.replace(old, new, 1))
    with pytest.raises(InputError, match=message):
        prepare(load_study(path))


def test_without_a_sharing_rule_the_connections_are_named(tmp_path: Path) -> None:
    from pinstress.check import describe
    from pinstress.pipeline import all_loads

    start, end = GEAR.index("[[mechanism.sharing]]"), GEAR.index("[mechanism.joint.A]")
    study = load_study(write(tmp_path, GEAR[:start] + GEAR[end:]))
    for ask in (lambda: all_loads(study, ["landing"]), lambda: describe(study)):
        with pytest.raises(InputError, match="D1, D2, G1, G3 are not determined"):
            ask()
