"""What a study asks besides stress, drawn at random: strength, requirements, fatigue, designs."""

from __future__ import annotations

import random

from tests.fuzz.quantity import Quantity, Tree, force

STRONG: Tree = {
    "youngs_modulus": Quantity(206e9, "stress"),
    "poisson_ratio": 0.3,
    "density": Quantity(7850.0, "density"),
    "yield_strength": Quantity(800e6, "stress"),
    "ultimate_strength": Quantity(1000e6, "stress"),
    "shear_strength": Quantity(600e6, "stress"),
    "bearing_strength": Quantity(1600e6, "stress"),
    "ultimate_strain": 0.12,
    "fkm": {"group": "Steel", "roughness": Quantity(6.3e-6, "length"), "plastic_factor": 1.7},
}
CURVE: Tree = {"knee_stress": Quantity(395e6, "stress"), "knee_cycles": 1e6, "slope": 5,
               "scatter": 3.5, "mean_stress_sensitivity": 0.25}  # fmt: skip
CHECKS = ("yield", "rupture", "bearing", "shear")
LIMIT_LOADS = 0.05  # of the studies: a limit load takes as long as twenty others


def asked(rng: random.Random, study: Tree, command: list[str]) -> tuple[Tree, set[str]]:
    """The study with more to answer, and the classes to which it belongs then.

    command: changed to that which answers designs.
    """
    if all(pin["material"] != "steel" for pin in study["pin"].values()):
        return study, set()
    mean = rng.choice(("none", "fkm", "goodman", "swt"))
    strong = STRONG | {"fatigue": CURVE | {"mean_stress": mean}}
    study = study | {"material": study["material"] | {"steel": strong}}
    classes = {"strength"}
    analysis: Tree = {"code": rng.choice(("general", "aircraft", "civil", "lifting"))}
    analysis["code"] = ["general", "civil"] if rng.random() < 0.2 else analysis["code"]
    if analysis["code"] == "lifting":
        analysis["design_factor"] = rng.choice((2.0, 3.0))
    if rng.random() < 0.5:
        analysis |= {"required_safety_factor": rng.choice((1.0, 1.5, 3.0)),
                     "goal": rng.choice(("value", "decide"))}  # fmt: skip
    checks: tuple[str, ...] = (*CHECKS, "limit load")
    if rng.random() > LIMIT_LOADS:
        checks, analysis["limit_load"] = CHECKS, "never"
    study["analysis"] = analysis
    classes.add(f"code {analysis['code']}")
    if rng.random() < 0.5:
        study["require"] = [
            {"check": check, "factor": rng.choice((1.0, 1.5, 2.0))}
            for check in rng.sample(checks, rng.choice((1, 2)))
        ]
        classes.add("require")
    if rng.random() < 0.5:
        study["fatigue"] = _fatigue(rng, study)
        classes |= {"fatigue", study["fatigue"]["method"]}
    if rng.random() < 0.3 and (parameters := _parameters(rng, study)):
        grid = all("from" in p for p in parameters.values())
        sample = {"sample": "grid"} if grid else {"sample": "latin-hypercube", "count": 4}
        study["vary"] = sample | {"parameters": parameters}
        command[0] = "sweep"
        classes.add("vary")
    return study, classes


def _fatigue(rng: random.Random, study: Tree) -> Tree:
    method = rng.choice(("signed-von-mises", "critical-plane", "fkm-p-ram"))
    table: Tree = {
        "method": method,
        "occurrences": {name: rng.choice((0.01, 1, 20)) for name in study["case"]},
        "life": rng.choice((100, 20000)),
    }
    return table | ({"failure_probability": 0.1} if rng.random() < 0.5 else {})


def _parameters(rng: random.Random, study: Tree) -> Tree:
    """One or two numbers of the study that vary a little, by ends or by a law."""
    steel = f"{STRONG['youngs_modulus'].value / 1e9:g} GPa"
    out: Tree = {"material.steel.youngs_modulus": {"from": "190 GPa", "to": steel, "steps": 2}}
    pin, table = next(iter(study["pin"].items()))
    last = table["profile"][-1]["length"]
    if isinstance(last, Quantity) and rng.random() < 0.6:
        key = f"pin.{pin}.profile[{len(table['profile'])}].length"
        out[key] = {"from": last * 1.0, "to": last * 1.05, "steps": 2}
    case, given = next(iter(study["case"].items()))
    for connection, f in given.get("forces", {}).items():
        if rng.random() < 0.3 and table.get("clamp") and abs(f[0].value) > 0.0:
            law = [f[0], force(0.05 * abs(f[0].value))]
            out[f"case.{case}.forces.{connection}[1]"] = {"normal": law}
    if any("normal" in p for p in out.values()):
        out = {key: p if "normal" in p else {k: p[k] for k in ("from", "to")}
               for key, p in out.items()}  # fmt: skip
    return out
