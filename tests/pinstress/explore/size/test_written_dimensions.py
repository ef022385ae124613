"""The dimensions that a search for the least weight writes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geometry import Pin
from pinstress.explore.size.other_dimensions import written_study
from pinstress.explore.size.pin_shape import DIMENSION_KINDS, Proportions, VariedShape
from pinstress.explore.size.written_dimensions import rounded_values
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import parse_study

STUDY = """
title = "A fillet in another unit"
units = "in-lbf-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[pin.S]
material = "steel"
clamp = ["root"]
fillet = "2 mm"
profile = [
  { length = "30 mm", diameter = "40 mm", name = "root" },
  { length = "40 mm", diameter = "20 mm", connection = "L" },
]
[case.pull]
kind = "given"
forces = { L = [0, 1000] }
"""


def test_a_fillet_that_stays_is_written_as_it_is(tmp_path: Path) -> None:
    """2 mm became 0.07874 in, of four digits, 1.999996 mm: less than what a fillet may be."""
    study = parse_study(tmp_path / "study.toml", STUDY)
    pin, inch = pin_of(study, "S"), study.system.factor("length")
    assert isinstance(pin, Pin)
    shape = VariedShape(study, pin, DIMENSION_KINDS, Proportions())
    fillets = np.array(["fillet" in key for key in shape.keys])
    found = np.where(fillets, shape.values * (1.0 - 1e-8), 0.9 * shape.values)
    new = rounded_values(shape, found, None, inch)
    assert new[fillets] == pytest.approx(shape.values[fillets], rel=1e-15)
    assert new[~fillets] / inch == pytest.approx([1.418, 0.7087])
    values = {"S": dict(zip(shape.keys, new.tolist(), strict=True))}
    text = written_study(study, {"S": (pin, shape.dimensions)}, values).text
    assert 'fillet = "2 mm"' in text
    assert 'diameter = "36.0172 mm"' in text
