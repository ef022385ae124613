from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from reports.data.results import Results
from reports.plots.all import save_plots

PINS = "AB"


@pytest.fixture(scope="module")
def small(results: Results) -> Results:
    """Two pins, a motion of one with two connections, and everything else."""
    table = results.reactions[0]
    few = replace(
        table,
        connections=table.connections[:2],
        bodies=table.bodies[:2],
        pins=table.pins[:2],
        forces=table.forces[:, :2],
        moments=table.moments[:, :2],
    )
    pins = tuple(p for p in results.pins if p.pin in PINS)
    return replace(results, pins=pins, reactions=(few, results.reactions[1]))


@pytest.fixture(scope="module")
def drawn(small: Results, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    return save_plots(small, tmp_path_factory.mktemp("plots"))


def test_plots_are_the_same_bytes_on_every_run(
    small: Results, drawn: list[Path], tmp_path: Path
) -> None:
    again = save_plots(small, tmp_path)
    assert [p.name for p in drawn] == [p.name for p in again]
    assert [p.read_bytes() for p in drawn] == [p.read_bytes() for p in again]


def test_every_plot_is_there_as_svg_and_png(drawn: list[Path]) -> None:
    kinds = {
        "reactions.retract.A",
        "magnitudes.retract.A",
        "reactions.landing",
        "drive.retract",
        "linkage.retract",
        "bodies.retract",
        "transmission.retract",
        "shaking.retract",
        "ledger.retract",
        "linkage.landing",
        "beam-diagrams",
        "beam-stress",
        "motion-check",
        "refinement.retract",
        "refinement.landing",
        *(f"refinement-pin.{pin}" for pin in PINS),
    }
    assert {p.name for p in drawn} == {k + end for k in kinds for end in (".svg", ".png")}
    for path in drawn:
        if path.suffix == ".svg":
            assert ElementTree.parse(path).getroot().tag.endswith("svg")
        else:
            assert path.read_bytes().startswith(b"\x89PNG")


def test_zero_forces_and_odd_names(results: Results, tmp_path: Path) -> None:
    moving, static = results.reactions
    odd = replace(
        results,
        reactions=(
            replace(
                moving,
                case="$x_1",
                position=None,
                connections=("a/b $", *moving.connections[1:2]),
                bodies=moving.bodies[:2],
                pins=("../P", "../P"),
                forces=np.zeros((201, 2, 3)),
                moments=np.zeros((201, 2, 3)),
            ),
            replace(static, case="zero", forces=np.zeros_like(static.forces), published={}),
        ),
        drive=(),
        motion=(),
        beam_check=None,
        motion_check=None,
        pins=(),
    )
    paths = save_plots(odd, tmp_path)
    assert len(paths) == 6
    assert all(path.parent == tmp_path and path.exists() for path in paths)
