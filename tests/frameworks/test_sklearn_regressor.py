"""The estimator keeps to scikit-learn's manners wherever those fit what has a memory."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest

import hyst

sklearn = pytest.importorskip("sklearn")

from sklearn.base import clone  # noqa: E402
from sklearn.exceptions import NotFittedError  # noqa: E402
from sklearn.model_selection import GridSearchCV, TimeSeriesSplit  # noqa: E402
from sklearn.utils.estimator_checks import check_estimator  # noqa: E402

U = 3.0 * np.sin(2.0 * np.pi * np.arange(1500.0) / 250.0) * np.exp(-np.arange(1500.0) / 2000.0)
STAGE = hyst.PrandtlIshlinskii([0.5, 0.3], [0.4, 1.1], p0=1.0)
Y = STAGE(U) + np.random.default_rng(2).normal(0.0, 0.01, U.size)

NOISE = "its X and y are noise without an order in time, which is refused by name"
MEMORY = "an output depends on all inputs before it, in their order"
CANNOT_APPLY = {
    "check_regressors_train": NOISE,
    "check_regressor_data_not_an_array": NOISE,
    "check_fit_check_is_fitted": NOISE,
    "check_n_features_in": NOISE,
    "check_methods_sample_order_invariance": MEMORY,
    "check_methods_subset_invariance": MEMORY,
}
"""Checks that cannot apply to what has a memory, and why."""


def regressor(**settings: Any) -> Any:
    return hyst.sklearn.HysteresisRegressor(family="pi", plays=2, dt=0.01, delay=0, **settings)


class FirstColumn(hyst.sklearn.HysteresisRegressor):
    """The estimator with nothing but the refusal of several columns taken away.

    The checks give several columns, so of the estimator itself most would see that refusal only.
    """

    def _input(self, X: np.ndarray) -> np.ndarray:
        return X[:, 0]


@pytest.mark.filterwarnings("ignore")  # the checks warn of what they do themselves
def test_the_checks_of_scikit_learn_pass_where_they_apply() -> None:
    one_play = FirstColumn("pi", plays=1, delay=0, options={"allow_unconverged": True})
    told = check_estimator(
        one_play, expected_failed_checks=CANNOT_APPLY, on_skip=None, on_fail=None
    )
    status: dict[str, set[str]] = {}
    for each in told:
        status.setdefault(each["check_name"], set()).add(each["status"])
    assert not [name for name, ended in status.items() if "failed" in ended]
    # Each that is listed does fail: none is left out that would pass.
    assert {name for name, ended in status.items() if "xfail" in ended} == set(CANNOT_APPLY)
    assert sum(ended == {"passed"} for ended in status.values()) >= 35


@pytest.mark.filterwarnings("ignore")
def test_of_several_columns_nothing_but_their_number_is_refused() -> None:
    told = check_estimator(hyst.sklearn.HysteresisRegressor(), on_skip=None, on_fail=None)
    failed = [each for each in told if each["status"] == "failed"]
    causes = [each["exception"] for each in failed]
    # A check that expects another message wraps the refusal.
    refused = [str(each.__context__ or each) for each in causes]
    assert failed
    assert all("give one, the input in the order of time" in each for each in refused)


def test_it_predicts_as_what_it_found_and_scores() -> None:
    fitted = regressor().fit(U[:, None], Y)
    np.testing.assert_array_equal(fitted.predict(U[:, None]), fitted.identified_.predict(U))
    # Noise of 0.01 under an output whose deviation is above 1.
    assert fitted.score(U[:, None], Y) > 0.999
    assert fitted.identified_.verdict.level == "good"
    assert fitted.model_ == fitted.identified_.model
    assert fitted.n_features_in_ == 1


def test_it_is_searched_over_stretches_of_time() -> None:
    search = GridSearchCV(
        clone(regressor()), {"plays": [1, 2]}, cv=TimeSeriesSplit(2), error_score="raise"
    )
    search.fit(U[:, None], Y)
    # It was made of two plays, and noise of 0.01.
    assert search.best_params_ == {"plays": 2}


def test_options_reach_the_identification() -> None:
    fitted = regressor(options={"creep": None, "drift": False}).fit(U[:, None], Y)
    asked = fitted.model_.description.provenance.options
    assert {"creep": None, "drift": False, "plays": 2}.items() <= asked.items()


def test_bad_input_is_refused() -> None:
    with pytest.raises(hyst.InputError, match="X has 2 columns; give one"):
        regressor().fit(np.column_stack([U, U]), Y)
    with pytest.raises(ValueError, match="NaN"):
        regressor().fit(np.append(U[1:], np.nan)[:, None], Y)
    with pytest.raises(ValueError, match="inconsistent numbers of samples"):
        regressor().fit(U[:, None], Y[1:])
    with pytest.raises(NotFittedError):
        regressor().predict(U[:, None])
    with pytest.raises(hyst.InputError, match="unknown family 'pie'"):
        hyst.sklearn.HysteresisRegressor("pie").fit(U[:, None], Y)


def test_without_scikit_learn_what_to_install_is_said() -> None:
    program = (
        "import sys\nsys.modules['sklearn'] = None\nimport hyst\n"
        "try:\n    hyst.sklearn.HysteresisRegressor\n"
        "except hyst.MissingExtraError as missing:\n    print(missing)\n"
    )
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert "pip install 'hyst[sklearn]'" in ended.stdout, ended.stderr
