"""A pin's weight that is stated twice, by a number and by its shape."""

from __future__ import annotations

from pathlib import Path

from click.testing import CliRunner

from pinstress.cli.commands import commands
from pinstress.study.model.weights import weight_warnings
from pinstress.study.reading.file import load_study
from pinstress.study.reading.shipped import shipped
from tests.support.each import each

STUDIES = shipped("one_pin.toml").parent
GEAR = (STUDIES / "grenier2008.toml").read_text(encoding="utf-8")
STATED = "weight = { value = 14.159421669136941,"


def gear(tmp_path: Path, stated: str) -> Path:
    assert STATED in GEAR
    path = tmp_path / "study.toml"
    text = GEAR.replace(STATED, f"weight = {{ value = {stated},")
    path.write_text(text.replace('"grenier2008/', f'"{STUDIES}/grenier2008/'), encoding="utf-8")
    return path


@each("study", sorted(p.name for p in STUDIES.glob("*.toml")))
def test_the_shipped_studies_do_not_contradict_themselves(study: str) -> None:
    assert weight_warnings(load_study(STUDIES / study)) == []


@each(("stated", "warned"), [("14.4", 0), ("14.5", 1), ("13.8", 1), ("14", 0)])
def test_two_hundredths_apart_is_told(tmp_path: Path, stated: str, warned: int) -> None:
    """The profile of pin E weighs 14.17 lbf."""
    assert len(weight_warnings(load_study(gear(tmp_path, stated)))) == warned


@each("command", ["check", "loads"])
def test_both_weights_are_named_on_stderr(tmp_path: Path, command: str) -> None:
    path = gear(tmp_path, "28.32")
    more = ["--out", str(tmp_path / "out")] if command == "loads" else []
    found = CliRunner().invoke(commands, [command, str(path), *more], catch_exceptions=False)
    assert "Warning" not in found.stdout
    line = next(i for i, x in enumerate(path.read_text().splitlines(), 1) if "= 28.32" in x)
    assert f"Warning: {path}:{line}: mechanism.joint.E.weight: 28.32 lbf is stated" in found.stderr
    assert "give 14.17 lbf; the stated weight is used" in found.stderr


def test_a_run_says_so_too(tmp_path: Path) -> None:
    arguments = ["run", str(gear(tmp_path, "28.32")), "--out", str(tmp_path / "out")]
    arguments += ["--pins", "A", "--cases", "landing", "--model", "beam"]
    found = CliRunner().invoke(commands, arguments, catch_exceptions=False)
    assert "mechanism.joint.E.weight: 28.32 lbf is stated" in found.stderr


def test_a_weight_that_nothing_uses_is_told(tmp_path: Path) -> None:
    path = tmp_path / "bar.toml"
    path.write_text(
        """
title = "Pendulum"
units = "m-N-s"
[case.hold]
kind = "static"
[mechanism.drive]
body = "bar"
line = ["O", "P"]
law = "constant"
start = "0 deg"
end = "10 deg"
duration = 1
[mechanism.joint.O]
at = [0, 0]
fixed_in = "ground"
weight = 3
connections = { O = "bar" }
[mechanism.joint.P]
at = [1, 0]
fixed_in = "bar"
connections = { P = "load" }
[mechanism.body.bar]
mass = 1
inertia = 1
[mechanism.body.load]
mass = 1
""",
        encoding="utf-8",
    )
    (warning,) = weight_warnings(load_study(path))
    assert "mechanism.joint.O.weight: pin O is fixed in ground" in warning
    assert "not used" in warning


@each(("gravity", "warned"), [(386.0886, 0), (380, 0), (0, 0), (772.2, 1)])
def test_weights_that_a_load_factor_in_gravity_does_not_change_are_told(
    tmp_path: Path, gravity: float, warned: int
) -> None:
    """Masses would weigh twice as much in twice the gravity."""
    path = tmp_path / "study.toml"
    text = GEAR.replace('"grenier2008/', f'"{STUDIES}/grenier2008/')
    assert "[0, -386.0886]" in text
    path.write_text(text.replace("[0, -386.0886]", f"[0, -{gravity}]"), encoding="utf-8")
    found = [one for one in weight_warnings(load_study(path)) if "mechanism.gravity" in one]
    assert len(found) == warned
    assert all("it is 2 times the standard one" in one for one in found)
