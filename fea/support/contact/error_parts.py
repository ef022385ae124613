"""Parts of a maximum's error that are found after those of its meshes and instants."""

from __future__ import annotations

from dataclasses import replace

from fea.core.peak import ErrorParts, Maximum, accuracy
from fea.core.requirement import Requirement


def with_parts(peak: Maximum, parts: ErrorParts, requirement: Requirement) -> Maximum:
    """The peak with larger parts of the error, and the verdict that follows from them."""
    largest, error = peak.max_von_mises, peak.error_estimate
    if not largest or error is None or peak.parts is None:
        return peak
    more = parts.total - peak.parts.total
    interval = peak.interval and (peak.interval[0] - more, peak.interval[1] + more)
    ratios = [x.total / largest for x in (peak.parts, parts)]
    before, after = (accuracy(x, requirement.tolerance, x <= requirement.tolerance) for x in ratios)
    loose = peak.verdict == "converged" and after.codes != before.codes
    return replace(
        peak,
        parts=parts,
        error_estimate=error + more,
        interval=interval,
        verdict="unconverged" if loose else peak.verdict,
        note=peak.note.replace(before.text, after.text),
        reasons=tuple(after.codes[0] if x == before.codes[0] else x for x in peak.reasons),
    )


def with_cells(peak: Maximum, relative: float, requirement: Requirement) -> Maximum:
    """The peak with the error of the cells, relative, among its parts."""
    largest = peak.max_von_mises
    if not largest or peak.parts is None:
        return peak
    return with_parts(peak, replace(peak.parts, cells=relative * largest), requirement)
