"""Planar linkages lifted into space: the same forces, and none out of the plane."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest

from loads import Dynamics, LinkageError, Slider, StateDrive, Turn
from loads.forces.corners import Varying
from loads.space.acting import SpaceLoad, SpacePush
from loads.space.dynamics import SpaceDynamics, space_reactions
from loads.space.motion import SpaceMotion, space_move
from pinbase.arrays import Floats
from pinstress import load_study
from pinstress.study.model.cases import case_loads
from pinstress.study.model.mechanism.drives import laws
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import MotionCase
from tests.conftest import ROOT
from tests.support.each import each, sampled
from tests.support.mechanism.lift import lamina, lift

MAX_SAMPLES = 41  # of a motion that are compared
TOLERANCE = 1e-9  # of the largest force of the case
# Where the equations are this ill-conditioned, within about 0.1 degree of a toggle, both
# formulations lose digits in proportion.
TOGGLE_CONDITION, TOGGLE_TOLERANCE = 1e4, 1e-6
JAMS = ("slider_crank_jammed",)  # has no forces

QUICK = "slider_crank", "planetary", "lifting_arm"
SLOW = (
    "bowman2019", "bucket", "crane", "drop", "engine", "excavator", "grenier2008", "hood",
    "landing_gear", "landing_gear_part25", "light_gear_part23", "main_gear", "matrix_four_bar",
    "pump_jack", "scissor_lift",
)  # fmt: skip


@dataclass(frozen=True)
class _Known:
    """A force along a coordinate, (T,), of what exists in the plane only: locks, and friction of
    sliders.
    """

    name: str
    force: Floats
    kinks: tuple[Varying[SpaceMotion], ...] = ()
    switches: tuple[float, ...] = ()

    def pushes(self, motion: SpaceMotion) -> Iterator[SpacePush]:
        return iter(())

    def along_measured(self, motion: SpaceMotion) -> Iterator[tuple[str, Floats]]:
        yield self.name, self.force


def _cases(study: Study) -> Iterator[tuple[str, Dynamics]]:
    """The cases of a study's mechanism, solved in the plane."""
    mechanism = linkage(study)
    for name, case in study.table.case.items():
        if case.kind == "given":
            continue
        if isinstance(case, MotionCase):
            samples = min(case.samples, MAX_SAMPLES)
            case = case.model_copy(update={"samples": samples})
            cases = {**study.table.case, name: case}
            study = replace(study, table=study.table.model_copy(update={"case": cases}))
        dynamics = case_loads(study, name, mechanism, extremes=False).dynamics
        assert dynamics is not None
        yield name, dynamics


def _in_space(study: Study, name: str, planar: Dynamics) -> SpaceDynamics:
    motion = planar.motion
    smooth = tuple(replace(s, friction=0.0) for s in motion.linkage.sliders)
    hold = {a.name for a in planar.actuators}  # a rule applies where all its members do
    parallel = tuple(rule for rule in motion.linkage.parallel if hold >= {*rule.members})
    flat = replace(motion.linkage, sliders=smooth, parallel=parallel)
    lifted, loads = lift(flat, planar.applied)
    driven = {*flat.driven, *(name for rule in flat.parallel for name in rule.members)}
    known: list[SpaceLoad] = [
        _Known(a.name, force)
        for a, force in zip(planar.actuators, planar.drive.T, strict=True)
        if a.name not in driven
    ]
    rubbing = zip(flat.sliders, planar.sliders.friction.T, strict=True)
    known += [_Known(s.name, force) for s, force in rubbing]
    if isinstance(study.table.case[name], MotionCase):
        by = list(laws(study))
    else:
        rows = zip(motion.drives[0], motion.speeds[0], motion.rates[0], strict=True)
        by = [StateDrive(*map(float, row)) for row in rows]
    moved = space_move(lifted, by, motion.times)
    return space_reactions(name, moved, [*loads, *known])


def _compare(name: str) -> None:
    study = load_study(ROOT / "studies" / f"{name}.toml")
    for case, planar in _cases(study):
        space = _in_space(study, case, planar)
        flat = planar.reactions
        size = np.linalg.norm(flat.forces, axis=2).max()
        largest = max(float(size), *np.abs(planar.drive).ravel().tolist(), 1e-300)
        toggle = planar.motion.condition > TOGGLE_CONDITION
        tolerance = np.where(toggle, TOGGLE_TOLERANCE, TOLERANCE) * largest
        for c, connection in enumerate(flat.connections):
            # Side loads are apart from the motion in the plane (test_out_of_plane.py).
            apart = space.reactions.force(connection) - flat.forces[:, c]
            error = np.abs(apart[:, :2]).max(axis=1)
            assert np.all(error <= tolerance), (name, case, connection, error.max() / largest)
        scale = planar.motion.linkage.length_scale
        across = np.abs(space.reactions.moments[..., :2]).max(axis=(1, 2))
        assert np.all(across <= tolerance * scale), (name, case)
        linkage_ = planar.motion.linkage
        known: dict[str, Slider | Turn] = {s.name: s for s in linkage_.sliders}
        known |= {t.name: t for t in linkage_.turns}
        forces = {a.name: f for a, f in zip(planar.actuators, planar.drive.T, strict=True)}
        for name_, force in zip(space.motion.equations.actuators, space.drive.T, strict=True):
            drive = known[name_]
            expected = forces.get(drive.name, np.zeros(len(planar.motion)))
            unit = 1.0 if isinstance(drive, Slider) else scale
            error = np.abs(force - expected)
            assert np.all(error <= tolerance * max(unit, 1.0)), (name, case, drive.name)


@each("name", QUICK)
def test_a_lifted_study_has_the_same_forces(name: str) -> None:
    _compare(name)


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(SLOW, every=3))
def test_every_lifted_study_has_the_same_forces(name: str) -> None:
    _compare(name)


def test_every_planar_study_is_compared() -> None:
    planar = {
        path.stem
        for path in (ROOT / "studies").glob("*.toml")
        if "[mechanism." in (text := path.read_text(encoding="utf-8"))
        and "dimension = 3" not in text
    }
    assert planar == {*QUICK, *SLOW, *JAMS}


def test_friction_of_sliders_is_refused() -> None:
    study = load_study(ROOT / "studies" / "slider_crank_jammed.toml")
    with pytest.raises(LinkageError, match="friction cannot be lifted"):
        lift(linkage(study))


def test_the_inertia_of_a_lamina_is_possible() -> None:
    xx, yy, zz = np.diag(np.array(lamina(3.0)))
    assert (xx, yy, zz) == (1.5, 1.5, 3.0)
    assert xx + yy == zz
