"""What a design comes to: one answer for an engineer, with everything it rests on."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.compensation import ErrorBound
from hyst.control import (
    EXACT,
    Certificate,
    ClosedLoop,
    ControllerDesign,
    InverseComparison,
    LoopComparison,
    LoopJudgement,
    LoopMargins,
    SampledCertificate,
    StressTest,
    TrackingController,
    TriedLoop,
)
from hyst.control.sampled.judged import limits_met
from hyst.report.observer.cures import cure_of
from hyst.report.observer.words import finite, hertz, told
from hyst.report.table import number

ComplexArray = NDArray[np.complex128]

_NOTHING = 0.05  # of the error: less is nothing


@final
@dataclass(frozen=True, eq=False)
class TruePlant:
    """How the loop fares around a plant that is given as the true one.

    Parameters
    ----------
    poles
        Of the sampled loop, the largest modulus first.
    used, frequency
        Largest |P / Pn - 1| / |Wu|, and where, rad/s.
    failing
        A slope of hysteresis after inverse that was met and at which the loop is unstable, or None.
    """

    poles: ComplexArray
    used: float
    frequency: float
    failing: float | None

    @property
    def within(self) -> bool:
        """Whether it is among the plants that Wu stands for."""
        # A Wu that is drawn from the true plant is met up to rounding.
        return self.used <= 1.0 + 1e-6


@final
@dataclass(frozen=True, eq=False)
class ObserverAnswer:
    """What a design comes to, with everything it rests on. All of it is of the block that runs.

    Parameters
    ----------
    design
        The observer, with the certificate of its own design.
    certificate
        Of the sampled block, around the nominal plant.
    inverse_name
        Of the inverse asked about.
    without, observed
        Sampled blocks tried with each inverse, without and with the observer.
    noise
        Standard deviation of the sensor's noise that was simulated.
    rivals
        Certificates of other blocks for the same plant, by name.
    true_plant
        What is known of the true plant, if one is given.
    bound
        Of the inverse's error over the range it is used in; None where there is none.
    identified
        Least and largest drive the model was identified from; None if not known.
    stress
        A search for a plant that breaks the block; None if none was asked for.
    margins
        Of the loop with C alone and of that with the block; None where they are not told.
    controller_design
        What C was designed by; None if it was written.
    parts
        What inverse, feedback and observer are worth alone and together; None if not asked for.
    unfit
        Whether the verdict on a model that this rests on is unfit, and it was asked for despite it.
    """

    design: Any
    certificate: SampledCertificate
    inverse_name: str
    without: Mapping[str, TriedLoop]
    observed: Mapping[str, TriedLoop]
    noise: float
    rivals: Mapping[str, SampledCertificate]
    true_plant: TruePlant | None = None
    bound: ErrorBound | None = None
    identified: tuple[float, float] | None = None
    stress: StressTest | None = None
    margins: tuple[LoopMargins, LoopMargins] | None = None
    controller_design: ControllerDesign | None = None
    parts: LoopComparison | None = None
    unfit: bool = False

    @property
    def block(self) -> TrackingController:
        """The sampled controller to implement."""
        return self.observed[self.inverse_name].block

    @property
    def loop(self) -> ClosedLoop:
        """The loop with it."""
        return self.observed[self.inverse_name].loop

    @property
    def judgement(self) -> LoopJudgement:
        """What is known of that loop."""
        return self.observed[self.inverse_name].judgement

    @property
    def has_observer(self) -> bool:
        """Whether the block has an observer."""
        return self.design.observer is not None

    def checks(self) -> tuple[tuple[str, bool, str], ...]:
        """Give each condition of safety: what, whether it holds, and the number behind it."""
        c, j = self.certificate, self.judgement
        radius = float(np.abs(c.poles).max(initial=0.0))
        rows = [
            ("stable around the nominal plant", c.nominal_stable,
             f"largest |z| {radius:.6f}"),
            ("stable for every plant within Wu, aliases too", c.robustly_stable,
             f"Wu T {number(c.uncertainty_norm)} at {hertz(c.uncertainty_frequency)}"),
        ]  # fmt: skip
        if self.true_plant is not None:
            of_true = float(np.abs(self.true_plant.poles).max(initial=0.0))
            said = f"largest |z| {of_true:.6f}"
            rows.append(("stable around the true plant", of_true < 1.0, said))
        failing = self.failing_slope()
        met = f"stable at each slope that was met, {j.met[0]:.3g} to {j.met[1]:.3g}"
        by = "for every plant within Wu" if failing is None else f"unstable at {failing:.3g}"
        rows.append((met, failing is None, by))
        finite_loop = self.loop.diverged_at is None
        ran = "drive {} to {}".format(*map(number, self.drive_range))
        by = ran if finite_loop else f"diverges at {self.loop.diverged_at:.4g} s"
        rows.append(("simulation stays finite", finite_loop, by))
        if self.stress is not None:
            said = (
                f"{self.stress.broken} of {self.stress.tried}, largest |z| {self.stress.radius:.6f}"
            )
            rows.append(("no plant within Wu found that breaks it", self.stress.holds, said))
        return tuple(rows)

    def failing_slope(self) -> float | None:
        """Give a slope that was met and at which some plant that counts is unstable."""
        if self.true_plant is not None and self.true_plant.failing is not None:
            return self.true_plant.failing
        return self.judgement.failing

    def sampled(self) -> str:
        """Say how the block runs."""
        c = self.certificate
        late = f", {number(c.delay)} s late" if c.delay else ""
        return f"every {number(c.dt)} s{late}"

    @property
    def drive_range(self) -> tuple[float, float]:
        """Least and largest drive of the block, the start included, in input units."""
        u = self.loop.u
        return (float(u.min()), float(u.max())) if u.size else (0.0, 0.0)

    @property
    def within_identified(self) -> bool:
        """Whether the drive stays where the model was identified, or that is not known."""
        if self.identified is None:
            return True
        low, high = self.drive_range
        # A hundredth of the range is no guess yet.
        slack = 0.01 * (self.identified[1] - self.identified[0])
        return self.identified[0] - slack <= low and high <= self.identified[1] + slack

    @property
    def safe(self) -> bool:
        """Whether all conditions of safety hold."""
        return all(holds for _, holds, _ in self.checks())

    @property
    def meets_demand(self) -> bool:
        """Whether the observer, as it runs, rejects what Wp asks for."""
        return self.certificate.performance_norm < 1.0

    @property
    def proven_with_inverse(self) -> bool:
        """Whether the loop is proven stable with the inexact inverse too, for all plants in Wu."""
        return self.judgement.standing == "proven"

    def verdict(self) -> str:
        """Give the answer in one sentence."""
        failed = [what for what, holds, _ in self.checks() if not holds]
        c = self.certificate
        if failed:
            return f"NOT SAFE. It fails: {'; '.join(failed)}. {cure_of(self)}"
        demand = (
            "rejects what Wp asks for"
            if self.meets_demand
            else f"does NOT reject all that Wp asks for ({c.performance_norm:.3g} times as much is "
            f"left at {hertz(c.performance_frequency)})"
        )
        inverse = "is proven" if self.proven_with_inverse else "is simulated, not proven"
        rejects = f"the observer {demand}" if self.has_observer else "it has no observer"
        return (
            f"SAFE: the block, {self.sampled()}, is stable for every plant within Wu, which may "
            f"grow {c.robust_stability_margin:.3g} times; with the inverse ({self.inverse_name}) "
            f"it {inverse}; {rejects}.{self._but()}"
        )

    @property
    def margin_of_design(self) -> float | None:
        """How often Wu may grow around the design in continuous time; None if there is none."""
        own = getattr(self.design, "certificate", None)
        if not isinstance(own, Certificate):
            return None
        return float(own.robust_stability_margin) if own.nominal_stable else 0.0

    def _but(self) -> str:
        said = ""
        if self.unfit:
            said += (
                " BUT the verdict on the model is unfit: it does not describe the actuator, and "
                "all of this is of the model."
            )
        if self.true_plant is not None and not self.true_plant.within:
            said += " BUT the true plant is not within Wu: widen Wu."
        if limits_met(self.block, self.loop):
            said += " BUT the drive met its limits: while it does, nothing is rejected."
        if self.identified is not None and not self.within_identified:
            (low, high), (least, most) = self.drive_range, self.identified
            said += (
                f" BUT the drive goes from {number(low)} to {number(high)}, and the model was "
                f"identified from {number(least)} to {number(most)}: beyond, all of this is a "
                "guess."
            )
        return said + self._noisy()

    def _noisy(self) -> str:
        with_it, alone = self.observed[self.inverse_name], self.without[self.inverse_name]
        if self.noise == 0.0 or with_it.noise_jitter <= 3.0 * alone.noise_jitter:
            return ""
        return (
            f" BUT sensor noise of {number(self.noise)} makes the drive jump by "
            f"{number(with_it.noise_jitter)} from sample to sample, "
            f"{_times(with_it.noise_jitter, alone.noise_jitter)}."
        )

    def gain_sentence(self) -> str:
        """Say what the observer buys, in one sentence."""
        name = self.inverse_name
        if not self.has_observer:
            return (
                f"With the inverse ({name}) and no observer the rms tracking error is "
                f"{told(self.without[name].loop.rms_error)}."
            )
        without, observed = (each[name].loop.rms_error for each in (self.without, self.observed))
        if not math.isfinite(observed):
            return "With the observer the simulated loop diverges."
        if not math.isfinite(without):
            return f"Without it the loop diverges; with it the rms error is {number(observed)}."
        said = (
            f"With the inverse ({name}) the rms tracking error is {number(without)} without the "
            f"observer and {number(observed)} with it"
        )
        if observed > (1.0 - _NOTHING) * without:
            return f"The observer buys nothing here. {said}{self._price()}."
        if name == EXACT or EXACT not in self.without:
            return f"{said}{self._price()}."
        recovered = self.recovered(name)
        exact = told(self.without[EXACT].loop.rms_error)
        if math.isnan(recovered):
            return f"{said}; with the exact inverse and no observer: {exact}{self._price()}."
        return (
            f"{said}; the exact inverse alone has {exact}, so the observer recovers "
            f"{100.0 * recovered:.1f} % of what the inexact inverse adds{self._price()}."
        )

    def _price(self) -> str:
        if self.noise == 0.0:
            return ""
        with_it, alone = self.observed[self.inverse_name], self.without[self.inverse_name]
        return (
            f"; noise of {number(self.noise)} makes the drive jump by "
            f"{number(with_it.noise_jitter)} from sample to sample, {number(alone.noise_jitter)} "
            "without it"
        )

    def recovered(self, name: str) -> float:
        """Give the share of what an inverse adds to the rms error that the observer takes off.

        Parameters
        ----------
        name
            Of the inverse.

        Returns
        -------
        float
            1 is all of it; NaN where an inverse adds nothing, or a loop diverges.
        """
        loops = [{n: each.loop for n, each in of.items()} for of in (self.without, self.observed)]
        return InverseComparison(*loops).recovered(name)

    def implement_sentence(self) -> str:
        """Say what to implement, in one sentence."""
        if not self.safe:
            return "Nothing: controller.json is not written while the loop is not safe."
        inverse = "no inverse" if self.block.inverse is None else "the inverse of the hysteresis"
        states = f"{self.block.order} state{'s' * (self.block.order != 1)}"
        return (
            f"controller.json: {states} and {inverse}, every {self.block.dt:g} s; "
            f"in the simulation it tracks with rms {number(self.loop.rms_error)}, "
            f"max {number(self.loop.max_error)}."
        )

    def to_dict(self) -> dict[str, Any]:
        """Give certificate, checks and errors as plain numbers and text."""
        j, true = self.judgement, self.true_plant
        return {
            "safe": self.safe,
            "verdict": self.verdict(),
            "checks": [
                {"condition": what, "holds": bool(holds), "by": said}
                for what, holds, said in self.checks()
            ],
            **self.design.to_dict(),
            "sampled": self.certificate.to_dict(),
            "others_sampled": {name: each.to_dict() for name, each in self.rivals.items()},
            "inverse": self.inverse_name,
            "inverse_error_bound": None if self.bound is None else self.bound.to_dict(),
            "slopes": None if j.slopes is None else list(j.slopes),
            "seen_slopes": list(j.met),
            "failing_slope": self.failing_slope(),
            "slope_proof": finite(j.proof),
            "uncertainty_used": None if true is None else [true.used, true.frequency],
            "drive_range": list(self.drive_range),
            "identified": None if self.identified is None else list(self.identified),
            "noise": self.noise,
            "margins": None
            if self.margins is None
            else {"controller": self.margins[0].to_dict(), "block": self.margins[1].to_dict()},
            "tracking": {
                name: {
                    "without": _row(self.without[name]),
                    "with_observer": _row(self.observed[name]),
                }
                for name in self.observed
            },
            "stress": None
            if self.stress is None
            else {
                "tried": self.stress.tried,
                "broken": self.stress.broken,
                "radius": self.stress.radius,
            },
        }


def _times(with_it: float, alone: float) -> str:
    if alone == 0.0:
        return "which it would not without the observer"
    return f"{float(f'{with_it / alone:.2g}'):.6g} times as much as without the observer"


def _row(tried: TriedLoop) -> dict[str, Any]:
    loop, diverged = tried.loop, tried.loop.diverged_at is not None
    return {
        "rms": None if diverged else loop.rms_error,
        "max": None if diverged else loop.max_error,
        "max_drive": None if diverged else loop.max_drive,
        "jitter": None if diverged else loop.drive_jitter,
        "noise_in_drive": None if diverged else tried.noise_in_drive,
        "noise_jitter": None if diverged else tried.noise_jitter,
        "diverged_at": loop.diverged_at,
        "standing": tried.judgement.standing,
        "reason": tried.judgement.reason,
    }
