"""The page of a sweep's designs: brushing, the front, the design shown, the table and its file."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from pinstress.explore.sweep.design_columns import designs_of
from pinstress.explore.sweep.page import render_designs
from reports.format.numbers import engineering, short
from tests.browser.test_page import AXE, FAULTS
from tests.support.each import sampled
from tests.support.results.browser_page import PIXELS, errors, screen, wait
from tests.support.results.html_page import EVIL
from tests.support.results.made_up_designs import FAILING, REQUIRED, made_up_designs, table_of

pytestmark = pytest.mark.browser

ROWS = (("B", "landing"), ("B", "retract"), ("E", "landing"))
COUNT = 400
FIRST = "pin.B.profile[1].diameter"
SELECTED = "return [...page.mask].flatMap((is, d) => (is ? [d] : []));"
CHOOSE = """
const select = document.getElementById(arguments[0]);
const named = [...select.options].find((o) => o.textContent === arguments[1]);
select.value = named.value;
select.dispatchEvent(new Event("change"));
"""
STATUS = "return document.getElementById('status').textContent;"
CARD = "return document.getElementById('card').textContent;"
HEADS = "return [...document.querySelectorAll('#selection thead th')].map((h) => h.textContent);"
CELLS = """
return [...document.querySelectorAll("#selection tbody tr")].map(
  (row) => [...row.cells].map((cell) => cell.textContent));
"""
# Objectives at random with ties, and a selection: the front by the page.
FRONT = """
const [a, b, mask, signs] = arguments;
return frontOf(ordered(a, b, signs), a, b, signs, mask);
"""


@pytest.fixture(scope="module")
def table() -> pa.Table:
    return made_up_designs(COUNT, 4, ROWS, failing=0.05)


def shown(browser: Any, table: pa.Table, folder: Path) -> Any:
    path = folder / "designs.html"
    path.write_text(render_designs(designs_of(table)), encoding="utf-8")
    browser.get_log("browser")
    browser.get(path.as_uri())
    wait(browser, lambda: browser.execute_script("return page !== null;"))
    wait(browser, lambda: browser.execute_script(STATUS))
    return browser


@pytest.fixture
def page(browser: Any, table: pa.Table, tmp_path: Path) -> Any:
    return shown(browser, table, tmp_path)


def selection(page: Any, count: int | None = None) -> set[int]:
    """The selected designs from 0, once there are so many, or else any but all."""
    found: list[int] = []

    def ready() -> bool:
        found[:] = page.execute_script(SELECTED)
        return len(found) == count if count is not None else len(found) < COUNT

    wait(page, ready)
    return set(found)


def least(table: pa.Table) -> dict[str, Any]:
    """Of every design, by numpy: its factor, mass and the failed ones."""
    factors = table.column("safety_factor").to_numpy().reshape(COUNT, len(ROWS))
    mass = table.column("mass").to_numpy().reshape(COUNT, len(ROWS))
    failed = np.isnan(factors).all(axis=1)
    first = table.column(FIRST).to_numpy()[:: len(ROWS)]
    return {
        "factor": np.where(failed, np.nan, factors.min(axis=1)),
        "mass": mass[:, 0] + mass[:, 2],
        "failed": failed,
        "first": first,
    }


def drag(page: Any, element: Any, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Drag between parts of an element, from its upper left corner."""
    from selenium.webdriver import ActionChains

    page.execute_script("arguments[0].scrollIntoView({ block: 'center' });", element)
    size = element.size
    at = [(x * size["width"], y * size["height"]) for x, y in (start, end)]
    offsets = [(round(x - size["width"] / 2), round(y - size["height"] / 2)) for x, y in at]
    chain = ActionChains(page).move_to_element_with_offset(element, *offsets[0]).click_and_hold()
    step = [b - a for a, b in zip(*offsets, strict=True)]
    chain.move_by_offset(*step).release().perform()


def test_it_is_one_file_that_asks_for_nothing(page: Any) -> None:
    names = page.execute_script("return performance.getEntriesByType('resource').map(r => r.name);")
    assert names == []
    assert errors(page) == []
    assert page.execute_script(STATUS).startswith(f"{COUNT} of {COUNT} designs selected, ")


def test_dragging_along_an_axis_selects_what_is_within(page: Any, table: pa.Table) -> None:
    grab = page.find_element("css selector", ".axis .grab")
    drag(page, grab, (0.5, 0.25), (0.5, 0.75))
    chosen = selection(page)
    low, high = page.execute_script("return page.ranges.get(0);")
    first = least(table)["first"]
    assert chosen == set(np.flatnonzero((first >= low) & (first <= high)).tolist())
    assert low == pytest.approx(15.0, abs=0.6)
    assert high == pytest.approx(25.0, abs=0.6)
    grab.click()  # without a drag it removes the range
    assert len(selection(page, COUNT)) == COUNT
    assert errors(page) == []


def test_what_is_drawn_in_steps_is_what_is_drawn_at_once(page: Any) -> None:
    """Counts of lines go up and down by whole numbers: nothing is left over."""
    canvas = page.find_element("css selector", "#lines canvas")
    before = page.execute_script(PIXELS, canvas)
    for low in (12.0, 12.5, 14.0, 20.0, 13.0):
        page.execute_script(f"page.ranges.set(0, [{low}, 25]); page.redraw();")
    stepped = page.execute_script(PIXELS, canvas)
    page.execute_script("page.redraw(true);")
    assert page.execute_script(PIXELS, canvas) == stepped != before
    page.execute_script("page.ranges.clear(); page.redraw();")
    assert page.execute_script(PIXELS, canvas) == before


def test_a_rectangle_selects_by_both_columns(page: Any, table: pa.Table) -> None:
    over = page.find_elements("css selector", "#scatter canvas")[1]
    drag(page, over, (0.3, 0.2), (0.6, 0.7))
    chosen, known = selection(page), least(table)
    ranges = dict(page.execute_script("return [...page.ranges];"))
    keys = page.execute_script("return page.model.columns.map((c) => c.key);")
    bounds = {keys[k]: ends for k, ends in ranges.items()}
    assert set(bounds) == {"mass", "safety_factor"}
    within = np.ones(COUNT, bool)
    for key, values in (("mass", known["mass"]), ("safety_factor", known["factor"])):
        low, high = bounds[key]
        within &= (values >= low) & (values <= high)
    assert chosen == set(np.flatnonzero(within).tolist())
    assert 0 < len(chosen) < COUNT


def test_ranges_can_be_typed(page: Any, table: pa.Table) -> None:
    end = page.find_element("css selector", '#ranges [aria-label="safety factor from"]')
    page.execute_script("arguments[0].scrollIntoView();", end)
    end.send_keys(str(REQUIRED), "\t")
    known = least(table)
    wanted = set(np.flatnonzero(known["factor"] >= REQUIRED).tolist())
    assert selection(page, len(wanted)) == wanted
    page.find_element("id", "clear").click()
    selection(page, COUNT)


def test_a_pin_and_case_can_be_chosen(page: Any, table: pa.Table) -> None:
    page.execute_script(CHOOSE, "view", "pin E, landing")
    factor = page.execute_script(
        "return [...page.now().values[page.model.byKey.safety_factor.index]];"
    )
    wanted = table.column("safety_factor").to_numpy()[2 :: len(ROWS)]
    found = np.array([np.nan if v is None else v for v in factor], float)
    assert np.array_equal(found, wanted, equal_nan=True)


def test_least_factor_and_mass_are_those_of_the_whole_design(page: Any, table: pa.Table) -> None:
    known = least(table)
    for key, wanted in (("safety_factor", known["factor"]), ("mass", known["mass"])):
        script = f"return [...page.now().values[page.model.byKey.{key}.index]];"
        found = np.array([np.nan if v is None else v for v in page.execute_script(script)], float)
        assert np.array_equal(found, wanted, equal_nan=True)


def test_verdicts_filter(page: Any, table: pa.Table) -> None:
    labels = page.find_elements("css selector", "#verdicts label")
    named = {label.text.split(" (")[0]: label for label in labels}
    failed = int(least(table)["failed"].sum())
    assert named["failed"].text == f"failed ({failed})"
    named["failed"].click()
    assert len(selection(page, COUNT - failed)) == COUNT - failed


def test_the_front_is_what_brute_force_finds(page: Any) -> None:
    random = np.random.default_rng(4)
    for signs in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        a, b = random.integers(0, 12, (2, 120)).astype(float)
        mask = random.random(120) < 0.7
        mine, other = signs[0] * a[mask], signs[1] * b[mask]
        worse = [
            ((mine <= p) & (other <= q) & ((mine < p) | (other < q))).any()
            for p, q in zip(mine, other, strict=True)
        ]
        wanted = set(np.flatnonzero(mask)[~np.array(worse)].tolist())
        arguments = (a.tolist(), b.tolist(), mask.astype(int).tolist(), list(signs))
        assert set(page.execute_script(FRONT, *arguments)) == wanted


def test_only_the_front_can_be_selected(page: Any) -> None:
    front = page.execute_script("return page.front();")
    page.find_element("id", "on-front").click()
    assert selection(page, len(front)) == set(front)
    wait(page, lambda: page.execute_script(STATUS).startswith(f"{len(front)} of"))


def test_pointing_shows_a_design_with_all_its_numbers(page: Any, table: pa.Table) -> None:
    row = page.find_element("css selector", "#selection tbody button")
    number = int(row.text)
    page.execute_script("arguments[0].click();", row)
    known = table.slice((number - 1) * len(ROWS), len(ROWS)).to_pylist()
    governing = min(known, key=lambda r: r["safety_factor"])
    text = page.execute_script(CARD)
    assert f"Design {number} (kept)" in text
    assert f"{engineering(governing['max_von_mises'])} ± " in text
    assert f"{short(governing[FIRST])} mm" in text
    assert f"Pin {governing['pin']}, case {governing['case']}. {governing['verdict']}: " in text
    values = page.execute_script(
        "return [...document.querySelectorAll('#card dd')].map((d) => d.dataset.value);"
    )
    for value in (governing["max_von_mises"], governing["safety_factor"], governing[FIRST]):
        assert value in [float(v) for v in values if v]
    page.find_element("css selector", "body").send_keys("\ue00c")  # Escape
    assert "Point at" in page.execute_script(CARD)


def test_arrow_keys_step_through_the_designs(page: Any) -> None:
    from selenium.webdriver import Keys

    over = page.find_elements("css selector", "#scatter canvas")[1]
    told = []
    for _ in range(2):
        over.send_keys(Keys.ARROW_RIGHT)
        told.append(page.execute_script(CARD))
    assert told[0] != told[1]
    over.send_keys(Keys.ARROW_LEFT)
    assert page.execute_script(CARD) == told[0]


def test_the_pointer_finds_the_nearest_line(page: Any) -> None:
    from selenium.webdriver import ActionChains

    layers = page.find_element("css selector", "#lines svg")
    page.execute_script("page.ranges.set(0, [10, 11]); page.redraw();")
    page.execute_script("arguments[0].scrollIntoView();", layers)
    wide, tall = layers.size["width"], layers.size["height"]
    for k in range(12):
        offset = (-wide // 2 + 90, round(tall * (0.05 * k - 0.1)))
        ActionChains(page).move_to_element_with_offset(layers, *offset).perform()
        if "Design" in page.execute_script(CARD):
            return
    raise AssertionError("no line was found")


def test_the_table_sorts_and_its_file_has_every_digit(page: Any, table: pa.Table) -> None:
    heads = page.execute_script(HEADS)
    at = heads.index("safety factor")
    cells = page.execute_script(CELLS)
    assert len(cells) == 300
    first = [float(row[at].replace(",", "")) for row in cells]
    assert first == sorted(first)
    button = page.find_elements("css selector", "#selection thead button")[at]
    page.execute_script("arguments[0].click();", button)
    wait(page, lambda: page.execute_script(CELLS)[0] != cells[0])
    rows = list(csv.DictReader(io.StringIO(page.execute_script("return page.csv();"))))
    assert len(rows) == COUNT
    known = least(table)
    for row in rows:
        d = int(row["design"]) - 1
        assert float(row[FIRST]) == known["first"][d]
        assert (row["safety_factor"] == "") == known["failed"][d]
        assert row["safety_factor"] == "" or float(row["safety_factor"]) == known["factor"][d]
    assert rows[-1]["reason"] == FAILING[0]  # those without a value are the last


def test_the_table_has_no_empty_column(browser: Any, tmp_path: Path) -> None:
    heads = shown(browser, ODD["one"], tmp_path).execute_script(HEADS)
    assert not any(head.startswith("governing time") for head in heads)
    assert any(head.startswith("safety factor") for head in heads)


def test_the_table_has_the_digits_that_errors_leave(page: Any) -> None:
    heads = page.execute_script(HEADS)
    for name, most in (("maximum von Mises [MPa]", 4), ("± of maximum [MPa]", 2)):
        at = heads.index(name)
        digits = [len(row[at].replace(",", "").replace(".", "").lstrip("0"))
                  for row in page.execute_script(CELLS) if row[at] != "–"]  # fmt: skip
        assert digits
        assert max(digits) <= most


def test_scales_can_be_logarithmic(page: Any) -> None:
    canvas = page.find_element("css selector", "#scatter canvas")
    before = page.execute_script(PIXELS, canvas)
    name = "logarithmic scale of safety factor"
    box = page.find_element("xpath", f'//label[span[text()="{name}"]]/input')
    page.execute_script("arguments[0].click();", box)
    assert page.execute_script(PIXELS, canvas) != before
    at = "const s = scaleOf(page.model.byKey.safety_factor, [0.1, 1, 10], null);"
    found = page.execute_script(
        f"{at} return [0.1, 1, 10, 2].map((v) => s.at(v)).concat(s.back(s.at(2)));"
    )
    assert np.diff(found[:3]) == pytest.approx(0.48)
    assert found[4] == pytest.approx(2.0)


@pytest.mark.parametrize("shade", sampled(["dark", "light"], every=2))
def test_axe_finds_nothing_serious(page: Any, shade: str) -> None:
    page.execute_script(f"document.documentElement.style.colorScheme = '{shade}'; page.lay();")
    page.execute_script(AXE.read_text(encoding="utf-8"))
    assert page.execute_async_script(FAULTS) == []


# Words before choices that are broken into several lines.
BROKEN = """
return [...document.querySelectorAll(".bar label")].map((label) => label.firstChild)
  .filter((node) => node.nodeType === Node.TEXT_NODE && /^\\w+ $/.test(node.textContent))
  .filter((node) => {
    const range = document.createRange();
    range.selectNodeContents(node);
    return new Set([...range.getClientRects()].map((r) => r.top)).size > 1;
  }).map((node) => node.textContent);
"""


@pytest.mark.parametrize("width", [390, 320])
def test_a_phone_shows_it_without_scrolling_aside(browser: Any, page: Any, width: int) -> None:
    with screen(browser, width, 800):
        page.refresh()
        wait(page, lambda: page.execute_script("return page !== null;"))
        assert page.execute_script("return document.documentElement.scrollWidth;") <= width
        assert page.execute_script(BROKEN) == []


SOLVED = {
    "max_von_mises": 100.0,
    "error_estimate": 1.0,
    "safety_factor": 2.0,
    "verdict": "converged",
    "governing_time": None,
    "mass": None,
    "reason": "",
    "code": "",
}


def row(design: int, value: Any, **more: Any) -> dict[str, Any]:
    return {"design": design, "pin": "B", "case": "c", "a": value, **SOLVED, **more}


NONE = {**dict.fromkeys(SOLVED), "verdict": "failed", "reason": "none", "code": "none"}
LAW = {"a": {"unit": "mm", "law": ""}}
ODD = {
    "one": table_of([row(1, 3.0)], ["a"], LAW),
    "constant": table_of([row(1, 3.0), row(2, 3.0)], ["a"], LAW, required=None),
    "no success": table_of([row(k, float(k), **NONE) for k in (1, 2, 3)], ["a"], LAW),
    "no pin": table_of([row(1, 1.0, **NONE) | {"pin": None, "case": None}], ["a"], LAW),
    "texts": table_of([row(1, "steel"), row(2, "titanium")], ["a"], LAW),
    "no factor": table_of([row(k, k + 0.5, safety_factor=None) for k in (1, 2)], ["a"], LAW),
    "infinite": table_of([row(1, 1.0, safety_factor=np.inf), row(2, 2.0)], ["a"], LAW),
    "hostile": table_of([row(1, 1.0, **NONE | {"reason": EVIL})], ["a"], LAW, study=EVIL),
    "20 parameters": made_up_designs(40, 20, ROWS),
}


@pytest.mark.parametrize("name", ODD)
def test_odd_tables_are_shown(browser: Any, name: str, tmp_path: Path) -> None:
    page = shown(browser, ODD[name], tmp_path)
    count = len(set(ODD[name].column("design").to_pylist()))
    assert page.execute_script(STATUS).startswith(f"{count} of {count} designs selected")
    assert len(page.execute_script(CELLS)) == count
    page.execute_script("document.querySelector('#selection tbody button').click();")
    assert "(kept)" in page.execute_script(CARD)
    page.execute_script(
        "for (const box of document.querySelectorAll('#ranges input')) box.click();"
    )
    assert errors(page) == []
    assert page.title == f"{EVIL if name == 'hostile' else 'made up'}: designs"


def test_ticks_close_together_have_different_labels(page: Any) -> None:
    """A mass within a thousandth had 0.3011 three times."""
    at = "const s = scaleOf({ key: 'mass' }, [0.30095, 0.30118], null);"
    labels = page.execute_script(f"{at} return s.ticks.map(([, text]) => text);")
    assert len(set(labels)) == len(labels) > 2
    assert all(len(label) <= len("0.30105") for label in labels)


def test_a_factor_that_is_missed_is_not_rounded_to_it(page: Any) -> None:
    """It was 1.5 with the required 1.5, and in the selection below that."""
    worded = """
    return [1.49999, 1.5, 1.4, 1 / 0, NaN].map((x) => worded(page.model.byKey.safety_factor, x));
    """
    assert REQUIRED == 1.5
    assert page.execute_script(worded) == ["1.49999", "1.5", "1.4", "∞", "–"]
