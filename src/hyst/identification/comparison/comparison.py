"""What a comparison of models gives back."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, overload

from hyst._above import PAGES, PLOTS, above
from hyst.errors import InputError
from hyst.identification.choice.cross_validation import Score
from hyst.identification.choice.selection import EQUAL, NEGLIGIBLE, REPEATED, ROUNDING
from hyst.identification.comparison.compared_model import ComparedModel
from hyst.identification.comparison.words import which_for_what
from hyst.identification.judgement.validation import (
    FAR_ABOVE,
    HARDLY_BETTER_THAN_THE_MEAN,
)
from hyst.identification.record_use.used_samples import UsedSamples
from hyst.signals import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from hyst.report.shown.axes import Panels


@dataclass(frozen=True, eq=False, repr=False)
class Comparison:
    """Models of one actuator on records that none of them has seen.

    Parameters
    ----------
    records
        What they are judged on.
    models
        Each with its errors, in the order given.
    used
        The samples of each record that all models are judged on.
    shows_minor_loops
        Whether the records hold enough of loops inside the largest one to judge these by.
    straight_line_rms
        Root mean square error of the straight line that fits these very samples best, with the
        delay of one of the models, output units.
    """

    records: tuple[Record, ...]
    models: tuple[ComparedModel, ...]
    used: tuple[UsedSamples, ...]
    shows_minor_loops: bool
    straight_line_rms: float
    _by_name: dict[str, ComparedModel] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_by_name", {each.name: each for each in self.models})

    def __repr__(self) -> str:
        errors = ", ".join(
            f"{each.name}: {each.metrics.rms_percent:.3g} % of range" for each in self.models
        )
        return f"{type(self).__name__}({errors})"

    def __getitem__(self, name: str) -> ComparedModel:
        try:
            return self._by_name[name]
        except KeyError:
            known = ", ".join(self._by_name)
            raise InputError(f"there is no model {name!r}; choose one of {known}") from None

    def __iter__(self) -> Iterator[ComparedModel]:
        return iter(self.models)

    def __len__(self) -> int:
        return len(self.models)

    @functools.cached_property
    def zero_is_off(self) -> bool:
        """Whether most of every model's error is a constant: then models are ranked beside it."""
        whole = min(each.metrics.rms for each in self.models)
        return FAR_ABOVE * min(each.free_offset.rms for each in self.models) < whole

    def error_of(self, model: ComparedModel) -> float:
        """Give the error that models are ranked by, output units.

        Parameters
        ----------
        model
            One of them.
        """
        return (model.free_offset if self.zero_is_off else model.metrics).rms

    def is_unfit(self, model: ComparedModel) -> bool:
        """Tell whether no command should come from a model: by its verdict, or by these records.

        Parameters
        ----------
        model
            One of them.
        """
        metrics = model.free_offset if self.zero_is_off else model.metrics
        misses = metrics.nrmse_fit_percent < HARDLY_BETTER_THAN_THE_MEAN
        return model.description.is_unfit or misses

    @property
    def fit_models(self) -> tuple[ComparedModel, ...]:
        """Those that are not unfit."""
        return tuple(each for each in self.models if not self.is_unfit(each))

    @property
    def best(self) -> ComparedModel:
        """The one that misses least."""
        return min(self.models, key=self.error_of)

    @property
    def chosen(self) -> ComparedModel | None:
        """The simplest of those that the records do not tell from the best; None if all are unfit.

        Those that are unfit do not count. Simple means few constants; of equally many the one that
        misses less.
        """
        return self._simplest(self.fit_models)

    @property
    def best_on_minor_loops(self) -> ComparedModel | None:
        """The one that misses least inside the largest loop; None if the records show no others."""
        if not self.shows_minor_loops:
            return None
        return min(self.models, key=lambda each: each.minor_loops or 0.0)

    @property
    def for_commands(self) -> ComparedModel | None:
        """The simplest that is not told from the best of those with an exact inverse; or None."""
        return self._simplest([each for each in self.fit_models if each.is_invertible])

    def is_as_good(self, model: ComparedModel, other: ComparedModel) -> bool:
        """Tell whether these records do not show that a model is worse than another one.

        It is as good if its error is larger by no more than 2 %, or by less than one standard error
        of the difference over blocks of the records, block by block; where the records show one
        amplitude only, and so repeat themselves, also if the difference is negligible.

        Parameters
        ----------
        model, other
            Two of them, the other one the better.

        Notes
        -----
        The rule by which ``identify`` chooses among families, there on blocks left out of the fit.
        """
        error, least = self.error_of(model), self.error_of(other)
        output_range = model.metrics.output_range
        if error <= max((1.0 + EQUAL) * least, ROUNDING * output_range):
            return True
        negligible = 0.0
        if not self.shows_minor_loops:
            negligible = min(REPEATED * (least / output_range) ** 2, NEGLIGIBLE**2)
        return not self._score(model).seems_worse(self._score(other), negligible)

    def sentences(self) -> tuple[str, ...]:
        """Say which model is for what, and what stands against it.

        Returns
        -------
        tuple of str
        """
        return which_for_what(self)

    def to_dict(self) -> dict[str, Any]:
        """Give everything but models and records as plain numbers and text."""
        chosen, commands, inside = self.chosen, self.for_commands, self.best_on_minor_loops
        return {
            "models": [each.to_dict() for each in self.models],
            "best": self.best.name,
            "chosen": None if chosen is None else chosen.name,
            "best_on_minor_loops": None if inside is None else inside.name,
            "for_commands": None if commands is None else commands.name,
            "as_good_as_best": [
                each.name for each in self.models if self.is_as_good(each, self.best)
            ],
            "zero_is_off": self.zero_is_off,
            "straight_line_rms": self.straight_line_rms,
            "used_samples": [vars(each) for each in self.used],
            "sentences": list(self.sentences()),
        }

    def summary(self) -> str:
        """Give a table for people, and which model is for what.

        Returns
        -------
        str
        """
        unit = self.records[0].output_unit
        width = max(len(each.name) for each in self.models)
        lines = [_line(each, width, f" {unit}" if unit else "") for each in self.models]
        return "\n".join([*lines, "", *self.sentences()])

    @overload
    def plot(  # type: ignore[overload-overlap]
        self, axes: Axes | None = ..., *, what: str, interactive: Literal[False] = ...
    ) -> Axes: ...
    @overload
    def plot(
        self,
        axes: Sequence[Axes] | None = ...,
        *,
        what: Sequence[str] = ...,
        interactive: Literal[False] = ...,
    ) -> Panels: ...
    @overload
    def plot(self, axes: None = ..., *, what: Any = ..., interactive: Literal[True]) -> Any: ...
    def plot(
        self,
        axes: Any = None,
        *,
        what: str | Sequence[str] = ("loops", "errors"),
        interactive: bool = False,
    ) -> Any:
        """Draw the models over each other and over the records; of many models the best six.

        Parameters
        ----------
        axes, interactive
            As of ``Record.plot``.
        what
            ``"loops"``; ``"hysteresis"``, the same without the straight line of the record;
            ``"errors"`` over time, the records after each other; or a sequence of these.

        Returns
        -------
        matplotlib.axes.Axes, tuple of them, or plotly.graph_objects.Figure
            As of ``Record.plot``.

        Raises
        ------
        InputError
            If there is no such panel, or ``axes`` are no plain axes or as many as panels.
        MissingExtraError
            If plotly is asked for and not installed.
        """
        return above(PLOTS, "plot_comparison")(self, axes, what, interactive)

    def _repr_html_(self) -> str:
        return str(above(PAGES, "page_of_comparison")(self))

    def _simplest(self, models: Sequence[ComparedModel]) -> ComparedModel | None:
        if not models:
            return None
        best = min(models, key=self.error_of)
        tied = [each for each in models if each is best or self.is_as_good(each, best)]
        return min(tied, key=lambda each: (each.constants, self.error_of(each)))

    def _score(self, model: ComparedModel) -> Score:
        return Score(model.centred_block_errors if self.zero_is_off else model.block_errors)


def _line(each: ComparedModel, width: int, unit: str) -> str:
    metrics = each.metrics
    return (
        f"{each.name:{width}s}  {each.constants:4d} constants   rms {metrics.rms:.4g}{unit} "
        f"({metrics.rms_percent:.3f} % of range)   max {metrics.max_abs:.4g}{unit}   "
        f"{'exact inverse' if each.is_invertible else 'no exact inverse'}"
    )
