"""Materials that a study only names: of the library, or of a file of the user's."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import pytest

from loads import noted_files
from pinbase.memo import Memo
from pinstress import Engine, InputError, load_study, prepare, run
from pinstress.cli.commands import run_command_line
from pinstress.explore.size.scaled_study import moved
from pinstress.explore.sweep.evaluate import Evaluator
from pinstress.explore.sweep.number import number_at
from pinstress.study.reading.file import Study
from pinstress.study.reading.inputs import inputs
from pinstress.study.reading.materials import library
from pinstress.study.reading.shipped import shipped
from tests.support.each import each
from tests.support.study_text import study_file

STUDY = """{head}
title = "One pin"
units = "mm-N-s"
{tables}
[pin.B]
material = "{material}"
clamp = ["start"]
profile = [
  {{ length = 40, diameter = 100, name = "root" }},
  {{ length = 50, diameter = 50, connection = "B" }},
]
fillet = 10

[case.landing]
kind = "given"
forces = {{ B = [0, -4000] }}

[analysis]
model = "beam"
"""
OWN = """
[material.{name}]
note = "a certificate"
provenance = "given"
youngs_modulus = "{modulus}"
poisson_ratio = 0.3
yield_strength = "{strength}"
"""
KSI = 6.894757293168361e6  # Pa


def written(folder: Path, material: str, head: str = "", tables: str = "") -> Path:
    return study_file(folder, STUDY.format(head=head, tables=tables, material=material))


def steel(name: str = "S", modulus: str = "200 GPa", strength: str = "355 MPa") -> str:
    return OWN.format(name=name, modulus=modulus, strength=strength)


def yield_of(study: Study) -> float | None:
    (task,) = prepare(study).tasks
    return task.material.yield_strength


def test_a_material_of_the_library_is_used_and_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, "6061-T651")
    study = load_study(path)
    assert yield_of(study) == pytest.approx(40.0 * KSI)
    said = "the library of pinstress"
    assert any("6061-T651" in x and said in x and "Grenier" in x for x in run(study).assumptions)
    assert any(x.key == "material.6061-T651" and "table 1" in x.note for x in study.provenance)
    assert run_command_line(["check", str(path)]) == 0
    assert f"material 6061-T651: that of {said} (M. Grenier" in capsys.readouterr().out


def test_the_library_has_the_steel_of_the_main_study(tmp_path: Path) -> None:
    """Both are table 1 of Grenier (2008), which has an ultimate strength, too."""
    main = load_study(shipped("grenier2008.toml")).table.material["AISI 4340"]
    ours = load_study(written(tmp_path, "AISI 4340")).table.material["AISI 4340"]
    for key, value in main.model_dump(exclude_defaults=True).items():
        assert getattr(ours, key) == (pytest.approx(value) if value else value)
    assert ours.ultimate_strength == pytest.approx(269.0 * KSI)


@each("name", library())
def test_every_material_of_the_library_has_a_source_and_is_usable_or_says_why_not(
    name: str, tmp_path: Path
) -> None:
    stored = library()[name]
    assert stored.table["provenance"] == "given"
    assert len(stored.source) > 10
    path = written(tmp_path, name)
    if stored.missing:
        with pytest.raises(InputError) as caught:
            load_study(path)
        for part in (name, stored.source, *stored.missing):
            assert part in str(caught.value)
    else:
        assert yield_of(load_study(path))


def test_a_study_comes_before_its_file_and_that_before_the_library(tmp_path: Path) -> None:
    (tmp_path / "ours.toml").write_text(steel("6061-T651", strength="250 MPa"))
    head, own = 'materials = "ours.toml"', steel("6061-T651", strength="200 MPa")
    for top, tables, strength in ((head, own, 200e6), (head, "", 250e6), ("", "", 40.0 * KSI)):
        study = load_study(written(tmp_path, "6061-T651", top, tables))
        assert yield_of(study) == pytest.approx(strength)
        assert any("6061" in x for x in run(study).assumptions) == (not tables)


def test_a_changed_file_gives_new_answers(tmp_path: Path) -> None:
    """Also where answers are remembered, and in what `sweep --resume` compares."""
    path, factors, values = written(tmp_path, "S", 'materials = "ours.toml"'), [], []
    memo = Memo()
    for strength in ("355 MPa", "710 MPa"):
        (tmp_path / "ours.toml").write_text(steel(strength=strength))
        study = load_study(path)
        factors.append(Engine(study, memo=memo).row({}, "B", "landing").safety_factor)
        values.append(inputs(study))
    assert None not in factors
    assert factors[1] == pytest.approx(2.0 * (factors[0] or 0.0))
    changed = {key for key in values[0] if values[0][key] != values[1][key]}
    assert changed == {"materials", "material.S.yield_strength"}


def test_a_number_of_a_material_that_is_only_named_has_a_key(tmp_path: Path) -> None:
    study, key = load_study(written(tmp_path, "6061-T651")), "material.6061-T651.yield_strength"
    number = number_at(study, key)
    assert number.nominal == pytest.approx(40.0 * KSI)
    assert yield_of(Evaluator(study, [number]).changed([3e8])) == pytest.approx(3e8)
    changed = Engine(study).changed({key: 300})
    assert yield_of(changed) == pytest.approx(3e8)
    assert changed.table.material["6061-T651"].density == pytest.approx(2700.0, rel=1e-3)


def test_an_engine_takes_another_material_of_the_library(tmp_path: Path) -> None:
    study, changes = load_study(written(tmp_path, "6061-T651")), {"pin.B.material": "316L"}
    engine = Engine(study)
    row, changed = engine.row(changes, "B", "landing"), engine.changed(changes)
    assert row.safety_factor == pytest.approx(run(changed)["B", "landing"].safety_factor)
    assert yield_of(changed) == pytest.approx(42.1 * KSI)
    with pytest.raises(InputError, match="A36' of the library of pinstress has no youngs_modulus"):
        engine.row({"pin.B.material": "A36"}, "B", "landing")


def test_a_study_that_is_written_elsewhere_names_the_same_file(tmp_path: Path) -> None:
    (tmp_path / "ours.toml").write_text(steel())
    there = tmp_path / "there"
    there.mkdir()
    path = written(tmp_path, "S", 'materials = "ours.toml"')
    written_there = there / "study.toml"
    written_there.write_text(moved(path.read_text(), tmp_path, there))
    assert yield_of(load_study(written_there)) == pytest.approx(355e6)


def test_the_file_is_noted_so_that_it_is_sent_to_other_computers(tmp_path: Path) -> None:
    (tmp_path / "ours.toml").write_text(steel())
    with noted_files() as files:
        load_study(written(tmp_path, "S", 'materials = "ours.toml"'))
    assert tmp_path / "ours.toml" in files


@each(
    ("content", "message"),
    [
        (None, r"ours.toml: no such file"),
        ("[material", r"ours.toml:1: not valid TOML"),
        ("units = 'mm-N-s'", r"ours.toml: a file of materials has tables \[material.NAME\], not"),
        ("material.S = 1", r"ours.toml: material.S: must be a table"),
        (steel().replace('"200 GPa"', "200000"),
         r"material.S.youngs_modulus: a quantity has no unit"),
        (steel(modulus="-1 GPa"), r"ours.toml: material.S.youngs_modulus: must be positive"),
        (steel() + "hardness = 3", r"ours.toml: material.S: unknown key 'hardness'"),
        (steel().replace("poisson_ratio = 0.3", ""),
         r"material 'S' of ours.toml has no poisson_ratio, which its source \(a certificate\)"),
        (steel("T"), r"study.toml:\d+: pin.B.material: no material 'S'"),
    ],
)  # fmt: skip
def test_what_is_refused(content: str | None, message: str, tmp_path: Path) -> None:
    if content is not None:
        (tmp_path / "ours.toml").write_text(content)
    with pytest.raises(InputError, match=message):
        load_study(written(tmp_path, "S", 'materials = "ours.toml"'))


def test_the_command_lists_materials_and_the_values_of_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "ours.toml").write_text(steel())
    assert run_command_line(["materials", "--materials", str(tmp_path / "ours.toml")]) == 0
    listed = capsys.readouterr().out
    assert "AISI 4340" in listed
    assert "a certificate" in listed
    assert run_command_line(["materials", "4130 125 ksi"]) == 0
    shown = capsys.readouterr().out
    assert 'shear_strength = "82 ksi"  # AFFDL-TR-69-42' in shown
    assert "# poisson_ratio: missing, AFFDL-TR-69-42" in shown
    assert run_command_line(["materials", "6061-T651", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["yield_strength"] == "40 ksi"
    assert run_command_line(["materials", "6061"]) == 2
    assert "did you mean '6061-T651'?" in capsys.readouterr().err


@each(
    ("old", "new", "message"),
    [
        ('"355 MPa"', "355", "material.S.yield_strength: a quantity has no unit"),
        ('"355 MPa"', '"355 mm"', "material.S.yield_strength: "),
        ("yield_", "yeild_", "material.S: unknown key 'yeild_strength'; did you mean 'yield_stren"),
    ],
)
def test_the_command_refuses_a_file_that_no_study_can_use(
    old: str, new: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It listed such values as if they were good, with exit status 0."""
    file = tmp_path / "ours.toml"
    file.write_text(steel().replace(old, new))
    for words in ([], ["S"]):
        assert run_command_line(["materials", "--materials", str(file), *words]) == 2
        done = capsys.readouterr()
        assert f"Error: ours.toml: {message}" in done.err
        assert not done.out


def test_the_command_prints_tables_sources_of_lines_and_quoted_names_as_toml(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A table was "a table", and the second line of a source no comment."""
    text = steel("'5\" bar'") + (
        'ultimate_strength = { value = "510 MPa", note = """a test\nof ours""" }\n'
        'range.yield_strength = ["350 MPa", "360 MPa"]\n'
    )
    (tmp_path / "ours.toml").write_text(text)
    command = "materials", "--materials", str(tmp_path / "ours.toml"), '5" bar'
    assert run_command_line([*command]) == 0
    printed = tomllib.loads(capsys.readouterr().out)["material"]['5" bar']
    assert printed["range"] == {"yield_strength": ["350 MPa", "360 MPa"]}
    assert printed["ultimate_strength"] == "510 MPa"


def test_what_the_command_prints_is_a_material_of_a_study(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command_line(["materials", "14S-T bar 2 x 2 in"]) == 0
    own = capsys.readouterr().out
    named, defined = (
        load_study(written(tmp_path, "14S-T bar 2 x 2 in", tables=tables)) for tables in ("", own)
    )
    assert named.table == defined.table
