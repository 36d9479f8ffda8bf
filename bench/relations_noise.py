#!/usr/bin/env python3
"""bench/relations_noise.py RELATIONS ESTIMATE: how exact relations of a log are themselves.

RELATIONS: two stamps, x y z roll pitch yaw a line (Kuemmerle et al. 2009). ESTIMATE: estimate.tum of a run on that log.
The poses that agree best with all relations are found by least squares, with nothing else to hold them; what then is left
of relations that others confirm (they close cycles) is their own noise. Prints it beside the errors of the estimate.
Needs python3-numpy and python3-scipy.
"""
import sys

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu

SIGMA_M, SIGMA_RAD = 0.01, 0.005  # about those of Intel; it is their ratio that matters
LATEST = 0.01  # the estimate must have a pose so close to each stamp [s]
CONFIRMED = 0.9  # leverage: beyond, a relation is all that ties its poses


def read_estimate(path):
    rows = np.loadtxt(path)
    return rows[:, 0], np.column_stack([rows[:, 1:3], 2 * np.arctan2(rows[:, 6], rows[:, 7])])


def nearest(stamps, asked):
    after = np.clip(np.searchsorted(stamps, asked), 1, len(stamps) - 1)
    found = np.where(stamps[after] - asked < asked - stamps[after - 1], after, after - 1)
    if (late := np.abs(stamps[found] - asked).max()) > LATEST:
        sys.exit(f"the estimate has no pose within {LATEST} s of each stamp (worst: {late:.3f} s): is it of another log?")
    return found


def residuals(poses, first, second, measured):
    a, b = poses[first], poses[second]
    c, s, d = np.cos(a[:, 2]), np.sin(a[:, 2]), b[:, :2] - a[:, :2]
    turn = b[:, 2] - a[:, 2] - measured[:, 2]
    return np.column_stack([c * d[:, 0] + s * d[:, 1] - measured[:, 0], c * d[:, 1] - s * d[:, 0] - measured[:, 1],
                            np.arctan2(np.sin(turn), np.cos(turn))])


def jacobian(poses, first, second):
    """Rows: x of all relations, then y, then the turn."""
    a, d = poses[first], poses[second, :2] - poses[first, :2]
    c, s, one = np.cos(a[:, 2]), np.sin(a[:, 2]), np.ones(len(first))

    def block(sigma, columns):
        values = np.concatenate([value for value, _ in columns]) / sigma
        rows = np.tile(np.arange(len(first)), len(columns))
        return sparse.coo_matrix((values, (rows, np.concatenate([column for _, column in columns]))),
                                 shape=(len(first), 3 * len(poses)))

    i, j = 3 * first, 3 * second
    return sparse.vstack([
        block(SIGMA_M, [(-c, i), (-s, i + 1), (c, j), (s, j + 1), (c * d[:, 1] - s * d[:, 0], i + 2)]),
        block(SIGMA_M, [(s, i), (-c, i + 1), (-s, j), (c, j + 1), (-c * d[:, 0] - s * d[:, 1], i + 2)]),
        block(SIGMA_RAD, [(-one, i + 2), (one, j + 2)])]).tocsr()


def pieces(count, first, second):
    root = list(range(count))

    def find(k):
        while root[k] != k:
            root[k] = root[root[k]]
            k = root[k]
        return k

    for a, b in zip(first, second):
        root[find(a)] = find(b)
    return len({find(k) for k in range(count)})


def main(relations_path, estimate_path):
    relations = np.loadtxt(relations_path)
    measured = relations[:, [2, 3, 7]]
    stamps, estimate = read_estimate(estimate_path)
    used, ends = np.unique(np.concatenate([nearest(stamps, relations[:, k]) for k in (0, 1)]), return_inverse=True)
    first, second = np.split(ends, 2)
    poses = estimate[used].copy()
    ours = np.hypot(*residuals(poses, first, second, measured)[:, :2].T)
    for _ in range(10):
        J = jacobian(poses, first, second)
        factor = splu((J.T @ J + 1e-6 * sparse.identity(J.shape[1])).tocsc())
        r = residuals(poses, first, second, measured) / [SIGMA_M, SIGMA_M, SIGMA_RAD]
        step = -factor.solve(J.T @ r.T.ravel())
        poses += step.reshape(-1, 3)
        if np.abs(step).max() < 1e-6:
            break
    left = residuals(poses, first, second, measured)
    freedom = len(relations) - len(poses) + pieces(len(poses), first, second)
    sigma = np.sqrt((left[:, :2] ** 2).sum() / (2 * freedom))
    rows = J[:2 * len(relations)]
    leverage = np.array([row @ factor.solve(row.toarray().ravel()) for row in rows]).reshape(2, -1).mean(axis=0)
    confirmed = leverage < CONFIRMED
    own = np.hypot(*left[:, :2].T) / np.sqrt(np.maximum(1 - leverage, 1e-9))
    gap = np.abs(relations[:, 1] - relations[:, 0])
    print(f"{len(relations)} relations of {len(poses)} poses, {freedom} cycles")
    print(f"noise of a relation: {sigma:.4f} m along each axis; exact poses would have a mean error of "
          f"{sigma * np.sqrt(np.pi / 2):.4f} m if it is Gaussian")
    print("mean errors of those that others confirm [m]: the relations' own, the estimate's")
    for name, which in (("all", gap >= 0), ("up to 2 s apart", gap <= 2), ("20 s and more apart", gap >= 20)):
        which = which & confirmed
        print(f"{name:20s} {which.sum():5d} {own[which].mean():.4f} {ours[which].mean():.4f}")
    print(f"{'all relations':20s} {len(ours):5d}        {ours.mean():.4f}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
