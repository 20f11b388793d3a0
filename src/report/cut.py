"""Surfaces through structured blocks: where a scalar at the nodes takes a value, by marching tetrahedra; gradients of cell values.
Called by rotor_pictures.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import numpy as np

# The six tetrahedra of a hexahedron whose corners are numbered i + 2 j + 4 k, all round the diagonal 0-7.
TETRAHEDRA = np.array([[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]])


def between(values, axis):
    """Means of neighbours along an axis: one fewer than there are values."""
    return 0.5 * (np.take(values, range(1, values.shape[axis]), axis) + np.take(values, range(values.shape[axis] - 1), axis))


def at_nodes(cells):
    """Values at the nodes of a block, (nk + 1, nj + 1, ni + 1, ...): means of the cells round them, at the block's faces of its own."""
    out = cells
    for axis in range(3):
        width = [(0, 0)] * out.ndim
        width[axis] = (1, 1)
        out = between(np.pad(out, width, mode="edge"), axis)
    return out


def gradient(points, values):
    """Derivatives by x, y, z of cell values (nk, nj, ni, m) of a block with nodes `points`: (nk, nj, ni, m, 3), second order on smooth blocks."""
    centres = points
    for axis in range(3):
        centres = between(centres, axis)
    along_x = np.stack([np.gradient(centres, axis=axis) for axis in range(3)], axis=-2)   # [..., index direction, xyz]
    along_v = np.stack([np.gradient(values, axis=axis) for axis in range(3)], axis=-2)    # [..., index direction, m]
    return np.swapaxes(np.linalg.solve(along_x, along_v), -1, -2)


def surface(points, scalar, level, carried):
    """Triangles (n, 3, 3) on which the node scalar is `level`, and the node values `carried` at their corners (n, 3)."""
    shape = np.array(scalar.shape)
    if (shape < 2).any():
        return np.empty((0, 3, 3)), np.empty((0, 3))
    index = np.arange(scalar.size).reshape(shape)
    corners = np.stack([index[k:shape[0] - 1 + k, j:shape[1] - 1 + j, i:shape[2] - 1 + i].ravel()
                        for k in (0, 1) for j in (0, 1) for i in (0, 1)], axis=-1)
    value = scalar.ravel() - level
    above = value[corners] > 0.0
    tets = corners[above.any(axis=1) & ~above.all(axis=1)][:, TETRAHEDRA].reshape(-1, 4)
    inside = value[tets] > 0.0
    position, other = points.reshape(-1, 3), carried.ravel()

    def crossing(a, b):
        """Where the edges a-b meet the level: position and carried value."""
        w = (value[a] / (value[a] - value[b]))[:, None]
        return (1.0 - w) * position[a] + w * position[b], (1.0 - w[:, 0]) * other[a] + w[:, 0] * other[b]

    triangles, values = [], []

    def add(*edges):
        ends = [crossing(a, b) for a, b in edges]
        triangles.append(np.stack([p for p, _ in ends], axis=1))
        values.append(np.stack([v for _, v in ends], axis=1))

    count = inside.sum(axis=1)
    order = np.argsort(~inside, axis=1, kind="stable")   # those inside first
    sorted_tets = np.take_along_axis(tets, order, axis=1)
    for alone, rest in ((sorted_tets[count == 1], (0, 1, 2, 3)), (sorted_tets[count == 3], (3, 0, 1, 2))):
        a, b, c, d = (alone[:, n] for n in rest)
        add((a, b), (a, c), (a, d))
    a, b, c, d = sorted_tets[count == 2].T
    add((a, c), (a, d), (b, d))
    add((a, c), (b, d), (b, c))
    return np.concatenate(triangles), np.concatenate(values)
