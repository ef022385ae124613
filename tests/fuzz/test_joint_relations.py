"""Relations between the answers to pins in contact, with cuts, under a spectrum, and the same said
or loaded otherwise: maxima within the sum of both errors, margins by hand to round-off.
"""

from __future__ import annotations

import cmath
import random
from functools import cache

import pytest

from tests.fuzz import draw_asked, draw_cut, draw_joint
from tests.fuzz.answers import Answers, answers
from tests.fuzz.quantity import Quantity, Tree, angle, mapped
from tests.support.each import sampled

ROUND_OFF = 1e-9  # of the same meshes, where sums have another order
pytestmark = pytest.mark.slow
# In lugs, with a cut, beside a wall, and between walls, which takes a minute a solution.
SEEDS = "lugs 2", "cut 3", "lugs 5", "lugs 9"
EXPONENTS = {"length": 1, "force": 2, "moment": 3, "stress": 0}


def seeds(*in_ci: str) -> pytest.MarkDecorator:
    """Those that CI runs, and the others in `make test-all`."""
    others = [pytest.param(s, marks=pytest.mark.long) for s in SEEDS if s not in in_ci]
    return pytest.mark.parametrize("seed", [*in_ci, *others])


def drawn(seed: str) -> Tree:
    """A pin in two cases, with strengths and a spectrum."""
    rng = random.Random(seed)
    pin, forces, _ = (draw_joint.joint if "lugs" in seed else draw_cut.pin)(rng, "P")
    steel = draw_asked.STRONG | {"fatigue": draw_asked.CURVE | {"slope_below": 5}}
    for lug in pin.get("lug", {}).values():
        if lug.pop("fit", None) is not None:  # whose limits are of absolute size
            lug["clearance"] = pin["profile"][0]["diameter"] * 0.002
    case = {"kind": "given", "distribution": "cosine", "forces": forces}
    back = {name: [f * -0.4 for f in pull] for name, pull in forces.items()}
    return {
        "title": "A relation",
        "units": "mm-N-s",
        "material": {"steel": steel, "bronze": draw_joint.BRONZE},
        "analysis": {"limit_load": "never"},
        "pin": {"P": pin},
        "case": {"pull": case, "push": case | {"forces": back}},
        "fatigue": {"occurrences": {"pull": 1, "push": 3}, "life": 100},
    }


@cache
def before(seed: str) -> Answers:
    """The drawn study as it is, to compare with."""
    return answers(drawn(seed))


def agree(one: Answers, other: Answers, times: float = 1.0) -> None:
    """Maxima within both errors, of the same verdict; every margin there, those of a whole pin
    (a band's demand follows the mesh) as near as the maxima are.

    times: of the stresses in the other.
    """
    assert one.rows.keys() == other.rows.keys()
    share = 0.0
    for key, row in one.rows.items():
        second = other.rows[key]
        error = times * row.error + second.error + ROUND_OFF * second.maximum
        assert abs(times * row.maximum - second.maximum) <= error, key
        assert row.verdict == second.verdict, key
        share = max(share, error / second.maximum)
    assert one.used.keys() == other.used.keys()
    for name, used in one.used.items():
        if used is None:
            assert other.used[name] is None, name
        else:
            of_damage = name[2] == "fatigue life"  # of slope 5, as below
            rel = (1.0 - share) ** -5.0 - 1.0 if of_damage else share
            assert other.used[name] == pytest.approx(times * used, rel=rel + 1e-6), name
    assert one.damage.keys() == other.damage.keys()
    for pin, damage in one.damage.items():  # of slope 5, between cells of either mesh
        assert (1.0 - share) ** 5 * damage <= other.damage[pin] * (1.0 + 1e-6), pin
        assert other.damage[pin] <= damage / (1.0 - share) ** 5 * (1.0 + 1e-6), pin


def turned(node: object, by: float) -> object:
    """With its cuts and shanks, after a mirror: the plane x, z."""
    if isinstance(node, dict):
        return {k: turned(v, by) for k, v in node.items()}
    if isinstance(node, list) and node and getattr(node[0], "dimension", "") == "force":
        z = complex(node[0].value, node[1].value).conjugate() * cmath.rect(1.0, by)
        return [Quantity(z.real, "force"), Quantity(z.imag, "force"), *node[2:]]
    if isinstance(node, list):
        return [turned(v, by) for v in node]
    if isinstance(node, Quantity) and node.dimension == "angle":
        return angle(by - node.value)
    return node


@seeds("lugs 2")
@pytest.mark.parametrize("units", sampled(["in-lbf-s", "mm-N-s"], every=2))
def test_a_joint_told_otherwise_is_stressed_as_much(seed: str, units: str) -> None:
    """In a mirror, turned, of another size under the square of it, in other units, some of its
    numbers in units of their own.
    """
    tree = drawn(seed)

    def larger(q: Quantity) -> Quantity:
        return q * 2.5 ** EXPONENTS.get(q.dimension, 0)

    changed = {k: mapped(turned(tree[k], 1.1), larger) for k in ("pin", "case")}
    agree(before(seed), answers(tree | {"units": units} | changed, random.Random(1)))


@seeds("lugs 5")
def test_a_stronger_and_stiffer_joint_under_more_load_has_the_same_margins(seed: str) -> None:
    """All of modulus, strengths and loads are doubled; gaps close as they did."""
    tree = drawn(seed)

    def doubled(q: Quantity) -> Quantity:
        return q * 2.0 if q.dimension in ("stress", "force", "moment") else q

    other = answers(tree | {k: mapped(tree[k], doubled) for k in ("material", "case")})
    one = before(seed)
    for key, row in one.rows.items():
        assert other.rows[key].maximum == pytest.approx(2.0 * row.maximum, rel=1e-6)
    assert other.used.keys() == one.used.keys()
    for name, used in one.used.items():
        if used is not None:
            assert other.used[name] == pytest.approx(used, rel=1e-6), name
    assert other.damage == pytest.approx(one.damage, rel=1e-5)


@seeds("cut 3")
def test_names_and_the_order_of_cases_change_nothing(seed: str) -> None:
    """Names to the last digit; the order to round-off."""
    tree, one = drawn(seed), before(seed)
    said = answers(tree | {"case": dict(reversed(tree["case"].items()))})
    assert said.damage == pytest.approx(one.damage, rel=ROUND_OFF)
    assert {k: r.maximum for k, r in said.rows.items()} == pytest.approx(
        {k: r.maximum for k, r in one.rows.items()}, rel=ROUND_OFF
    )
    names = {"P": "Ω 1", "pull": "zieh", "push": "a b"}
    renamed = answers(
        tree
        | {"pin": {names["P"]: tree["pin"]["P"]},
           "case": {names[k]: v for k, v in tree["case"].items()},
           "fatigue": {"occurrences": {"zieh": 1, "a b": 3}, "life": 100}}
    )  # fmt: skip
    assert renamed.rows == {(names[p], names[c]): r for (p, c), r in one.rows.items()}
    assert renamed.damage == {names[p]: d for p, d in one.damage.items()}


@seeds()
def test_twice_as_many_occurrences_do_more_damage_at_most_in_proportion(seed: str) -> None:
    """Where cases stress a point either way, the one range from the first to the second case is
    counted once in a flight, however often both occur.
    """
    tree, one = drawn(seed), before(seed)
    twice = {"occurrences": {"pull": 2, "push": 6}, "life": 100}
    more = answers(tree | {"fatigue": twice})
    assert more.rows == one.rows
    assert min(one.damage.values()) > 0.0
    for pin, damage in one.damage.items():
        assert damage * (1.0 + ROUND_OFF) < more.damage[pin] <= 2.0 * damage * (1.0 + ROUND_OFF)
