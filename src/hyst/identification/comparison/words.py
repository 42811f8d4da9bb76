"""Which of several models is for what, in sentences."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from hyst.identification.judgement.validation import FAR_ABOVE

if TYPE_CHECKING:
    from hyst.identification.comparison.compared_model import ComparedModel
    from hyst.identification.comparison.comparison import Comparison

SMALL_PART = 0.6
"""Of the input range a model was identified over: records of less say little of its large loops."""

HARDLY_OUTSIDE = 5e-3
"""Of the range a model was identified over: an input that goes less far beyond it is not told."""


def which_for_what(found: Comparison) -> tuple[str, ...]:
    """Say which model is best, which is simplest, and which are for what.

    Parameters
    ----------
    found
        The comparison.

    Returns
    -------
    tuple of str
        What makes the comparison doubtful first.
    """
    return (
        *_no_tests(found),
        *_alone(found),
        _best(found),
        *_simplest(found),
        *_on_minor_loops(found),
        _for_commands(found),
        *_carried_over(found),
        *_outside(found),
    )


def _no_tests(found: Comparison) -> Iterator[str]:
    for seen in dict.fromkeys(each.seen for each in found.models if each.seen):
        which = _numbers("record", seen, len(found.records))
        names = [each.name for each in found.models if each.seen == seen]
        yield (
            f"Warning: {_called(names, found)} identified from {which}, so an error there "
            "is no test; compare on a record that no model has seen."
        )
    if found.zero_is_off:
        bias = found.best.metrics.bias
        yield (
            f"The zero of these records is off by {_with_unit(abs(bias), found)} or so for every "
            "model, which is most of the error; the models are ranked by what is left beside it."
        )


def _alone(found: Comparison) -> Iterator[str]:
    if len(found) == 1:
        yield "One model alone: nothing to compare it with but a straight line."


def _best(found: Comparison) -> str:
    best, line = found.best, found.straight_line_rms
    metrics = best.free_offset if found.zero_is_off else best.metrics
    share = 100.0 * line / metrics.output_range
    where = " (on records it was identified from)" if best.seen else ""
    told = (
        f"Best overall{where}: {best.name} misses by {_with_unit(metrics.rms, found)} rms, "
        f"{metrics.rms_percent:.3g} % of the output's range; a straight line through these very "
        f"samples misses by {share:.3g} %"
    )
    if metrics.rms >= line:
        return f"{told}, so no model here is better than that line."
    if found.is_unfit(best):
        return f"{told}. It is unfit, {_why_unfit(found, best)}: no command should come from it."
    return f"{told}."


def _simplest(found: Comparison) -> Iterator[str]:
    chosen, best = found.chosen, found.best
    if chosen is None:
        yield (
            "Every model is unfit, so none is chosen: "
            + "; ".join(f"{each.name}, {_why_unfit(found, each)}" for each in found.models)
            + "."
        )
        return
    if len(found) == 1:
        return
    as_good = [
        each.name for each in found.models if each is not best and found.is_as_good(each, best)
    ]
    if not as_good:
        yield (
            "No other model is as good: the difference is more than 2 % and more than one standard "
            "error of it over blocks of the records, block by block."
        )
    else:
        yield (
            f"{_listed(as_good)} {_is(as_good)} not told from it by these records: the difference "
            "is at most 2 %, or less than one standard error of it over blocks of the records."
        )
    if chosen is best:
        yield f"Take {chosen.name}: nothing simpler is as good."
    else:
        yield (
            f"Take {chosen.name}: of those that are fit and not told from the best of them it is "
            f"the simplest, with {chosen.constants} constants and "
            f"{_with_unit(found.error_of(chosen), found)} rms."
        )


def _on_minor_loops(found: Comparison) -> Iterator[str]:
    inside = found.best_on_minor_loops
    if inside is None:
        yield (
            "These records hold hardly any loops inside their largest one, so they do not tell "
            "which model to take for minor loops."
        )
        return
    if len(found) == 1 or inside.minor_loops is None:
        return
    others = [
        f"{each.name} {each.minor_loops:.3g}"
        for each in found.models
        if each is not inside and each.minor_loops is not None
    ]
    yield (
        f"On minor loops {inside.name} is best, with {_with_unit(inside.minor_loops, found)} rms "
        f"({', '.join(others)})."
    )


def _for_commands(found: Comparison) -> str:
    commands = found.for_commands
    if commands is not None:
        return (
            f"For commands take {commands.name}, which has an exact inverse: "
            f"{_with_unit(found.error_of(commands), found)} rms here."
        )
    if not found.fit_models:
        return "For commands there is none, since none is fit."
    reasons = "; ".join(f"{each.name}: {each.not_invertible}" for each in found.fit_models)
    return f"For commands none of those that are fit has an exact inverse ({reasons})."


def _carried_over(found: Comparison) -> Iterator[str]:
    """Say which models are much worse here than where they were identified."""
    for each in found.models:
        # Those of an inverse are in units of its input.
        errors = {} if each.description.is_inverse else each.description.errors
        training = errors.get("training", {}).get("rms")
        least = 5e-4 * each.metrics.output_range
        error = found.error_of(each)
        if training is None or each.seen or error <= FAR_ABOVE * max(training, least):
            continue
        yield (
            f"{each.name} misses by {error / max(training, least):.2g} times as much as on the "
            f"records it was identified from ({_with_unit(training, found)}): what it says there "
            "does not carry over to these."
        )


def _outside(found: Comparison) -> Iterator[str]:
    low = min(float(each.u.min()) for each in found.records)
    high = max(float(each.u.max()) for each in found.records)
    ranges = {
        each.name: (each.description.input_low, each.description.input_high)
        for each in found.models
    }
    for span in dict.fromkeys(ranges.values()):
        if span[0] is None or span[1] is None:
            continue
        names = [name for name, its in ranges.items() if its == span]
        share = found[names[0]].extrapolated
        said = f"{_called(names, found)} identified from {span[0]:.6g} to {span[1]:.6g}"
        beyond = max(high - span[1], span[0] - low)
        if share and beyond > HARDLY_OUTSIDE * (span[1] - span[0]):
            yield (
                f"Warning: the input goes from {low:.6g} to {high:.6g}, {said}; "
                f"{100.0 * share:.3g} % of the samples are extrapolation."
            )
        elif high - low < SMALL_PART * (span[1] - span[0]):
            yield (
                f"The input goes from {low:.6g} to {high:.6g} only, {said}: nothing is said here "
                "of larger loops."
            )


def _why_unfit(found: Comparison, model: ComparedModel) -> str:
    verdict = model.verdict
    if model.description.is_unfit and verdict is not None:
        return f"by the verdict it was saved with ({verdict.sentences[0].rstrip('.')})"
    metrics = model.free_offset if found.zero_is_off else model.metrics
    explained = max(metrics.nrmse_fit_percent, 0.0)
    return f"since it explains {explained:.2g} % of what the output does here beside its mean"


def _with_unit(value: float, found: Comparison) -> str:
    unit = found.records[0].output_unit
    return f"{value:.3g} {unit}" if unit else f"{value:.3g}"


def _numbers(what: str, numbers: tuple[int, ...], count: int) -> str:
    if count == 1:
        return f"this very {what}"
    plural = "s" if len(numbers) > 1 else ""
    return f"{what}{plural} {_listed([str(each) for each in numbers])}"


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _called(names: list[str], found: Comparison) -> str:
    if 2 < len(names) == len(found):
        return "every model was"
    return f"{names[0]} was" if len(names) == 1 else f"{_listed(names)} were"


def _is(names: list[str]) -> str:
    return "is" if len(names) == 1 else "are"
