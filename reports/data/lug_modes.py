"""The failure modes of lugs, and which checks of the codes judge each."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from assess.strength.press_fit import METHOD as PRESS_FIT_METHOD

BORE_STRESS, BEARING = "stress at the bore", "bearing"
PIN_AND_LUGS = "pin and lugs together"
# The beginnings of the names of checks, by mode, in the order of a table.
LUG_MODES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        BORE_STRESS: ("lug, von Mises stress at the bore", "lug, elastic stress at the bore"),
        "net section": (
            "lug, net section", "AFFDL lug net section", "Melcon-Hoblit tension",
            "BTH-1 plate, tension", "AISC tensile rupture",
        ),
        "gross section": ("AISC yielding",),
        "shear-out": ("lug, shear-out", "BTH-1 plate, double-plane shear", "AISC shear rupture"),
        "fracture beyond the bore": ("BTH-1 plate, single-plane fracture",),
        "shear-out and bearing": ("AFFDL lug bearing", "Melcon-Hoblit shear-bearing"),
        BEARING: (
            "lug, bearing", "BTH-1 plate, bearing", "AISC bearing", "EN 1993 bearing",
            "EN 1993 contact", "special factor in bearing",
        ),
        "yield": ("Melcon-Hoblit yield",),
        "across the shank": ("Melcon-Hoblit transverse", "Ekvall transverse"),
        "out of its plane": ("lug, bending out of its plane",),
        "oblique": ("Melcon-Hoblit oblique",),
        "bushing": ("AFFDL bushing", "Melcon-Hoblit bushing"),
        "press fit": (PRESS_FIT_METHOD,),
        PIN_AND_LUGS: ("AFFDL joint in double shear",),
        "collapse": ("lug, limit load", "lug, ultimate load"),
    }
)  # fmt: skip


def lug_mode(method: str) -> str | None:
    """Return the failure mode of a lug that a check judges, by the name of the check; None for a
    check of something else.
    """
    for mode, methods in LUG_MODES.items():
        if method.startswith(methods):
            return mode
    return None


def bore_wall(method: str) -> str:
    """Return the wall of a bushed lug that a check of the stress at the bore judges: "bushing" or
    "hole".

    The result is empty for a lug without a bushing, and for other checks.
    """
    is_wall = lug_mode(method) == BORE_STRESS
    return next((w for w in ("bushing", "hole") if is_wall and method.endswith(f", {w}")), "")
