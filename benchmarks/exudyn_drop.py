"""Drop of a spinning rigid disk into a cageless 17-ball bearing, in EXUDYN.

A planar benchmark (SI units, y up).  A rigid disk falls, spinning, into the
bore of the inner ring of a full-complement ball bearing whose outer ring sits,
with its housing, on a spring and a damper.  Every surface is a circle.  The
system is set up in two ways:

``equal``
    The contact laws exactly as stated in the constants below: every possible
    contact is an ``ObjectGenericODE2`` without mass, spanning the two bodies,
    whose force is a symbolic user function.  EXUDYN records that function once
    as an expression tree and evaluates it in C++, with no Python call while
    integrating.

``native``
    The nearest built-in contact, ``ObjectContactSphereSphere``.  It has the
    Hertz exponent and the concave contact, but its friction is a constant
    coefficient with a linear ramp at low sliding speed instead of the tanh
    law, and its Hunt-Crossley damping goes with indentation^1.5 times rate
    instead of indentation times rate (matched at the expected peak).

The default solver is the implicit generalized-alpha scheme with some numerical
damping (spectral radius 0.5), modified Newton and numerical, object-wise
Jacobians.  Explicit RK44 also runs, at up to about 3 us with the same peak
force, but takes some three times as long.  Forces, torques and sliding speeds use
the nominal radii as lever arms in ``equal``; EXUDYN's own contact takes the
middle of the overlap.

``drop`` integrates one variant and returns the figures; run as a script, the
module prints them as a table, with ``--fine`` next to a much finer run.  Needs
only numpy and exudyn (1.13 or later).
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

sys.exudynFast = True  # type: ignore[attr-defined]  # EXUDYN build without range checks

import exudyn  # noqa: E402
import exudyn.utilities  # noqa: E402

# EXUDYN has no usable types of its own
exu: Any = exudyn
exutil: Any = exudyn.utilities

Array = NDArray[np.float64]

GRAVITY = 9.81

DISK_MASS = 1.65
DISK_INERTIA = 0.5e-3
DISK_RADIUS = 9.7e-3
DISK_START = (0.0, -0.299e-3)
DISK_VELOCITY = (0.0, -0.0766)
DISK_SPIN = 942.478

RING_MASS = 0.0095
RING_INERTIA = 1.08e-6
BORE_RADIUS = 10.0e-3
INNER_RACE_RADIUS = 11.85e-3

BALL_COUNT = 17
BALL_RADIUS = 2.4e-3
BALL_MASS = 7830.0 * 4.0 / 3.0 * np.pi * BALL_RADIUS**3
BALL_INERTIA = 0.4 * BALL_MASS * BALL_RADIUS**2
PITCH_RADIUS = 14.25e-3

HOUSING_MASS = 5.02
HOUSING_STIFFNESS = 2.5e8
HOUSING_DAMPING = 2500.0
OUTER_RACE_RADIUS = 16.65e-3
LARGE_INERTIA = 1.0e6  # the housing does not rotate

END_TIME = 0.02  # duration simulated by default

DISK_DAMPING = 1.0e7  # force per indentation and rate, disk in bore only

STRONG_FRICTION = (0.068943, 0.10)
WEAK_FRICTION = (0.013786, 0.02)
VISCOUS_FRICTION = 1.0e-4

EXPECTED_PEAK = 27.9e-6  # where the native damping is matched


@dataclass(frozen=True)
class Contact:
    """A possible contact of circle ``first`` with circle ``second``.

    ``first`` and ``second`` are body numbers.  With ``hollow`` the first
    circle lies inside the second.
    """

    first: int
    second: int
    radii: tuple[float, float]
    hollow: bool
    stiffness: float
    damping: float
    friction: tuple[float, float]
    rotates: bool  # False where the second body cannot rotate


@dataclass(frozen=True)
class Result:
    """Figures of one run; times in s, lengths in m, forces in N."""

    variant: str
    solver: str
    step: float
    wall: float
    wall_per_second: float
    peak_force: float
    peak_force_time: float
    peak_indentation: float
    inner_indentation: float
    outer_indentation: float
    ball_indentation: float
    disk_spin: float  # at the end, rad/s
    ring_spin: float


# bodies: 0 the disk, 1 the inner ring, 2 the housing, from 3 on the balls
DISK, RING, HOUSING, FIRST_BALL = 0, 1, 2, 3


def contacts() -> list[Contact]:
    """Return every possible contact, the disk in the bore first."""
    found = [
        Contact(DISK, RING, (DISK_RADIUS, BORE_RADIUS), True, 2.4e9, DISK_DAMPING, STRONG_FRICTION, True)
    ]
    balls = range(FIRST_BALL, FIRST_BALL + BALL_COUNT)
    for ball in balls:
        radii = (BALL_RADIUS, INNER_RACE_RADIUS)
        found.append(Contact(ball, RING, radii, False, 2.021e10, 0.0, STRONG_FRICTION, True))
    for ball in balls:
        radii = (BALL_RADIUS, OUTER_RACE_RADIUS)
        found.append(Contact(ball, HOUSING, radii, True, 2.102e10, 0.0, STRONG_FRICTION, False))
    for ball in balls:
        other = FIRST_BALL + (ball - FIRST_BALL + 1) % BALL_COUNT
        radii = (BALL_RADIUS, BALL_RADIUS)
        found.append(Contact(ball, other, radii, False, 1.0e8, 0.0, WEAK_FRICTION, True))
    return found


def add_bodies(mbs: Any) -> list[Any]:
    """Add the rigid bodies, their weight and the housing's suspension."""
    angles = -0.5 * np.pi + 2.0 * np.pi * np.arange(BALL_COUNT) / BALL_COUNT
    bodies = [
        (DISK_MASS, DISK_INERTIA, DISK_START, (*DISK_VELOCITY, DISK_SPIN)),
        (RING_MASS, RING_INERTIA, (0.0, 0.0), (0.0, 0.0, 0.0)),
        (HOUSING_MASS, LARGE_INERTIA, (0.0, 0.0), (0.0, 0.0, 0.0)),
    ]
    for angle in angles:
        place = (PITCH_RADIUS * np.cos(angle), PITCH_RADIUS * np.sin(angle))
        bodies.append((BALL_MASS, BALL_INERTIA, place, (0.0, 0.0, 0.0)))
    nodes = []
    for mass, inertia, place, velocity in bodies:
        node = mbs.AddNode(
            exutil.NodeRigidBody2D(initialCoordinates=[*place, 0.0], initialVelocities=list(velocity))
        )
        mbs.AddObject(exutil.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node))
        upward = mbs.AddMarker(exutil.MarkerNodeCoordinate(nodeNumber=node, coordinate=1))
        mbs.AddLoad(exutil.LoadCoordinate(markerNumber=upward, load=-mass * GRAVITY))
        nodes.append(node)
    ground = mbs.AddMarker(
        exutil.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(exutil.NodePointGround()), coordinate=0)
    )
    for axis in (0, 1):
        marker = mbs.AddMarker(exutil.MarkerNodeCoordinate(nodeNumber=nodes[HOUSING], coordinate=axis))
        mbs.AddObject(
            exutil.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=[ground, marker],
                stiffness=HOUSING_STIFFNESS,
                damping=HOUSING_DAMPING,
            )
        )
    return nodes


def contact_force(mbs: Any, contact: Contact) -> Any:
    """Record the generalized force of a contact as a symbolic user function.

    With d from the first centre to the second, h = -1 inside a hollow circle
    and 1 otherwise, n = h d / |d| and t = n turned by 90 degrees, the force on
    the six coordinates is  -N (g + f(v) w)  with g = (n, 0, -n, 0),
    w = (-t, -r0, t, -h r1), sliding speed v = w . qdot and indentation rate
    g . qdot.  Everything is kept as vectors, for the expression tree has no
    shared parts.
    """
    symbolic = exu.symbolic
    radius0, radius1 = contact.radii
    sign = -1.0 if contact.hollow else 1.0
    reach = radius0 + sign * radius1
    low, high = contact.friction
    apart = np.zeros((2, 6))
    apart[0, [0, 3]] = apart[1, [1, 4]] = -1.0, 1.0
    normal = np.vstack([apart, np.zeros(6), -apart, np.zeros(6)])
    turned = np.vstack([apart[1], -apart[0], np.zeros(6), -apart[1], apart[0], np.zeros(6)])
    arms = [0.0, 0.0, -radius0, 0.0, 0.0, -sign * radius1 if contact.rotates else 0.0]

    def force(mbs: Any, t: Any, itemNumber: Any, q: Any, q_t: Any) -> Any:
        # the recorder starts from empty vectors
        q.SetVector(symbolic.Vector([1.0, 2.0, 0.0, 0.0, 0.0, 0.0]))
        q_t.SetVector(symbolic.Vector([0.0] * 6))
        zero = symbolic.Real(0.0)
        distance = (symbolic.Matrix(apart.tolist()) * q).NormL2()
        depth = reach - distance if sign > 0.0 else distance + reach
        inward = (sign / distance) * (symbolic.Matrix(normal.tolist()) * q)
        slide = (sign / distance) * (symbolic.Matrix(turned.tolist()) * q) + symbolic.Vector(arms)
        speed = slide * q_t
        press = contact.stiffness * depth * symbolic.sqrt(depth)
        if contact.damping:
            press = symbolic.max(zero, press + contact.damping * depth * (inward * q_t))
        rub = (
            (high + low) * symbolic.tanh(100.0 * speed)
            - low * symbolic.tanh(10.0 * speed)
            + VISCOUS_FRICTION * speed
        )
        # only the taken branch is evaluated
        press = symbolic.IfThenElse(depth > 0.0, press, zero)
        rub = symbolic.IfThenElse(depth > 0.0, rub, zero)
        return (-1.0 * press) * (inward + rub * slide)

    return exutil.CreateSymbolicUserFunction(
        mbs, force, "forceUserFunction", itemTypeName="ObjectGenericODE2"
    )


def add_equal_contacts(mbs: Any, nodes: list[Any]) -> list[Any]:
    """Add the contacts as symbolic user functions, which must be kept alive."""
    functions = []
    for contact in contacts():
        function = contact_force(mbs, contact)
        mbs.AddObject(
            exutil.ObjectGenericODE2(
                nodeNumbers=[nodes[contact.first], nodes[contact.second]],
                massMatrix=np.zeros((6, 6)),
                forceUserFunction=function,
            )
        )
        functions.append(function)
    return functions


def native_damping() -> float:
    """Return the factor of indentation^1.5 and rate that fits at the peak."""
    return DISK_DAMPING / float(np.sqrt(EXPECTED_PEAK))


def add_native_contacts(mbs: Any, nodes: list[Any]) -> None:
    """Add the contacts as EXUDYN's own sphere-sphere contact."""
    markers = [mbs.AddMarker(exutil.MarkerNodeRigid(nodeNumber=node)) for node in nodes]
    for contact in contacts():
        low, high = contact.friction
        viscous = VISCOUS_FRICTION * DISK_SPIN * DISK_RADIUS if contact.first == DISK else 0.0
        options: dict[str, Any] = {}
        if contact.damping:
            # damping is 1.5 k (1 - e) / (impact speed); the large minimum speed fixes it
            restitution = 1.0 - native_damping() / (1.5 * contact.stiffness)
            options = {
                "impactModel": 1,
                "minimumImpactVelocity": 1.0,
                "restitutionCoefficient": restitution,
            }
        data = mbs.AddNode(
            exutil.NodeGenericData(initialCoordinates=[1.0, 0.0, 0.0, 0.0], numberOfDataCoordinates=4)
        )
        mbs.AddObject(
            exutil.ObjectContactSphereSphere(
                markerNumbers=[markers[contact.first], markers[contact.second]],
                nodeNumber=data,
                spheresRadii=list(contact.radii),
                isHollowSphere1=contact.hollow,
                dynamicFriction=high + viscous,
                frictionProportionalZone=high / (100.0 * high + 90.0 * low),
                contactStiffness=contact.stiffness,
                contactStiffnessExponent=1.5,
                **options,
            )
        )


SOLVERS = {
    "alpha": "GeneralizedAlpha",
    "trapezoid": "TrapezoidalIndex2",
    "rk44": "RK44",
    "dopri5": "DOPRI5",
    "verlet": "VelocityVerlet",
}


@dataclass(frozen=True)
class Control:
    """Solver settings of a run."""

    solver: str = "alpha"
    step: float = 5.0e-6  # s
    tolerance: float = 1.0e-2  # of the Newton iteration, relative
    radius: float = 0.5  # spectral radius of generalized-alpha


FINE = Control(step=0.5e-6, tolerance=1.0e-7, radius=0.9)


def settings(control: Control, end: float) -> Any:
    """Return the simulation settings, without any file output."""
    chosen = exu.SimulationSettings()
    integration = chosen.timeIntegration
    integration.endTime = end
    integration.numberOfSteps = max(1, round(end / control.step))
    integration.verboseMode = 0
    integration.newton.useModifiedNewton = True
    integration.newton.relativeTolerance = control.tolerance
    integration.newton.absoluteTolerance = control.tolerance
    integration.generalizedAlpha.spectralRadius = control.radius
    integration.adaptiveStep = True  # halves the step where Newton fails
    # the step recommended by the native contact at first touch stops the solver
    integration.discontinuous.useRecommendedStepSize = False
    chosen.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    chosen.parallel.numberOfThreads = 1
    chosen.solution.file.write = False
    chosen.show.computationTime = False
    chosen.show.statistics = False
    return chosen


def indentations(states: Array, rates: Array) -> tuple[list[Contact], Array, Array]:
    """Return the contacts and their indentations and rates over the samples."""
    listed = contacts()
    depths = np.empty((len(listed), states.shape[1]))
    speeds = np.empty_like(depths)
    for row, contact in enumerate(listed):
        apart = states[contact.second, :, :2] - states[contact.first, :, :2]
        moving = rates[contact.second, :, :2] - rates[contact.first, :, :2]
        distance = np.hypot(apart[:, 0], apart[:, 1])
        sign = -1.0 if contact.hollow else 1.0
        depths[row] = contact.radii[0] + sign * contact.radii[1] - sign * distance
        speeds[row] = -sign * (apart * moving).sum(axis=1) / distance
    return listed, depths, speeds


def integrate(
    variant: str, control: Control, end: float, record: float | None
) -> tuple[float, Array, Array]:
    """Integrate one variant and return the wall time, states and rates.

    With ``record`` the bodies' coordinates and velocities are stored at that
    period; without it the run is only timed and the arrays are empty.
    """
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    nodes = add_bodies(mbs)
    alive: list[Any] = []
    if variant == "equal":
        alive = add_equal_contacts(mbs, nodes)
    else:
        add_native_contacts(mbs, nodes)
    sensors: list[list[Any]] = [[], []]
    kinds = (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
    if record is not None:
        for chosen, kind in zip(sensors, kinds, strict=True):
            for node in nodes:
                sensor = exutil.SensorNode(
                    nodeNumber=node, storeInternal=True, writeToFile=False, outputVariableType=kind
                )
                chosen.append(mbs.AddSensor(sensor))
    mbs.Assemble()
    options = settings(control, end)
    if record is not None:
        options.solution.sensors.writePeriod = record
    began = time.perf_counter()
    mbs.SolveDynamic(options, solverType=getattr(exu.DynamicSolverType, SOLVERS[control.solver]))
    wall = time.perf_counter() - began
    del alive
    if record is None:
        empty = np.empty((0, 0, 3))
        return wall, empty, empty
    stored = [
        np.stack([np.asarray(mbs.GetSensorStoredData(each))[:, 1:4] for each in chosen])
        for chosen in sensors
    ]
    return wall, stored[0], stored[1]


def drop(
    variant: str = "equal",
    control: Control | None = None,
    end: float = END_TIME,
    sample: float = 1.0e-6,
) -> Result:
    """Integrate the drop twice, timed without and then with recording."""
    control = control or Control()
    wall, _, _ = integrate(variant, control, end, None)
    period = max(control.step, sample)
    _, states, rates = integrate(variant, control, end, period)
    listed, depths, speeds = indentations(states, rates)
    stiffness = np.array([contact.stiffness for contact in listed])
    closed = np.clip(depths, 0.0, None)
    force = stiffness[0] * closed[0] ** 1.5
    if variant == "equal":
        force = np.maximum(0.0, force + DISK_DAMPING * closed[0] * speeds[0])
    else:
        force = force + native_damping() * closed[0] ** 1.5 * speeds[0]
    peak = int(np.argmax(force))
    deepest = closed.max(axis=1)
    inner = deepest[1 : 1 + BALL_COUNT].max()
    outer = deepest[1 + BALL_COUNT : 1 + 2 * BALL_COUNT].max()
    between = deepest[1 + 2 * BALL_COUNT :].max()
    return Result(
        variant=variant,
        solver=control.solver,
        step=control.step,
        wall=wall,
        wall_per_second=wall / end,
        peak_force=float(force[peak]),
        peak_force_time=peak * period,
        peak_indentation=float(deepest[0]),
        inner_indentation=float(inner),
        outer_indentation=float(outer),
        ball_indentation=float(between),
        disk_spin=float(rates[DISK, -1, 2]),
        ring_spin=float(rates[RING, -1, 2]),
    )


def table(results: list[Result]) -> str:
    """Return the results as a small table."""
    lines = [
        f"{'variant':8} {'solver':10} {'step/us':>8} {'wall/s':>8} {'wall s/s':>9} "
        f"{'peak/N':>8} {'at/ms':>7} {'disk/um':>8} {'inner/um':>8} {'outer/um':>8} "
        f"{'balls/um':>8} {'disk':>7} {'ring rad/s':>10}"
    ]
    for one in results:
        lines.append(
            f"{one.variant:8} {one.solver:10} {one.step * 1e6:8.3f} {one.wall:8.2f} "
            f"{one.wall_per_second:9.1f} {one.peak_force:8.2f} {one.peak_force_time * 1e3:7.3f} "
            f"{one.peak_indentation * 1e6:8.3f} {one.inner_indentation * 1e6:8.3f} "
            f"{one.outer_indentation * 1e6:8.3f} {one.ball_indentation * 1e6:8.3f} "
            f"{one.disk_spin:7.2f} {one.ring_spin:10.2f}"
        )
    return "\n".join(lines)


def main() -> None:
    """Run the chosen variants and print their figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--variant", choices=("equal", "native", "both"), default="both")
    basic = Control()
    parser.add_argument("--solver", choices=tuple(SOLVERS), default=basic.solver)
    parser.add_argument("--step", type=float, default=basic.step, help="time step, s")
    parser.add_argument(
        "--tolerance", type=float, default=basic.tolerance, help="relative Newton tolerance"
    )
    parser.add_argument(
        "--radius", type=float, default=basic.radius, help="spectral radius of generalized-alpha"
    )
    parser.add_argument("--end", type=float, default=END_TIME, help="duration, s")
    parser.add_argument("--fine", action="store_true", help="add a much finer run of each")
    chosen = parser.parse_args()
    control = Control(chosen.solver, chosen.step, chosen.tolerance, chosen.radius)
    controls = (control, FINE) if chosen.fine else (control,)
    variants = ("equal", "native") if chosen.variant == "both" else (chosen.variant,)
    print(table([drop(variant, each, chosen.end) for variant in variants for each in controls]))


if __name__ == "__main__":
    main()
