"""Friction on measured records: a magneto-rheological damper and a pneumatic seal.

Every family is identified from one record, displacement to force, and judged on others that it has
not seen: of the damper at another amplitude and in the same state, of the seal the second half.
Printed are errors in percent of the output's range, rms, the verdict, and the seconds of a fit.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

import hyst
from hyst.operators import Affine

DATA = Path(__file__).parents[2] / "shared" / "data"

DAMPER = (("B.1", ("B.5", "B.8")), ("B.5", ("B.1", "B.8")), ("B.8", ("B.1", "B.5")),
          ("A.1", ("A.5",)), ("A.5", ("A.1",)))  # fmt: skip
"""Trained on, judged on: two states of the damper, strokes of 11 to 22 mm."""

Row = tuple[str, Callable[[hyst.Record], hyst.Identified]]


def main() -> None:
    if not DATA.is_dir():
        print(f"skipped: no measured records in {DATA}")
        return
    for training, others in DAMPER:
        print(f"damper, trained on {training}, judged on {', '.join(others)}: %")
        print_table(damper(training), [damper(each) for each in others])
    for bar in (3, 7):
        record = seal(bar)
        half = len(record) // 2
        print(f"seal at {bar} bar, trained on the first half, judged on the second: %")
        print_table(part(record, slice(0, half)), [part(record, slice(half, None))])


def rows() -> list[Row]:
    """Give what is compared: families with their options, and shapes fitted as they are."""

    def family(name: str, **options: object) -> Row:
        said = " ".join(f"{key}={value}" for key, value in options.items())
        return f"{name} {said}", lambda record: hyst.identify(record, family=name, **options)

    return [
        *(family(name) for name in ("linear", "pi", "mpi", "rdpi", "dahl", "maxwell-slip")),
        family("hammerstein", hysteresis="pi"),
        family("hammerstein", hysteresis="dahl"),
        family("lugre", viscosity="none"),
        family("lugre", viscosity="linear"),
        family("lugre"),
        ("generalized maxwell-slip", generalized),
    ]


def generalized(record: hyst.Record) -> hyst.Identified:
    """Fit three elements with a curve and viscosity, from the LuGre model of the record."""
    found = hyst.identify(record, family="lugre", stribeck="none", viscosity="linear")
    lugre = dict(zip(found.parameter_names, found.parameter_values.tolist(), strict=True))
    k, Fc = lugre["lugre.sigma0"], lugre["lugre.Fc"]
    model = hyst.GeneralizedMaxwellSlip(
        [0.6 * k, 0.3 * k, 0.1 * k],
        [0.4, 0.35, 0.25],
        10.0 * Fc,
        Fc,
        1.05 * Fc,
        5.0,
        record.dt,
        sigma2=max(lugre["lugre.sigma2"], 1e-6 * k),
    )
    guess = Affine(1.0, lugre["affine.offset"]) @ model
    kind = "generalized_maxwell_slip"
    free = [*(f"{kind}.k[{i}]" for i in (1, 2, 3)), *(f"{kind}.alpha[{i}]" for i in (1, 2, 3))]
    free += [f"{kind}.sigma2", "affine.offset"]
    return hyst.fit(guess, record, free=free, delay=0, allow_unconverged=True)


def print_table(record: hyst.Record, others: Sequence[hyst.Record]) -> None:
    for name, identify in rows():
        began = time.perf_counter()
        try:
            found = identify(record)
        except hyst.HystError as refusal:
            print(f"  {name:32s} {type(refusal).__name__}: {refusal}"[:150], flush=True)
            continue
        seconds = time.perf_counter() - began
        judged = [record, *others]
        errors = "  ".join(f"{error(found, each):6.2f}" for each in judged)
        print(f"  {name:32s} {errors}   {found.verdict.level:5s} {seconds:6.1f} s", flush=True)


def error(found: hyst.Identified, record: hyst.Record) -> float:
    """Give the rms error, percent of the output's range, once the input has passed its range."""
    left = found.predict(record.u) - record.y
    turns = hyst.signals.reversals(record.u, 0.3 * float(np.ptp(record.u)))
    return 100.0 * float(np.sqrt(np.mean(np.square(left[turns[1] :])))) / float(np.ptp(record.y))


def damper(name: str) -> hyst.Record:
    """Give a record of the damper, mm to N."""
    path = DATA / "mr-damper" / f"ensaio.{name}.mat"
    return hyst.read_record(path, input="dist", output="forc", rate=100.0)


def seal(bar: int) -> hyst.Record:
    """Give a record of the seal, mm to N, every 10 ms from after the gap at its beginning."""
    table = np.loadtxt(DATA / "pneumatic-seal" / f"O-ring_{bar}bar.csv")[20:]
    seconds = table[:, 0] / 1000.0
    grid = np.arange(seconds[0], seconds[-1], 0.01)
    return hyst.Record(
        np.interp(grid, seconds, table[:, 4]), np.interp(grid, seconds, table[:, 6]), 0.01
    )


def part(record: hyst.Record, samples: slice) -> hyst.Record:
    """Give some samples of a record."""
    return hyst.Record(record.u[samples], record.y[samples], record.dt)
