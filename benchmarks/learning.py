"""Learning from repetitions on a stage of no model's class, started from identified models.

The stage (``learning_stage``: Bouc-Wen hysteresis, creep of 4.5 % of the stroke, a mode at 800 Hz,
noise of 0.05 % of the stroke) is driven at 10 kHz, each motion from rest after a stroke of its
whole range. Errors are those measured, the noise of the sensor in them, over that noise as it was
simulated: 1 is the least there is. Column k is the k-th repetition; the first has the model's
inverse as its command, so that column 4 is the first command made of three repetitions.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.learning_stage import LearningStage
from hyst.compensation import LearningCompensator

Array = NDArray[np.float64]

DT, NOISE, SEED = 1e-4, 5e-4, 3
STARTS = {"PI": "pi", "mpi": "mpi", "gain": "linear"}
COUNT = 9
PASSED = (0.0, 100.0, 0.0)


def record_drive(dt: float, duration: float = 20.0) -> Array:
    """Give strokes of falling size, as a lab records them, V."""
    t = np.arange(round(duration / dt)) * dt
    return np.asarray(50.0 - 50.0 * np.cos(2.0 * np.pi * 0.5 * t) * np.exp(-0.08 * t))


def references(stroke: float, rest: float, frequency: float) -> dict[str, Array]:
    """Give motions from rest and back, um: four periods at 50 Hz, one at 1 Hz."""
    periods = 4 if frequency > 10.0 else 1
    x = np.arange(round(periods / frequency / DT)) * DT * frequency
    hill = 0.5 - 0.5 * np.cos(2.0 * np.pi * x)
    shapes = {
        "triangle": 1.0 - np.abs(2.0 * (x % 1.0) - 1.0),
        "sine": hill,
        "mixed": 0.6 * hill
        + 0.1 * (1.0 - np.cos(6.0 * np.pi * x))
        + 0.1 * (1.0 - np.cos(2.0 * np.pi * x / periods)),
    }
    still = np.zeros(round(0.01 / DT))
    return {
        name: rest + 0.8 * stroke * np.concatenate([still, each, still])
        for name, each in shapes.items()
    }


def rounded(y_ref: Array, samples: int = 20) -> Array:
    """Round the corners of a motion over so many samples to either side."""
    kernel = np.hanning(samples + 2)[1:-1]
    wide = np.pad(y_ref, samples, mode="edge")
    return np.convolve(wide, kernel / kernel.sum(), "same")[samples:-samples]


def main() -> None:
    u = record_drive(1e-3)
    stroke = float(np.ptp(LearningStage(dt=1e-3).moved(u)))
    y = LearningStage(dt=1e-3, noise=NOISE * stroke, seed=7).measured(u)
    record = hyst.Record(u, y, 1e-3)
    models = {
        name: hyst.identify(record, family=family, creep=None, drift=False).model
        for name, family in STARTS.items()
    }
    rest = float(LearningStage(dt=DT).moved(np.zeros(3))[0])
    print(_row("Hz", "motion", "start", *range(1, COUNT + 1), "largest"))
    print(_row(*["---"] * (COUNT + 4)))
    for frequency in (1.0, 50.0):
        motions = references(stroke, rest, frequency)
        if frequency > 10.0:
            motions["triangle, 2 ms turns"] = rounded(motions["triangle"])
        for motion, y_ref in motions.items():
            for start, model in models.items():
                told = _learnt(model, y_ref, _stage(stroke), COUNT)
                print(_row(f"{frequency:g}", motion, start, *_told(told)), flush=True)
            for gain, cut in ((1.0, None), (0.5, None), (0.5, 200.0)):
                peer = _peer(models["PI"], y_ref, _stage(stroke), gain, cut)
                name = f"peer: gain {gain:g}" + (f", {cut:g} Hz" if cut else "")
                print(_row(f"{frequency:g}", motion, name, *_told(peer)), flush=True)
    print("\nA gain that changes by 30 % after 9 repetitions (PI): errors from there on\n")
    print(_row("Hz", "motion", "gain", *range(1, 7)))
    print(_row(*["---"] * 9))
    for frequency in (1.0, 50.0):
        for motion, y_ref in references(stroke, rest, frequency).items():
            for change in (1.3, 0.7):
                found = _drifting(models["PI"], y_ref, _stage(stroke), change)
                cells = (f"{each:.2f}" for each in found)
                print(_row(f"{frequency:g}", motion, f"{change:g}", *cells), flush=True)


def _stage(stroke: float) -> LearningStage:
    return LearningStage(dt=DT, noise=NOISE * stroke, seed=SEED, passed=PASSED)


def _learnt(model: hyst.Operator, y_ref: Array, stage: LearningStage, count: int) -> Array:
    learning = LearningCompensator(model, y_ref, dt=DT, history=PASSED)
    for _ in range(count):
        learning.update(stage.measured(learning.command))
    return np.array([each.error_rms for each in learning.history]) / stage.noise


def _drifting(model: hyst.Operator, y_ref: Array, stage: LearningStage, change: float) -> Array:
    learning = LearningCompensator(model, y_ref, dt=DT, history=PASSED)
    for k in range(COUNT + 6):
        stage.gain = 1.0 if k < COUNT else change
        learning.update(stage.measured(learning.command))
    return np.array([each.error_rms for each in learning.history[COUNT:]]) / stage.noise


def _peer(
    model: hyst.Operator, y_ref: Array, stage: LearningStage, gain: float, cut: float | None
) -> Array:
    """Learn by ``u += gain * (y_ref - y) / slope``, through a low-pass without phase if asked."""
    inverse = model.inverse()
    own = inverse.run(model(np.array(PASSED)))[1]
    u = inverse.run(y_ref, own)[0]
    slope = float(np.ptp(y_ref)) / float(np.ptp(u))
    errors = []
    frequency = np.fft.rfftfreq(2 * y_ref.size, DT)
    filtered = 1.0 if cut is None else 1.0 / (1.0 + (frequency / cut) ** 4)
    for _ in range(COUNT):
        error = y_ref - stage.measured(u)
        errors.append(float(np.sqrt(np.mean(error**2))) / stage.noise)
        spectrum = np.fft.rfft(np.concatenate([error, error[::-1]])) * filtered
        u = u + gain / slope * np.fft.irfft(spectrum)[: error.size]
    return np.array(errors)


def _told(errors: Array) -> tuple[str, ...]:
    return (*(f"{each:.3g}" for each in errors), f"{errors.max() / errors[0]:.3g} x first")


def _row(*cells: object) -> str:
    return "| " + " | ".join(str(each) for each in cells) + " |"


if __name__ == "__main__":
    main()
