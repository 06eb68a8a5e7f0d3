"""Modes of one plane from a folder of matrices, for `touchdown import rotor`: runs/spindle_modes.npz."""

import numpy as np
from scipy import io, linalg

folder = "examples/spindle_matrices/"
M, K, G = (io.mmread(f"{folder}{name}.mtx").toarray() for name in "MKG")
rows = np.arange(len(M)).reshape(-1, 4)  # of each node UY, UZ, ROTY, ROTZ
plane, other = rows[:, [0, 3]].ravel(), rows[:, [1, 2]].ravel()  # slopes are ROTZ, and less ROTY
square, shapes = linalg.eigh(K[np.ix_(plane, plane)], M[np.ix_(plane, plane)])
polar = G[np.ix_(plane, other)] * np.tile([1.0, -1.0], len(rows))
kept = shapes[:, :8]
np.savez(
    "runs/spindle_modes.npz",
    positions=np.loadtxt(f"{folder}nodes.csv", delimiter=",", skiprows=1)[:, 1] / 1e3,
    frequencies=np.sqrt(np.maximum(square[:8], 0.0)) / (2.0 * np.pi),
    deflections=kept[0::2],
    slopes=kept[1::2],
    gyroscopic=kept.T @ polar @ kept,
)
