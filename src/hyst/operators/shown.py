"""What an operator shows of itself."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, final, overload

from numpy.typing import ArrayLike

from hyst._above import PAGES, PLOTS, above

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from hyst.report.shown.axes import Panels


class Shown:
    """What is drawn, and has a page of its own in a notebook."""

    @overload
    def plot(  # type: ignore[overload-overlap]
        self,
        axes: Axes | None = ...,
        *,
        what: str,
        u: ArrayLike | None = ...,
        interactive: Literal[False] = ...,
    ) -> Axes: ...
    @overload
    def plot(
        self,
        axes: Sequence[Axes] | None = ...,
        *,
        what: Sequence[str] | None = ...,
        u: ArrayLike | None = ...,
        interactive: Literal[False] = ...,
    ) -> Panels: ...
    @overload
    def plot(
        self,
        axes: None = ...,
        *,
        what: Any = ...,
        u: ArrayLike | None = ...,
        interactive: Literal[True],
    ) -> Any: ...
    @final
    def plot(
        self,
        axes: Any = None,
        *,
        what: str | Sequence[str] | None = None,
        u: ArrayLike | None = None,
        interactive: bool = False,
    ) -> Any:
        """Draw the loop of a model, and what it is made of.

        Parameters
        ----------
        axes, interactive
            As of ``Record.plot``.
        what
            ``"loop"``, and where the model has them ``"weights"`` over radii, the loading
            ``"curve"``, the ``"map"`` before or behind the hysteresis and the density of
            ``"relays"``; or a sequence; all there are if left out.
        u
            Input to draw it over, shape (N,), finite, input units; swings that shrink within the
            range it was identified over if left out.

        Returns
        -------
        matplotlib.axes.Axes, tuple of them, or plotly.graph_objects.Figure
            As of ``Record.plot``.

        Raises
        ------
        InputError
            If the model has no such panel, ``axes`` are no plain axes or as many as panels, or
            ``u`` is left out of a model that was not identified.
        MissingExtraError
            If plotly is asked for and not installed.
        """
        return above(PLOTS, "plot_operator")(self, axes, what, u, interactive)

    def _repr_html_(self) -> str:
        return str(above(PAGES, "page_of_operator")(self))
