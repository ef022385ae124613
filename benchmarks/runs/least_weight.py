"""Least weight of pins: the saving compared with scaling, the number of designs, and the time."""

from __future__ import annotations

import time

from benchmarks.timing import table
from pinstress.explore.size.least_weight import lighten
from pinstress.explore.size.weight_search import WeightGoal
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import load_study
from pinstress.study.reading.shipped import shipped

FACTORS = {"one_pin": 10.0, "engine": 3.0, "crane": 3.0, "grenier2008": 10.0}


def saved() -> str:
    """Return the table of every pin of some studies, computed in one process."""
    rows, lines = [], []
    for name, factor in FACTORS.items():
        study = load_study(shipped(f"{name}.toml"))
        before = time.process_time()
        found = lighten(study, WeightGoal(factor))
        spent = time.process_time() - before
        pins, designs = len(found.pins), sum(each.solved for each in found.pins)
        lines.append(
            f"{name}, factor {factor:g}: {spent:.1f} s of processor time for {pins} "
            f"pin{'s' * (pins > 1)}, {designs} designs and a run"
        )
        for each in found.pins:
            old, new = (pin_of(x, each.pin).volume for x in (study, found.study))
            scaled, optimality = each.scaled or float("nan"), each.optimality
            rows.append(
                (
                    f"{name} {each.pin}",
                    f"{scaled / old:.3f}",
                    f"{new / old:.3f}",
                    f"{round(1.0 - new / scaled, 3) + 0.0:.1%}",
                    "–" if optimality is None else f"{optimality.residual:.1g}",
                    str(each.solved),
                    each.binding[0][0] if each.binding else each.why,
                )
            )
    head = ("pin", "only scaled", "least", "saved", "residual", "designs", "binds most")
    said = (
        "Volumes over those of the pins as they are. residual: of the conditions of an optimum, "
        "relative to the gradient of the weight."
    )
    return "\n\n".join([said, table(head, rows), "\n\n".join(lines)])
