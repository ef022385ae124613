"""Ten machines beside exudyn and MuJoCo: all components of all joints and drives at six instants.

The peers' forces are in peers/*.csv, written by `python -m benchmarks.space.peers_space`, with the
error of each as measured there: exudyn's by halving its steps, MuJoCo's by another path.
"""

from __future__ import annotations

from benchmarks.space import recorded
from benchmarks.space.machines import MACHINES
from benchmarks.space.ours import ours, space_linkage
from loads.space.kinds import KINDS
from tests.support.each import each

ROUND_OFF = 1e-11  # two ways of solving systems of condition up to 1e4, relative to the largest


@each("name", MACHINES)
def test_a_machine_has_the_forces_of_both_peers(name: str) -> None:
    """Points, forces, moments and drives, relative to the largest of their kind."""
    forces = ours(MACHINES[name](), recorded.instants(name))
    for code in ("mujoco", "exudyn"):
        peer, error = recorded.read(code, name)
        assert error < 1e-5, code  # a mistake in any product of inertia is larger, see below
        assert forces.difference(peer) < max(error, ROUND_OFF), code


def test_the_machines_have_every_kind_of_joint_and_no_redundancy() -> None:
    """So that nothing is compared which a rule of sharing decides."""
    linkages = [space_linkage(machine()) for machine in MACHINES.values()]
    assert {j.kind for linkage in linkages for j in linkage.joints} == set(KINDS)
    for linkage in linkages:
        conditions = sum(KINDS[j.kind].count for j in linkage.joints)
        assert 6 * len(linkage.bodies) - conditions == len(linkage.driven)


def test_the_comparison_notices_a_percent_of_one_product_of_inertia() -> None:
    machine = MACHINES["quill"]()
    rotor = machine["bodies"]["rotor"]
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = rotor["inertia"]
    rotor["inertia"] = (xx, xy, 1.01 * xz), (xy, yy, yz), (1.01 * xz, yz, zz)
    peer, _ = recorded.read("mujoco", "quill")
    assert ours(machine, recorded.instants("quill")).difference(peer) > 1e-4
