"""The pin of a joint in symmetrical double shear by the method of Melcon and Hoblit.

    M = P/2 (t_1/2 + g + gamma t_2/4)      against F_b W

The pressure of a bent pin peaks at the faces of the middle lug, which shortens the arm of its
moment. gamma is the remaining fraction of t_2/4. It is read off a figure as a function of the size
of the lug's head and its share of the load, and stated by the study. With gamma = 1 the bearing
pressure is even.

Source: M. C. Y. Niu, Airframe Stress Analysis and Sizing, 9.8, pp. 329-336, after Melcon & Hoblit,
whose paper was not read.
"""

from __future__ import annotations

from assess.check import CheckText, WorstPlace, check
from assess.clauses.cozzone import PIN_OMITS, bending_strength
from assess.clauses.melcon_hoblit import NIU
from assess.margin import Margin
from assess.situation import Situation
from assess.strength.bending_arms import in_double_shear, outer_and_gap, sections_between
from assess.work import Work, wider, work
from geometry import ArgumentError, Band

GAMMA_NEEDED = "symmetrical double shear, with factors.gamma of the middle lug alone"


@check("Melcon-Hoblit pin bending", NIU, kind="clause", takes="statics", level="ultimate",
       dimension="moment", omits=PIN_OMITS)  # fmt: skip
def peaked_bending(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin of the moment with pressure peaks at the faces of the middle lug, if gamma
    is given.
    """
    if not _given(s) or not s.loaded_across:
        return []
    bands = peaking_bands(s)
    if bands is None:
        return [text.lacks(s, GAMMA_NEEDED)]
    carried = []
    try:
        for section in sections_between(s.pin, bands[0], bands[2]):
            strength = bending_strength(s, section)
            if isinstance(strength, list):
                return [text.lacks(s, *strength)]
            carried.append((strength.result.value * section.modulus, section, strength))
    except ArgumentError as error:
        return [text.lacks(s, str(error))]
    allowed, section, strength = min(carried, key=lambda x: x[0])
    force = s.across[:, s.loads.surfaces.index(bands[1].name)]
    t = int(force.argmax())
    moment = peaked_moment(float(force[t]), *bands, gamma=_given(s)[bands[1].name])
    resisted = work(
        "M_u", allowed, "moment", "{F_b} × {W}", F_b=(strength.result.value, "stress"),
        W=(section.modulus, "length^3"),
    )  # fmt: skip
    place, name = WorstPlace.at_band(bands[1], s.loads, t), s.material.name
    used = s.factors.at(text.level) * moment.result.value / allowed
    passing = wider(section, used, 3.0, lambda x: x.modulus)
    return [
        text.margin(
            s, moment.result.value, allowed, place, name, work=(moment, strength, resisted),
            passing=passing,
        )
    ]  # fmt: skip


def peaking_bands(s: Situation) -> tuple[Band, Band, Band] | None:
    """Return the three bands along a pin in double shear if gamma is given for the middle one only;
    else None.
    """
    bands = sorted((s.pin.band(name) for name in s.loads.surfaces), key=lambda b: b.z0)
    if len(bands) != 3 or set(_given(s)) != {bands[1].name} or not in_double_shear(s):
        return None
    return bands[0], bands[1], bands[2]


def _given(s: Situation) -> dict[str, float]:
    """Return gamma of the lugs for which it is given, by connection."""
    return {name: k.gamma for name, k in s.lug_factors.items() if k.gamma is not None}


def peaked_moment(force: float, first: Band, middle: Band, last: Band, gamma: float) -> Work:
    """Return M, N m, for a force on the middle lug, N; the thicker outer lug and the wider gap
    count.
    """
    t_1, g = outer_and_gap(first, middle, last)
    value = force / 2.0 * (t_1 / 2.0 + g + gamma * middle.length / 4.0)
    return work(
        "M", value, "moment", "{P} / 2 × ({t_1} / 2 + {g} + {γ} × {t_2} / 4)",
        P=(force, "force"), t_1=(t_1, "length"), g=(g, "length"), γ=(gamma, "1"),
        t_2=(middle.length, "length"),
    )  # fmt: skip
