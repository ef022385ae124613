"""Designs that cannot be solved are found before any is: forces that vary one by one above all."""

from __future__ import annotations

from pathlib import Path

import pytest

import pinstress
from pinbase.keys import key_part
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.in_python import study_from
from tests.support.described import describe
from tests.support.each import each

CLEVIS = """title = "Clevis"
units = "mm-N-s"
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.3
yield_strength = "500 MPa"
[pin.P]
material = "steel"
{balance}
profile = [
  {{ length = 10, diameter = 20, connection = "left" }},
  {{ length = 20, diameter = 20, connection = "middle" }},
  {{ length = 10, diameter = 20, connection = "right" }},
]
[pin.P.lug.left]
[pin.P.lug.middle]
[pin.P.lug.right]
[case.pull]
kind = "given"
forces = {{ {forces} }}
[analysis]
required_safety_factor = 2
tolerance = 0.2
joints = "foundation"
[reliability]
samples = 20
importance_samples = 20
[vary]
sample = "random"
count = 8
[vary.parameters]
"case.pull.forces.left[2]" = {{ normal = [5000, 1000] }}
"case.pull.forces.right[2]" = {{ normal = [5000, 1000] }}
"""
ALL = "left = [0, 5000], middle = [0, -10000], right = [0, 5000]"
OTHERS = "left = [0, 5000], right = [0, 5000]"
HINT = 'name the link that balances the others, as pin.P.balance = "middle"'


def clevis(forces: str = OTHERS, balance: str = 'balance = "middle"') -> str:
    return CLEVIS.format(forces=forces, balance=balance)


def test_the_closing_force_is_minus_the_sum_of_the_others() -> None:
    study = study_from(clevis("left = [100, 5000], right = [0, 4000, 300]"))
    table = pinstress.run(study).tables["reactions"]
    rows = {row["connection"]: row for row in table.records()}
    assert [rows["middle"][key] for key in ("fx", "fy", "fz")] == [-100.0, -9000.0, -300.0]
    stated = study_from(clevis(ALL, ""))
    ours, theirs = (pinstress.run(s).pins[0] for s in (study_from(clevis()), stated))
    assert ours.max_von_mises == theirs.max_von_mises


@pytest.mark.parametrize("command", ["check", "sweep", "reliability"])
def test_forces_that_vary_one_by_one_are_refused_at_once(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "clevis.toml"
    path.write_text(clevis(ALL, ""))
    out = [] if command == "check" else ["--out", str(tmp_path / "out")]
    assert run_command_line([command, str(path), *out]) == 2
    said = capsys.readouterr().err
    assert "designs tried the given forces on pin P in case pull are out of equilibrium" in said
    assert HINT in said
    assert not (tmp_path / "out").exists()


def test_with_the_closing_link_no_design_is_lost() -> None:
    table = pinstress.sweep(study_from(clevis()))
    assert table.num_rows == 8
    assert "failed" not in table["verdict"].to_pylist()
    assert "rigid" not in table["verdict"].to_pylist()


@each(
    ("forces", "balance", "message"),
    [
        (ALL, 'balance = "middle"', "case.pull.forces.middle: follows from the other forces on"),
        (OTHERS, 'balance = "centre"', "pin.P.balance: no connection of the pin 'centre'"),
    ],
)
def test_a_balance_that_contradicts_is_refused(forces: str, balance: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        study_from(clevis(forces, balance))
    assert message in str(caught.value)


def test_a_table_that_states_the_closing_force_is_refused(tmp_path: Path) -> None:
    (tmp_path / "loads.csv").write_text("connection,fx,fy\nleft,0,1\nmiddle,0,-2\nright,0,1\n")
    text = clevis().split("[reliability]")[0].replace(f"forces = {{ {OTHERS} }}",
                                                      'table = "loads.csv"')  # fmt: skip
    with pytest.raises(InputError) as caught:
        pinstress.run(study_from(text, tmp_path))
    assert "connection middle: follows from the other forces on pin P" in str(caught.value)


def test_check_tells_how_many_designs_cannot_be_built() -> None:
    text = clevis().replace("[vary.parameters]", "[vary.parameters]\n"
                            '"pin.P.profile[2].diameter" = { uniform = [16, 24] }')  # fmt: skip
    text = text.replace("profile = [", "fillet = 1.0\nprofile = [")
    _, _, warnings = describe(study_from(text))
    assert any("of 8 designs tried cannot be built: " in line for line in warnings)


@each(
    ("key", "low", "high", "end"),
    [
        ("pin.P.profile[2].diameter", 22.0001, 30.0, None),  # steps of 1 mm and more
        ("pin.P.profile[2].diameter", 21.0, 30.0, "21 mm"),  # of 0.5 mm, below the fillet of 1 mm
        ("pin.P.fillet", 0.5, 6.0, "6 mm"),
        ("pin.P.profile[1].length", 5.0, 20.0, None),
    ],
)
def test_check_tells_which_end_of_a_range_cannot_be_built(
    key: str, low: float, high: float, end: str | None
) -> None:
    """None of the eight random designs need be near it."""
    text = clevis().replace("[vary.parameters]", "[vary.parameters]\n"
                            f'"{key}" = {{ uniform = [{low}, {high}] }}')  # fmt: skip
    text = text.replace("length = 20, diameter = 20", "length = 20, diameter = 24")
    text = text.replace("profile = [", "fillet = 1.0\nprofile = [")
    _, _, warnings = describe(study_from(text))
    at_end = f"vary.parameters.{key_part(key)}: impossible at"
    ends = [line for line in warnings if line.startswith(at_end)]
    assert len(ends) == (end is not None)
    assert all(f"impossible at {end} " in line and "fillet" in line for line in ends)


@each(
    ("varies", "says"),
    [
        ({"profile[2].diameter": (21, 23)}, ['profile[2].diameter": impossible at 21 mm and in ']),
        (  # two ranges, one cause: the fillet against the step
            {"fillet": (0.5, 6), "profile[2].diameter": (21, 30)},
            ['fillet": impossible at 6 mm, "pin.P.profile[2].diameter" at 21 mm and in '],
        ),
        (  # one design may have two causes; numpy's numbers were no input of a study
            {"profile[1].length": (-2, 10), "profile[1].diameter": (-5, 20)},
            [
                'profile[1].length": impossible at -2 mm',
                'profile[1].diameter": impossible at -5 mm',
            ],
        ),
    ],
)
def test_check_tells_each_cause_once(
    varies: dict[str, tuple[float, float]], says: list[str]
) -> None:
    laws = [f'"pin.P.{key}" = {{ uniform = [{a}, {b}] }}\n' for key, (a, b) in varies.items()]
    text = clevis().split("[vary.parameters]")[0] + "[vary.parameters]\n" + "".join(laws)
    text = text.replace("length = 20, diameter = 20", "length = 20, diameter = 24")
    if "fillet" in varies or len(varies) == 1:
        text = text.replace("profile = [", "fillet = 1.0\nprofile = [")
    _, _, warnings = describe(study_from(text))
    assert len(warnings) == len(says), warnings
    for line, begins in zip(warnings, says, strict=True):
        assert line.startswith(f'vary.parameters."pin.P.{begins}'), line
        assert line.count("of 8 designs tried") <= 1
