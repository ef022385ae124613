"""Joints as they are built: each is answered, or refused with its reason.

A joint that was refused without need, or with a wrong reason, says so.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

import pinstress
from pinstress.cli.check import examine
from pinstress.study.reading.errors import InputError
from tests.support.each import each, sampled

HEAD = """
title = "A joint of practice"
units = "mm-N-s"
[material.C45]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "430 MPa"
[material.bronze]
youngs_modulus = "110 GPa"
poisson_ratio = 0.34
yield_strength = "200 MPa"
[analysis]
tolerance = 0.3
limit_load = "never"
[pin.P]
material = "C45"
"""
# Segments of a length, a diameter and what is there: FORK and its other ear, or a link.
FORK = """profile = [
  {{ length = 12, diameter = 30, connection = "A"{bore} }},
  {{ length = 1, diameter = 30{bore} }},
  {{ length = 24, diameter = 30, connection = "B"{bore} }},
  {{ length = 1, diameter = 30 }},
  {{ length = 12, diameter = 30, name = "A2", ear_of = "A" }},
]
lug.B = {{ clearance = 0.03 }}
"""
CLEVIS = FORK.format(bore="")
SHAFT = """profile = [
  { length = 30, diameter = 40, connection = "A" },
  { length = 40, diameter = 40 },
  { length = 30, diameter = 40, connection = "B" },
]
"""
PULL = """
[case.pull]
kind = "given"
forces = { A = [0, -20000], B = [0, 20000] }
"""
TURN = """
[case.turn]
kind = "given"
moments = { A = [0, 0, "400 N m"], B = [0, 0, "-400 N m"] }
"""


@dataclass(frozen=True)
class Joint:
    """A pin and its case. model: which answers it. refused: the reason, if it is."""

    pin: str
    model: str = "harmonic"
    refused: str = ""


JOINTS = {
    "clevis with bushings": Joint(
        CLEVIS.replace("lug.B", 'lug.A.bushing = { thickness = 3, material = "bronze" }\nlug.B')
        + PULL
    ),
    "hinge of three plates, pin with a head": Joint(
        """fillet = 1
profile = [
  { length = 5, diameter = 22 },
  { length = 8, diameter = 16, connection = "A" },
  { length = 0.5, diameter = 16 },
  { length = 10, diameter = 16, connection = "B" },
  { length = 0.5, diameter = 16 },
  { length = 8, diameter = 16, connection = "C" },
  { length = 4, diameter = 16 },
]
lug.A = { clearance = 0.05 }
[case.pull]
kind = "given"
forces = { A = [0, -6000], B = [0, 12000], C = [0, -6000] }
"""
    ),
    "groove of a retaining ring, and a hole for a cotter": Joint(
        """fillet = 0.1
profile = [
  { length = 4, diameter = 20 },
  { length = 1.3, diameter = 18 },
  { length = 2, diameter = 20 },
  { length = 10, diameter = 20, connection = "A" },
  { length = 1, diameter = 20 },
  { length = 20, diameter = 20, connection = "B" },
  { length = 1, diameter = 20 },
  { length = 10, diameter = 20, name = "A2", ear_of = "A" },
  { length = 10, diameter = 20 },
]
hole = [{ z = 54.3, diameter = 4 }]
lug.A = { clearance = 0.04 }
"""
        + PULL,
        "harmonic+local",
    ),
    "two diameters in lugs": Joint(
        """fillet = 1
profile = [
  { length = 15, diameter = 30, connection = "A" },
  { length = 2, diameter = 30 },
  { length = 20, diameter = 25, connection = "B" },
  { length = 2, diameter = 25 },
  { length = 12, diameter = 20, connection = "C" },
]
lug.A = {}
[case.pull]
kind = "given"
forces = { A = [0, -10000], B = [0, 20000], C = [0, -10000] }
"""
    ),
    "hollow pin with a hole for oil under its lug": Joint(
        FORK.format(bore=", bore = 6")
        + 'hole = [{ z = 25, diameter = 4, depth = 13, angle = "90 deg" }]'
        + PULL,
        "harmonic+local",
    ),
    "grease passage on the axis": Joint(  # "offset: is missing"
        CLEVIS
        + "passage = [{ depth = 26, diameter = 5 }]\nhole = [{ z = 25, diameter = 4, depth = 15 }]"
        + PULL,
        "harmonic+local",
    ),
    "head and thread, pulled along": Joint(
        """fillet = 0.3
profile = [
  { length = 8, diameter = 30, name = "head" },
  { length = 12, diameter = 20, connection = "A" },
  { length = 1, diameter = 20 },
  { length = 20, diameter = 20, connection = "B" },
  { length = 1, diameter = 20 },
  { length = 12, diameter = 20, connection = "C" },
  { length = 3, diameter = 16 },
  { length = 14, diameter = 16.93, name = "thread" },
]
lug.A.axial = ["head", "thread"]
[case.pull]
kind = "given"
forces = { A = [0, -10000, -500], B = [0, 20000, 1000], C = [0, -10000, -500] }
"""
    ),
    "taper pin": Joint(
        """profile = [
  { length = 20, diameter = [10, 10.4], connection = "A" },
  { length = 20, diameter = [10.4, 10.8], connection = "B" },
]
lug.A = {}
"""
        + PULL,
        refused="a link cannot bear on a cone, as A does; give it a segment of one diameter",
    ),
    "key in a shaft": Joint(
        SHAFT + "slot = [{ z = [4, 26], width = 12, depth = 5, radius = 0.8 }]" + TURN,
        "harmonic+local",
    ),
    "key in a keyway open at the end of a shaft": Joint(  # "a sharp corner", whatever its radius
        SHAFT + "slot = [{ z = [-6, 26], width = 12, depth = 5, radius = 1.6 }]" + TURN, "solid"
    ),
    "flats under a lug": Joint(
        CLEVIS + "flat = [{ z = [17, 33], distance = 13, radius = 0.5 }]" + PULL, "harmonic+local"
    ),
    "slot of a lock plate, said as a slot": Joint(  # "would cut the pin in two"
        CLEVIS.replace("profile = [", "profile = [\n  { length = 20, diameter = 30 },")
        + "slot = [{ z = [8, 13], width = 30, depth = 5 }]"
        + PULL,
        refused="so that it is a flat: give it as one, with its distance from the axis",
    ),
    "slot of a lock plate": Joint(
        CLEVIS.replace("profile = [", "profile = [\n  { length = 20, diameter = 30 },")
        + "flat = [{ z = [8, 13], distance = 10 }]"
        + PULL,
        "harmonic+local",
    ),
    "flat through a lug": Joint(
        CLEVIS + "flat = [{ z = [0, 12.5], distance = 13, radius = 0.5 }]" + PULL,
        refused="it goes through the whole lug; end it inside of the lug or leave the lug out",
    ),
    "spherical bearing": Joint(CLEVIS.replace("clearance = 0.03", 'tilt = "free"') + PULL),
    "pressed into both cheeks": Joint(
        """profile = [
  { length = 15, diameter = 20, name = "CHEEK" },
  { length = 1, diameter = 20 },
  { length = 20, diameter = 20, connection = "B" },
  { length = 1, diameter = 20 },
  { length = 15, diameter = 20, name = "OTHER" },
]
lug.CHEEK.fit = "H7/r6"
lug.OTHER.fit = "H7/r6"
lug.B.fit = "H7/f7"
[case.pull]
kind = "given"
forces = { B = [0, 20000] }
"""
    ),
    "cantilever pressed into a plate": Joint(
        """profile = [
  { length = 25, diameter = 20, name = "PLATE" },
  { length = 3, diameter = 20 },
  { length = 15, diameter = 20, connection = "B" },
]
lug.PLATE.fit = "H7/r6"
lug.B = {}
[case.pull]
kind = "given"
forces = { B = [0, 3000] }
"""
    ),
    "two lugs in single shear": Joint(
        """profile = [
  { length = 15, diameter = 20, connection = "A" },
  { length = 0.5, diameter = 20 },
  { length = 15, diameter = 20, connection = "B" },
]
lug.A = { clearance = 0.03 }
"""
        + PULL
    ),
    "hinge of five knuckles": Joint(
        """profile = [
  { length = 20, diameter = 6, connection = "A" },
  { length = 20, diameter = 6, connection = "B" },
  { length = 20, diameter = 6, name = "A2", ear_of = "A" },
  { length = 20, diameter = 6, name = "B2", ear_of = "B" },
  { length = 20, diameter = 6, name = "A3", ear_of = "A" },
]
lug.A = {}
"""
        + PULL,
        refused="already has two ears; a link with more needs connections of their own",
    ),
    "slotted spring pin": Joint(
        FORK.format(bore=", bore = 20") + "slot = [{ z = [0, 12], width = 2, depth = 5 }]" + PULL,
        refused="it goes through the whole lug",
    ),
}
ANSWERED = [name for name, joint in JOINTS.items() if not joint.refused]


def study(name: str, folder: Path) -> pinstress.Study:
    path = folder / "joint.toml"
    path.write_text(HEAD + JOINTS[name].pin, encoding="utf-8")
    return pinstress.load_study(path)


@each("name", [*JOINTS])
def test_a_joint_of_practice_is_valid_or_refused_with_its_reason(name: str, tmp_path: Path) -> None:
    joint = JOINTS[name]
    if not joint.refused:
        assert not examine(study(name, tmp_path)).unheld
        return
    with pytest.raises(InputError) as refused:
        examine(study(name, tmp_path))
    assert joint.refused in str(refused.value)


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(ANSWERED, every=10))
def test_a_joint_of_practice_is_answered(name: str, tmp_path: Path) -> None:
    (row,) = pinstress.run(study(name, tmp_path)).pins
    assert row.model == JOINTS[name].model
    assert row.verdict in ("converged", "unconverged")
    assert row.max_von_mises
