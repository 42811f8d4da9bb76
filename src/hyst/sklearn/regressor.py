"""A model with memory as a regressor of scikit-learn."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError, MissingExtraError
from hyst.identification import Identified, identify
from hyst.signals import Record

try:
    from sklearn.base import BaseEstimator, RegressorMixin
    from sklearn.utils.validation import check_is_fitted, validate_data
except ImportError as missing:
    raise MissingExtraError(
        "hyst.sklearn needs scikit-learn 1.6 or newer, which is not installed; "
        "pip install 'hyst[sklearn]'"
    ) from missing

Array = NDArray[np.float64]


class HysteresisRegressor(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """A hysteresis model that is fitted to a record and predicts from rest.

    X is the input of one record, in the order of time, and not a heap of samples: y[k] depends on
    X[0] to X[k]. So rows are never to be shuffled, and folds are to be stretches of time, as those
    of ``TimeSeriesSplit``. Each prediction starts from the state of rest, as ``hyst simulate``.

    Parameters
    ----------
    family
        As of ``hyst.identify``: a name, several with commas, or ``"auto"``.
    dt
        Time between rows, s, > 0.
    plays
        Number of plays, for the families that have it; None for their own choice.
    delay
        Samples by which the output lags, or ``"auto"``.
    options
        Further options of ``hyst.identify`` by name, as ``{"creep": None}``; None for none.

    Attributes
    ----------
    identified_ : hyst.Identified
        What was found, with its verdict: a fit that scikit-learn scores well may be unfit.
    model_ : hyst.Operator
        The model.
    n_features_in_ : int
        1.

    Examples
    --------
    >>> import hyst, numpy as np
    >>> u = np.sin(np.linspace(0.0, 40.0, 1000)) * np.linspace(1.0, 0.3, 1000)
    >>> y = hyst.PrandtlIshlinskii([0.5], [0.2], p0=1.0)(u)
    >>> regressor = HysteresisRegressor(family="pi", plays=1, dt=1e-3).fit(u[:, None], y)
    >>> round(regressor.score(u[:, None], y), 6)
    1.0
    """

    def __init__(
        self,
        family: str = "auto",
        *,
        dt: float = 1.0,
        plays: int | None = None,
        delay: float | str = "auto",
        options: dict[str, Any] | None = None,
    ) -> None:
        self.family = family
        self.dt = dt
        self.plays = plays
        self.delay = delay
        self.options = options

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Identify a model.

        Parameters
        ----------
        X
            Input in the order of time, shape (N, 1), finite.
        y
            Output, shape (N,), finite.

        Returns
        -------
        HysteresisRegressor
            Itself.

        Raises
        ------
        InputError
            If X has more than one column, or as ``hyst.identify``.
        NotIdentifiableError, SolverError
            As ``hyst.identify``.
        """
        X, y = validate_data(self, X, y, dtype=np.float64, y_numeric=True, ensure_min_samples=2)
        more = {} if self.plays is None else {"plays": self.plays}
        self.identified_: Identified = identify(
            Record(self._input(X), np.asarray(y, dtype=np.float64), self.dt),
            family=self.family,
            **{"delay": self.delay, **more, **(self.options or {})},
        )
        self.model_ = self.identified_.model
        return self

    def predict(self, X: ArrayLike) -> Array:
        """Give the output for an input that starts from the state of rest.

        Parameters
        ----------
        X
            Input in the order of time, shape (N, 1), finite, ``dt`` between rows.

        Returns
        -------
        numpy.ndarray
            Shape (N,), delayed as the record was.

        Raises
        ------
        sklearn.exceptions.NotFittedError
            If it was not fitted.
        """
        check_is_fitted(self)
        X = validate_data(self, X, dtype=np.float64, reset=False)
        return self.identified_.predict(self._input(X))

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.regressor_tags.poor_score = True  # where rows have no order there is no memory to find
        return tags

    def _input(self, X: Any) -> Array:
        """Give the one column of X."""
        if X.shape[1] != 1:
            raise InputError(
                f"X has {X.shape[1]} columns; give one, the input in the order of time, shape "
                "(N, 1)"
            )
        column: Array = X[:, 0]
        return column
