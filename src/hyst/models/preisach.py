"""The Preisach model on a grid of cells, and its exact inverse."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_number, whole_number
from hyst.errors import InputError, NotInvertibleError
from hyst.models.masing import DEPTH
from hyst.models.preisach_grid import as_edges, as_masses, lower_triangle, names_of_cells, triangle
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.portrait import Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]
Density = Literal["even", "ridges"]

_OVERFLOW = 3
"""Place in the state; see core/include/hyst/preisach.h."""


@dataclass(frozen=True, eq=False, init=False)
class _Relays(Operator):
    """What the Preisach model and its inverse have in common: all constants."""

    weights: Array
    thresholds: Array
    p0: float
    u0: float
    density: Density
    depth: int

    def __init__(
        self,
        weights: ArrayLike,
        thresholds: ArrayLike,
        p0: float = 0.0,
        u0: float = 0.0,
        density: Density = "even",
        depth: int = DEPTH,
    ) -> None:
        edges = as_edges(thresholds)
        object.__setattr__(self, "weights", as_masses(weights, edges))
        object.__setattr__(self, "thresholds", edges)
        object.__setattr__(self, "p0", as_number(p0, "p0"))
        object.__setattr__(self, "u0", as_number(u0, "u0"))
        if self.p0 < 0.0:
            raise InputError(f"p0 is {self.p0:.6g}; the linear part beside the relays is 0 or more")
        if density not in ("even", "ridges"):
            raise InputError(f"density is {density!r}; choose 'even' or 'ridges'")
        object.__setattr__(self, "density", density)
        object.__setattr__(self, "depth", whole_number(depth, "depth", 1, 100_000, " reversals"))

    def overflowed(self, state: ArrayLike) -> bool:
        """Tell whether a reversal has found no room and its loop was traced without area.

        Parameters
        ----------
        state
            As ``run`` gave it.

        Returns
        -------
        bool
        """
        return bool(np.asarray(state)[..., _OVERFLOW].any())

    def parameters(self) -> Parameters:
        """Give p0 and the masses of the cells, row by row; thresholds stay as they are."""
        values = np.append(self.p0, lower_triangle(self.weights))
        return Parameters(
            values=values,
            names=("p0", *names_of_cells(self.weights.shape[0])),
            lower=np.zeros(values.size),
            upper=np.full(values.size, np.inf),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the model of other masses on the same thresholds, with the same start."""
        n = self.weights.shape[0]
        vector = as_parameter_vector(theta, 1 + n * (n + 1) // 2)
        return type(self)(triangle(vector[1:], n), self.thresholds, float(vector[0]), *self._rest())

    def to_dict(self) -> dict[str, Any]:
        """Give kind, the rows of the lower triangle, thresholds and what is not as usual."""
        rows = [row[: i + 1].tolist() for i, row in enumerate(self.weights)]
        usual = {"u0": 0.0, "density": "even", "depth": DEPTH}
        rest = {name: getattr(self, name) for name in usual if getattr(self, name) != usual[name]}
        return {
            "kind": self.kind,
            "p0": self.p0,
            "weights": rows,
            "thresholds": self.thresholds.tolist(),
            **rest,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        given = entries(data, ("weights", "thresholds", "p0"), ("u0", "density", "depth"))
        return cls(**given)

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is the output of the relays."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        choices = {
            "inverse": int(self._is_inverse()),
            "ridges": int(self.density == "ridges"),
            "depth": self.depth,
        }
        constants = (self.p0, *lower_triangle(self.weights).tolist())
        fixed = {"thresholds": tuple(self.thresholds.tolist())}
        return (Stage("preisach", constants, fixed, choices),)

    def _rest(self) -> tuple[float, Density, int]:
        return self.u0, self.density, self.depth

    def _cell_rises(self) -> Array:
        """Give what the output rises by along each cell of the diagonal, at least."""
        return np.asarray(2.0 * np.diag(self.weights) + self.p0 * np.diff(self.thresholds))


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class Preisach(_Relays):
    """Preisach model: ``y = p0 u + sum_ij w_ij <relays of cell ij>``, a relay is +1 up and -1 down.

    A relay (alpha, beta), beta <= alpha, goes up where the input rises to alpha and down where it
    falls to beta. ``n + 1`` thresholds are the edges of ``n x n`` cells; the relays of cell (i, j)
    have alpha between ``thresholds[i]`` and ``thresholds[i + 1]``, beta between ``thresholds[j]``
    and ``thresholds[j + 1]``, and its mass ``w_ij`` is spread evenly over them. So between two
    thresholds y is a straight line and a square in u, without steps. Beyond the outer thresholds y
    saturates at ``+-sum(w) + p0 u``.

    Parameters
    ----------
    weights
        Shape (n, n), masses of the cells, output units, >= 0; row i for alpha, column j for beta,
        lower triangle: 0 above the diagonal.
    thresholds
        Shape (n + 1,), edges of the cells, ascending, input units.
    p0
        Linear part beside the relays, >= 0, output units per input unit.
    u0
        Input before the first sample, input units, to which the demagnetised state was brought:
        there relays with alpha + beta < 0 are up, the others down, as plays without memory are. 0
        is that state itself; at or below ``-max(abs(thresholds))`` is negative saturation.
    density
        ``"even"``: mass all over a cell. ``"ridges"``: mass along the line from corner to corner,
        which makes each cell a hysteron of Krasnoselskii and Pokrovskii; see
        ``krasnoselskii_pokrovskii``.
    depth
        Reversals there is room for. When they are used up, loops nested deeper are traced without
        area and still close; ``overflowed`` tells it.

    Raises
    ------
    InputError
        If a mass is negative or above the diagonal, shapes do not fit, thresholds do not ascend, or
        another constant is not allowed.

    Notes
    -----
    F. Preisach, Z. Phys. 94 (1935) 277; D. H. Everett, Trans. Faraday Soc. 51 (1955) 1551;
    I. D. Mayergoyz, Mathematical Models of Hysteresis (1991), eqs. 1.2 and 2.41. A sample costs the
    same for 10 and 1000 cells, but for the search of one; core/include/hyst/preisach.h counts.

    Examples
    --------
    >>> model = Preisach([[1.0, 0.0], [2.0, 1.0]], [-1.0, 0.0, 1.0])
    >>> model([0.0, 1.0, 0.0, 1.0, -1.0])
    array([ 0.,  4.,  2.,  4., -4.])
    """

    kind = "preisach"

    @classmethod
    def krasnoselskii_pokrovskii(
        cls, weights: ArrayLike, thresholds: ArrayLike, p0: float = 0.0, u0: float = 0.0
    ) -> Preisach:
        """Give the model of Krasnoselskii and Pokrovskii: ``y = p0 u + sum_ij w_ij k_ij``.

        The hysteron k_ij goes from -1 to 1 along a ridge between ``thresholds[i]`` and
        ``thresholds[i + 1]`` while the input rises, and back along one between ``thresholds[j]``
        and ``thresholds[j + 1]`` while it falls. A ridge is a row of relays on the line from corner
        to corner of a cell, so that this is the Preisach model with mass on those lines: exactly,
        with its memory and its inverse. Evenly spaced thresholds make the published model, whose
        ridges are all as wide as a cell.

        Parameters
        ----------
        weights, thresholds, p0, u0
            As in the class.

        Returns
        -------
        Preisach

        Raises
        ------
        InputError
            As the class.

        Notes
        -----
        M. Krasnoselskii and A. Pokrovskii, Systems with Hysteresis (Springer 1989); H. T. Banks,
        A. J. Kurdila and G. Webb, Math. Probl. Eng. 3 (1997) 287-328, eqs. 2-5.

        Examples
        --------
        >>> ridge = Preisach.krasnoselskii_pokrovskii([[0, 0], [1, 0]], [-1.0, 0.0, 1.0])
        >>> ridge([0.5, 1.0, 0.0, -0.25, 0.25]).tolist()
        [0.0, 1.0, 1.0, 0.5, 0.5]
        """
        return cls(weights, thresholds, p0, u0, "ridges")

    def traits(self) -> Traits:
        """Give the traits of a superposition of relays."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=True,
            congruent_loops=True,
            monotone=True,
            invertible=self.is_invertible,
        )

    def initial_state(self) -> Array:
        """Give the input before the first sample, and room for reversals."""
        state = np.zeros(self._chain.state_length)
        state[0] = self.u0
        return state

    def exact_inverse(self) -> InversePreisach:
        """Give the exact inverse: the input on the branch that has an output, in closed form.

        With p0 = 0 the output is limited to ``-sum(weights)`` to ``sum(weights)``; beyond, ``run``
        names the sample, a stepper holds its last output and raises its flag. Saturation itself is
        answered by the outer threshold.

        Raises
        ------
        NotInvertibleError
            If a cell of the diagonal is empty to rounding and there is no linear part to make up
            for it: after a reversal there the output rests while the input goes on.
        """
        rises = self._cell_rises()
        size = np.abs(self.weights).sum() + self.p0 * np.abs(self.thresholds).max()
        empty = np.flatnonzero(rises <= 4.0 * np.finfo(np.float64).eps * size)
        if empty.size:
            i = int(empty[0])
            low, high = self.thresholds[i : i + 2]
            raise NotInvertibleError(
                f"weights[{i}, {i}] is {self.weights[i, i]:.6g} and p0 {self.p0:.6g}: after a "
                f"reversal between {low:.6g} and {high:.6g} the output rests while the input goes "
                "on; give that cell mass, or p0 > 0"
            )
        return InversePreisach(self.weights, self.thresholds, self.p0, *self._rest())

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of p0 and the masses."""
        n = self.weights.shape[0]
        return np.repeat([output_scale / input_scale, output_scale], [1, n * (n + 1) // 2])

    def in_units(self, input_scale: float, output_scale: float) -> Preisach:
        """Give the model in other units, its thresholds and its start too."""
        return Preisach(
            self.weights * output_scale,
            self.thresholds * input_scale,
            self.p0 * (output_scale / input_scale),
            self.u0 * input_scale,
            self.density,
            self.depth,
        )

    def portrait(self) -> Portrait:
        """Show the density of the relays, and the loop."""
        widths = np.diff(self.thresholds)
        area = np.multiply.outer(widths, widths) * (1.0 - 0.5 * np.eye(widths.size))
        density = np.where(np.tri(widths.size, dtype=bool), self.weights / area, np.nan)
        return Portrait(("relays", "loop"), p0=self.p0, thresholds=self.thresholds, density=density)

    def lipschitz_constant(self) -> float:
        """Give a bound: p0, and twice the mass along the densest staircase, over its height.

        Two inputs a way d apart leave staircases d apart, and what lies between them has turned.
        Steps of a staircase share no alpha and no beta.
        """
        widths = np.diff(self.thresholds)
        if self.density == "ridges":  # each cell alone is as steep as its shorter ridge
            return float(self.p0 + 2.0 * (self.weights / np.minimum.outer(widths, widths)).sum())
        dense = self.weights * (1.0 + np.eye(widths.size))
        rows = (dense / widths).max(axis=0).sum()
        return float(self.p0 + 2.0 * (rows + (dense.T / widths).max(axis=0).sum()))

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class InversePreisach(_Relays):
    """Inverse of the Preisach model, from its output to its input; ``Preisach.inverse()`` makes it.

    Parameters
    ----------
    weights, thresholds, p0, u0, density, depth
        As in ``Preisach``.

    Raises
    ------
    InputError
        As ``Preisach``.

    Examples
    --------
    >>> model = Preisach([[1.0, 0.0], [2.0, 1.0]], [-1.0, 0.0, 1.0])
    >>> u = [0.0, 0.5, -0.5, 0.25]
    >>> bool(abs(model.inverse()(model(u)) - u).max() < 1e-7)
    True
    """

    kind = "inverse-preisach"

    def traits(self) -> Traits:
        """Give the traits of an input that an output within saturation determines."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=True,
            congruent_loops=False,
            monotone=True,
            invertible=True,
        )

    def initial_state(self) -> Array:
        """Give output and input before the first sample, and room for reversals."""
        state = np.zeros(self._chain.state_length)
        state[0] = self.inverse()([self.u0])[0]
        state[1] = self.u0
        return state

    def exact_inverse(self) -> Preisach:
        """Give the model."""
        return Preisach(self.weights, self.thresholds, self.p0, *self._rest())

    def lipschitz_constant(self) -> float:
        """Give infinity: no bound is known."""
        return float("inf")

    def _is_inverse(self) -> bool:
        return True
