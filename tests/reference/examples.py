"""Operators one would meet, and the odd ones at the edge of what is allowed."""

from __future__ import annotations

from hyst import (
    Affine,
    Composition,
    DeadZone,
    GeneralizedPrandtlIshlinskii,
    ModifiedPrandtlIshlinskii,
    Operator,
    Play,
    PrandtlIshlinskii,
    Stop,
)

PI = PrandtlIshlinskii([0.5, 0.25, 0.7], [0.5, 1.5, 4.0], p0=0.3)
WAVY = PrandtlIshlinskii([0.5, -0.6, 0.4, -0.1], [0.5, 1.0, 2.5, 3.0], p0=0.3)
ENVELOPE = DeadZone.odd([0.65, 0.2, 0.3], [0.0, 2.0, 5.0])
LOPSIDED = DeadZone([0.8, 0.6, -0.5, 0.4], [0.0, 1.5, -2.5, 4.0])
TENT = DeadZone([1.0, -2.0], [0.0, 1.0])
GPI = GeneralizedPrandtlIshlinskii(ENVELOPE, PI)
MPI = ModifiedPrandtlIshlinskii(PI, LOPSIDED)
NESTED = MPI @ Affine(-0.5, 1.0) @ GPI

EXAMPLES: dict[str, Operator] = {
    "play": Play(1.25),
    "play with memory": Play(0.75, z0=2.5),
    "play without width": Play(0.0),
    "stop": Stop(1.25),
    "stop with memory": Stop(0.75, z0=-2.5),
    "stop without width": Stop(0.0),
    "affine": Affine(2.5, -1.0),
    "affine falling": Affine(-0.75, 0.5),
    "affine flat": Affine(0.0, 3.0),
    "dead-zone odd": ENVELOPE,
    "dead-zone lopsided": LOPSIDED,
    "dead-zone falling": DeadZone([-1.0, -0.5, 0.25], [0.0, 1.0, -3.0]),
    "dead-zone tent": TENT,
    "dead-zone without linear part": DeadZone([0.4, 0.7], [-0.5, 1.0]),
    "dead-zone tied": DeadZone([0.5, 0.25, 0.5, 0.3], [0.0, 1.0, 0.0, 1.0]),
    "dead-zone by direction": DeadZone([1.0, 0.5], [0.0, 1.5], "by-direction"),
    "pi": PI,
    "pi wavy": WAVY,
    "pi with memory": PrandtlIshlinskii([0.5, 0.3], [1.0, 3.0], p0=0.2, z0=[0.5, -1.25]),
    "pi tied": PrandtlIshlinskii([0.5, 0.3, 0.2], [1.0, 1.0, 2.0], p0=0.2),
    "pi with an ideal play": PrandtlIshlinskii([0.5, 0.3], [0.0, 2.0], p0=0.2),
    "pi with idle plays": PrandtlIshlinskii([0.0, 0.3, 0.0], [1.0, 2.0, 50.0], p0=0.2),
    "pi without linear part": PrandtlIshlinskii([0.6, 0.4], [1.0, 2.0]),
    "pi without plays": PrandtlIshlinskii([], [], p0=1.5),
    "pi falling": PrandtlIshlinskii([-0.5, -0.3], [1.0, 2.0], p0=-0.2),
    "gpi": GPI,
    "gpi behind a tent": GeneralizedPrandtlIshlinskii(TENT, PI),
    "gpi without memory": GeneralizedPrandtlIshlinskii(
        Affine(2.0), PrandtlIshlinskii([], [], p0=1.5)
    ),
    "mpi": MPI,
    "mpi onto a tent": ModifiedPrandtlIshlinskii(WAVY, TENT),
    "composition of one": Composition((Play(1.0),)),
    "composition of two banks": PI @ WAVY,
    "composition mixed": Stop(0.5) @ LOPSIDED @ Play(0.75) @ Affine(1.5, 0.25),
    "composition with names inside": NESTED,
    "gpi after pi": GPI @ PI,
    "inverse of gpi": GPI.inverse(),
    "inverse of mpi": MPI.inverse(),
    "inverse of nested": NESTED.inverse(),
    "inverse with memory": PrandtlIshlinskii(
        [0.5, -0.3], [1.0, 3.0], p0=0.5, z0=[0.5, -1.25]
    ).inverse(),
}
