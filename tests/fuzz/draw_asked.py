"""What a study asks besides stress, drawn at random: strength, requirements, fatigue, designs."""

from __future__ import annotations

import random

from tests.fuzz.quantity import Quantity, Tree, force, length

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
EXPANSION = {"steel": "11.7e-6 1/K", "bronze": "17.5e-6 1/K", "rubber": "0.2e-3 1/K",
             "cork": "30e-6 1/K"}  # fmt: skip
CUTS = ("hole", "flat", "slot", "passage")
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
    classes = {"strength"}
    if rng.random() < 0.25:
        strong["range"] = {"yield_strength": [Quantity(x, "stress") for x in (7e8, 9e8)]}
        classes.add("strength range")
    materials = study["material"] | {"steel": strong}
    study = study | {
        "material": {k: m | {"thermal_expansion": EXPANSION[k]} for k, m in materials.items()}
    }
    if rng.random() < 0.25:
        study = _heated(rng, study)
        classes.add("temperature")
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
    hard = rng.random() < 0.25 and not any(cut in p for p in study["pin"].values() for cut in CUTS)
    if hard:
        study["pin"], checks = _hardened(rng, study["pin"], "range" in strong), CHECKS
        analysis["limit_load"] = "never"
        classes.add("hardened")
    if rng.random() < 0.5:
        study["require"] = [
            {"check": check, "factor": rng.choice((1.0, 1.5, 2.0))}
            for check in rng.sample(checks, rng.choice((1, 2)))
        ]
        classes.add("require")
    if rng.random() < 0.5:
        study["fatigue"] = _fatigue(rng, study)
        classes |= {"fatigue", study["fatigue"]["method"]}
        if rng.random() < 0.3:
            study["require"] = [*study.get("require", []), {"check": "fatigue", "factor": 2.0}]
    if rng.random() < 0.3 and (parameters := _parameters(rng, study)):
        grid = all("from" in p for p in parameters.values())
        sample = {"sample": "grid"} if grid else {"sample": "latin-hypercube", "count": 4}
        study["vary"] = sample | {"parameters": parameters}
        command[0] = "sweep"
        classes.add("vary")
        if all("from" not in p for p in parameters.values()) and not hard and rng.random() < 0.5:
            command[0] = "reliability"
            study["reliability"] = {"samples": 10, "importance_samples": 0, "sobol_samples": 0}
            classes.add("reliability")
    return study, classes


def _heated(rng: random.Random, study: Tree) -> Tree:
    """The study with a temperature in some cases, and the expansions that it needs."""
    cases = {
        name: case | ({"temperature": rng.choice(("-40 degC", "80 degC", "100 degF"))}
                      if i == 0 or rng.random() < 0.5 else {})
        for i, (name, case) in enumerate(study["case"].items())
    }  # fmt: skip
    return study | {"case": cases}


def _hardened(rng: random.Random, pins: Tree, whole: bool) -> Tree:
    """Pins with a hardened surface, of the whole or of a segment.

    whole: as a range of the yield strength demands.
    """
    hardened = {}
    for name, pin in pins.items():
        if pin["material"] != "steel":  # others have no strength, which the rest must have
            hardened[name] = pin
            continue
        thin = min(_least(s["diameter"]) - _largest(s.get("bore")) for s in pin["profile"])
        case: Tree = {"surface": Quantity(11e8, "stress"), "core": Quantity(6e8, "stress"),
                      "depth": length(thin * rng.choice((0.01, 0.05, 0.1)))}  # fmt: skip
        profile = pin["profile"]
        if whole or rng.random() < 0.5:
            hardened[name] = pin | {"hardened": case}
        else:
            at = rng.randrange(len(profile))
            segment = profile[at] | {"hardened": case}
            hardened[name] = pin | {"profile": [*profile[:at], segment, *profile[at + 1 :]]}
    return hardened


def _least(size: Quantity | list[Quantity]) -> float:
    return min(x.value for x in (size if isinstance(size, list) else [size]))


def _largest(size: Quantity | None) -> float:
    return 0.0 if size is None else size.value


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
    if "temperature" in given and rng.random() < 0.7:
        out[f"case.{case}.temperature"] = {"normal": ["50 degC", "10 degC"]}
    for band, lug in table.get("lug", {}).items():
        if "clearance" in lug and "range" not in lug and rng.random() < 0.5:
            d = table["profile"][0]["diameter"].value
            out[f"pin.{pin}.lug.{band}.clearance"] = {"uniform": [length(0.0), length(0.002 * d)]}
    if rng.random() < 0.4:
        law = [Quantity(8e8, "stress"), Quantity(0.3e8, "stress")]
        out["material.steel.yield_strength"] = {"normal": law}
    if rng.random() < 0.5:
        del out["material.steel.youngs_modulus"]
    for connection, f in given.get("forces", {}).items():
        if rng.random() < 0.3 and table.get("clamp") and abs(f[0].value) > 0.0:
            law = [f[0], force(0.05 * abs(f[0].value))]
            out[f"case.{case}.forces.{connection}[1]"] = {"normal": law}
    if any("steps" not in p for p in out.values()):
        out = {key: p if "from" not in p else {k: p[k] for k in ("from", "to")}
               for key, p in out.items()}  # fmt: skip
    return out
