"""The headline and the outcome of every row, found again from results.json alone.

Nothing here imports the program: a reader with results.json and a pocket calculator. Every row's
number is the larger of its surface and its section; it is safe where that with its error, and what
lies beneath contact with its own, stay below yield over the required factor; and the first line of
the report says of the worst check what the numbers say.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.support.programs.once import Shipped

ROOT = Path(__file__).parents[2]
SHIPPED = sorted(path.stem for path in (ROOT / "studies").glob("*.toml"))
QUICK = ["one_pin"]
# Whose pins other tests in CI solve (browser, least weight, portable, validation), and linkages in
# a plane of which CI has bowman2019 and planetary.
LONG = ["landing_gear", "landing_gear_part25", "crane", "engine", "excavator", "grenier2008"]
LONG += ["bucket", "bucket_pin", "hood", "main_gear", "pump_jack", "scissor_lift", "drop"]
LONG += ["matrix_four_bar", "slider_crank"]
LONG += ["light_gear_part23", "side_stay"]  # landing gears, too
LOADS_ALONE = ["slider_crank_jammed"]  # has no pin
Row = dict[str, Any]
SAME = 1e-9


def same(a: float, b: float, within: float = SAME) -> bool:
    return math.isclose(a, b, rel_tol=within, abs_tol=1e-12)


def ends(row: Row) -> tuple[float, float]:
    """Of the maximum, by its error or its interval."""
    low, high = row["max_von_mises_interval"] or (
        row["max_von_mises"] - row["error_estimate"],
        row["max_von_mises"] + row["error_estimate"],
    )
    return low, math.inf if high is None else high


def yield_strength(row: Row) -> float:
    return float(row["safety_factor"] * row["max_von_mises"])


def wrong_parts(row: Row) -> Iterator[str]:
    """Of case and core: the row is that of the part which has the least factor."""
    parts = row["hardened"]
    worst = min(parts, key=lambda part: part["strength"] / part["max_von_mises"])
    if parts[0] != worst or row["governs"] not in (worst["part"], worst["place"]):
        yield f"{row['governs']} governs, and {worst['part']} has the least factor"
    if not same(worst["max_von_mises"], row["max_von_mises"]):
        yield "its maximum is not that of the part that governs"
    if not same(yield_strength(row), worst["strength"]):
        yield "its factor is not that of the part that governs"
    for place in (row["surface"], row["section"]):
        if not same(place["safety_factor"] * place["max_von_mises"], place["strength"]):
            yield "the factor of a place is not yield over stress"


def wrong_places(row: Row) -> Iterator[str]:
    """Of surface, section and contact."""
    if row.get("hardened"):
        yield from wrong_parts(row)
        return
    if row["governs"] is None:
        return
    places = {name: row[name] for name in ("surface", "section") if name in row}
    largest = max(places, key=lambda name: places[name]["max_von_mises"])
    if row["governs"] != largest:
        yield f"{row['governs']} governs, and {largest} has more"
    own = places[row["governs"]]
    if not same(own["max_von_mises"], row["max_von_mises"]):
        yield "its maximum is not that of the place that governs"
    if own["error_estimate"] > row["error_estimate"] * (1.0 + SAME):
        yield "its error is smaller than that of the place that governs"
    if own["time"] != row["time"]:
        yield "its time is not that of the place that governs"
    at = own["location"][2] if "location" in own else own["z"]
    if not same(at, row["location"][2], 1e-6):
        yield "its location is not that of the place that governs"
    if row["safety_factor"] is not None:
        for name, place in places.items():
            if not same(place["safety_factor"] * place["max_von_mises"], yield_strength(row)):
                yield f"the factor of its {name} is not yield over stress"
    for name, place in places.items():
        top = place["max_von_mises"]
        if place["verdict"] != "singular":  # of which the row has the interval
            top += place["error_estimate"]
        if top > ends(row)[1] * (1.0 + 1e-6):
            yield f"its {name} with its error exceeds its upper end"
    for edge in row.get("contact", {}).get("edges", ()):
        if (edge["max_pressure"] is None) != (edge["max_von_mises"] is None):
            yield "an edge has half a peak"


def outcome_again(row: Row, required: float | None) -> str:
    """As the definition has it, from the row's numbers."""
    if row["safety_factor"] is None or row["max_von_mises"] is None:
        return "not decided"
    low, high = ends(row)
    permitted = yield_strength(row) / (required or 1.0)
    if low > permitted:
        return "fails" if required else "yields"
    if high > permitted or row["verdict"] == "singular":
        return "not decided"
    contact = row.get("contact")
    deep = permitted
    if contact and contact.get("strength"):  # of the core, or of what is not hardened
        deep *= contact["strength"] / yield_strength(row)
    if contact and contact["beneath"] + contact["beneath_error"] > deep:
        return "depends"
    over = (row["joint"] or {}).get("range")
    for varied in over["over"] if over else ():
        stress = (varied["max_von_mises_interval"] or (0.0, varied["max_von_mises"]))[1]
        own = 1.0 if varied["max_von_mises_interval"] else high / row["max_von_mises"]
        if stress * own > permitted:
            return "depends"
        if contact and contact["beneath"]:
            upper = 1.0 + contact["beneath_error"] / contact["beneath"]
            if (varied["beneath"] or 0.0) * upper > deep:
                return "depends"
    if any(
        d["over"] == "landing" for d in row["depends_on"]
    ):  # its ranges are in landing_range.csv
        return "depends"
    return "safe" if required else "below yield"


def wrong_row(row: Row, required: float | None) -> Iterator[str]:
    yield from wrong_places(row)
    found = outcome_again(row, required)
    if row["outcome"] != found:
        yield f"its outcome is {row['outcome']}, and by its numbers {found}"
    meets = {"safe": True, "fails": False, "depends": False}.get(found) if required else None
    if row["meets_required"] is not meets:
        yield f"meets_required is {row['meets_required']}"
    if bool(row["depends_on"]) != (found == "depends"):
        yield "it depends on something and does not, or the other way round"
    contact = row.get("contact") or {}
    for on in row["depends_on"]:
        if on["what"] == "beneath" and on["over"] != "beneath":  # over a range, of which it is said
            if on["safety_factor"] >= (required or 1.0) or not on["value"]:
                yield "what lies beneath does not change its outcome"
        elif on["what"] == "beneath":
            if on["reach"] != contact["reach_required" if required else "reach"]:
                yield "it depends on another depth than that of contact"
            most = contact["beneath"] + contact["beneath_error"]
            if on["safety_factor"] < yield_strength(row) / most * (1.0 - SAME):
                yield "the factor beneath is less than its upper end gives"
        elif on["safety_factor"] * row["max_von_mises"] / ends(row)[1] >= (required or 1.0):
            yield f"{on['what']} does not change its outcome"


ORDER = {"fails": 0, "yields": 0, "not decided": 1, "depends": 2, "safe": 3, "below yield": 3}
Check = tuple[int, float, str, str, str, str]  # rank, - utilisation, pin, outcome, check, case


def checks(results: dict[str, Any]) -> Iterator[Check]:
    """Every check that counts: of rows, of margins that govern, of fatigue that is not decided."""
    limit = results["required_safety_factor"] or 1.0
    rows = {(row["pin"], row["case"]): row for row in results["pins"]}
    for row in results["pins"]:
        used = -math.inf
        if row["safety_factor"]:
            low = (row["safety_factor_interval"] or [row["safety_factor"]])[0]
            used = limit / low if low else math.inf
        state = outcome_again(row, results["required_safety_factor"])
        yield ORDER[state], -used, row["pin"], state, "von Mises stress, yield", row["case"]
    for m in results["margins"]:
        if not m["governs"] or m["not_made"] or m["method"] == "von Mises stress, yield":
            continue
        used = m["utilisation"]
        method, state = m["method"], "safe" if used <= 1.0 else "fails"
        if state == "safe" and used * m["over_joint"] > 1.0:
            method, state = f"{method} at {m['level']} load", "depends"
        row = rows.get((m["pin"], m["case"]))
        if m["method"] == "von Mises stress, rupture" and row and state == "fails":
            low, high = ends(row)
            state = "fails" if used * low / high > 1.0 else "not decided"
        yield ORDER[state], -used, m["pin"], state, method, m["case"] or ""
    for pin in (results["fatigue"] or {}).get("not_decided") or ():
        yield 1, math.inf, pin, "not decided", "fatigue life", ""


def near(text: str, value: float) -> bool:
    """A number in a sentence has three digits."""
    return same(float(text.replace(",", "")), value, 5.1e-3)


FACTOR = r"(?<!required )factor ([\d.,]+)(?: to ([\d.,–]+))?"
NEEDED = r"(?:([\d.,]+) required|1 at yield)"


def wrong_headline(results: dict[str, Any]) -> Iterator[str]:
    said, required = results["headline"], results["required_safety_factor"]
    if said is None:
        if results["pins"]:
            yield "rows without a headline"
        return
    worst: dict[str, Check] = {}
    for check in sorted(checks(results), key=lambda c: c[:2]):
        worst.setdefault(check[2], check)
    for key, states in (
        ("failing", ("fails", "yields")),
        ("depends", ("depends",)),
        ("not_decided", ("not decided",)),
    ):
        if sorted(said[key]) != sorted(pin for pin, c in worst.items() if c[3] in states):
            yield f"headline.{key} is {said[key]}"
    first = min(worst.values(), key=lambda c: c[:2])
    named = tuple(said["worst"][key] for key in ("pin", "outcome", "check", "case"))
    if named not in [c[2:] for c in worst.values() if c[0] == first[0] and same(c[1], first[1])]:
        yield f"the worst is {first}, not {named}"
    yield from wrong_sentence(said, worst, results, required)


SEVERAL = r"(\d+) of (\d+) pins (?:miss(?:es)? the required factor ([\d.,]+)|fails?|yields?)"


def wrong_list(said: dict[str, Any], results: dict[str, Any]) -> Iterator[str]:
    """How many of all pins fail, what is required, and their names, the worst first."""
    match = re.match(rf"{SEVERAL}(?: \(.+?\))?: (.+)\.$", said["sentence"])
    if match is None:
        yield "not how many pins fail"
        return
    failing, pins = said["failing"], {row["pin"] for row in results["pins"]}
    if (int(match[1]), int(match[2])) != (len(failing), len(pins)):
        yield f"{match[1]} of {match[2]} for {len(failing)} of {len(pins)}"
    required = {r["required"] for r in results["requirements"] if r["check"] == "yield"}
    if match[3] and not any(near(match[3], factor) for factor in required if factor):
        yield "another factor is required"
    told = [part.split(" (")[0] for part in match[4].split(" and ")[0].split(", ")]
    if told[0] != said["worst"]["pin"] or not set(told) <= set(failing):
        yield f"{told} for {failing}"


def wrong_sentence(
    said: dict[str, Any], worst: dict[str, Check], results: dict[str, Any], required: float | None
) -> Iterator[str]:
    """Its pin, its state, its factors, what is required and its case."""
    text, state = said["sentence"], said["worst"]["outcome"]
    if state in ("fails", "yields") and len({row["pin"] for row in results["pins"]}) > 1:
        yield from wrong_list(said, results)
        return
    named = re.search(r"[Pp]in (\S+?)[ ,.]", text)
    rows = results["pins"]
    if state in ("safe", "below yield"):
        number = re.match(r"(?:All (\d+)|Both) pins (are safe|stay below yield)", text)
        if number and int(number[1] or 2) != len({row["pin"] for row in rows}):
            yield "another number of pins"
        if not number and not re.match(r"Pin \S+ (is safe|stays below yield)", text):
            yield "not that its pin is safe"
        if any(c[3] not in ("safe", "below yield") for c in worst.values()):
            yield "all pins are safe, and one is not"
        row = min(rows, key=lambda r: (r["safety_factor_interval"] or [r["safety_factor"]])[0])
    elif said["worst"]["check"] != "von Mises stress, yield":
        if named is None or named[1] != said["worst"]["pin"]:
            yield "another pin"
        return
    else:
        own = (said["worst"]["pin"], said["worst"]["case"])
        row = next(r for r in rows if (r["pin"], r["case"]) == own)
        good = "is safe" if required else "stays below yield"
        words = {
            "fails": f"Pin {own[0]} fails", "yields": f"Pin {own[0]} yields",
            "not decided": f"Whether pin {own[0]} is safe is not decided",
            "depends": f"Pin {own[0]} {good} as described",
        }[state]  # fmt: skip
        if not text.startswith(words):
            yield f"it does not begin with {words!r}"
    if row["case"] not in text or named is None or named[1] != row["pin"]:
        yield f"not of {row['pin']} in {row['case']}"
    factor = re.search(FACTOR, text)
    if factor is None:
        if row["safety_factor"] is not None:
            yield "no factor"
        return
    low = (row["safety_factor_interval"] or [row["safety_factor"]])[0]
    if not near(factor[1], low):
        yield f"a factor of {factor[1]} for {low}"
    needed = re.search(NEEDED, text)
    if needed is None or (needed[1] is None) != (required is None):
        yield "not what is required"
    elif needed[1] is not None and required is not None and not near(needed[1], required):
        yield "another factor is required"
    below = re.search(
        rf"not beneath contact \({FACTOR}(?:, too low to a depth of ([\d.,]+))?", text
    )
    on = next((d for d in row["depends_on"] if d["over"] == "beneath"), None)
    if (below is None) != (on is None or state != "depends"):
        yield "beneath contact is said where it is not so, or the other way round"
    if below is not None and on is not None:
        if not near(below[1], on["safety_factor"]):
            yield "another factor beneath contact"
        if below[3] and not same(float(below[3]), on["reach"], 5.1e-2):
            yield "another depth"


def violations(results: dict[str, Any]) -> list[str]:
    found = [
        f"{row['pin']} in {row['case']}: {text}"
        for row in results["pins"]
        for text in wrong_row(row, results["required_safety_factor"])
    ]
    return [*found, *wrong_headline(results)]


SLOW = [
    pytest.param(s, marks=[pytest.mark.slow, *[pytest.mark.long] * (s in LONG)])
    for s in SHIPPED
    if s not in (*QUICK, *LOADS_ALONE, "clevis")
]


@pytest.mark.parametrize("study", [*QUICK, *SLOW])
def test_the_headline_follows_from_results_json(study: str, shipped: Shipped) -> None:
    found = json.loads((shipped(study) / "results.json").read_text(encoding="utf-8"))
    assert found["pins"]
    assert violations(found) == []


@pytest.mark.slow
def test_a_reader_finds_what_is_wrong(shipped: Shipped) -> None:
    """The clevis's results, and these with an outcome or a headline changed by hand."""
    found = json.loads((shipped("clevis") / "results.json").read_text(encoding="utf-8"))
    assert violations(found) == []
    P, top = "pins", found["headline"]["sentence"]
    for keys, value, said in (
        ((P, 0, "contact", "beneath"), 1e6, "by its numbers depends"),
        ((P, 0, "governs"), "section", "surface has more"),
        ((P, 0, "section", "max_von_mises"), 460.0, "exceeds its upper end"),
        (("headline", "failing"), ["P"], "headline.failing"),
        (("headline", "sentence"), top.replace("factor 2", "factor 3"), "a factor of"),
    ):
        made = json.loads(json.dumps(found))
        part = made
        for key in keys[:-1]:
            part = part[key]
        part[keys[-1]] = value
        assert any(said in text for text in violations(made)), said
