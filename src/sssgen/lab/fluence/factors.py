"""A field of voxels and light directions as a sum of few products: T(voxel, l) ~ sum_k U_k(voxel) V_k(l).

Truncated singular values minimise the absolute error; dark voxels, which a relative error counts as much as bright
ones, are lost. So rounds of alternating least squares with weights follow (Gabriel and Zamir, Lower rank approximation
of matrices by least squares with any choice of weights, Technometrics 1979).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

ROUNDS = 6
MORE, ITERATIONS = 8, 4
"""Of the first guess: columns beside those of the rank, and how often they are improved."""
RIDGE = 1e-6
"""The weight of the factors' own squares, relative to the mean weight of a row: it keeps the equations solvable."""
LEAST_SQUARE = 1e-30
"""Of light: where there is none, its error has a weight, too."""


def factors(field: Array, rank: int, floor: float, smooth: Array) -> tuple[Array, Array]:
    """U (voxels, rank) and V (rank, columns) for a field (voxels, columns) that is at least 0.

    The error of a value T counts relative to sqrt(T^2 + floor^2), where T is that of `smooth`, the field with less
    noise: weights of noisy values would prefer those that are too small.
    """
    rank = min(rank, *field.shape)
    weight = 1.0 / np.maximum(smooth**2 + floor**2, LEAST_SQUARE)
    right = _rows(field * np.sqrt(weight.mean(axis=1, keepdims=True)), rank)
    left: Array = np.zeros((len(field), rank))
    for _ in range(ROUNDS):
        left = _solve(right, field, weight)
        right = _solve(left.T, field.T, weight.T).T
    return left, right


def _rows(matrix: Array, rank: int) -> Array:
    """The right singular vectors of the largest singular values, nearly: by iterations of a random subspace (Halko,
    Martinsson and Tropp, Finding structure with randomness, SIAM Review 2011, algorithm 4.4)."""
    basis = np.random.default_rng(0).normal(size=(matrix.shape[1], rank + MORE))
    for _ in range(ITERATIONS):
        basis = np.linalg.qr(matrix.T @ (matrix @ basis))[0]
    rows: Array = np.linalg.svd(matrix @ basis, full_matrices=False)[2][:rank] @ basis.T
    return rows


def _solve(basis: Array, field: Array, weight: Array) -> Array:
    """The coefficients (rows, rank) of `basis` (rank, columns) that fit each row of the field best."""
    rank = len(basis)
    # the matrices are symmetric
    row, column = np.triu_indices(rank)
    matrices = np.empty((len(field), rank, rank))
    matrices[:, row, column] = weight @ (basis[row] * basis[column]).T
    matrices[:, column, row] = matrices[:, row, column]
    mean = np.trace(matrices, axis1=1, axis2=2)[:, None] / rank
    # a row without light has the mean 0: its coefficients are 0
    matrices[:, range(rank), range(rank)] += np.where(mean > 0.0, RIDGE * mean, 1.0)
    solution = np.linalg.solve(matrices, ((weight * field) @ basis.T)[..., None])[..., 0]
    return solution.astype(np.float64, copy=False)
