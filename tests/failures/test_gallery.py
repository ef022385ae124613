"""Where methods fail: what `python -m benchmarks failures` draws is asserted here, entry by entry.

Every failure is reported by the program: refused with the reason, or its verdict says so, or its
error contains the truth.
"""

from __future__ import annotations

import re

import numpy as np
import pytest

from benchmarks.failures import corners, elements, entries, holding, locking, mechanisms, shapes
from benchmarks.failures.asked import STUDIES, contains, row, surface_contains
from benchmarks.failures.broken_meshes import FOLDED, INSIDE_OUT, TURNED
from benchmarks.failures.fields import finest
from benchmarks.failures.page import PAGE, PICTURES
from pinstress.cli.commands import run_command_line
from tests.support.each import each, sampled


@pytest.mark.slow
@pytest.mark.parametrize(
    ("found", "theory", "off"),
    [(corners.sharp_corner, 0.4555, 0.05), (corners.clamped_edge, 0.2888, 0.03)],
)
def test_a_corners_peak_grows_and_its_exponent_is_measured(
    found: object, theory: float, off: float
) -> None:
    """Exponents within what `benchmarks corners` finds on random pins; growth within a tenth of
    2^s, more than any convergent peak has.
    """
    g = found()  # type: ignore[operator]
    assert g.theory == pytest.approx(theory, abs=1e-4)
    assert g.growth == pytest.approx(2.0**theory, rel=0.1)
    assert (g.found.verdict, g.zone.governs) == ("singular", True)
    assert g.zone.exponent == pytest.approx(theory, abs=off)


@pytest.mark.slow
def test_a_clamp_that_looks_converged_on_two_meshes() -> None:
    g = corners.looks_converged()
    first, second, *later = (m.maximum for m in g.meshes)
    assert second == pytest.approx(first, rel=0.005)  # who would refine?
    assert later[-1] > 1.5 * second
    assert g.found.verdict == "singular"
    assert g.zone.kind == "the edge of a clamp"


def test_the_edge_of_a_uniform_load_is_a_logarithm() -> None:
    """The slope of the shear against q / pi of the antiplane half plane, to 3 %."""
    e = corners.load_edge()
    assert e.slope == pytest.approx(e.theory, rel=0.03)
    assert np.all(np.diff(e.shear) > 0.0)
    assert e.found.verdict == "singular"
    assert "log(1/distance)" in e.found.note


@pytest.mark.slow
def test_the_edge_of_a_pressure_is_read_from_every_direction() -> None:
    e = corners.pressure_edge()
    low = [1.0 - m.maximum / e.truth for m in e.meshes]
    assert np.all(np.diff(low) < 0.0)
    assert min(low[:3]) > 0.015  # on meshes of the size of ours
    assert e.found.verdict == "converged"
    assert contains(e.found, e.truth / 1e6)
    assert e.found.history[0].max_von_mises == pytest.approx(e.truth / 1e6, rel=0.02)


@pytest.mark.slow
def test_linear_elements_lock_in_bending() -> None:
    b = locking.bending()
    linear, own = b.linear / b.truth, b.quadratic / b.truth
    assert np.all(linear[:, 0] < 0.96)
    assert linear[0, 1] < 0.5
    assert own[:, 0] == pytest.approx(np.ones(len(own)), abs=0.01)
    assert own[-1, 1] == pytest.approx(1.0, abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("case", sampled(range(3), every=3, first=2))
def test_poissons_ratio_towards_one_half(case: int) -> None:
    r = locking.incompressible()[case]
    assert r.naive < (0.9, 0.85, 0.65)[case] * r.truth
    assert r.found.verdict == "converged"
    assert contains(r.found, r.truth)


def test_a_folded_element_is_refused_and_turned_numbers_are_not() -> None:
    over, sound = elements.broken(FOLDED), elements.broken(TURNED)
    assert (sound.folds, sound.told) == (0, "")
    assert over.shape.min() > 0.0  # det J alone, by the element's own numbering, sees nothing
    assert abs(over.peak / sound.peak - 1.0) > 0.01
    assert over.volume > 1.01 * sound.volume
    assert "overlap" in over.told
    assert f" {over.folds} facets" in over.told


def test_elements_bent_inside_out_are_refused() -> None:
    out, sound = elements.broken(INSIDE_OUT), elements.broken(TURNED)
    assert out.shape.min() < 0.0 < sound.shape.min()
    assert abs(out.peak / sound.peak - 1.0) > 0.05
    assert "3 elements are inverted" in out.told


@pytest.mark.parametrize("name", sampled([FOLDED, INSIDE_OUT], every=2))
def test_the_command_ends_with_status_3(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line(["run", str(STUDIES / f"{name}.toml")]) == 3
    assert f"{name}.msh: " in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize(
    ("family", "naive"),
    # Slender pins and thin tubes are tested in fea, too.
    sampled([(shapes.fillets, 0.4), (shapes.slender, 0.01), (shapes.tubes, 0.02)], every=3),
)
def test_extreme_shapes(family: object, naive: float) -> None:
    """The naive value is as bad as that at one end; the truth is within pinstress's error, and all
    are known to the tolerance.
    """
    found = family()  # type: ignore[operator]
    assert min(s.naive / s.truth for s in found) < naive
    assert all(s.held for s in found)
    assert all(s.found.verdict == "converged" for s in found)


def test_units_and_sizes() -> None:
    """Units to round-off; sizes to 1e-3: of two nodes with all but the same stress round-off says
    which is the higher, about which the next mesh is finer.
    """
    s = shapes.units()
    assert s.apart < 1e-9
    assert np.ptp(s.stress) < 1e-3 * s.stress.mean()
    assert s.taken[0] > 0.99 > 10.0 * s.right
    assert s.taken[2] == s.right


def test_a_pin_that_nothing_holds() -> None:
    f = holding.free_pin()
    assert np.all((f.stress > 1e6) & (f.stress < 1e11))  # round-off that looks like stress
    assert f.stress.max() > 1.5 * f.stress.min()
    assert f.motion.min() > 1e6
    assert (f.found.verdict, f.found.max_von_mises) == ("rigid", None)


@pytest.mark.slow
def test_stiff_and_soft_supports() -> None:
    stiff, soft = row("supports", "stiff"), row("supports", "soft")
    assert (stiff.verdict, soft.verdict) == ("singular", "converged")
    assert 2.0 * (stiff.max_von_mises or 0.0) < (soft.max_von_mises or 0.0)
    bent = 32.0 / (np.pi * 20.0**3)  # MPa per N mm
    assert contains(soft, 15e3 * (27.5 - 7.5) * bent)  # F / 2 times the arm of its halves
    # A solid of 27-node hexahedra, the lugs' bands held rigidly (tests/places/test_section.py)
    assert contains(stiff, 105.9e3 * bent)
    for found, pin in ((stiff, "stiff"), (soft, "soft")):
        assert surface_contains(found, finest("supports", pin) / 1e6)


def test_reactions_from_stresses_and_from_the_residual() -> None:
    s = holding.reactions()
    assert np.all(s.surface > 0.05)
    assert np.all(s.residual < 1e-10)


def test_a_toggle() -> None:
    """Forces of the formula until 1e-8 rad before the dead point, which is the cosine law's."""
    t = mechanisms.toggle()
    assert t.force == pytest.approx(t.exact, rel=1e-7)
    assert t.told == pytest.approx(t.dead, abs=1e-4)
    assert t.condition[-1] > 1e4
    assert np.all(np.diff(t.condition) > 0.0)
    assert "would snap through" in mechanisms.refusal("toggle")


def test_a_change_point() -> None:
    ends = list(mechanisms.change_point().ends.values())
    assert ends == pytest.approx([-60.0, 120.0], abs=1e-9)  # the paths, by reflection
    assert "change point at crank" in mechanisms.refusal("change_point")


def test_redundant_links() -> None:
    s = mechanisms.shares()
    assert s.smallest == pytest.approx((900.0, 900.0))
    assert s.ruled == pytest.approx((1350.0, 450.0))
    assert "P1, P2, Q1, Q2" in mechanisms.refusal("redundant")


def test_a_guide_that_jams() -> None:
    j = mechanisms.jamming()
    slides = j.friction < j.limit
    assert j.ours[slides] == pytest.approx(j.force[slides], rel=1e-6)
    assert np.isnan(j.ours[~slides]).all()
    assert np.all(j.force[~slides] < 0.0)  # the naive formula changes its sign and goes on
    assert "friction jams slider guide" in mechanisms.refusal("jamming")


@each("name", ["toggle", "change_point", "redundant", "jamming"])
def test_refused_linkages_end_with_status_2(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line(["loads", str(STUDIES / f"{name}.toml")]) == 2
    assert mechanisms.refusal(name).partition(": ")[2] in capsys.readouterr().err


def test_what_the_page_names_is_there() -> None:
    """And nothing is missing: a new entry has a study and, once it is recorded, a picture."""
    text = PAGE.read_text(encoding="utf-8")
    files = re.findall(r"^pinstress \w+ (\S+)", text, re.MULTILINE)
    assert all((STUDIES.parents[1] / name).is_file() for name in files)
    assert {f"studies/failures/{path.name}" for path in STUDIES.glob("*.toml")} <= set(files)
    pictures = re.findall(r"\(images/failures/(\w+)\.svg\)", text)
    assert sorted(pictures) == sorted(path.stem for path in PICTURES.glob("*.svg"))
    assert len(pictures) == text.count("\n## ")


@pytest.mark.long
@pytest.mark.slow
def test_the_page_names_every_entry_and_its_picture() -> None:
    text = PAGE.read_text(encoding="utf-8")
    for entry in entries():
        assert f"## {entry.title}\n" in text, "run: python -m benchmarks failures --record"
        assert (PICTURES / f"{entry.name}.svg").is_file()
        for command in entry.commands:
            assert (STUDIES.parents[1] / command.split()[2]).is_file()
            assert f"\n{command}\n" in text
