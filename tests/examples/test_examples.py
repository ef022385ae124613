"""The scripts of examples/ run as a reader runs them, and print what is true."""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

import meshio
import numpy as np
import pytest
from scipy.optimize import brentq

from tests.conftest import ROOT
from tests.support.each import each
from tests.support.mechanism import pump_jack

SCRIPTS = sorted((ROOT / "examples").glob("*.py"))
QUICK = "one_pin", "own_mechanism"
# What they call is called by other tests, too: models by rung, corners, ranges of a landing.
LONG = "speed_accuracy", "intervals", "landing_range"
MOST_LINES = 40
HANGS = 300  # seconds; they take a few


class Printed(str):
    """What a script printed."""

    def numbers(self, pattern: str) -> list[float]:
        """Of the one line that has `pattern`, the numbers after it."""
        (line,) = (line for line in self.splitlines() if re.search(pattern, line))
        rest = re.split(pattern, line, maxsplit=1)[1]
        return [float(n.replace(",", "")) for n in re.findall(r"-?\d[\d,]*\.?\d*", rest)]

    def rows(self, pattern: str) -> list[list[str]]:
        """The groups of `pattern` wherever it is found."""
        return [list(found.groups()) for found in re.finditer(pattern, self, re.MULTILINE)]


def bending(moment: float, diameter: float) -> float:
    """M c / I of a solid round section."""
    return float(32.0 * moment / (np.pi * diameter**3))


def one_pin(out: Printed, _: Path) -> None:
    """Within its error of 1,878.9 psi, from seven meshes to 0.05 %; the arm is from the shoulder
    to the middle of what the fillet leaves of the band.
    """
    stress, error = out.numbers("largest von Mises stress")
    assert abs(stress - 1878.9) <= error <= 0.01 * stress
    assert out.numbers("factor of safety")[0] == pytest.approx(225e3 / stress, rel=1e-3)
    assert "required                  10, met: True" in out
    assert out.numbers("hand check: bending  ")[0] == pytest.approx(
        bending(988.86 * 1.2, 2.0), abs=0.5
    )


def clevis(out: Printed, _: Path) -> None:
    """Each half a beam: 10 kN on an arm's middle, 20 mm from the eye's, whose own half acts 6 mm
    from it; the stress of finite elements is that of the beam to 3 %.
    """
    by_hand = bending(10e3 * (6 + 2 + 12) - 10e3 * 6, 20.0)
    assert out.numbers("bending at eye:")[0] == pytest.approx(by_hand, abs=0.05)
    assert out.numbers("finite elements:")[0] == pytest.approx(by_hand, rel=0.03)
    double_shear = 20e3 / (2 * np.pi * 20.0**2 / 4)
    assert out.numbers("double shear, mean at eye:")[0] == pytest.approx(double_shear, abs=0.05)
    assert "(converged)" in out


def excavator_bucket(out: Printed, _: Path) -> None:
    """At the start nothing accelerates: the machine carries the weights and the digging force."""
    bars = 7850 * 0.6 * (0.12 * 0.06 + 0.14 * 0.08)
    weight = (1400 + 700 + 650 + 220 + 130 + 140 + 80 + 95 + 55 + bars) * 9.80665 / 1000
    forward, down = out.numbers("at the start with")
    assert forward == pytest.approx(40.0, abs=0.005)
    assert down == pytest.approx(weight + 20.0, abs=0.005)
    force, when = out.numbers("^  K ")
    # 88.59 MPa on six meshes, to 0.1 %; a beam clamped at both ends times the fillets' notch factor
    stress, then = out.numbers("pin K:(?! factor)")
    assert stress == pytest.approx(88.59, rel=0.02)
    assert 1.2 < stress / bending(force * 1000 * 260 / 12, 90.0) < 1.7
    assert when == then == 9.0
    assert out.numbers("pin K: factor") == pytest.approx([650 / stress, 2.0], abs=0.01)


def many_load_cases(out: Printed, _: Path) -> None:
    """The pin is round, so the stress is as the size of the force, whatever its direction."""
    force = {"take-off": 9.0, "climb": 6.5, "gust": 14.2, "approach": 11.0, "go-around": 12.4}
    part = {0: 0.55, 10: 0.7, 25: 0.9, 40: 1.0}
    sizes = {f"{name} {k}": f * p for name, f in force.items() for k, p in part.items()}
    stress = {name: float(x) for name, x in out.rows(r"^(\S+ \d+) +([\d.]+) MPa  factor +[\d.]+$")}
    assert list(stress) == sorted(sizes, key=lambda name: -sizes[name])
    assert stress["gust 40"] == pytest.approx(251.6, rel=0.01)  # seven meshes, to 0.04 %
    per_force = stress["gust 40"] / 14.2
    assert stress == pytest.approx({n: per_force * f for n, f in sizes.items()}, abs=0.06)
    assert f"worst of 20: gust 40, factor {900 / stress['gust 40']:.2f}" in out


def diameter_sweep(out: Printed, _: Path) -> None:
    """M c / I in the middle of the axle; a slender one differs less."""
    moment = 9000 * (10 + 90 + 30) - 9000 * 15
    found = {float(d): float(factor) for d, factor in out.rows(r"^ +(\d+) mm +([\d.]+)$")}
    assert list(found) == [30, 40, 50, 60, 70]
    for diameter, factor in found.items():
        assert factor == pytest.approx(335 / bending(moment, diameter), rel=0.02), diameter


def own_mechanism(out: Printed, _: Path) -> None:
    """Newton and Euler, body by body."""
    forces, torque = pump_jack.forces(np.linspace(0.0, 5.0, 361))
    for name, sizes in forces.items():
        largest, when = out.numbers(f"joint {name} *:")
        assert largest == pytest.approx(sizes.max(), abs=0.6), name
        assert when == pytest.approx(5.0 * sizes.argmax() / 360, abs=0.006), name
    least, most = out.numbers("torque of the crank:")
    assert (least, most) == pytest.approx((torque.min(), torque.max()), abs=0.6)


def paraview_fields(out: Printed, folder: Path) -> None:
    """Another library reads the file; what is hottest lies on the fillet, in the bending plane."""
    mesh = meshio.read(folder / "pin_B.vtu")
    (points,) = out.numbers(r"^pin_B\.vtu:")[:1]
    stress = mesh.point_data["von Mises [psi]"]
    assert len(mesh.points) == len(stress) == points
    assert stress.max() == pytest.approx(1878.9, rel=0.01)
    assert mesh.point_data["factor of safety"].min() == pytest.approx(225e3 / stress.max())
    x, y, z = mesh.points[stress.argmax()]
    assert x == pytest.approx(0.0, abs=1e-6)
    assert (z - 1.9) ** 2 + (abs(y) - 1.4) ** 2 == pytest.approx(0.4**2, rel=1e-3)
    printed = [float(v) for row in out.rows("x = (.+), y = (.+), z = (.+) in$") for v in row]
    assert printed == pytest.approx([x, y, z], abs=0.006)
    # ends, cylinders and the face of the shoulder less the fillet, and the quarter torus
    area = np.pi * (2.0**2 + 1.0**2 + 4.0 * 1.5 + 2.0 * 1.6 + 2.0**2 - 1.4**2)
    torus = 2 * np.pi * 0.4 * (1.4 * np.pi / 2 - 0.4)
    assert out.numbers("^[0-9.]+ of")[0] == pytest.approx(area + torus, rel=3e-3)


def speed_accuracy(out: Printed, _: Path) -> None:
    """The solid model says 1,904.9 ± 96.7 psi at 160,191 unknowns; the section has less error with
    a fiftieth of them.
    """
    reference, known = out.numbers("^reference")
    assert reference == pytest.approx(1904.9, abs=96.7)
    assert known <= 0.1
    ((beam,),) = out.rows(r"^beam +\d+ +\d+ +([-+.\d]+)%$")
    assert 2.0 < abs(float(beam)) < 15.0
    rows = out.rows(r"^harmonic +([\d,]+) +\d+ +([-+.\d]+)%$")
    unknowns = [int(n.replace(",", "")) for n, _ in rows]
    assert unknowns == sorted(unknowns)
    assert len(unknowns) >= 3
    assert max(abs(float(error)) for _, error in rows) < 0.3


def intervals(out: Printed, _: Path) -> None:
    """At a corner of 270 degrees stress grows as d^-s, sin((1 - s) w) = -(1 - s) sin(w) (Williams
    1952), and the notch stress intensity is sqrt(2 pi) times the hoop stress on the bisector. Along
    the free side there is radial stress alone, in plane strain.
    """
    w = 1.5 * np.pi
    size = brentq(lambda x: np.sin(x * w) + x * np.sin(w), 0.5, 0.6)
    measured, theory = out.numbers("grows as distance")
    assert -theory == pytest.approx(1.0 - size, abs=5e-4)
    assert measured == pytest.approx(theory, abs=0.02)
    half = w / 2
    share = -np.cos((size + 1) * half) / np.cos((size - 1) * half)
    hoop = size * (size + 1) * (1 + share)
    bend = -((size + 1) ** 2) * np.cos((size + 1) * half)
    bend -= share * (size - 1) ** 2 * np.cos((size - 1) * half)
    side = abs(bend) * np.sqrt(1 - 0.3 + 0.3**2)
    ((strength,),) = out.rows(r"^  ([\d.]+) psi \* \(distance")
    wanted = float(strength) * np.sqrt(2 * np.pi) * hoop / side
    assert out.numbers("notch stress intensity")[0] == pytest.approx(wanted, rel=1e-3)
    ((value,),) = out.rows(r"^  ([\d.]+) psi farther away")
    ((low, high),) = out.rows(r"^  ([\d.]+) to ([\d.]+) psi over twice")
    assert float(low) <= float(value) < float(high)  # the section at the step has that much
    fillets = out.rows(r"^fillet ([\d.]+): (\d+) ± (\d+) psi, converged$")
    stress = [float(s) for _, s, _ in fillets]
    assert len(stress) == 4
    assert stress == sorted(stress, reverse=True)
    assert abs(stress[-1] - 1878.9) <= float(fillets[-1][2])
    # a small fillet's stress is as its radius to the same power, nearly
    assert np.log2(stress[0] / stress[1]) == pytest.approx(1.0 - size, abs=0.06)


def landing_range(out: Printed, _: Path) -> None:
    """37,500 lbf stopped: the force is mass times speed over time, and factors are as one over it,
    but for the weight of the gear itself. Of the study's own landing they are those of goal =
    "value".
    """
    mass, times = 37500 / 32.2, np.array([0.1, 0.125, 0.15, 0.175, 0.2])
    assert out.numbers("^landing force") == pytest.approx([mass * 50, mass * 250], abs=0.6)
    refined = {"A": 1.997, "B": 81.40, "H": 20.43}
    for pin, table in zip(refined, out.split("\npin ")[1::2], strict=True):
        rows = Printed(table).rows(r"^ +(\d+) ft/s +(.+)$")
        speeds = np.array([float(speed) for speed, _ in rows])
        factors = np.array([[float(n) for n in row.split()] for _, row in rows])
        assert list(speeds) == [10, 15, 20, 25]
        assert factors[-1, 2] == pytest.approx(refined[pin], rel=0.02), pin
        scaled = factors * mass * speeds[:, None] / times
        assert scaled == pytest.approx(np.full((4, 5), scaled[-1, 2]), rel=0.02), pin
        assert f"pin {pin} yields in {(factors < 1.0).sum()} of 20 landings" in out


CHECKS = {
    check.__name__: check
    for check in (
        one_pin,
        clevis,
        excavator_bucket,
        many_load_cases,
        diameter_sweep,
        own_mechanism,
        paraview_fields,
        speed_accuracy,
        intervals,
        landing_range,
    )
}


def in_a_process(script: Path, folder: Path) -> str:
    """What it prints as a reader starts it."""
    done = subprocess.run(
        [sys.executable, str(script)],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        timeout=HANGS,
        env=os.environ | {"PYTHONIOENCODING": "utf-8"},
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def here(script: Path, folder: Path) -> str:
    """What it prints in this process, which has imported what it takes seconds to import."""
    with chdir(folder), redirect_stdout(StringIO()) as out, redirect_stderr(StringIO()) as err:
        runpy.run_path(str(script), run_name="__main__")
    assert err.getvalue() == ""
    return out.getvalue()


def test_every_example_has_a_check() -> None:
    assert {script.stem for script in SCRIPTS} == set(CHECKS)


@pytest.mark.parametrize(
    "script",
    [
        pytest.param(
            script,
            marks=[pytest.mark.slow] * (script.stem not in QUICK)
            + [pytest.mark.long] * (script.stem in LONG),
        )
        for script in SCRIPTS
    ],
    ids=lambda script: script.stem,
)
def test_an_example_prints_what_is_true(script: Path, tmp_path: Path) -> None:
    assert len(script.read_text(encoding="utf-8").splitlines()) <= MOST_LINES
    printed = in_a_process(script, tmp_path) if script.stem == "one_pin" else here(script, tmp_path)
    written = [file.name for file in tmp_path.iterdir()]
    assert written == (["pin_B.vtu"] if script.stem == "paraview_fields" else [])
    CHECKS[script.stem](Printed(printed), tmp_path)


@each("script", SCRIPTS)
def test_the_documentation_shows_every_example(script: Path) -> None:
    page = (ROOT / "docs" / "examples.md").read_text(encoding="utf-8")
    assert f"{{literalinclude}} ../examples/{script.name}\n" in page
    assert f"\n## {script.name}\n\n" in page
