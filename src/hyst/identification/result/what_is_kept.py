"""What a result shows and hands on of itself: pictures, a page, what is left, a model file."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from hyst._above import PAGES, PLOTS, above
from hyst.errors import InputError
from hyst.signals import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from hyst.identification.record_use.used_samples import UsedSamples
    from hyst.operators import ModelDescription, Operator
    from hyst.report.shown.axes import Panels

Array = NDArray[np.float64]


class Kept:
    """What has a model and the records it was identified from."""

    if TYPE_CHECKING:
        model: Operator
        description: ModelDescription
        records: tuple[Record, ...]

        @property
        def used_of_shown(self) -> tuple[UsedSamples, ...]:
            """Which samples took part."""

        predict: Callable[..., Array]

    @property
    def residuals(self) -> Array:
        """What the model leaves of the records it was identified from, modelled minus recorded.

        Shape (M,), output units: over the samples that took part, ``used``, of the first record,
        then of the next. Slow drift and single samples that the fit left aside are in it.
        """
        parts = [
            (self.predict(record.u, record.dt) - record.y)[used.start : used.stop]
            for record, used in zip(self.kept_records(), self.used_of_shown, strict=True)
        ]
        return np.concatenate(parts)

    def kept_records(self) -> tuple[Record, ...]:
        """Give the records it was identified from.

        Returns
        -------
        tuple of Record
            As its family took them, in the units of its model; of a record in a file the part that
            ``part`` names.

        Raises
        ------
        InputError
            If they were not kept, as by a fleet.
        """
        if not self.records:
            raise InputError(
                "this result keeps no records; give the records to look at, as plot(records=...)"
            )
        return self.records

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model with its description to a file, which ``hyst.load`` reads.

        Parameters
        ----------
        path
            The file to create or replace; it is written whole or not at all.

        Raises
        ------
        InputError
            If the folder does not exist.
        """
        self.model.save(path, self.description)

    @overload
    def plot(  # type: ignore[overload-overlap]
        self,
        axes: Axes | None = ...,
        *,
        what: str,
        records: Any = ...,
        interactive: Literal[False] = ...,
    ) -> Axes: ...
    @overload
    def plot(
        self,
        axes: Sequence[Axes] | None = ...,
        *,
        what: Sequence[str] = ...,
        records: Any = ...,
        interactive: Literal[False] = ...,
    ) -> Panels: ...
    @overload
    def plot(
        self, axes: None = ..., *, what: Any = ..., records: Any = ..., interactive: Literal[True]
    ) -> Any: ...
    def plot(
        self,
        axes: Any = None,
        *,
        what: str | Sequence[str] = ("loop", "residual", "memory", "band"),
        records: Record | Sequence[Record] | None = None,
        interactive: bool = False,
    ) -> Any:
        """Draw how the model follows the records, what it leaves, and what it remembers by.

        Parameters
        ----------
        axes, interactive
            As of ``Record.plot``.
        what
            ``"loop"``; ``"hysteresis"``, the same without its straight line; ``"output"`` over
            time, of the first record; ``"strokes"``, a few of it; ``"band"``, the error over these
            in the band that is to hold 95 % of the samples; ``"residual"`` over time,
            ``"residual-input"`` over the input, their ``"distribution"`` and
            ``"autocorrelation"``; ``"memory"``, the weights over radii, the density of relays
            or the loading curve, and the model's loop where it has none of these; or a sequence.
        records
            One or more records to draw it over, in its units: those it was identified from if left
            out.

        Returns
        -------
        matplotlib.axes.Axes, tuple of them, or plotly.graph_objects.Figure
            As of ``Record.plot``.

        Raises
        ------
        InputError
            If there is no such panel, ``axes`` are no plain axes or as many as panels, or a record
            is none.
        MissingExtraError
            If plotly is asked for and not installed.
        """
        return above(PLOTS, "plot_identified")(self, axes, what, records, interactive)

    def _repr_html_(self) -> str:
        return str(above(PAGES, "page_of_identified")(self))
