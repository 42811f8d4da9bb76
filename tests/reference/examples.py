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
    RateDependentPrandtlIshlinskii,
    Stop,
)
from hyst.models import (
    BoucWen,
    Butterfly,
    ColemanHodgdon,
    Creep,
    CreepingPlays,
    Dahl,
    DegradingBoucWen,
    Delay,
    DynamicJilesAtherton,
    ExponentialCurve,
    GeneralizedMaxwellSlip,
    Iwan,
    JilesAtherton,
    Lag,
    LinearDynamics,
    LuGre,
    MasingOperator,
    MaxwellSlip,
    MemoryElement,
    MemoryFunction,
    PiecewiseLinear,
    PolynomialCurve,
    PowerLaw,
    Preisach,
    RambergOsgood,
    RateCurve,
    RateDependentPreview,
    RateShift,
    SecondOrderSections,
    TwoEnvelopePrandtlIshlinskii,
)

PI = PrandtlIshlinskii([0.5, 0.25, 0.7], [0.5, 1.5, 4.0], p0=0.3)
CREEPING_PLAYS = CreepingPlays(
    [0.5, 0.3], [0.5, 2.0], 1.0, [[0.05, 0.02], [-0.01, 0.08]], [0.05, 0.5], dt=0.01
)
WAVY = PrandtlIshlinskii([0.5, -0.6, 0.4, -0.1], [0.5, 1.0, 2.5, 3.0], p0=0.3)
ENVELOPE = DeadZone.odd([0.65, 0.2, 0.3], [0.0, 2.0, 5.0])
LOPSIDED = DeadZone([0.8, 0.6, -0.5, 0.4], [0.0, 1.5, -2.5, 4.0])
TENT = DeadZone([1.0, -2.0], [0.0, 1.0])
RATE_DEPENDENT = RateDependentPrandtlIshlinskii(
    [0.5, 0.25, 0.7], [0.5, 1.5, 4.0], beta=0.02, dt=0.1, p0=0.3
)
GPI = GeneralizedPrandtlIshlinskii(ENVELOPE, PI)
MPI = ModifiedPrandtlIshlinskii(PI, LOPSIDED)
NESTED = MPI @ Affine(-0.5, 1.0) @ GPI

PLAYS_AND_MAPS: dict[str, Operator] = {
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
    "pi wide": PrandtlIshlinskii(
        [0.4 / (1 + i) for i in range(19)], [0.3 * i for i in range(19)], p0=0.2
    ),
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
    "rate-dependent": RATE_DEPENDENT,
    "rate-dependent in name only": RateDependentPrandtlIshlinskii(
        [0.5, 0.25], [0.5, 1.5], beta=0.0, dt=0.1, p0=0.3
    ),
    "rate-dependent with memory": RateDependentPrandtlIshlinskii(
        [0.5, -0.3], [1.0, 3.0], beta=0.05, dt=0.1, p0=0.2, z0=[0.5, -1.25]
    ),
    "rate-dependent by a curve": RateDependentPrandtlIshlinskii(
        [0.5, 0.3], [0.0, 2.0], RateCurve(0.02, [1e-3], [0.05, -0.04], [5.0, 20.0]), 0.1, 0.4
    ),
    "mpi of rate-dependent plays": ModifiedPrandtlIshlinskii(RATE_DEPENDENT, LOPSIDED),
    "explicit inverse": RATE_DEPENDENT.explicit_inverse(),
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

LAG = LinearDynamics.from_transfer_function([0.5, 0.1], [1.0, -1.2, 0.5], dt=0.01)
CHARGE = MemoryFunction.polynomial([1.0, 0.2, 0.1])
RELAYS = Preisach(
    [[0.25, 0.0, 0.0], [0.5, 0.75, 0.0], [0.2, 1.0, 0.5]], [-3.0, -1.0, 0.5, 4.0], p0=0.5
)
# The gap between them is 0 at 0, -0.54 at 1, -0.24 at 4, and grows far out on either side.
UP = DeadZone([1.0, -0.6, 0.2, 0.2, -0.1], [0.0, 1.0, -1.5, -3.0, 2.5])
DOWN = DeadZone([0.7, -0.2, -0.25, 0.25], [0.0, 1.5, -1.0, -2.5])
TWO_ENVELOPE = TwoEnvelopePrandtlIshlinskii([0.5, 0.3, 0.2], [1.0, 1.25, 2.5], UP, DOWN, p0=0.4)
RELAYS = Preisach(
    [[0.25, 0.0, 0.0], [0.5, 0.75, 0.0], [0.2, 1.0, 0.5]], [-3.0, -1.0, 0.5, 4.0], p0=0.5
)
OTHERS: dict[str, Operator] = {
    "linear": LAG,
    "linear with delay": LinearDynamics.from_transfer_function([0.5], [1.0, -0.5], 0.01, delay=2),
    "linear that answers at once": LinearDynamics.from_transfer_function(
        [1.0, 0.2], [1.0, -0.5], dt=0.01
    ),
    "linear without order": LinearDynamics([], [], [], 1.5, dt=0.01),
    "sections": SecondOrderSections.from_linear(LAG),
    "masing of a power": MasingOperator(PowerLaw(1.0, 0.5, 0.7)),
    "masing of plays": MasingOperator(PiecewiseLinear([0.5, -0.3], [1.0, 2.0], p0=0.4)),
    "masing of a polynomial": MasingOperator(PolynomialCurve([1.0, 0.25])),
    "masing that stiffens": MasingOperator(ExponentialCurve(1.0, 0.75, 2.0)),
    "masing that softens": MasingOperator(ExponentialCurve(0.5, -1.0, 1.5)),
    "masing that saturates": MasingOperator(ExponentialCurve(0.0, -1.0, 1.5)),
    "inverse of a masing that stiffens": MasingOperator(ExponentialCurve(1.0, 0.75, 2.0)).inverse(),
    "inverse of a masing that softens": MasingOperator(ExponentialCurve(0.5, -1.0, 1.5)).inverse(),
    "iwan": Iwan(2.0, 1.5, -0.4, 0.25, 0.1),
    "iwan without a spring": Iwan(2.0, 1.5),
    "inverse iwan": Iwan(2.0, 1.5, -0.4, 0.25, 0.1).inverse(),
    "masing that forgets": MasingOperator(PowerLaw(1.0, 0.5, 0.7), "last-reversal", dead_band=0.3),
    "ramberg-osgood": RambergOsgood(1.0, 0.5, 1.2),
    "ramberg-osgood that forgets": RambergOsgood(1.0, 0.5, 1.2, "last-reversal"),
    "ramberg-osgood that starts flat": RambergOsgood(0.0, 0.5, 0.8),
    "inverse ramberg-osgood": RambergOsgood(1.0, 0.5, 1.2).inverse(),
    "memory element": MemoryElement(CHARGE, 0.1, start=0.5),
    "memory element of rates": MemoryElement(
        MemoryFunction.power_law(1.0, 0.5, 1.5), 0.1, "absolute", "sign-change"
    ),
    "inverse memory element": MemoryElement(CHARGE, 0.1).inverse(),
    "coleman-hodgdon": ColemanHodgdon(0.25, 2.0, 1.5),
    "coleman-hodgdon saturating": ColemanHodgdon(0.5, [2.0, 0.5], [1.75, 0.45], [3.0], 0.25, 0.25),
    "coleman-hodgdon that falls": ColemanHodgdon(1.0, [2.0, 0.5], [0.75, 0.25], [3.0]),
    "inverse coleman-hodgdon": ColemanHodgdon(0.5, [2.0, 0.5], [1.75, 0.45], [3.0]).inverse(),
    "dahl": Dahl(1.5, 200.0),
    "dahl ductile": Dahl(1.5, 2.0, 0.5, z0=-0.25, u0=0.5),
    "inverse dahl": Dahl(0.5, 400.0, 1.5).inverse(),
    "maxwell-slip": MaxwellSlip([1.0, 0.5, 0.25], [0.5, 1.0, 1.0], 0.25),
    "maxwell-slip that slides": MaxwellSlip([1.0, 0.5], [0.5, 1.0], z0=[0.25, -1.0]),
    "generalized maxwell-slip": GeneralizedMaxwellSlip(
        [1.0, 0.5], [0.375, 0.625], C=4.0, Fc=1.0, Fs=1.5, vs=20.0, dt=0.1, delta=1.5, sigma2=0.02
    ),
    "two envelopes": TWO_ENVELOPE,
    "two envelopes without linear part": TwoEnvelopePrandtlIshlinskii(
        [0.5, 0.3],
        [0.25, 1.5],
        DeadZone([0.5, -0.4], [0.0, 2.0]),
        DeadZone([0.5, 0.5, -0.1], [0.0, 2.0, -1.0]),
    ),
    "inverse of two envelopes": TWO_ENVELOPE.inverse(),
    "rate shift": RateShift(0.3, 0.4, 0.1),
    "plays behind a rate shift": PI @ RateShift(0.3, 0.7, 0.1, z0=0.5),
    "rate-dependent preview": RATE_DEPENDENT.inverse(preview=4),
    "rate-dependent preview held back": RateDependentPreview(
        RATE_DEPENDENT, 3, command_range=(-2.0, 3.0), largest_change=0.5
    ),
    "creep": Creep([0.03, 0.02, 0.01], [0.05, 0.5, 5.0], dt=0.01, rest=0.5),
    "creep that goes back": Creep([0.3, -0.2], [0.1, 1.0], dt=0.01),
    "inverse creep": Creep([0.2, 0.1], [0.03, 0.4], dt=0.01).inverse(),
    "creep of hysteresis": Creep([0.02, 0.02], [0.1, 1.0], dt=0.01) @ PI,
    "creeping plays": CREEPING_PLAYS,
    "inverse of creeping plays": CREEPING_PLAYS.inverse(),
    "lag": Lag(0.013, dt=0.01),
    "lag of a held signal": Lag(0.004, dt=0.01, hold="zero"),
    "inverse lag": Lag(0.006, dt=0.01).inverse(),
    "delay": Delay(2.25, dt=0.01),
    "delay of whole samples": Delay(3, dt=0.01),
    "delay of nothing": Delay(0.0, dt=0.01),
    "inverse delay": Delay(0.2, dt=0.01).inverse(),
    "delay taken back by preview": Delay(1.7, dt=0.01).inverse(preview=5),
    "inverse of hysteresis behind a delay": (PI @ Delay(3.8, dt=0.01)).inverse(preview=9),
    "inverse of an actuator that creeps and lags": (
        Affine(-2.0, 0.5)
        @ Creep([0.02, 0.03, 0.01], [0.013, 0.17, 2.3], dt=0.01)
        @ ModifiedPrandtlIshlinskii(PI, DeadZone.odd([1.0, 0.2], [0.0, 0.5]))
        @ Lag(0.0042, dt=0.01)
    ).inverse(),
    "hysteresis and creep behind a lag": Creep([0.02, 0.02], [0.1, 1.0], dt=0.01)
    @ PI
    @ Delay(0.25, dt=0.01)
    @ Lag(0.0042, dt=0.01),
    "preisach": RELAYS,
    "preisach of relays alone": Preisach([[0.0, 0.0], [1.0, 0.5]], [-1.0, 0.0, 1.5]),
    "preisach from saturation": Preisach([[0.5, 0.0], [1.0, 0.5]], [0.0, 2.0, 3.0], 0.2, u0=-5.0),
    "preisach of ridges": Preisach(RELAYS.weights, [-3.0, -1.0, 1.0, 3.0], 0.4, density="ridges"),
    "inverse preisach": RELAYS.inverse(),
    "bouc-wen": BoucWen(0.6, 0.35, 0.12, 0.06, h=-1.0),
    "bouc-wen sharp": BoucWen(0.2, 1.5, 0.7, -0.3, 1.7, phi=0.1, z0=-0.25, u0=0.5),
    "bouc-wen without inverse": BoucWen(0.5, 0.4, 0.5, 0.1, 0.6, -1.0),
    "inverse bouc-wen": BoucWen(1.1, 0.4, 0.2, 0.1, 2.5, -1.0, 0.02).inverse(),
    "degrading bouc-wen": DegradingBoucWen(0.4, 0.8, 0.3, 0.2, 1.0, 0.02, 0.05),
    "degrading bouc-wen that pinches": DegradingBoucWen(
        0.3, 1.0, 0.4, -0.1, 1.7, 0.01, 0.02, 0.45, 0.5, 0.2, 0.4, 0.01, 0.3
    ),
    "degrading bouc-wen without inverse": DegradingBoucWen(0.0, 1.0, 0.5, 0.1, 2.0, 0.3),
    "inverse degrading bouc-wen": DegradingBoucWen(
        0.5, 0.6, 0.4, 0.1, 1.3, 0.03, 0.1, 0.4, 1.0, 0.1, 0.5, 0.0, 0.5
    ).inverse(),
    "jiles-atherton": JilesAtherton(2.0, 3.0, 2.0, 0.2, 1.0),
    "jiles-atherton 1992": JilesAtherton(2.0, 3.0, 2.0, 0.2, 1.0, "jiles-thoelke-devine-1992"),
    "jiles-atherton 1986": JilesAtherton(2.0, 3.0, 5.0, 0.3, 1.0, "jiles-atherton-1986"),
    "jiles-atherton of B": JilesAtherton(2.0, 3.0, 1.0, 0.1, 1.5, output="B", mu0=0.5),
    "inverse jiles-atherton": JilesAtherton(200.0, 3.0, 2.0, 0.4, 0.01).inverse(),
    "inverse jiles-atherton of B": JilesAtherton(
        2.0, 3.0, 2.0, 0.2, 1.0, output="B", mu0=0.5
    ).inverse(),
    "jiles-atherton with losses": DynamicJilesAtherton(
        JilesAtherton(2.0, 3.0, 2.0, 0.2, 1.0), 0.05, 0.1, dt=0.1
    ),
    "jiles-atherton of B with eddy currents": DynamicJilesAtherton(
        JilesAtherton(2.0, 3.0, 1.0, 0.1, 1.5, output="B", mu0=0.5), 0.2, 0.0, dt=0.1
    ),
    "inverse jiles-atherton with eddy currents": DynamicJilesAtherton(
        JilesAtherton(200.0, 3.0, 2.0, 0.4, 0.01), 0.001, 0.0, dt=0.1
    ).inverse(),
    "lugre": LuGre(1.5, 0.05, 0.02, Fc=2.0, Fs=3.0, vs=20.0, dt=0.1, Fv=0.5, vv=15.0),
    "hysteresis before dynamics": LAG @ PI,
    "butterfly": Butterfly(GPI, [[0.5, 0.1, 0.4], [-0.2, 0.3, 0.0], [0.05, 0.0, 0.0]]),
    "butterfly of a higher degree": Butterfly(
        WAVY, [[0.5, 0.1, 0.4, 0.1], [-0.2, 0.3, 0.1, 0.0], [0.05, 0.02, 0.0, 0.0], [0.01, 0, 0, 0]]
    ),
    "butterfly of friction": Butterfly(
        Dahl(1.5, 200.0), [[0.0, 0.1, 0.01], [0.2, 0, 0], [0, 0, 0]]
    ),
    "butterfly of relays": Butterfly(RELAYS, [[0.0, 0.1, 0.4], [0.2, 0.3, 0.0], [0.0, 0.0, 0.0]]),
    "butterfly in a chain": Affine(-2.0, 1.0) @ Butterfly(PI, [[0.0, 1.0], [0.5, 0.0]]),
}

# Fs is Fc, below which it must not come: no difference to both sides can be taken there.
WITHOUT_STRIBECK_CURVE: dict[str, Operator] = {
    "generalized maxwell-slip at rest": GeneralizedMaxwellSlip(
        [2.0], [1.0], 0.0, 1.0, 1.0, 1.0, 0.1
    ),
    "lugre without rate": LuGre(1.5, 0.0, 0.0, Fc=2.0, Fs=2.0, vs=1.0, dt=0.1),
}

EXAMPLES = {**PLAYS_AND_MAPS, **OTHERS, **WITHOUT_STRIBECK_CURVE}
