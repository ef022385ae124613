"""Keys of materials in a study file."""

from itertools import pairwise
from typing import Annotated

from pydantic import Field

from pinbase.errors import ArgumentError
from pinstress.study.schema.fatigue import FkmTable, SnTable
from pinstress.study.schema.rules import condition
from pinstress.study.schema.types import (
    Density,
    Number,
    PositiveLength,
    Stress,
    StrictTable,
    ThermalExpansion,
)


class HardenedTable(StrictTable):
    """A hardened outer surface, whose yield strength depends on the depth."""

    surface: Stress
    """Yield strength of the case: the least from the surface down to `depth`."""
    core: Stress
    """Yield strength of the core beneath it."""
    depth: PositiveLength
    """Effective depth of the case, normal to the surface. Where it is measured to a limiting
    hardness (as in ISO 18203), `surface` is the strength that belongs to that hardness."""

    @condition
    def _softer_core(self) -> None:
        if self.core > self.surface:
            raise ArgumentError(
                f"the core is {self.core / self.surface:.4g} times as strong as the surface; a "
                "hardened surface is at least as strong as its core: check both, and their units",
                "strengths-out-of-order",
            )


class MaterialRangeTable(StrictTable):
    """Ranges of uncertain strengths: [lower, upper]."""

    yield_strength: tuple[Stress, Stress] | None = None
    """Range of the yield strength. The outcome of each pin against yield is decided over the range;
    limit loads and checks by formula use the worse end. The stresses of `hardening` change in the
    same proportion. Default: the `yield_strength` alone."""


class MaterialTable(StrictTable):
    """An isotropic linear-elastic material."""

    youngs_modulus: Stress
    """Young's modulus."""
    poisson_ratio: Annotated[Number, Field(gt=-1.0, lt=0.5)]
    """Poisson's ratio."""
    density: Density | None = None
    """Density, for the weight and inertia of the pin. Default: no weight."""
    thermal_expansion: ThermalExpansion | None = None
    """Mean coefficient of thermal expansion between the reference temperature and those of the
    cases, which a case with a `temperature` needs for pins in lugs, for the lugs and for their
    bushings."""
    yield_strength: Stress | None = None
    """Yield strength. Without it no safety factors are computed."""
    hardened: HardenedTable | None = None
    """Hardened surface of pins of this material, instead of `yield_strength`. Lugs and bushings of
    it are not hardened: their yield strength is that of the core."""
    ultimate_strength: Stress | None = None
    """Ultimate tensile strength, for checks at ultimate load."""
    shear_strength: Stress | None = None
    """Ultimate shear strength."""
    bearing_strength: Stress | None = None
    """Ultimate bearing strength, on the projected area."""
    ultimate_strain: Annotated[Number, Field(gt=0.0, lt=1.0)] | None = None
    """Total strain at the ultimate strength, for the plastic bending of pins after Cozzone (code
    "aircraft")."""
    failure_strain: Annotated[Number, Field(gt=0.0, lt=3.0)] | None = None
    """Equivalent plastic strain at which a lug breaks, for its ultimate load where limit loads are
    requested, ln(1 + A) of the elongation A for instance. Default: no ultimate load."""
    fatigue: SnTable | None = None
    """Stress-life curve, for `fatigue.method` "signed-von-mises" and "critical-plane"."""
    fkm: FkmTable | None = None
    """Data for `fatigue.method` "fkm-p-ram"."""
    hardening: list[tuple[Annotated[Number, Field(gt=0.0)], Stress]] = []
    """Pairs of equivalent plastic strain and true stress past yield, in rising order, for limit
    loads; the stress stays constant after the last. Default: perfectly plastic."""

    range: MaterialRangeTable = MaterialRangeTable()
    """Ranges of uncertain properties of the material."""

    @condition
    def _within_range(self) -> None:
        ends, strength = self.range.yield_strength, self.yield_strength
        if ends is not None and (strength is None or not ends[0] <= strength <= ends[1]):
            raise ArgumentError(
                "range.yield_strength needs a yield_strength, which lies between its lower and its "
                "upper end",
                "strengths-out-of-order",
            )

    @condition
    def _in_order(self) -> None:
        ultimate = self.ultimate_strength
        for key in ("yield_strength", "shear_strength"):
            lower = getattr(self, key)
            if ultimate is not None and lower is not None and lower > ultimate:
                raise ArgumentError(
                    f"{key} is {lower / ultimate:.4g} times ultimate_strength, which it cannot "
                    "exceed; check both, and their units",
                    "strengths-out-of-order",
                )

    @condition
    def _one_strength(self) -> None:
        if self.hardened is not None and self.yield_strength is not None:
            raise ArgumentError(
                "give either yield_strength or hardened, whose core is the yield strength of what "
                "is not hardened",
                "give-one",
            )
        if self.hardened is not None and self.hardening:
            raise ArgumentError(
                "hardening is past the yield strength of one material; a hardened surface has two",
                "key-not-applicable",
            )

    @condition
    def _hardens(self) -> None:
        points = [(0.0, self.yield_strength or 0.0), *self.hardening]
        rising = all(a < b and s <= t for (a, s), (b, t) in pairwise(points))
        if self.hardening and (self.yield_strength is None or not rising):
            raise ArgumentError(
                "hardening needs yield_strength, plastic strains that increase and stresses that "
                "do not decrease from it",
                "bad-hardening",
            )
