"""What an estimate knows: a band for each parameter, or why it is not determined."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BAND = 2.0


@dataclass(frozen=True, eq=False)
class Knowledge:
    """What an estimate knows about each of its m parameters.

    Parameters
    ----------
    names
        Of the parameters.
    low, high
        Shape (m,): the truth is stated to lie between them, two standard errors to either side
        where nothing better is known; equal where a parameter is held. Where a parameter is not
        determined they are the interval in which the samples leave it; infinite where they say
        nothing.
    determined
        Shape (m,): whether the samples determine the parameter.
    reasons
        One for each parameter: why it is not determined, or what its band rests on; empty where
        there is nothing to add.
    sentences
        What there is to say about the estimate as a whole.
    doubts
        Those of the sentences that say why the bands cannot be believed; empty if they can.

    Examples
    --------
    >>> told = knowledge_from(("gain", "offset"), [2.0, 0.0], [0.1, np.inf], {"offset": "no data"})
    >>> told.known, float(told.low[0]), str(told)
    (False, 1.8, 'offset is not determined: no data')
    """

    names: tuple[str, ...]
    low: Array
    high: Array
    determined: NDArray[np.bool_]
    reasons: tuple[str, ...]
    sentences: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()

    @property
    def known(self) -> bool:
        """Whether every parameter is determined, and there is no reason to doubt the bands."""
        return bool(self.determined.all()) and not self.doubts

    @property
    def unknown(self) -> tuple[str, ...]:
        """What is not determined and why, one sentence for each reason."""
        by_reason: dict[str, list[str]] = {}
        told = zip(self.names, self.determined, self.reasons, strict=True)
        for name, is_known, reason in told:
            if not is_known:
                by_reason.setdefault(reason, []).append(name)
        return tuple(
            f"{', '.join(names)} {'is' if len(names) == 1 else 'are'} not determined: {reason}"
            for reason, names in by_reason.items()
        )

    @property
    def said(self) -> tuple[str, ...]:
        """All there is to say, each thing once."""
        again = [each for each in self.sentences if each not in self.reasons]
        return (*self.unknown, *again)

    def __str__(self) -> str:
        said = self.said
        return "; ".join(said) if said else "every parameter is determined"


def knowledge_from(
    names: tuple[str, ...],
    values: Array | list[float],
    standard_errors: Array | list[float],
    reasons: Mapping[str, str],
    sentences: tuple[str, ...] = (),
    doubts: tuple[str, ...] = (),
) -> Knowledge:
    """Give bands of two standard errors.

    Parameters
    ----------
    names
        Of the m parameters.
    values, standard_errors
        Shape (m,).
    reasons
        Why parameters are not determined, by name; those that are not named here are, if their
        standard error is finite.
    sentences
        What there is to say besides.
    doubts
        Why the bands cannot be believed; they are said first.

    Returns
    -------
    Knowledge
    """
    value, error = np.asarray(values, float), np.asarray(standard_errors, float)
    is_finite = np.isfinite(error)
    width = np.where(is_finite, _BAND * error, np.inf)
    why = tuple(
        reasons.get(name, "" if finite else "its standard error is not known")
        for name, finite in zip(names, is_finite, strict=True)
    )
    return Knowledge(
        names=names,
        low=value - width,
        high=value + width,
        determined=is_finite & np.array([name not in reasons for name in names], dtype=bool),
        reasons=why,
        sentences=(*doubts, *sentences),
        doubts=doubts,
    )
