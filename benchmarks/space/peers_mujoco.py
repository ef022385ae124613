"""A machine in MuJoCo: a tree of its joints by MuJoCo's recursive Newton-Euler equations.

MuJoCo's own constraints are soft: with their smallest regularisation they give forces accurate to
about 1e-5. Therefore loops are cut here at spherical joints and points on lines. The forces there
are those that leave no torque in the passive joints of the tree, by MuJoCo's inverse dynamics
(mj_inverse) and the Jacobians of the points. The wrench in every other joint is MuJoCo's own
interaction force with the parent (cfrc_int). Positions are found by Newton's method, to round-off.
"""

from __future__ import annotations

import mujoco
import numpy as np

from benchmarks.space.bodies import Vector
from benchmarks.space.machines import DriveData, JointData, Machine
from benchmarks.space.peer_forces import PeerForces
from loads import CycloidalDrive
from pinbase.arrays import Floats

CUT = ("spherical", "point-on-line")
MAX_NEWTON_STEPS = 50
ROUND_OFF = 1e-14  # m, gap of a closed loop


def solve(machine: Machine, times: Floats) -> PeerForces:
    """Return the forces at increasing times, at which the loops are closed one after another."""
    model = _Model(machine)
    rows = [model.at(time) for time in times]
    points, forces, moments, drives = (np.array(x) for x in zip(*rows, strict=True))
    return PeerForces(points, forces, moments, drives)


class _Model:
    """A tree of hinges and slides, and the joints that close its loops."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.parent = _tree(machine)  # joint to the parent, by body
        self.closing = [n for n in machine["joints"] if n not in self.parent.values()]
        spec = mujoco.MjSpec()
        spec.option.gravity = [*machine["gravity"]]
        spec.compiler.boundmass = spec.compiler.boundinertia = 0.0
        self._bodies = {"ground": spec.worldbody}
        self._centre: dict[str, Vector] = {"ground": (0.0, 0.0, 0.0)}
        for body in self.parent:
            self._add_body(body)
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.driven = [self._column(d) for d in machine["drives"].values()]
        self.passive = [k for k in range(self.model.nv) if k not in self.driven]

    def _column(self, drive: DriveData) -> int:
        return int(self.model.joint(f"{drive['joint']} {drive['measures']}").dofadr[0])

    def _add_body(self, name: str) -> None:
        """Add a body to its parent; its frame is at its centre along world axes as drawn."""
        joint = self.machine["joints"][self.parent[name]]
        base = joint["moving"] if joint["base"] == name else joint["base"]
        if base not in self._bodies:
            self._add_body(base)
        if name in self._bodies:
            return
        data = self.machine["bodies"][name]
        place = np.subtract(data["centre"], self._centre[base])
        body = self._bodies[base].add_body(name=name, pos=place)
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = data["inertia"]
        body.explicitinertial = True
        body.mass, body.fullinertia = data["mass"], [xx, yy, zz, xy, xz, yz]
        body.ipos = [0.0, 0.0, 0.0]
        self._bodies[name], self._centre[name] = body, data["centre"]
        arm = np.subtract(joint["at"], data["centre"])
        for label, slides, axis in _freedoms(joint, reverse=joint["base"] == name):
            kind = mujoco.mjtJoint.mjJNT_SLIDE if slides else mujoco.mjtJoint.mjJNT_HINGE
            sign = -1.0 if joint["base"] == name else 1.0
            body.add_joint(
                name=f"{self.parent[name]} {label}", type=kind, axis=sign * axis, pos=arm
            )

    # --- one instant ------------------------------------------------------------------------------

    def at(self, time: float) -> tuple[Floats, Floats, Floats, Floats]:
        """Return points, forces and moments (C, 3) of the joints and forces of the drives (D,)."""
        model, data = self.model, self.data
        laws = [
            CycloidalDrive(0.0, d["to"], self.machine["duration"])
            for d in self.machine["drives"].values()
        ]
        drives = np.array([[float(x[0]) for x in law(np.array([time]))] for law in laws])
        data.qpos[self.driven] = drives[:, 0]
        self._close()
        J, bias = self._conditions(second=False)
        data.qvel[self.driven] = drives[:, 1]
        if self.closing:
            data.qvel[self.passive] = np.linalg.solve(
                J[:, self.passive], -J[:, self.driven] @ drives[:, 1]
            )
        mujoco.mj_forward(model, data)
        J, bias = self._conditions(second=True)
        data.qacc[self.driven] = drives[:, 2]
        if self.closing:
            side = -bias - J[:, self.driven] @ drives[:, 2]
            data.qacc[self.passive] = np.linalg.solve(J[:, self.passive], side)
        mujoco.mj_inverse(model, data)
        return self._forces(J)

    def _close(self) -> None:
        """Close the loops by Newton's method on the passive coordinates.

        Raises: ArithmeticError if they do not close.
        """
        for _ in range(MAX_NEWTON_STEPS):
            mujoco.mj_fwdPosition(self.model, self.data)
            if not self.closing:
                return
            gap = self._gaps()
            if np.abs(gap).max() < ROUND_OFF:
                return
            J, _ = self._conditions(second=False)
            self.data.qpos[self.passive] -= np.linalg.solve(J[:, self.passive], gap)
        if np.abs(gap).max() > 100.0 * ROUND_OFF:
            raise ArithmeticError("MuJoCo's loops do not close")

    def _place(self, body: str, at: Vector) -> tuple[Floats, int]:
        """Return the position of a point of a body as drawn, and the body's number."""
        number = self.model.body(self._bodies[body].name).id
        arm = np.subtract(at, self._centre[body])
        rotation = self.data.xmat[number].reshape(3, 3)
        return self.data.xpos[number] + rotation @ arm, number

    def _directions(self, joint: JointData) -> Floats:
        """Return the directions (k, 3) along which a closing joint keeps its points together."""
        if joint["kind"] == "spherical":
            return np.eye(3)
        _, base = self._place(joint["base"], joint["at"])
        return np.asarray(_across(joint["axis"]) @ self.data.xmat[base].reshape(3, 3).T)

    def _gaps(self) -> Floats:
        gaps = []
        for joint in map(self.machine["joints"].__getitem__, self.closing):
            p, _ = self._place(joint["moving"], joint["at"])
            b, _ = self._place(joint["base"], joint["at"])
            gaps.append(self._directions(joint) @ (p - b))
        return np.concatenate(gaps)

    def _conditions(self, second: bool) -> tuple[Floats, Floats]:
        """Return the Jacobian of the closing conditions, and with `second` their velocity terms."""
        model, data = self.model, self.data
        rows, terms = [np.zeros((0, model.nv))], [np.zeros(0)]
        for joint in map(self.machine["joints"].__getitem__, self.closing):
            n = self._directions(joint)
            p, moving = self._place(joint["moving"], joint["at"])
            _, base = self._place(joint["base"], joint["at"])
            J = self._jacobian(p, moving)[0] - self._jacobian(p, base)[0]
            rows.append(n @ J)
            if second:
                dot = [np.zeros((3, model.nv)) for _ in range(4)]
                mujoco.mj_jacDot(model, data, dot[0], dot[1], p, moving)
                mujoco.mj_jacDot(model, data, dot[2], dot[3], p, base)
                spin = self._jacobian(p, base)[1] @ data.qvel
                coriolis = 2.0 * np.cross(spin, J @ data.qvel)
                terms.append(n @ ((dot[0] - dot[2]) @ data.qvel - coriolis))
        return np.concatenate(rows), np.concatenate(terms)

    def _jacobian(self, point: Floats, body: int) -> tuple[Floats, Floats]:
        slides, turns = np.zeros((3, self.model.nv)), np.zeros((3, self.model.nv))
        mujoco.mj_jac(self.model, self.data, slides, turns, point, body)
        return slides, turns

    def _forces(self, J: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return points, forces and moments of the joints and forces of the drives: first those of
        closing joints and drives, then MuJoCo's interaction forces.
        """
        data = self.data
        needed = data.qfrc_inverse.copy()
        data.xfrc_applied[:] = 0.0
        for loaded, at, stated in self.machine["forces"]:
            point, body = self._place(loaded, at)
            needed -= self._jacobian(point, body)[0].T @ np.array(stated)
            self._apply(body, point, np.array(stated))
        unit = np.eye(len(needed))[:, self.driven]
        solved = np.linalg.solve(np.hstack([J.T, unit]), needed)
        closing, drives = solved[: len(J)], solved[len(J) :]
        wrenches = {}
        for name in self.closing:
            joint = self.machine["joints"][name]
            n = self._directions(joint)
            force, closing = closing[: len(n)] @ n, closing[len(n) :]
            p, moving = self._place(joint["moving"], joint["at"])
            self._apply(moving, p, force)
            self._apply(self._place(joint["base"], joint["at"])[1], p, -force)
            wrenches[name] = p, -force, np.zeros(3)
        mujoco.mj_rnePostConstraint(self.model, data)
        for child, name in self.parent.items():
            wrenches[name] = self._interaction(child, name, drives)
        points, forces, moments = zip(*(wrenches[n] for n in self.machine["joints"]), strict=True)
        return np.array(points), np.array(forces), np.array(moments), drives

    def _apply(self, body: int, point: Floats, force: Floats) -> None:
        arm = point - self.data.xipos[body]
        self.data.xfrc_applied[body] += [*force, *np.cross(arm, force)]

    def _interaction(self, body: str, name: str, drives: Floats) -> tuple[Floats, Floats, Floats]:
        """Return point, force and moment of the moving body on the base, without the drives."""
        joint = self.machine["joints"][name]
        number = self.model.body(body).id
        p, _ = self._place(joint["moving"], joint["at"])
        root = self.data.subtree_com[self.model.body_rootid[number]]
        moment, force = self.data.cfrc_int[number, :3], self.data.cfrc_int[number, 3:]
        moment = moment + np.cross(root - p, force)
        sign = -1.0 if joint["moving"] == body else 1.0  # cfrc_int acts on the body, by its parent
        force, moment = sign * force, sign * moment
        for drive, value in zip(self.machine["drives"].values(), drives, strict=True):
            if drive["joint"] == name:
                _, base = self._place(joint["base"], joint["at"])
                axis = np.array(joint["axis"]) / np.linalg.norm(joint["axis"])
                axis = self.data.xmat[base].reshape(3, 3) @ axis
                if drive["measures"] == "angle":
                    moment = moment + value * axis
                else:
                    force = force + value * axis
        return p, force, moment


def _tree(machine: Machine) -> dict[str, str]:
    """Return the joint that connects each body to its parent; joints that can be cut are
    used last.
    """
    names = sorted(machine["joints"], key=lambda n: machine["joints"][n]["kind"] in CUT)
    group = {name: name for name in ("ground", *machine["bodies"])}
    chosen = []
    for name in names:
        base, moving = (group[machine["joints"][name][end]] for end in ("base", "moving"))
        if base != moving:
            group = {n: base if g == moving else g for n, g in group.items()}
            chosen.append(name)
    parent: dict[str, str] = {}
    while len(parent) < len(chosen):
        for name in chosen:
            ends = {machine["joints"][name]["base"], machine["joints"][name]["moving"]}
            if name in parent.values():
                continue
            hung = ends - {"ground", *parent}
            if len(hung) == 1:
                parent[hung.pop()] = name
    return parent


def _across(axis: Vector) -> Floats:
    """Return two unit vectors perpendicular to an axis, (2, 3)."""
    e = np.array(axis) / np.linalg.norm(axis)
    u = np.cross(np.eye(3)[int(np.abs(e).argmin())], e)
    u /= np.linalg.norm(u)
    return np.array([u, np.cross(e, u)])


def _freedoms(joint: JointData, reverse: bool) -> list[tuple[str, bool, Floats]]:
    """Return the label, whether it slides, and the axis of each of MuJoCo's joints, from the parent
    to the body.
    """
    axis = np.array(joint.get("axis", (0.0, 0.0, 1.0)))
    axis = axis / np.linalg.norm(axis)
    angle, travel = ("angle", False, axis), ("travel", True, axis)
    match joint["kind"]:
        case "revolute":
            return [angle]
        case "prismatic":
            return [travel]
        case "cylindrical":
            return [travel, angle]
        case "planar":
            u, v = _across(joint["axis"])
            return [("u", True, u), ("v", True, v), angle]
        case "universal":
            second = np.array(joint["second_axis"]) / np.linalg.norm(joint["second_axis"])
            pair = [("first", False, axis), ("second", False, second)]
            return pair[::-1] if reverse else pair
        case "fixed":
            return []
    raise ValueError(f"{joint['kind']} joints must be cut")
