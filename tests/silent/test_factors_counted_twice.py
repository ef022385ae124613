"""The ultimate and the fitting factor are in margins of safety, and not in the required factor.

docs/mechanisms.md put them into `required_safety_factor`, docs/strength.md into `ultimate_factor`
and `fitting_factor`: a study that followed both had 1.5 in both, and nothing said so.

Independent values: the products on paper, 1.5 x 1.15 = 1.725; 14 CFR 25.303, 25.305 and 25.625.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from pinstress import load_study, run
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import parse_study
from tests.conftest import ROOT

STUDY = """title = "One pin"
units = "mm-N-s"

[material.steel]
youngs_modulus = 210000
poisson_ratio = 0.3
yield_strength = 355

[analysis]
model = "beam"
tolerance = 0.5
{}

[case.pull]
kind = "given"
forces = {{ L = [0, 1000] }}

[pin.A]
material = "steel"
clamp = ["start"]
profile = [{{ length = 40, diameter = 25 }}, {{ length = 20, diameter = 25, connection = "L" }}]
"""
NOTED = 'required_safety_factor = {{ value = {}, provenance = "given", note = "{}" }}'


def warned(*keys: str) -> tuple[str, ...]:
    return parse_study(Path("s.toml"), STUDY.format("\n".join(keys))).warnings


@pytest.mark.parametrize(
    ("required", "stated", "product", "contained"),
    [
        (1.5, ["ultimate_factor = 1.5"], "ultimate_factor 1.5", "ultimate_factor"),
        (2, ["ultimate_factor = 2"], "ultimate_factor 2", "ultimate_factor"),
        (1.15, ["fitting_factor = 1.15"], "fitting_factor 1.15", "fitting_factor"),
        (
            1.725,
            ["ultimate_factor = 1.5", "fitting_factor = 1.15"],
            "ultimate_factor 1.5 times fitting_factor 1.15",
            "ultimate_factor and fitting_factor",
        ),
        (
            1.725,
            ["fitting_factor = 1.15"],
            "ultimate_factor 1.5 times fitting_factor 1.15",
            "ultimate_factor and fitting_factor",
        ),
        (1.725, ["ultimate_factor = 1.5"], "ultimate_factor 1.5 times 1.15", "ultimate_factor"),
        (1.2, ["limit_factor = 1.2"], "limit_factor 1.2", "limit_factor"),
    ],
)
def test_a_required_factor_that_margins_have_already(
    required: float, stated: list[str], product: str, contained: str
) -> None:
    (told,) = warned(f"required_safety_factor = {required}", *stated)
    assert told == (
        f"s.toml:12: analysis.required_safety_factor: {required} is {product}, and the margins of "
        f"safety already contain {contained}; the required factor compares yield with the stress "
        "under the loads of the study as they are (1: no yielding at limit load); if it is another "
        "factor, say in its note where it comes from"
    )


@pytest.mark.parametrize(
    "keys",
    [
        ["required_safety_factor = 1", "ultimate_factor = 1.5", "fitting_factor = 1.15"],
        ["required_safety_factor = 1.5"],  # of a machine; the other one is a default
        ["required_safety_factor = 1.5", "fitting_factor = 1.15"],
        ["required_safety_factor = 1.15"],
        ["required_safety_factor = 3", "ultimate_factor = 1.5"],
        ["required_safety_factor = 1.5", "ultimate_factor = 1", "fitting_factor = 1"],
        ["ultimate_factor = 1.5", "fitting_factor = 1.15"],
        [NOTED.format(1.5, "rule of the works on yield"), "ultimate_factor = 1.5"],
        [NOTED.format(1.5, "loads are ultimate loads"), "ultimate_factor = 1"],
        [NOTED.format(3, "of the ultimate strength")],
    ],
)
def test_what_is_no_second_count_is_not_asked_about(keys: list[str]) -> None:
    assert warned(*keys) == ()


@pytest.mark.parametrize(
    ("required", "note"),
    [(1.5, "ultimate factor, 14 CFR 25.303"), (2.25, "14 CFR 23.303 and another 1.5")],
)
def test_a_note_that_names_the_factor(required: float, note: str) -> None:
    """Then also the default of 1.5 is a second one."""
    (told,) = warned(NOTED.format(required, note))
    said = f"{required} contains ultimate_factor 1.5 by its note, and the margins of safety already"
    assert f"required_safety_factor: {said} contain ultimate_factor; " in told


def test_both_are_named() -> None:
    note = "ultimate factor and fitting factor"
    (told,) = warned(NOTED.format(1.725, note), "fitting_factor = 1.15")
    assert "1.725 contains ultimate_factor 1.5 times fitting_factor 1.15 by its note" in told


@pytest.mark.parametrize("command", ["check", "run"])
def test_commands_and_results_say_it(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    command: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("s.toml").write_text(STUDY.format("required_safety_factor = 1.5\nultimate_factor = 1.5"))
    more = ["--quiet"] if command == "run" else []
    assert run_command_line([command, "s.toml", *more]) in (0, 1)
    out, said = capsys.readouterr()
    assert said.startswith("Warning: s.toml:12: analysis.required_safety_factor: 1.5 is ultimate_")
    assert said.count("Warning") == 1
    assert "Warning" not in out
    found = run(load_study(Path("s.toml")))
    last = found.assumptions[-1]
    assert last.startswith("Possible mistake: analysis.required_safety_factor: 1.5 is")


def test_no_shipped_study_counts_twice() -> None:
    studies = sorted((ROOT / "studies").glob("*.toml"))
    assert len(studies) > 10
    for path in studies:
        assert not [x for x in load_study(path).warnings if "required_safety_factor" in x], path
