"""Keys that have no effect in a study have a warning: they are never left out in silence."""

from __future__ import annotations

from pinstress import study_from
from tests.conftest import ROOT
from tests.support.each import each

STUDY = """title = "Clamped pin"
units = "mm-N-s"
DEFAULTS
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.3
thermal_expansion = "12e-6 1/K"
[pin.P]
material = "steel"
PIN
profile = [
  { length = 10, diameter = 20, name = "head" },
  { length = 20, diameter = 20, connection = "L" },
]
[case.pull]
kind = "given"
forces = { L = [0, 0] }
CASE
[analysis]
ANALYSIS
"""
CLAMP, PRESCRIBED = 'clamp = ["start"]', 'joints = "prescribed"'
DEFAULTS, HOT = "lug_defaults = { outer_diameter = 50 }", 'temperature = "80 degC"'
SEATED = 'lug.L = { axial = "head" }'


def text(pin: str = "", defaults: str = "", case: str = "", analysis: str = "") -> str:
    filled = STUDY.replace("DEFAULTS", defaults).replace("PIN", pin).replace("CASE", case)
    return filled.replace("ANALYSIS", analysis)


@each(
    ("pin", "defaults", "key"),
    [
        ("bending_factor = 1.5", "", "pin.P.bending_factor"),
        ("lug.L.factors.K = 1.4", "", "pin.P.lug.L.factors"),
        ("", "lug_defaults.factors.K = 1.4", "lug_defaults.factors"),
    ],
)
def test_factors_without_the_code_that_has_them(pin: str, defaults: str, key: str) -> None:
    for code in ('"aircraft"', '["general", "aircraft"]'):
        assert not study_from(text(pin, defaults, analysis=f"code = {code}")).warnings
    for analysis in ("", 'code = "lifting"\ndesign_factor = 2'):
        (warning,) = study_from(text(pin, defaults, analysis=analysis)).warnings
        assert f"{key}: has no effect" in warning


def test_a_design_factor_without_the_code_that_has_it() -> None:
    (warning,) = study_from(text(analysis="design_factor = 2")).warnings
    assert "analysis.design_factor: has no effect" in warning
    assert not study_from(text(analysis='design_factor = 2\ncode = "lifting"')).warnings


def test_the_way_of_aisc_without_its_code() -> None:
    (warning,) = study_from(text(analysis='aisc = "ASD"')).warnings
    assert "analysis.aisc: has no effect" in warning
    assert not study_from(text(analysis='aisc = "ASD"\ncode = "civil"')).warnings


def test_partial_factors_without_a_check_of_en_1993() -> None:
    stated = "partial_factors = { M0 = 1.1 }\n"
    (warning,) = study_from(text(analysis=f'{stated}code = "aircraft"')).warnings
    assert "analysis.partial_factors: has no effect" in warning
    for code in ("general", "civil"):
        assert not study_from(text(analysis=f'{stated}code = "{code}"')).warnings


@each(
    ("pin", "defaults", "case", "analysis", "key"),
    [
        (CLAMP, DEFAULTS, "", "", "lug_defaults"),
        ("", DEFAULTS, "", "", ""),
        ("lug.L = {}", "", HOT, "", ""),
        ("lug.L = {}", "", HOT, PRESCRIBED, ""),  # whose checks take the fit
        (CLAMP, "", HOT, "", "case.pull.temperature"),
        (SEATED, "", "", PRESCRIBED, "pin.P.lug.L.axial"),
        (SEATED, "", "", "", ""),
    ],
)
def test_keys_without_effect_have_a_warning(
    pin: str, defaults: str, case: str, analysis: str, key: str
) -> None:
    warnings = study_from(text(pin, defaults, case, analysis)).warnings
    assert ["has no effect" in x for x in warnings] == [True] * bool(key)
    assert all(f": {key}: has" in x for x in warnings)


def test_a_clearance_outside_of_its_range_has_a_warning() -> None:
    for clearance, contradicts in ((0.02, True), (0.05, False)):
        lug = f"lug.L = {{ clearance = {clearance}, range = {{ clearance = [0.03, 0.06] }} }}"
        warned = [x for x in study_from(text(lug)).warnings if "L.clearance: is not within" in x]
        assert len(warned) == contradicts


def test_an_axial_of_all_lugs_is_told_once() -> None:
    """One of a lug itself is told beside it."""
    two = text('lug.M = { axial = "L" }', 'lug_defaults = { axial = "head" }', "", PRESCRIBED)
    band = '  { length = 20, diameter = 20, connection = "L" },\n'
    two = two.replace(band, band + band.replace('"L"', '"M"') + band.replace('"L"', '"N"'))
    two = two.replace("{ L = [0, 0] }", "{ L = [0, 0], M = [0, 0], N = [0, 0] }")
    told = [warning.split(": ")[1] for warning in study_from(two).warnings]
    assert told == ["lug_defaults.axial", "pin.P.lug.M.axial"]


@each(
    ("profile", "told"),
    [
        ("{ length = 9, diameter = 20, fillet = 1 }", 1),
        ("{ length = 9, diameter = 25, fillet = 1 }", 0),
        ("{ length = 9, diameter = 20, fillet = 0 }", 0),
        ("{ length = 9, diameter = [15, 20], fillet = 1 }", 0),
        ("{ length = 9, diameter = 25 }, { length = 9, diameter = 20, fillet = 1 }", 2),
    ],
)
def test_a_fillet_without_a_corner(profile: str, told: int) -> None:
    """The radius of the segment behind a step was taken for that of the step, which was sharp."""
    head = '{ length = 10, diameter = 20, name = "head" }'
    warnings = study_from(text().replace(head, profile)).warnings
    assert len(warnings) == bool(told)
    assert all(f"profile[{told}].fillet: has no effect" in warning for warning in warnings)


def test_a_fillet_at_the_end() -> None:
    (warning,) = study_from(text().replace('"L" }', '"L", fillet = 2 }')).warnings
    assert "profile[2].fillet: has no effect" in warning


def test_a_reference_temperature_without_a_temperature() -> None:
    reference = 'reference_temperature = "60 degC"'
    (warning,) = study_from(text(analysis=reference)).warnings
    assert "analysis.reference_temperature: has no effect" in warning
    hot = study_from(text("", DEFAULTS, HOT, reference)).warnings
    assert not any("reference_temperature" in warning for warning in hot)


DROP = (ROOT / "studies" / "drop.toml").read_text(encoding="utf-8")
AT = 'at = { value = [80, 18000], provenance = "assumed" }'
STIFFNESS = 'stiffness = { value = "600 N/mm", provenance = "assumed" }\n'


@each(
    ("old", "new", "key", "says"),
    [
        ('body = "arm"', 'velocity = "2 m/s"\nbody = "arm"', "velocity", "2000 mm/s is less"),
        ('body = "arm"', 'lift = 0.9\nbody = "arm"', "lift", "0.9 of the weight is more"),
        ('rule = "23.473"', 'rule = "25.473-landing-weight"', "wing_loading", "has no effect"),
        (AT, "deflection = [0, 80]\nforce = [0, 18000]", "tyre.exponent", "has no effect"),
        (STIFFNESS, "", "wheel.damping", "has no effect"),
    ],
)  # fmt: skip
def test_keys_of_a_drop_that_contradict_others(old: str, new: str, key: str, says: str) -> None:
    """A drop of 2 m/s was cited as one by the rule of 7 ft/s or more."""
    assert DROP.count(old) >= 1
    assert not study_from(DROP, ROOT / "studies").warnings
    (warning,) = study_from(DROP.replace(old, new, 1), ROOT / "studies").warnings
    assert f"case.landing.{key}: {says}" in warning


@each(
    ("sample", "steps", "key"),
    [
        ('sample = "grid"\ncount = 1000', ", steps = 2", "vary.count"),
        ('sample = "sobol"', ", steps = 2", 'vary.parameters."pin.P.profile[1].length".steps'),
        ('sample = "sobol"\ncount = 8', "", ""),
        ('sample = "grid"', ", steps = 2", ""),
    ],
)
def test_keys_of_another_sample(sample: str, steps: str, key: str) -> None:
    parameter = f'"pin.P.profile[1].length" = {{ from = 1, to = 2{steps} }}'
    study = study_from(f"{text()}\n[vary]\n{sample}\n[vary.parameters]\n{parameter}\n")
    told = [f"{key}: has no effect" in warning for warning in study.warnings]
    assert told == [True] * bool(key)


@each(
    ("part", "key"),
    [
        ("[mechanism.spring.s]\nreference = 3\nENDS", "spring.s"),
        ("[mechanism.spring.s]\nreference = 3\npreload = 5\nENDS", "spring.s.reference"),
        ("[mechanism.spring.s]\npreload = 5\nENDS", ""),
        ("[mechanism.spring.s]\nstiffness = 2\nreference = 3\nENDS", ""),
        ("[mechanism.torsion_spring.s]\nTURN", "torsion_spring.s"),
        ("[mechanism.stop.s]\nTURN", "stop.s"),
        ("[mechanism.stop.s]\nTURN\n[case.rest]\nhold = ['s']", ""),
    ],
)
def test_springs_and_stops_without_effect_have_a_warning(part: str, key: str) -> None:
    """In the plane and in space alike."""
    for dimension, zero, turn in (
        (2, "0", 'bodies = ["ground", "arm"]'),
        (3, "0, 0", 'joint = "O"'),
    ):
        axis = "axis = [0, 0, 1]\n" if dimension == 3 else ""
        ends = f'bodies = ["ground", "arm"]\njoints = [[5, {zero}], "O"]'
        inertia = (
            'inertia = ["1 kg m^2", "1 kg m^2", "1 kg m^2"]' if axis else 'inertia = "1 kg m^2"'
        )
        told = study_from(
            'title = "Arm"\nunits = "mm-N-s"\n'
            f"[mechanism]\ndimension = {dimension}\n[mechanism.joint.O]\nat = [0, {zero}]\n{axis}"
            'fixed_in = "ground"\nconnections = { o = "arm" }\n[mechanism.body.arm]\n'
            f'mass = "1 kg"\ncentre = [9, {zero}]\n{inertia}\n'
            + part.replace("ENDS", ends).replace("TURN", turn)
            + ("" if "[case.rest]" in part else "\n[case.rest]")
            + "\nkind = 'static'\n"
        ).warnings
        assert [x.split(": ")[1] for x in told] == [f"mechanism.{key}"] * bool(key)
