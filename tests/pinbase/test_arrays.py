"""The place of the largest value, whatever the processor rounds."""

from __future__ import annotations

import numpy as np

from pinbase.arrays import first_largest


def test_of_places_that_are_loaded_alike_the_first_is_named() -> None:
    """The two planes of a pin in double shear carry half the force each, but for round-off."""
    alike = np.array([[1.0, 5000.0, 5000.0 * (1.0 + 1e-13)], [5000.0, 2.0, 3.0]])
    assert first_largest(alike) == (0, 1)
    assert first_largest(-alike) == (0, 0)
    assert first_largest(np.array([[1.0, 1.0 + 1e-6]])) == (0, 1)
    preferred = np.array([False, False, True])
    assert first_largest(alike, preferred) == (0, 2)
    assert first_largest(alike, np.zeros(3, bool)) == (0, 1)
    for values in ([0.0, 0.0], [-np.inf, -np.inf], [1.0, np.inf]):
        assert first_largest(np.array([values])) == (0, int(np.argmax(values)))
