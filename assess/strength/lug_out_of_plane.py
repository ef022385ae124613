"""What no check of a lug covers: forces along the pin and moments of its link, which bend it out of
its plane. It is not made, so that nobody takes the other checks of the lug for all.
"""

from __future__ import annotations

import numpy as np

from assess.check import CheckText, check
from assess.margin import Margin
from assess.situation import Situation

NEEDED = "a check of lugs under forces along the pin and moments of their links"
MIN_SHARE = 1e-6  # of the largest force (times the pin's length): smaller loads are round-off


@check("lug, bending out of its plane", "statics", kind="model", takes="loads")
def lug_out_of_plane(text: CheckText, s: Situation) -> list[Margin]:
    """That the check is not made, where links in lugs have such loads; nothing without any."""
    forces, moments = s.loads.forces, np.broadcast_to(s.loads.moments, s.loads.forces.shape)
    least = MIN_SHARE * float(np.abs(forces).max(initial=0.0))
    held = [k for k, name in enumerate(s.loads.surfaces) if s.lug(name) is not None]
    along, turning = np.abs(forces[:, held, 2]), np.abs(moments[:, held, :2])
    bent = along.max(initial=0.0) > least or turning.max(initial=0.0) > least * s.pin.length
    return [text.lacks(s, NEEDED)] if bent else []
