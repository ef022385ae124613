"""The hoop stress that a shank adds beside the bore of its lug when it bends out of its plane.

A pin that bends presses more on one face of a lug than on the other, and the shank carries the
couple. The eye as a body of revolution carries it all around (fea.lug.through_thickness). A lug
that is pulled carries it beside its bore alone: in three dimensions such lugs have 0.7 to 0.9 of
the nominal bending stress of the net section more than the eye, most at 82 degrees from the shank.
Lugs that are pressed have less than the eye, which is safe. Measured by `python -m benchmarks
shanks`.
"""

from __future__ import annotations

import math

import numpy as np

from fea.lug.lug_load import LugLoad
from geometry.shape.lug_outline import LugOutline
from pinbase.arrays import Floats

# The largest addition, of the nominal stress. With it no lug of the benchmark has a larger one from
# 90 degrees on, where contact of a pulled lug ends; at 75 degrees two have 0.90 and 0.91, where
# this has 0.87.
SHARE = 0.88
# The angle from the shank at which it is largest; it falls as cos^2 on both sides.
ANGLE = math.radians(82.0)


def bent(outline: LugOutline, load: LugLoad, angles: Floats) -> Floats:
    """The addition (T, R, P), Pa, to the hoop stress of the rings.

    outline: of the lug, m.
    angles: (P,) rad, from the shank.
    """
    thick, net_width = load.length.sum(), outline.width_at_bore - outline.hole
    along, across = load.along_shank.T
    size = np.hypot(along, across)
    pulled = np.where(size > 0.0, np.maximum(-along, 0.0) / np.where(size > 0.0, size, 1.0), 0.0)
    per_depth = load.couple(outline.bore / 2.0) / (net_width * thick**3 / 12.0)
    slope = -SHARE * pulled * per_depth
    off = np.abs(np.abs(np.remainder(angles + math.pi, 2.0 * math.pi) - math.pi) - ANGLE)
    around = np.where(off < math.pi / 2.0, np.cos(off) ** 2, 0.0)
    return np.asarray(slope[:, None, None] * load.z[:, None] * around)
