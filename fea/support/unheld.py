"""The results of cases without a solution, in particular where the lugs cannot hold the pin.

Whether lugs can hold a pin follows from the rule of fea.core.equilibrium, whatever the model of the
lugs.
"""

from __future__ import annotations

from fea.core.linear_solver import SolveError
from fea.core.peak import Maximum
from fea.support.lugs.fit import balance_in_lugs
from fea.support.support import PinProblem

# Codes of the errors with which a model reports that its lugs do not react the loads.
NOT_HELD = "not-in-equilibrium", "couple-not-reacted"


def unheld(problem: PinProblem, model: str) -> dict[str, Maximum]:
    """The results of the cases in which the lugs cannot hold the pin, by case: `rigid`, without
    numbers.
    """
    pin, out = problem.pin, dict[str, Maximum]()
    for case in problem.cases:
        of = balance_in_lugs(pin, problem.lugs, case, problem.material.density)
        if of.refusal:
            out[case.case] = Maximum(
                pin.name, case.case, model, "rigid", of.refusal, reasons=(of.code,)
            )
    return out


def unsolved(pin: str, case: str, model: str, error: SolveError) -> Maximum:
    """The result of a case without a solution: `rigid` where the lugs do not hold the pin,
    otherwise `failed`.
    """
    rigid = error.code in NOT_HELD
    codes = (error.code,) if rigid else ()
    return Maximum(pin, case, model, "rigid" if rigid else "failed", str(error), reasons=codes)
