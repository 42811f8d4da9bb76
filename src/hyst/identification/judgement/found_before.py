"""What a diagnosis found before the fit, and what it means for a verdict."""

from __future__ import annotations

from dataclasses import dataclass

from hyst.diagnosis import Diagnosis, Finding
from hyst.diagnosis.findings.direction import NAME as RUN_DIRECTION
from hyst.diagnosis.findings.drifting_output import NAME as DRIFT
from hyst.diagnosis.findings.dynamics import NAME as HAS_DYNAMICS
from hyst.diagnosis.findings.foreign_lines import NAME as FOREIGN_LINE
from hyst.diagnosis.findings.one_amplitude import NAME as AMPLITUDES
from hyst.diagnosis.findings.output_ahead import NAME as OUTPUT_AHEAD
from hyst.identification.families.family import Family
from hyst.identification.judgement.causes.dynamics import DYNAMICS
from hyst.identification.record_use.used_samples import Data
from hyst.operators.verdict import Level

TAKEN_OUT = frozenset({DRIFT, FOREIGN_LINE})


@dataclass(frozen=True)
class FoundBefore:
    """What findings allow, and their sentences.

    Parameters
    ----------
    level
        The best that a verdict may be.
    sentences
        What makes the records doubtful, or was taken out of them; then samples that were left out;
        then what they leave open.
    advice
        What to do about what the family cannot hold.
    """

    level: Level
    sentences: tuple[str, ...]
    advice: tuple[str, ...] = ()


def found_before(
    diagnosis: Diagnosis, data: Data, family: Family, *, leaves_noise: bool
) -> FoundBefore:
    """Say what findings mean for a model.

    A warning allows no better than ``fair``, unless it is of something that the model holds and
    describes until only noise is left: what its family explains, and a clockwise loop, which
    is told all the same, unless the family has dynamics: exchanged columns have such loops, too.
    What the family is for is no doubt at all.

    Parameters
    ----------
    diagnosis
        Of the records.
    data
        The records as they were used.
    family
        Of the model.
    leaves_noise
        Whether what the model leaves is the records' own noise.
    """
    level: Level = "good"
    sentences = []
    for each in diagnosis.of("warning"):
        if each.name == RUN_DIRECTION and diagnosis.named(OUTPUT_AHEAD):
            continue  # the same thing, seen in another way
        if each.name in family.describes:
            continue
        if leaves_noise and each.name in family.explains and each.name != RUN_DIRECTION:
            continue
        if leaves_noise and each.name == RUN_DIRECTION and family.answers_late:
            continue  # its dynamics turn the loop, above a resonance for one
        if leaves_noise and each.name == RUN_DIRECTION:
            sentences.append(f"{_capital(each.sentence)} {each.advice}")
            continue
        level = "fair"
        sentences.append(_warning(each, data))
    sentences += [_left_out(each) for each in diagnosis.of("left out") if each.samples.size]
    if family.has_memory:
        open_ones = diagnosis.named(AMPLITUDES)
        sentences += [f"{_capital(each.sentence)} {each.advice}" for each in open_ones]
    return FoundBefore(level, tuple(sentences), _advice(diagnosis, family))


def _advice(diagnosis: Diagnosis, family: Family) -> tuple[str, ...]:
    """Name a family with dynamics where the records show some and the model has none."""
    shown = any(each.name == HAS_DYNAMICS for each in diagnosis.of("warning"))
    return (DYNAMICS.advice,) if shown and HAS_DYNAMICS not in family.explains else ()


def _warning(finding: Finding, data: Data) -> str:
    if finding.name in TAKEN_OUT and _was_taken_out(finding, data):
        return (
            f"{_capital(finding.sentence).removesuffix('.')}; it was taken out before the fit, and "
            "the actuator's output will have it."
        )
    return f"The record itself is doubtful ({finding.name}): {finding.sentence}"


def _was_taken_out(finding: Finding, data: Data) -> bool:
    of_record = data.disturbances[max(finding.record - 1, 0) :][: 1 if finding.record else None]
    return any(each is not None for each in of_record)


def _left_out(finding: Finding) -> str:
    count = finding.samples.size
    some = "One sample was" if count == 1 else f"{count:,} samples were"
    return f"{some} left out: {finding.sentence}"


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]
