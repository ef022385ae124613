"""Loads of cases, computed again only if something has changed on which they depend."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from pinbase.memo import Memo
from pinstress.analysis.plan import LoadsOf, all_loads
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.sequence import require_times
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import GivenCase, MechanismCase
from pinstress.study.schema.landing import GroundCase
from pinstress.study.schema.mechanism import MechanismTable

# Tables that the loads of a mechanism do not depend on. A pin is only a point there, its joint. Its
# shape and material count only for the joint's weight and for the positions of links along the pin,
# which `content_of_loads` adds.
TABLES_WITHOUT_LOADS = "pin", "material", "analysis", "vary", "published", "report", "size"
# Keys of a load in a case that no other case depends on.
AMOUNTS = "force", "impulse"


def reused_loads(raw: Mapping[str, Any], memo: Memo) -> LoadsOf:
    """Return a function that computes loads, or finds them in a memo under the content of all they
    depend on.

    raw: the content of the study (pinstress.study.reading.file.raw_study).
    Files that the study names are read once, when their case is first requested.
    """

    def loads_of(study: Study, cases: list[str]) -> dict[str, CaseLoads]:
        alone = content_of_loads(study, _without_amounts(raw))
        keys = {
            # A case on the ground may follow from a drop, which is another case.
            name: ("loads", name, content_of_loads(study, raw))
            if isinstance(study.table.case[name], GroundCase)
            else ("loads", name, alone, json.dumps(raw["case"][name], default=str))
            for name in cases
            if _reusable(study, name)
        }
        known: dict[str, CaseLoads] = {}
        for name, key in keys.items():
            if (loads := memo.read(key)) is not None:
                known[name] = loads
        new = [name for name in cases if name not in known]
        computed = all_loads(study, new) if new else {}
        for name in keys.keys() & computed.keys():
            memo.write(keys[name], computed[name])
        loads = {name: known[name] if name in known else computed[name] for name in cases}
        require_times(study, {name: case.reactions.times for name, case in loads.items()})
        return loads

    return loads_of


def _without_amounts(raw: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the content of a study with the positions of its cases' loads but not their amounts; a
    mechanism may depend on the positions.
    """
    cases = {
        name: {
            **case,
            "apply": [
                {key: value for key, value in load.items() if key not in AMOUNTS}
                for load in case.get("apply", ())
            ],
        }
        for name, case in raw.get("case", {}).items()
    }
    return {**raw, "case": cases}


def _reusable(study: Study, case: str) -> bool:
    """Return whether the loads of a case follow from a mechanism. Given loads take no time, and are
    checked against the pins.
    """
    return study.table.mechanism is not None and not isinstance(study.table.case[case], GivenCase)


def content_of_loads(study: Study, raw: Mapping[str, Any]) -> bytes:
    """Return a hash of all that the loads of a mechanism depend on; empty without a mechanism.

    raw: the content of the study.
    """
    mechanism, table = study.table.mechanism, study.table
    if mechanism is None:
        return b""
    tables = {key: value for key, value in raw.items() if key not in TABLES_WITHOUT_LOADS}
    joints = [(name, study.connections(name)) for name in table.pin]
    weighed = [  # joints whose weight follows from the shape of the pin
        name
        for name, joint in mechanism.joint.items()
        if joint.weight is None and joint.fixed_in is None and name in table.pin
    ]
    weights = [(raw["pin"][x], table.material[table.pin[x].material].density) for x in weighed]
    along = [_places(raw["pin"][x]) for x in table.pin] if depends_on_bands(study) else []
    depends = [tables, joints, weights, along]
    return hashlib.sha256(json.dumps(depends, default=str).encode()).digest()


def depends_on_bands(study: Study) -> bool:
    """Return whether forces may depend on the positions of links along the pins: in space, and out
    of the plane of a planar linkage.
    """
    mechanism, cases = study.table.mechanism, study.table.case.values()
    if not isinstance(mechanism, MechanismTable):
        return True
    applied = (load for case in cases if isinstance(case, MechanismCase) for load in case.apply)
    return (
        any(joint.z is not None for joint in mechanism.joint.values())
        or any(isinstance(case, GroundCase) for case in cases)
        or any(load.out_of_plane for load in applied)
    )


def _places(pin: Mapping[str, Any]) -> Any:
    """Return what determines the positions of a pin's bands and clamps: lengths and names of its
    profile and its clamps, or the whole table of a pin without a profile.
    """
    keys = "length", "connection", "name", "ear_of"
    segments = [[segment.get(key) for key in keys] for segment in pin.get("profile", ())]
    return [segments, pin.get("clamp")] if segments else pin
