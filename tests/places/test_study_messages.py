"""What a study may no longer say, or says in vain, of edges and bearing strengths."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.programs.command_line import run_here

ROOT = Path(__file__).parents[2]
CLEVIS = (ROOT / "studies" / "clevis.toml").read_text(encoding="utf-8")

STEEL = 'bearing_strength = "900 MPa"\n'
SPARE = (
    '[material.bronze]\nyoungs_modulus = "110 GPa"\npoisson_ratio = 0.34\n'
    'bearing_strength = "200 MPa"\n\n[analysis]\n'
)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "[analysis]\n",
            '[analysis]\nlug_edges = "excluded"\n',
            (
                "analysis: unknown key 'lug_edges'",
                "was removed",
                "surface, section and contact",
                "delete",
            ),
        ),
        (
            "[analysis]\n",
            SPARE,
            (
                "material.bronze.bearing_strength",
                "no lug bears on a pin of this material",
                "remove",
            ),
        ),
        (
            "outer_diameter = 50\nclearance = 0.05\nedge_radius = 0.5\n",
            "outer_diameter = 50\nclearance = 0.05\nedge_radius = 5.1\n",  # the lug is 10 wide
            ("study.toml:", "lug LEFT", "0.51 of the length", "may be at most half"),
        ),
    ],
)
@pytest.mark.parametrize("command", [("check",), ("run",)])
def test_it_is_refused(
    old: str, new: str, said: tuple[str, ...], command: tuple[str, ...], tmp_path: Path
) -> None:
    assert old in CLEVIS
    (tmp_path / "study.toml").write_text(CLEVIS.replace(old, new, 1), encoding="utf-8")
    done = run_here(*command, "study.toml", cwd=tmp_path)
    assert done.returncode == 2
    assert "study.toml" in done.stderr
    assert "Traceback" not in done.stderr
    for words in said:
        assert words in " ".join(done.stderr.split()), done.stderr
    assert not (tmp_path / "out").exists()


def test_bearing_strengths_that_something_reads_are_welcome(tmp_path: Path) -> None:
    """Of the pin's own material, and of a lug's or a bushing's."""
    text = CLEVIS.replace("poisson_ratio = 0.3\n", "poisson_ratio = 0.3\n" + STEEL, 1)
    ring = 'bushing = { thickness = 2, material = "bronze" }\n'
    with_ring = text.replace("[analysis]\n", SPARE, 1).replace(
        'lug.EYE = { tilt = "guided" }', f'lug.EYE = {{ tilt = "guided", {ring.strip()} }}', 1
    )
    for each in (text, with_ring):
        (tmp_path / "study.toml").write_text(each, encoding="utf-8")
        done = run_here("check", "study.toml", cwd=tmp_path)
        assert done.returncode == 0, done.stderr
