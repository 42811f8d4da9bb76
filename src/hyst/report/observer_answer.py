"""One page for an engineer: is the loop safe, what does the observer buy, what to implement."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.compensation import ErrorBound
from hyst.control import ClosedLoop, DisturbanceObserver, TrackingController
from hyst.control.inverse_comparison import EXACT, InverseComparison
from hyst.report.observer_words import SIGNS, bandwidth_told, ended, errors, finite, rightmost, told
from hyst.report.page import Page
from hyst.report.tables import Table, number

ComplexArray = NDArray[np.complex128]


@final
@dataclass(frozen=True, eq=False)
class ObserverAnswer:
    """What a design comes to, with everything it rests on.

    Parameters
    ----------
    design
        The observer and its certificate.
    comparison
        Loops with the inverse asked about, the exact one and none.
    inverse_name
        Of the inverse asked about.
    block
        The sampled controller to implement.
    sampled
        The loop with it.
    sampled_poles
        Poles of that loop, the least stable first, where the inverse is exact.
    bound
        Of the inverse's error over the range it is used in; None where there is none.
    slopes
        Least and largest slope of hysteresis after inverse over that range; None if not known.
    unstable_slope
        Least slope that hysteresis after inverse had in the simulation and at which the loop is
        unstable; None if there is none.
    seen_slopes
        Least and largest slope it had there.
    slope_margin
        How many times wider that range may be before the circle criterion no longer proves the
        loop stable; None if not known.
    identified
        Least and largest drive the model was identified from; None if not known.
    uncertainty_used
        Largest |P / Pn - 1| / |Wu| of the true plant and its frequency, rad/s; None without one.
    """

    design: DisturbanceObserver
    comparison: InverseComparison
    inverse_name: str
    block: TrackingController
    sampled: ClosedLoop
    sampled_poles: ComplexArray
    bound: ErrorBound | None
    slopes: tuple[float, float] | None
    slope_margin: float | None
    seen_slopes: tuple[float, float]
    unstable_slope: float | None
    identified: tuple[float, float] | None = None
    uncertainty_used: tuple[float, float] | None = None

    def checks(self) -> tuple[tuple[str, bool, str], ...]:
        """Give each condition of safety: what, whether it holds, and the number behind it."""
        c = self.design.certificate
        nominal = rightmost(c.nominal_poles)
        radius = float(np.abs(self.sampled_poles).max(initial=0.0))
        loop = self.comparison.observed[self.inverse_name]
        rows = [
            ("loop around the nominal plant is stable", c.nominal_stable, f"pole {nominal} 1/s"),
            (
                "stable for every plant within Wu",
                c.uncertainty_norm < 1.0,
                f"norm of Wu T {c.uncertainty_norm:.4f} at {c.uncertainty_frequency:.4g} rad/s",
            ),
        ]
        if c.perturbed_poles is not None:
            worst = f"pole {rightmost(c.perturbed_poles)} 1/s"
            rows.append(("loop around the true plant is stable", c.perturbed_stable is True, worst))
        low, high = self.seen_slopes
        limit = self.unstable_slope
        rows += [
            (
                f"stable at each slope of hysteresis after inverse, {low:.3g} to {high:.3g}",
                limit is None,
                "poles for 200 slopes" if limit is None else f"unstable from {limit:.3g} on",
            ),
            (
                f"sampled loop is stable, dt = {self.block.dt:g} s",
                radius < 1.0,
                f"largest |z| {radius:.6f}",
            ),
            (
                f"simulation with the inverse ({self.inverse_name}) stays finite",
                loop.diverged_at is None and self.sampled.diverged_at is None,
                ended(loop) if loop.diverged_at is not None else self._driven(),
            ),
        ]
        return tuple(rows)

    def _driven(self) -> str:
        if self.sampled.diverged_at is not None:
            return ended(self.sampled)
        return "drive {} to {}".format(*map(number, self.drive_range))

    @property
    def drive_range(self) -> tuple[float, float]:
        """Least and largest drive with the observer, the start included, in input units."""
        u = np.concatenate([self.comparison.observed[self.inverse_name].u, self.sampled.u])
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
        """Whether the observer rejects what Wp asks for."""
        return self.design.certificate.performance_norm < 1.0

    def verdict(self) -> str:
        """Give the answer in one sentence."""
        failed = [what for what, holds, _ in self.checks() if not holds]
        if failed:
            return f"NOT SAFE. It fails: {'; '.join(failed)}. The design: {self.design.message}."
        margin = self.design.certificate.robust_stability_margin
        demand = (
            "rejects what Wp asks for"
            if self.meets_demand
            else "does NOT reject all that Wp asks for "
            f"({self.design.certificate.performance_norm:.3g} times as much is left)"
        )
        inverse = "is proven" if self.proven_with_inverse else "is simulated, not proven"
        return (
            f"SAFE: the loop is stable for every plant within Wu, which may grow {margin:.3g} "
            f"times; with the inverse ({self.inverse_name}) it {inverse}; the observer {demand}."
            + ("" if self.within_uncertainty else " BUT the true plant is not within Wu: widen Wu.")
            + self._extrapolation()
        )

    def _extrapolation(self) -> str:
        if self.identified is None or self.within_identified:
            return ""
        (low, high), (least, most) = self.drive_range, self.identified
        return (
            f" BUT the drive goes from {number(low)} to {number(high)}, and the model was "
            f"identified from {number(least)} to {number(most)}: beyond, all of this is a guess."
        )

    def gain_sentence(self) -> str:
        """Say what the observer buys, in one sentence."""
        name, c = self.inverse_name, self.comparison
        without, observed = c.without[name].rms_error, c.observed[name].rms_error
        if not math.isfinite(observed):
            return "With the observer the simulated loop diverges."
        if not math.isfinite(without):
            return f"Without it the loop diverges; with it the rms error is {number(observed)}."
        said = (
            f"With the inverse ({name}) the rms tracking error is {number(without)} without the "
            f"observer and {number(observed)} with it"
        )
        if name == EXACT:
            return f"{said}."
        recovered = c.recovered(name)
        if EXACT not in c.without:
            return f"{said}."
        exact = told(c.without[EXACT].rms_error)
        if math.isnan(recovered):
            return f"{said}; with the exact inverse and no observer: {exact}."
        return (
            f"{said}; the exact inverse alone has {exact}, so the "
            f"observer recovers {100.0 * recovered:.1f} % of what the inexact inverse adds."
        )

    def implement_sentence(self) -> str:
        """Say what to implement, in one sentence."""
        if not self.safe:
            return "Nothing: controller.json is not written while the loop is not safe."
        inverse = "no inverse" if self.block.inverse is None else "the inverse of the hysteresis"
        return (
            f"controller.json: {self.block.order} states and {inverse}, every {self.block.dt:g} s; "
            f"in the simulation it tracks with rms {number(self.sampled.rms_error)}, "
            f"max {number(self.sampled.max_error)}."
        )

    def checks_table(self) -> Table:
        """List the conditions of safety."""
        rows = tuple((what, "yes" if holds else "NO", said) for what, holds, said in self.checks())
        c = self.design.certificate
        demand = (
            "observer rejects what Wp asks for",
            "yes" if self.meets_demand else "NO",
            f"norm of Wp (1 - Q) {c.performance_norm:.4f} at {c.performance_frequency:.4g} rad/s",
        )
        more = (*self._true_plant(), *self._proof(), *self._within(), demand)
        return Table("Is the loop safe?", ("condition", "holds", "by"), (*rows, *more))

    @property
    def proven_with_inverse(self) -> bool:
        """Whether the circle criterion proves the loop stable with the inexact inverse too."""
        return self.slope_margin is not None and self.slope_margin > 1.0

    def _proof(self) -> tuple[tuple[str, str, str], ...]:
        if self.slopes is None or self.slope_margin is None:
            return ()
        low, high = self.slopes
        said = "not proven; only simulated"
        if self.slope_margin > 1e6:
            said = "the inverse is exact"
        elif self.slope_margin > 1.0:
            said = f"range may be {self.slope_margin:.3g} times wider"
        what = f"proven with this inverse: slopes {low:.3g} to {high:.3g} (circle criterion)"
        return ((what, "yes" if self.proven_with_inverse else "open", said),)

    @property
    def within_uncertainty(self) -> bool:
        """Whether the true plant, if there is one, is among those that Wu stands for."""
        # A Wu that is drawn from the true plant is met up to rounding.
        return self.uncertainty_used is None or self.uncertainty_used[0] <= 1.0 + 1e-6

    def _true_plant(self) -> tuple[tuple[str, str, str], ...]:
        if self.uncertainty_used is None:
            return ()
        ratio, at = self.uncertainty_used
        said = f"|P / Pn - 1| up to {ratio:.4g} |Wu|, at {at:.4g} rad/s"
        return (("true plant is within Wu", "yes" if self.within_uncertainty else "NO", said),)

    def _within(self) -> tuple[tuple[str, str, str], ...]:
        if self.identified is None:
            return ()
        what = "drive stays where the model was identified, {} to {}".format(
            *map(number, self.identified)
        )
        holds = "yes" if self.within_identified else "NO"
        return ((what, holds, "{} to {}".format(*map(number, self.drive_range))),)

    def tracking_table(self) -> Table:
        """List tracking errors by inverse, without and with the observer."""
        c = self.comparison
        rows = [
            (
                name,
                told(c.without[name].rms_error),
                told(c.without[name].max_error),
                told(c.observed[name].rms_error),
                told(c.observed[name].max_error),
            )
            for name in c.without
        ]
        rows.append(
            (
                f"{self.inverse_name}, sampled at {self.block.dt:g} s",
                "-",
                "-",
                told(self.sampled.rms_error),
                told(self.sampled.max_error),
            )
        )
        names = [row[0] for row in rows]
        return Table(
            "What does the observer buy? Tracking error",
            ("inverse", "rms without", "max without", "rms with", "max with"),
            tuple(rows),
            names.index(self.inverse_name),
        )

    def filter_table(self) -> Table:
        """List what the observer is: its gain and Q(s)."""
        c = self.design.certificate
        rows = [
            ("gain L", ", ".join(number(each, 8) for each in self.design.gain)),
            ("Q(s) numerator", ", ".join(number(each, 8) for each in c.Q_numerator)),
            ("Q(s) denominator", ", ".join(number(each, 8) for each in c.Q_denominator)),
            ("bandwidth of rejection", bandwidth_told(c.Q_numerator, c.Q_denominator)),
            (
                "rejection against what was asked",
                f"{c.performance_norm:.3g} of 1/Wp; slowest pole of Q "
                f"{rightmost(c.observer_poles)} 1/s",
            ),
        ]
        if self.bound is not None:
            rows.append(
                (
                    "error of the inverse",
                    f"command off by at most {number(self.bound.bound)}, its output by at most "
                    f"{number(self.bound.output_bound)}, for |v| up to {number(self.bound.y_max)}",
                )
            )
        return Table("What is it?", ("what", "value"), tuple(rows))

    def tables(self) -> tuple[Table, ...]:
        """Give the three tables of the answer."""
        return self.checks_table(), self.tracking_table(), self.filter_table()

    def to_dict(self) -> dict[str, Any]:
        """Give certificate, checks and errors as plain numbers and text."""
        return {
            "safe": self.safe,
            "verdict": self.verdict(),
            "checks": [
                {"condition": what, "holds": bool(holds), "by": said}
                for what, holds, said in self.checks()
            ],
            **self.design.to_dict(),
            "sampled_pole_radius": float(np.abs(self.sampled_poles).max(initial=0.0)),
            "inverse": self.inverse_name,
            "inverse_error_bound": None if self.bound is None else self.bound.to_dict(),
            "slopes": None if self.slopes is None else list(self.slopes),
            "seen_slopes": list(self.seen_slopes),
            "unstable_slope": self.unstable_slope,
            "slope_margin": finite(self.slope_margin),
            "uncertainty_used": None
            if self.uncertainty_used is None
            else list(self.uncertainty_used),
            "drive_range": list(self.drive_range),
            "identified": None if self.identified is None else list(self.identified),
            "tracking": {
                name: {
                    "without": errors(self.comparison.without[name]),
                    "with_observer": errors(self.comparison.observed[name]),
                }
                for name in self.comparison.without
            },
            "tracking_sampled": errors(self.sampled),
        }

    def to_html(self, bode: bytes, loops: bytes) -> str:
        """Give the page.

        Parameters
        ----------
        bode, loops
            Figures, PNG.

        Returns
        -------
        str
            HTML that needs nothing but itself.
        """
        page = Page("Disturbance observer")
        page.banner(self.verdict())
        page.text(self.gain_sentence())
        page.text(f"To implement: {self.implement_sentence()}")
        page.table(self.checks_table())
        page.table(self.tracking_table())
        page.faint(SIGNS)
        page.picture(loops, "Reference and output, errors and drives of the loops.")
        page.picture(
            bode,
            "What the observer leaves of a disturbance against what was asked, the output over the "
            "disturbance with and without it, and the condition of robust stability.",
        )
        page.table(self.filter_table())
        if self.safe:
            page.heading("On the target")
            page.text(
                "Each sample it takes reference and measured output, and gives the drive. In C:"
            )
            page.code("hyst export controller.json --target c -o firmware")
            page.text("In Python:")
            page.code(
                "import hyst\n"
                'step = hyst.load("controller.json").stepper()\n'
                f"u = step(y_ref, y)   # every {self.block.dt:g} s"
            )
        return page.to_html()
