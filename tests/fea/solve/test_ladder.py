"""The front door of the models: which one answers, and when it stops."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.hardened import Hardened
from fea.core.material import Material
from fea.core.memory import solid_memory
from fea.core.peak import meets_limit
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.voigt import von_mises
from fea.harmonic.evaluate import SECTION_MESHES
from fea.solve.solve import solve_pin
from geometry import ArgumentError, CutPin, Hole, Pin, Segment
from tests.support.errors import raises

# Double shear of a plain bar of 20 mm: nothing holds it, and no place is without a bound.
BAR = Pin(
    "D",
    (
        Segment(0.01, 0.02, connection="D1"),
        Segment(0.02, 0.02, connection="D2"),
        Segment(0.01, 0.02, connection="D3"),
    ),
)
SIZES = np.array([1000.0, -3000.0, 2000.0])
BALANCED = PinLoads(
    "push",
    ("D1", "D2", "D3"),
    SIZES[:, None, None] * np.array([[0.0, 0.5, 0.0], [0.0, -1.0, 0.0], [0.0, 0.5, 0.0]]),
    distribution="cosine",
)
ONE_SIDED = PinLoads("pull", ("D1",), np.array([[[0.0, 1000.0, 0.0]]]))
YIELD = 1.0e9  # of `steel`


def test_a_beam_decides_where_its_error_leaves_no_doubt(steel: Material) -> None:
    for required, meets in ((2.0, True), (1e4, False)):
        requirement = Requirement(goal="decide", required=required)
        (found,) = solve_pin(BAR, steel, (), (BALANCED,), requirement)
        peak = found.peak
        assert (peak.model, peak.verdict) == ("beam", "unconverged")
        assert peak.reasons == ("above-tolerance", "beam-decides")
        assert peak.max_von_mises is not None
        assert (YIELD / peak.max_von_mises > required) is meets


def test_what_no_beam_decides_goes_to_the_harmonic_model(steel: Material) -> None:
    (beam,) = solve_pin(BAR, steel, (), (BALANCED,), Requirement(model="beam"))
    assert "requested" in beam.peak.reasons
    close = YIELD / (beam.peak.max_von_mises or 0.0)
    (found,) = solve_pin(BAR, steel, (), (BALANCED,), Requirement(goal="decide", required=close))
    assert found.peak.model == "harmonic"
    assert "beam-open" in found.peak.reasons


def test_a_wide_tolerance_is_a_beams_and_a_narrow_one_is_not(steel: Material) -> None:
    (wide,) = solve_pin(BAR, steel, (), (BALANCED,), Requirement(tolerance=0.9))
    assert (wide.peak.model, wide.peak.verdict) == ("beam", "converged")
    (narrow,) = solve_pin(BAR, steel, (), (BALANCED,), Requirement(tolerance=0.06))
    assert narrow.peak.model == "harmonic"
    assert "beam-inaccurate" in narrow.peak.reasons


def test_a_singularity_that_no_beam_sees_is_the_reason_to_reject_it(steel: Material) -> None:
    """It was said to be the beam's error, which is within this tolerance."""
    requirement = Requirement(tolerance=0.9)
    for goal in ("value", "decide"):
        (found,) = solve_pin(BAR, steel, ("start",), (BALANCED,), replace(requirement, goal=goal))
        assert found.peak.model == "harmonic"
        assert found.peak.why.startswith(
            "harmonic: beam rejected: it does not see the singularity at the edge of a clamp; "
        )
        assert "beam-singular" in found.peak.reasons
    case = Hardened(0.0, BAR.length, 1.1 * YIELD, 0.9 * YIELD, 0.5e-3)
    hard = replace(steel, hardened=(case,))
    (found,) = solve_pin(BAR, hard, (), (BALANCED,), requirement)
    assert "beam-hardened" in found.peak.reasons


def test_a_strength_or_a_requirement_that_is_missing_decides_nothing(steel: Material) -> None:
    weak = replace(steel, yield_strength=None)
    for material, required in ((weak, 2.0), (steel, None)):
        requirement = Requirement(goal="decide", required=required, tolerance=0.2)
        (found,) = solve_pin(BAR, material, (), (BALANCED,), requirement)
        assert found.peak.model == "harmonic"


def test_meshes_that_run_out_are_told(steel: Material) -> None:
    requirement = Requirement(model="harmonic", tolerance=1e-6, meshes=3)
    (found,) = solve_pin(BAR, steel, (), (BALANCED,), requirement)
    assert (found.peak.verdict, len(found.peak.history)) == ("unconverged", 3)
    assert found.peak.reasons == ("above-tolerance", "requested", "mesh-limit")
    assert found.peak.why == (
        "harmonic: requested; the tolerance is not reached on the finest mesh allowed"
    )


def test_one_mesh_has_no_error_estimate(steel: Material) -> None:
    requirement = Requirement(model="harmonic", meshes=1)
    (found,) = solve_pin(BAR, steel, (), (BALANCED,), requirement)
    assert found.peak.verdict == "unconverged"
    assert found.peak.error_estimate == found.peak.max_von_mises
    assert "too-few-meshes" in found.peak.reasons
    assert meets_limit(found.peak, 100.0 * (found.peak.max_von_mises or 0.0)) is None


def test_a_case_out_of_balance_is_rigid_and_the_others_are_solved(steel: Material) -> None:
    first, second = solve_pin(BAR, steel, (), (ONE_SIDED, BALANCED), Requirement(model="beam"))
    assert (first.peak.case, first.peak.verdict, first.answer) == ("pull", "rigid", None)
    assert first.peak.max_von_mises is None
    assert first.peak.reasons == ("force-imbalance",)
    assert "pin.D.clamp" in first.peak.note
    assert (second.peak.case, second.peak.model) == ("push", "beam")


def test_a_load_without_size_says_nothing_of_a_balance(steel: Material) -> None:
    nothing = replace(BALANCED, forces=0.0 * BALANCED.forces)
    (found,) = solve_pin(BAR, steel, (), (nothing,), Requirement(model="beam"))
    assert found.peak.max_von_mises == 0.0
    assert found.peak.imbalance is None
    assert "imbalance-reacted" not in found.peak.reasons


def test_what_bands_take_up_is_told(steel: Material) -> None:
    """A twentieth of the force is left over, the couple of it about the middle, 5 % of F times 5 mm
    in 40.
    """
    some = replace(BALANCED, forces=BALANCED.forces * np.array([1.0, 1.0, 0.9])[:, None])
    (found,) = solve_pin(BAR, steel, (), (some,), Requirement(model="beam"))
    assert "imbalance-reacted" in found.peak.reasons
    assert found.peak.imbalance == pytest.approx((0.05, 0.01875))
    assert "a force of 0.05 of the largest load" in found.peak.note


def test_no_beam_where_a_corner_has_no_maximum(steel: Material) -> None:
    sharp = Pin("S", (Segment(0.02, 0.03), Segment(0.04, 0.02, connection="D1")))
    requirement = Requirement(goal="decide", required=1e4, meshes=3)
    (found,) = solve_pin(sharp, steel, ("start",), (ONE_SIDED,), requirement)
    assert found.peak.model == "harmonic"


@pytest.mark.parametrize("model", ["beam", "harmonic"])
def test_only_the_solid_takes_what_is_no_body_of_revolution(model: str, steel: Material) -> None:
    cut = CutPin(BAR, (Hole(0.02, 0.004),))
    with raises(ArgumentError, "not-axisymmetric", "pin D", model):
        solve_pin(cut, steel, (), (BALANCED,), Requirement(model=model))  # type: ignore[arg-type]


def test_the_picture_shows_the_answer(steel: Material) -> None:
    """60 sectors miss the maximum over the circumference by at most 1 - cos(3 deg)^2 or so, 0.3 %.
    All instants push the same way, so the largest is everywhere that of the envelope.
    """
    one_way = replace(BALANCED, forces=np.sign(SIZES)[:, None, None] * BALANCED.forces)
    (found,) = solve_pin(BAR, steel, (), (one_way,), Requirement(model="harmonic"))
    peak, answer = found.peak, found.answer
    assert answer is not None
    maxima = answer.maxima(one_way)
    assert maxima == pytest.approx(np.abs(SIZES) / 3000.0 * (peak.max_von_mises or 0.0), rel=1e-9)
    assert found.instant == 1
    for instant in (0, 1):
        picture = answer.picture(one_way, instant)
        assert picture is not None
        shown = von_mises(picture.stress)
        assert shown.max() == pytest.approx(maxima[instant], rel=4e-3)
        assert picture.envelope.max() == pytest.approx(maxima[1], rel=4e-3)
        ratio = abs(SIZES[instant]) / 3000.0
        np.testing.assert_allclose(shown, ratio * picture.envelope, rtol=1e-6, atol=1.0)
    assert picture is not None
    x, y, z = picture.points.T
    lateral = (z > 1e-9) & (z < BAR.length - 1e-9)
    s = picture.stress[lateral]  # xx, yy, zz, yz, xz, xy
    n = np.stack([x, y], axis=1)[lateral] / 0.01
    along = s[:, 4] * n[:, 0] + s[:, 3] * n[:, 1]
    assert np.abs(along).max() < 1e-6 * shown.max()  # a pressure does not shear


def test_the_envelope_of_odd_harmonics_goes_all_round(steel: Material) -> None:
    """Uniform tractions have no even ones: half a turn is computed, both halves are shown."""
    uniform = replace(
        BALANCED, distribution="uniform", forces=np.sign(SIZES)[:, None, None] * BALANCED.forces
    )
    (found,) = solve_pin(BAR, steel, (), (uniform,), Requirement(model="harmonic"))
    assert found.answer is not None
    picture = found.answer.picture(uniform, 1)
    assert picture is not None
    np.testing.assert_allclose(von_mises(picture.stress), picture.envelope, rtol=1e-6, atol=1.0)


def test_the_beams_answer_is_its_peak(steel: Material) -> None:
    (found,) = solve_pin(BAR, steel, (), (BALANCED,), Requirement(model="beam"))
    assert found.answer is not None
    maxima = found.answer.maxima(BALANCED)
    assert maxima.max() == pytest.approx(found.peak.max_von_mises, rel=1e-9)
    assert maxima == pytest.approx(np.abs(SIZES) / 3000.0 * maxima.max(), rel=1e-9)
    assert found.answer.picture(BALANCED, 0) is None


def test_a_harmonic_mesh_decides_before_it_is_exact(steel: Material) -> None:
    """A tenth from the limit: more than its error, and less than a beam's."""
    exact = solve_pin(BAR, steel, (), (BALANCED,), Requirement(model="harmonic"))[
        0
    ].peak.max_von_mises
    assert exact is not None
    requirement = Requirement(goal="decide", required=1.1 * YIELD / exact, tolerance=1e-6)
    (found,) = solve_pin(BAR, steel, (), (BALANCED,), requirement)
    assert (found.peak.model, found.peak.verdict) == ("harmonic", "unconverged")
    assert "mesh-decides" in found.peak.reasons
    assert len(found.peak.history) < SECTION_MESHES.max_meshes


def test_no_beam_where_a_fillet_has_no_factor(steel: Material) -> None:
    """The fits end at a bore of d/4. Who asks for a beam gets one, with all of its value as error
    and the place by name.
    """
    tube = Pin(
        "T",
        (
            Segment(0.02, 0.03, bore=0.01, connection="D1"),
            Segment(0.04, 0.02, bore=0.01, connection="D2"),
        ),
        fillet=0.003,
    )
    couples = np.array([[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]])
    bent = PinLoads("bent", ("D1", "D2"), 0.0 * couples, couples)
    (auto,) = solve_pin(tube, steel, (), (bent,), Requirement(tolerance=0.9, meshes=3))
    assert auto.peak.model == "harmonic"
    (beam,) = solve_pin(tube, steel, (), (bent,), Requirement(model="beam", tolerance=0.9))
    assert beam.peak.verdict == "unconverged"
    assert beam.peak.error_estimate == pytest.approx(beam.peak.max_von_mises, rel=1e-12)
    assert "no-notch-factor" in beam.peak.reasons


def test_unknowns_and_memory_have_a_limit(steel: Material, monkeypatch: pytest.MonkeyPatch) -> None:
    """The mesh that would pass it is not made, and that is reported."""
    loose = Requirement(model="solid", tolerance=1e-6, meshes=1)
    (first,) = solve_pin(BAR, steel, (), (BALANCED,), loose)
    enough = 1.5 * solid_memory(first.peak.dofs)  # the next mesh has 2^1.5 times as many
    tight = replace(loose, meshes=3, memory=enough)
    (stopped,) = solve_pin(BAR, steel, (), (BALANCED,), tight)
    assert [h.dofs for h in stopped.peak.history] == [first.peak.dofs]
    assert {"memory-limit", "mesh-limit"} <= set(stopped.peak.reasons)
    fine = Requirement(model="harmonic", tolerance=1e-6)
    coarse = replace(SECTION_MESHES, max_unknowns=6000)
    monkeypatch.setattr("fea.harmonic.evaluate.SECTION_MESHES", coarse)
    (found,) = solve_pin(BAR, steel, (), (BALANCED,), fine)
    assert 1 < len(found.peak.history) < SECTION_MESHES.max_meshes
    assert found.peak.dofs <= 6000 < 2.0 * found.peak.dofs


def test_a_limit_that_leaves_too_few_meshes_is_told(
    steel: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    fine = Requirement(model="harmonic", tolerance=1e-6)
    (first,) = solve_pin(BAR, steel, (), (BALANCED,), replace(fine, meshes=1))
    coarse = replace(SECTION_MESHES, max_unknowns=first.peak.dofs)
    monkeypatch.setattr("fea.harmonic.evaluate.SECTION_MESHES", coarse)
    (found,) = solve_pin(BAR, steel, (), (BALANCED,), fine)
    assert len(found.peak.history) == 1
    assert f"unknowns, of {first.peak.dofs:,} that this model may have" in found.peak.note
    assert "mesh-limit" in found.peak.reasons
