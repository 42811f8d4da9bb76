"""A watch over an actuator: samples in, windows with estimates and alarms out."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hyst.online.alarms import AlarmEvent, Alarms
from hyst.online.estimator import Estimator
from hyst.online.knowledge import Knowledge
from hyst.online.watch import limits as named
from hyst.online.watch.asking import at_better_fit, knowledge_of
from hyst.online.watch.limits import RULES, Limits
from hyst.online.watch.sample_clock import SLOT, Slots
from hyst.online.watch.tracker import Followed, Tracker
from hyst.online.watch.window import Window
from hyst.operators import Operator

Array = NDArray[np.float64]

_TIMES_STATED = 2.0
_CALIBRATED_BY = 10
_FEWEST = 5
# An estimate is settled after so many windows in a row within the limit; late ones are judged too.
_SETTLED_AFTER, _LATE = 3, 30
_SURE = 2.0
_COUNTED = {
    named.SAMPLES_LOST: "samples lost",
    named.UNREADABLE: "lines that cannot be read",
    named.NO_NUMBER: "samples without a number that can be a measurement",
    named.CLOCK: "stamps that repeat, go backwards or leap",
    named.OVERFLOW: "samples that led to an overflow",
}


class Watcher:
    """Watch samples of an actuator through an estimator.

    Parameters
    ----------
    estimator
        It follows the actuator, from the model or from where it was.
    model
        What the actuator is compared with. Its description states ranges and errors.
    samples
        In a window, at least 1.
    limits
        What is too much.
    knows_memory
        Whether model and estimator stand as the actuator does before the first sample. If not,
        nothing is learnt or judged until the input has wiped out whatever was before.
    start
        Shape (m,), parameters that drift is counted from; those of the estimator if left out.
    told_every
        Windows after which the estimator is asked again what it knows, which may cost more than a
        window does.
    ask
        Gives what the estimator knows, or None where that is not to be asked now.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> from hyst.online import JointEstimator
    >>> from hyst.online.watch.sample_clock import SampleClock
    >>> model = PrandtlIshlinskii(p=[0.5], r=[1.0], p0=1.0)
    >>> u = 4.0 * np.sin(np.arange(400) / 20.0)
    >>> y = np.where(np.arange(400) < 200, 1.0, 1.2) * model(u)
    >>> nothing = np.full(400, np.nan)
    >>> slots = SampleClock(1.0, False).take(u, y, nothing, np.isfinite(nothing))
    >>> watch = Watcher(JointEstimator(model), model, 20, Limits(error=0.05), knows_memory=True)
    >>> events = [event for each in watch.take(slots) for event in each.events]
    >>> [event.time for event in events if event.name == "model error"]
    [239.0]
    """

    def __init__(
        self,
        estimator: Estimator,
        model: Operator,
        samples: int,
        limits: Limits,
        *,
        knows_memory: bool = False,
        start: Array | None = None,
        told_every: int = 1,
        ask: Callable[[Estimator], Knowledge | None] = knowledge_of,
    ) -> None:
        self.estimator = estimator
        self.limits = limits
        stated = stated_error(model)
        self._tracker = Tracker(estimator, model, knows_memory, stated)
        self._window = samples
        self._start = estimator.parameters if start is None else start
        self._waiting = np.zeros(0, dtype=SLOT)
        self._allowed = limits.error or _TIMES_STATED * stated
        self._first_errors: list[float] = []
        self._settling, self._judged = 0, 0
        self._counts = dict.fromkeys(("samples", "learnt", *_COUNTED), 0)
        self._time = 0.0
        self._told_every, self._untold, self._ask_for = told_every, 0, ask
        self._knowledge = estimator.knowledge
        self.alarms = Alarms(RULES)
        """What is watched for."""

    @property
    def time(self) -> float:
        """Seconds since the first sample, of the last window."""
        return self._time

    @property
    def allowed_error(self) -> float:
        """Error from which on there is an alarm, output units; 0 while it is not known."""
        return self._allowed

    def take(self, slots: Slots) -> list[Window]:
        """Take in samples; give the windows that are full."""
        waiting = np.concatenate([self._waiting, slots]) if self._waiting.size else slots
        full = waiting.size // self._window
        self._waiting = waiting[full * self._window :].copy()
        return [
            self._judge(waiting[k * self._window : (k + 1) * self._window]) for k in range(full)
        ]

    def finish(self) -> list[Window]:
        """End the watch; give the window that was not full, if it has a sample."""
        waiting, self._waiting = self._waiting, self._waiting[:0]
        self._untold, self._ask_for = self._told_every, knowledge_of
        return [self._judge(waiting)] if waiting.size else []

    def silence(self, seconds: float, allowed: float) -> tuple[AlarmEvent, ...]:
        """Say for how long nothing has come.

        Parameters
        ----------
        seconds
            Since the last line.
        allowed
            Seconds from which on there is an alarm.
        """
        sentence = f"nothing has come for {seconds:.4g} s"
        return self.alarms.look(self._time, {named.SILENT: (seconds / allowed, sentence)})

    def _judge(self, slots: Slots) -> Window:
        tracker, before = self._tracker, self._tracker.used
        ratio = _ratio(slots["step"], self.estimator.dt)
        is_off = abs(ratio - 1.0) > self.limits.step
        tracker.is_learning_allowed = not (is_off and tracker.model.dt is not None)
        found = tracker.take(slots)
        self._count(slots, found, tracker.used - before)
        self._time = float(slots["time"][-1])
        error, model_error = _rms(found.estimate_error), _rms(found.model_error)
        self._calibrate(model_error)
        self._ask()
        knowledge = self._knowledge
        paused = "" if tracker.used > before else self._why_paused(found, is_off)
        values = {
            **self._of_errors(error, model_error, found),
            **self._of_counts(slots, found),
            named.DRIFT: self._of_drift(found, knowledge),
            named.NOT_DETERMINED: self._of_knowledge(),
            named.NOTHING_LEARNT: (float(bool(paused)), paused),
            named.MEMORY_UNKNOWN: (
                float(not tracker.is_memory_known),
                "how the input went before is not known, and it has moved too little since then to "
                "wipe that out; nothing is learnt or judged until it has, at most a stroke of its "
                "whole range",
            ),
            named.SAMPLE_TIME: (
                abs(ratio - 1.0) / self.limits.step,
                f"samples come every {ratio * self.estimator.dt:.6g} s, not every "
                f"{self.estimator.dt:.6g} s",
            ),
            named.INPUT_RANGE: self._of_input(found),
            named.STUCK: (found.stuck, f"it stays at {found.level:.6g} while the model moves"),
            named.SATURATED: (
                found.saturated,
                f"it stays at its end, {found.level:.6g}, while the model moves",
            ),
        }
        innovation = self.estimator.innovation
        events = self.alarms.look(self._time, values)
        return Window(
            time=self._time,
            error=error,
            model_error=model_error,
            noise=self.estimator.noise if self.estimator.counts["used"] else math.nan,
            parameters=self.estimator.parameters,
            knowledge=knowledge,
            has_bands=self._untold == 0,
            innovation=str(innovation),
            is_consistent=innovation.consistent,
            paused=paused,
            counts=dict(self._counts),
            events=events,
            active=self.alarms.active,
        )

    def _ask(self) -> None:
        """Ask the estimator what it knows, if that is due."""
        self._untold += 1
        knowledge = self._ask_for(self.estimator) if self._untold >= self._told_every else None
        if knowledge is None:
            return
        self._untold, self._knowledge = 0, at_better_fit(self.estimator, knowledge)

    def _count(self, slots: Slots, found: Followed, learnt: int) -> None:
        added = {"samples": int((slots["lost"] == 0).sum()), "learnt": learnt}
        for name, count in (added | _counts_of(slots, found)).items():
            self._counts[name] += count

    def _calibrate(self, model_error: float) -> None:
        """Where the model states no error, take that of the first windows for what is usual."""
        if self._allowed or math.isnan(model_error):
            return
        self._first_errors.append(model_error)
        if len(self._first_errors) == _CALIBRATED_BY:
            usual = float(np.median(self._first_errors))
            span = float(np.ptp(self._tracker.output_range))
            self._allowed = _TIMES_STATED * max(usual, 1e-6 * span)
            self._tracker.stated_error = usual

    def _why_paused(self, found: Followed, is_off: bool) -> str:
        if not self._tracker.is_memory_known:
            return "the memory is not known"
        if is_off and self._tracker.model.dt is not None:
            return "the sample time is another one"
        return "no output can be used" if not np.isfinite(found.y).any() else "no sample was used"

    def _of_errors(
        self, error: float, model_error: float, found: Followed
    ) -> dict[str, tuple[float, str]]:
        if not self._allowed:
            return {}
        self._settle(error)
        said = {}
        for name, value, errors in (
            (named.ESTIMATE_ERROR, error, found.estimate_error),
            (named.MODEL_ERROR, model_error, found.model_error),
        ):
            known = errors[np.isfinite(errors)]
            mean = float(known.mean()) if known.size else math.nan
            sentence = f"{value:.4g} rms (mean {mean:.4g}), allowed are {self._allowed:.4g}"
            said[name] = (value / self._allowed, sentence)
        if self._settling < _SETTLED_AFTER and self._judged < _LATE:
            del said[named.ESTIMATE_ERROR]
        return said

    def _settle(self, error: float) -> None:
        """See whether the estimate has come from its start to where it predicts well."""
        if math.isnan(error) or self._settling == _SETTLED_AFTER:
            return
        self._judged += 1
        self._settling = self._settling + 1 if error < self._allowed else 0

    def _of_counts(self, slots: Slots, found: Followed) -> dict[str, tuple[float, str]]:
        return {
            name: (float(count), f"{count} {_COUNTED[name]}, {self._counts[name]} since the start")
            for name, count in _counts_of(slots, found).items()
        }

    def _of_drift(self, found: Followed, knowledge: Knowledge) -> tuple[float, str]:
        """Compare the predictions of estimate and model, where bands say that they differ."""
        span = float(np.ptp(self._tracker.output_range))
        off = _rms(found.model_error - found.estimate_error)
        parameters = self.estimator.parameters
        change = parameters - self._start
        width = (knowledge.high - knowledge.low) / 4.0
        is_known = knowledge.determined & (width > 0.0)
        if not is_known.any() or math.isnan(off) or span == 0.0:
            return (math.nan, "")
        sureness = np.where(is_known, np.abs(change) / np.where(is_known, width, 1.0), 0.0)
        k = int(np.argmax(sureness))
        sentence = (
            f"the estimate predicts {100.0 * off / span:.3g} % of the range off the model; surest: "
            f"{knowledge.names[k]} is {parameters[k]:.5g}, was {self._start[k]:.5g}"
        )
        return (min(off / (self.limits.drift * span), float(sureness[k]) / _SURE), sentence)

    def _of_knowledge(self) -> tuple[float, str]:
        """Judge what the estimator knows where it was just asked."""
        if self._untold:
            return (math.nan, "")
        # Doubts about the model's shape are told with the bands; what lacks here is excitation.
        return (float(not self._knowledge.determined.all()), str(self._knowledge))

    def _of_input(self, found: Followed) -> tuple[float, str]:
        about = self._tracker.model.description
        low, high = about.input_low, about.input_high
        known = found.u[np.isfinite(found.u)]
        if low is None or high is None or not high > low or not known.size:
            return (math.nan, "")
        beyond = max(float(known.max()) - high, low - float(known.min())) / (high - low)
        sentence = (
            f"it goes from {known.min():.5g} to {known.max():.5g}, the model is known from "
            f"{low:.5g} to {high:.5g}"
        )
        return (max(beyond, 0.0) / 0.02, sentence)


def stated_error(model: Operator) -> float:
    """Give the error a model states of itself, output units; 0 if it states none."""
    errors = {} if model.description.is_inverse else model.description.errors
    for record in ("validation", *errors):
        value = errors.get(record, {}).get("rms")
        if value is not None:
            return float(value)
    return 0.0


def _counts_of(slots: Slots, found: Followed) -> dict[str, int]:
    is_row = (slots["lost"] == 0) & ~slots["unreadable"]
    measured = np.isfinite(slots["u"]) & np.isfinite(slots["y"])
    # What stands still was set to NaN by the tracker, and is told as that.
    is_far = np.isfinite(slots["u"]) & ~np.isfinite(found.u)
    return {
        named.SAMPLES_LOST: int(slots["lost"].sum()),
        named.UNREADABLE: int(slots["unreadable"].sum()),
        named.NO_NUMBER: int((is_row & (~measured | is_far)).sum()) + found.far,
        named.CLOCK: int(slots["repeated"].sum() + slots["backwards"].sum()),
        named.OVERFLOW: found.refused,
    }


def _rms(errors: Array) -> float:
    known = errors[np.isfinite(errors)]
    if known.size < min(_FEWEST, errors.size):
        return math.nan
    return math.sqrt(float(np.mean(known**2)))


def _ratio(steps: Array, dt: float) -> float:
    """Give the sample time that stamps show over that of the estimator; 1 where there are none."""
    known = steps[np.isfinite(steps)]
    if known.size < _FEWEST:
        return 1.0
    middle = float(np.median(known))
    if middle > 1.5 * dt:
        return middle / dt
    usual = known[known < 1.5 * dt] if middle > 0.0 else known
    return float(usual.mean()) / dt
