"""Joints drawn at random, and what is printed where CalculiX fails or is missing."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

from assess.opinion.calculix import CalculixError
from benchmarks.joints import joint_ccx
from benchmarks.joints.joint_ccx import COUNT, SEED, drawn, ours
from fea.support.contact.resolution import Resolution


def test_what_is_drawn() -> None:
    """Two lugs and three, all shapes, forces in balance, clearances to 0.005 d; one oblique."""
    joints = drawn(COUNT, SEED)
    assert {len(joint.lugs) for joint in joints} == {2, 3}
    assert [joint.oblique for joint in joints] == [False] * 5 + [True]
    described = " ".join(joint.described for joint in joints)
    assert all(word in described for word in ("plain", "stepped", "bore"))
    for joint in joints:
        assert np.abs(joint.loads.forces.sum(axis=1)).max() < 1e-9 * joint.loads.forces.max()
        d = joint.pin.smallest_diameter
        assert all(0.0 <= lug.clearance <= 0.005 * 1.4 * d for lug in joint.lugs)
    assert [j.loads.forces.tolist() for j in drawn(COUNT, SEED)] == [
        j.loads.forces.tolist() for j in joints
    ]


def test_a_failure_of_calculix_is_in_its_row(monkeypatch: pytest.MonkeyPatch) -> None:
    joint = drawn(1, SEED)[0]
    mine = ours(joint, Resolution(4, 16, 6))
    failed = CalculixError("ccx diverged", "failed")
    monkeypatch.setattr(joint_ccx, "_theirs", lambda *_: failed)
    row = joint_ccx._row(joint, mine, failed)
    assert row[0] == f"{mine.moment:.4g}"
    assert row[1] is failed
    assert len(row) == 12
    assert joint_ccx._meshes(joint).count("ccx diverged") == len(joint_ccx.MESHES)


def test_a_missing_calculix_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda _: None)
    assert "calculix-ccx" in joint_ccx.joint_ccx()
