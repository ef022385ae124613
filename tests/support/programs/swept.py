"""The shipped study of one pin, with a [vary] section."""

from __future__ import annotations

from pinstress import Study, shipped_studies, study_from

ONE_PIN = shipped_studies()["one_pin"].read_text(encoding="utf-8")
DIAMETER = "pin.B.profile[2].diameter"
FORCE = "case.landing.forces.B[2]"
STRENGTH = "material.AISI 4340.yield_strength"
SHAPES = f'"{DIAMETER}" = {{ from = "1.5 in", to = "4.5 in" }}'


def varied(parameters: str, head: str = 'sample = "sobol"\ncount = 4', text: str = ONE_PIN) -> str:
    """Return a study's text with [vary].

    parameters: the lines of [vary.parameters]. head: the lines before these.
    """
    return f"{text}\n[vary]\n{head}\n\n[vary.parameters]\n{parameters}\n"


def swept(parameters: str, head: str = 'sample = "sobol"\ncount = 4', text: str = ONE_PIN) -> Study:
    """Return the study of such a text."""
    return study_from(varied(parameters, head, text))


DEADLY = 2


# A sweep long enough to be interrupted; `whole_sweep` in tests/conftest.py is its table.
LONG_SWEEP = varied(SHAPES, 'sample = "sobol"\ncount = 48')
