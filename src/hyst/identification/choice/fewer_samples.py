"""Few samples, on which a family shows whether it comes near others at all."""

from __future__ import annotations

from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.thinning import thinned

LOOK_SAMPLES = 2000
"""About so many."""


def for_a_look(overview: Overview) -> Overview:
    """Give an overview of few samples, once for all who ask.

    Parameters
    ----------
    overview
        What families are compared on; given as it is where rates matter, or it has no more.
    """
    if overview.rates_matter:
        return overview

    def found() -> Overview:
        data = thinned(overview.data, LOOK_SAMPLES)
        return overview if data is overview.data else Overview(data, overview.delay)

    return overview.once("few samples", found)
