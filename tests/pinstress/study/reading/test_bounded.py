"""Wrong input of any size is reported soon and briefly enough for a user to wait and to read it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import pinstress
from pinstress.study.reading.errors import MAX_LISTED_ERRORS
from pinstress.study.schema.shown import MAX_TEXT_LENGTH, as_text, cut
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.limited_process import limited as check
from tests.support.programs.limited_process import start_server

ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()
MECHANISM = (ROOT / "studies" / "slider_crank.toml").read_text()
TABLE = ONE_PIN.replace("forces = { B = [0.0, -988.86] }", 'table = "given.csv"')


@pytest.fixture(scope="module", autouse=True)
def _server() -> None:
    start_server()


def changed(old: str, new: str, text: str = ONE_PIN) -> str:
    assert text.count(old) >= 1
    return text.replace(old, new, 1)


def segments(count: int, more: Callable[[int], str]) -> str:
    """The study with so many more segments, each with something more on its line."""
    lines = "".join(f"  {{ length = 0.2, diameter = 4.0{more(i)} }},\n" for i in range(count))
    return changed("profile = [", "profile = [\n" + lines)


LONG = "x" * 400_000
TOO_MANY = {
    "segments with one unknown key": lambda n: segments(n, lambda i: ", diametre = 4.0"),
    "segments with many unknown keys": lambda n: segments(n, lambda i: f", key{i} = 4.0"),
    "segments of unknown units": lambda n: segments(n, lambda i: f', bore = "{i} unit{i}"'),
    "unknown keys of a table": lambda n: changed(
        "[analysis]", "[analysis]\n" + "".join(f"key{i} = 1\n" for i in range(n))
    ),
    "provenances that are none": lambda n: segments(
        n, lambda i: ', bore = { value = 0.0, provenance = "guess" }'
    ),
    "pins of unknown materials": lambda n: (
        ONE_PIN
        + "".join(
            f'[pin.P{i}]\nmaterial = "steel {i}"\nprofile = [{{length = 1, diameter = 1}}]\n'
            for i in range(n)
        )
        + "".join(
            f'[material."stele {i}"]\nyoungs_modulus = 3e7\npoisson_ratio = 0.3\n' for i in range(n)
        )
    ),
    "forces at unknown connections": lambda n: changed(
        "forces = {", "forces = { " + "".join(f"B{i} = [0.0, 1.0], " for i in range(n))
    ),
    "loads on unknown bodies": lambda n: (
        MECHANISM + "".join(f'[[case.turn.apply]]\nbody = "rod{i}"\ncouple = 1\n' for i in range(n))
    ),
}


LIMITED = (
    "segments with one unknown key",
    "segments with many unknown keys",
    "segments of unknown units",
    "provenances that are none",
    "pins of unknown materials",
    "loads on unknown bodies",
)


@each("kind", TOO_MANY)
def test_of_many_errors_the_first_are_told(tmp_path: Path, kind: str) -> None:
    require_first_told(tmp_path, kind, 1_000)


@pytest.mark.long
@pytest.mark.parametrize("kind", TOO_MANY)
def test_of_ten_thousand_errors_the_first_are_told(tmp_path: Path, kind: str) -> None:
    require_first_told(tmp_path, kind, 10_000)


def require_first_told(tmp_path: Path, kind: str, count: int) -> None:
    (tmp_path / "study.toml").write_text(TOO_MANY[kind](count))
    status, told = check(tmp_path / "study.toml")
    heading, *lines = told.splitlines()
    assert status == 2
    count += kind in LIMITED  # that there are too many is said once, beside the others
    assert f"{count:,} errors" in heading
    assert len(lines) == MAX_LISTED_ERRORS + 1
    assert lines[-1].endswith(f"and {count - MAX_LISTED_ERRORS:,} more")
    numbers = [int(line.split(":")[1]) for line in lines[:-1]]
    assert numbers == sorted(numbers)
    assert len(told) < 20_000


def named(count: int) -> str:
    """So many unlike pins, which a hint may name."""
    pin = "profile = [{ length = 1.0, diameter = 1.0 }]"
    return "".join(f'[pin.P{i}]\nmaterial = "AISI 4340"\n{pin}\n' for i in range(count))


BEYOND: dict[str, tuple[Callable[[], str], str]] = {
    "segments": (
        lambda: segments(100_000, lambda i: ""),
        "pin.B.profile: 100,002 segments; the limit is",
    ),
    "pins": (lambda: ONE_PIN + named(20_000), "pin: 20,001 pins; the limit is 1,000"),
    "cases": (
        lambda: MECHANISM + "".join(f'[case.c{i}]\nkind = "static"\n' for i in range(20_000)),
        "case: 20,001 cases",
    ),
    "bodies": (
        lambda: MECHANISM + "".join(f"[mechanism.body.b{i}]\nmass = 1\n" for i in range(20_000)),
        "mechanism.body: 20,003 bodies; the limit is 500",
    ),
    "a slender pin": (
        lambda: changed("length = 1.5", 'length = "999 m"'),
        "pin.B.profile: the pin is 9,833 times as long as it is wide; the limit is 1,000",
    ),
    "a stepped pin": (
        lambda: changed("diameter = 4.0", 'diameter = "999 m"'),
        "pin.B.profile: the pin is 19,665 times as wide as elsewhere; the limit is 3,000",
    ),
    "samples": (
        lambda: changed("samples = 241", "samples = 1000000000", MECHANISM),
        "case.turn.samples: must be at most 100,001",
    ),
    "a short duration": (
        lambda: changed("duration = 0.25", "duration = 1e-200", MECHANISM),
        "mechanism.drive[1].duration: must be at least 1e-18",
    ),
}


@pytest.mark.parametrize(
    "kind",
    [pytest.param(k, marks=[pytest.mark.slow] * (k in ("segments", "pins"))) for k in BEYOND],
)
def test_more_than_can_be_calculated_is_refused(tmp_path: Path, kind: str) -> None:
    text, message = BEYOND[kind]
    (tmp_path / "study.toml").write_text(text())
    status, told = check(tmp_path / "study.toml")
    assert status == 2
    assert message in told


def test_as_much_as_can_be_calculated_is_not(tmp_path: Path) -> None:
    text = segments(998, lambda i: "").replace("fillet = 0.4", "fillet = 0.0")
    (tmp_path / "study.toml").write_text(text + named(999))
    assert check(tmp_path / "study.toml") == (0, "")


BLANKS, DOTS = " " * 3_000, ".".join("a" * 20_000)
AT_ONCE = {
    "blanks after a number": changed("length = 1.5", f'length = "1{BLANKS}x"'),
    "blanks before a unit": changed("length = 1.5", f'length = "1{" " * 150}in{" " * 40}x"'),
    "digits": changed("length = 1.5", f'length = "1{"0" * 400_000} in"'),
    "exponents": changed("length = 1.5", f'length = "1{"e1" * 90} in"'),
    "a large exponent": changed("length = 1.5", 'length = "1e99999999999999999999 in"'),
    "products": changed("length = 1.5", f'length = "1 in{"*in" * 10_000}"'),
    "a power": changed("length = 1.5", 'length = "1 in^9999999999"'),
    "powers of powers": changed("length = 1.5", 'length = "1 in^9^9^9^9^9"'),
    "superscripts": changed("length = 1.5", 'length = "1 in^9⁹⁹⁹⁹⁹⁹⁹⁹⁹"'),
    "powers in brackets": changed("length = 1.5", 'length = "1 (9*9**(99*99*99*99*99)) in"'),
    "brackets in a unit": changed("length = 1.5", f'length = "1 {"(" * 90}in{")" * 90}*in"'),
    "brackets without end": changed("length = 1.5", f'length = "1 {"(" * 100_000}in"'),
    "an unknown unit": changed("length = 1.5", f'length = "1 {LONG}"'),
    "a word for a length": changed("length = 1.5", f'length = "{LONG}"'),
    "an array for a length": changed("length = 1.5", f"length = [{'1.0, ' * 200_000}]"),
    "a dotted key": changed("length = 1.5", f"{DOTS} = 1.5"),
    "a dotted header": ONE_PIN + f"\n[{DOTS}]\n",
    "a dotted array of tables": ONE_PIN + f"\n[[{DOTS}]]\n",
    "dotted keys in brackets": changed(
        "length = 1.5", "{".join(f"{'.'.join('a' * 40)} = " for _ in range(400)) + "}" * 399
    ),
    "tables in tables": changed("length = 1.5", "a = " + "{a = " * 4_000 + "1" + "}" * 4_000),
    "arrays in arrays": changed("length = 1.5", f"length = {'[' * 100_000}"),
    "a long key": changed("length = 1.5", f"{LONG} = 1.5"),
    "a long key in quotes": changed("length = 1.5", f'"{LONG}" = 1.5'),
    "the name of a table": changed("[analysis]", f'[material."{LONG}"]'),
    "a whole number": changed("poisson_ratio = 0.30", f"poisson_ratio = 0x{'f' * 100_000}"),
    "a whole number of 900 digits": changed("poisson_ratio = 0.30", f"poisson_ratio = {'9' * 900}"),
    "a hexadecimal length": changed("length = 1.5", f"length = 0x{'f' * 900}"),
    "a hexadecimal system": changed('units = "in-lbf-s"', f"units = 0x{'f' * 900}"),
    "a unit system": changed('units = "in-lbf-s"', f'units = "{LONG}"'),
    "a kind": changed('kind = "given"', f'kind = "{LONG}"'),
    "a material": changed('material = "AISI 4340"', f'material = "{LONG}"'),
    "a provenance": changed("length = 1.5", f'length = {{ value = 1, provenance = "{LONG}" }}'),
    "a clamp": changed('clamp = ["start"]', f'clamp = ["{LONG}"]'),
    "a connection": changed("forces = { B =", f"forces = {{ {'y' * 900} ="),
    "a model": changed("[analysis]", f'[analysis]\nmodel = "{LONG}"'),
    "a table's name": TABLE.replace("given.csv", LONG),
    "a string without end": changed("title = ", 'title = "' + '\\"' * 200_000),
    "strings without end": ONE_PIN + '\nx = """' + '\n\\"""' * 100_000,
    "an escape": changed("title = ", f'title = "{LONG}\\q" #'),
    "a duplicate key": ONE_PIN + f"\n[a]\n{'x' * 900} = 1\n{'x' * 900} = 1\n",
    "no value": ONE_PIN + "\n" + "x = \n" * 100_000,
    "infinity": changed("poisson_ratio = 0.30", "poisson_ratio = inf"),
}


@each("kind", AT_ONCE)
def test_whatever_is_written_is_told_at_once_and_shortly(tmp_path: Path, kind: str) -> None:
    (tmp_path / "study.toml").write_text(AT_ONCE[kind])
    status, told = check(tmp_path / "study.toml")
    assert status == 2
    assert told.startswith("Error: ")
    assert len(told) < 2_500
    assert "Traceback" not in told


CELLS = "B,0,-988.86\n"
# Made when they are tested: some are 100 MB.
TABLES = {
    "columns": lambda: "connection,fx,fy" + "".join(f",c{i}" for i in range(100_000)) + "\n",
    "columns on a long line": lambda: (
        "connection,fx,fy" + "".join(f",c{i}" for i in range(1_000_000))
    ),
    "one column many times": lambda: "connection,fx,fy" + ",fx" * 1_000_000 + "\n",
    "a line": lambda: "connection,fx,fy\n" + "B,0," * 25_000_000 + "\n",
    "a cell": lambda: "connection,fx,fy\nB,0," + "9" * 100_000 + "x\n",
    "a number": lambda: "connection,fx,fy\nB,0," + "9" * 100_000 + "\n",
    "an infinite number": lambda: "connection,fx,fy\nB,0," + "0" * 100_000 + "1e999\n",
    "a quote without end": lambda: "connection,fx,fy\n" + CELLS + '"' + CELLS * 1_000_000,
    "a connection": lambda: "connection,fx,fy\n" + "y" * 100_000 + ",0,1\n",
    "a column": lambda: "connection,fx,fy," + "y" * 100_000 + "\n" + CELLS,
    "rows": lambda: "connection,fx,fy\n" + CELLS * 200_000,
}


@each("kind", TABLES)
def test_a_table_of_any_size_is_told_at_once(tmp_path: Path, kind: str) -> None:
    (tmp_path / "study.toml").write_text(TABLE)
    (tmp_path / "given.csv").write_text(TABLES[kind]())
    status, told = check(tmp_path / "study.toml")
    assert status == 2
    assert "given.csv" in told
    assert len(told) < 2_500


def test_a_large_study_that_is_right_is_read(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(("# " + "c" * 77 + "\n") * 190_000 + ONE_PIN)
    assert check(tmp_path / "study.toml") == (0, "")


def test_numbers_that_are_none_are_refused_everywhere(tmp_path: Path) -> None:
    """Every number of the shipped studies, one after the other, as nan and as infinity."""
    path, kept = tmp_path / "study.toml", []
    for study in ("one_pin", "slider_crank", "kuleuven2014"):
        text = (ROOT / "studies" / f"{study}.toml").read_text()
        for number, span in _numbers(text):
            for worse in ("nan", "inf", "-inf"):
                path.write_text(text[: span[0]] + worse + text[span[1] :])
                try:
                    pinstress.load_study(path)
                except pinstress.InputError as error:
                    assert "study.toml" in str(error)  # noqa: PT017
                else:
                    kept.append((study, number, worse))
    assert kept == []


def _numbers(text: str) -> list[tuple[str, tuple[int, int]]]:
    from pinstress.study.reading.toml_lines import TOKEN_PATTERN

    found, start = [], None
    for match in TOKEN_PATTERN.finditer(text):
        number = match[0].lstrip("+-").isdigit() or (start is not None and match[0] == ".")
        if number and start is None:
            start = match.start()
        if not number and start is not None:
            if text[:start].rstrip(" -")[-1] in "=[,":
                found.append((text[start : match.start()].strip(), (start, match.start())))
            start = None
    return found


def test_a_value_is_cut_where_it_is_shown() -> None:
    assert as_text("x" * 1000) == repr("x" * (MAX_TEXT_LENGTH - 1) + "…")
    assert as_text("short") == "'short'"
    assert len(as_text([LONG] * 1000)) <= MAX_TEXT_LENGTH
    assert as_text(2**20_000) == "a whole number of more than 80 digits"
    assert as_text(12) == "12"
    assert cut("abc", 3) == "abc"
    assert cut("abcd", 3) == "ab…"


@each("columns", [100, 100_000, 1_000_000])
def test_a_published_table_may_have_other_columns_but_not_any_number(
    tmp_path: Path, columns: int
) -> None:
    text = ONE_PIN + '\n[published]\nsource = "a book"\npeaks = "peaks.csv"\n'
    (tmp_path / "study.toml").write_text(text)
    more = [f"c{i}" for i in range(columns)]
    rows = ["pin,case,max_von_mises,safety_factor", *(f"B,landing,{i},2" for i in range(1, 3))]
    wide = [",".join([row, *more]) for row in rows]
    (tmp_path / "peaks.csv").write_text("\n".join(wide))
    status, told = check(tmp_path / "study.toml")
    assert (status, "peaks.csv" in told) == ((0, False) if columns == 100 else (2, True))
    assert len(told) < 2_500
