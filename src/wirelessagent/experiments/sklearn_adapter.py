# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownParameterType=false, reportMissingImports=false
"""The only door to scikit-learn, which has no type annotations and is an optional package: matrices filled by it.

Both imputers learn from rows that are samples and columns that are features, and know nothing of an order of either.
Gains enter with the subcarriers as samples and the users as features, or the other way round; see
:mod:`wirelessagent.experiments.competitors`.
"""

from __future__ import annotations

import warnings

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.errors import MissingDependencyError


def has_sklearn() -> bool:
    """Whether scikit-learn is installed."""
    try:
        require_sklearn("an evaluation")
    except MissingDependencyError:
        return False
    return True


def require_sklearn(purpose: str) -> None:
    """Raise :class:`MissingDependencyError` where scikit-learn is not installed."""
    try:
        import sklearn  # noqa: F401  # pyright: ignore[reportUnusedImport]
    except ImportError as error:
        raise MissingDependencyError("scikit-learn", "evaluate", purpose) from error


def knn_filled(matrix: FloatArray, *, num_neighbours: int) -> FloatArray:
    """The matrix (sample, feature) filled by ``KNNImputer``, the neighbours weighted by their inverse distance."""
    require_sklearn("the competitor 'knn'")
    from sklearn.impute import KNNImputer

    imputer = KNNImputer(n_neighbors=num_neighbours, weights="distance", keep_empty_features=True)
    return np.asarray(imputer.fit_transform(matrix), dtype=np.float64)


def iterative_filled(matrix: FloatArray, *, num_nearest: int, seed: int) -> FloatArray:
    """The matrix (sample, feature) filled by ``IterativeImputer``: Bayesian ridge regression of each feature on others.

    At most ``num_nearest`` other features are regressed on, those correlated most, and nothing falls below zero.
    """
    require_sklearn("the competitor 'iterative'")
    from sklearn.experimental import enable_iterative_imputer  # noqa: F401  # pyright: ignore[reportUnusedImport]
    from sklearn.impute import IterativeImputer

    imputer = IterativeImputer(
        n_nearest_features=num_nearest if num_nearest < matrix.shape[1] - 1 else None,
        min_value=0.0,
        keep_empty_features=True,
        random_state=seed,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that it had not converged after its usual ten rounds is its own affair
        return np.asarray(imputer.fit_transform(matrix), dtype=np.float64)
