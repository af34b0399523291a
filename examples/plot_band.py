# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Shows where a sheared sample deforms: local shear strain and rotation of grains in a vertical slice.

usage: plot_band.py RUN PICTURE [x|y]
From the last file fields/strain_*.vtp that `reckon analyse RUN` wrote. The slice goes through the middle,
at right angles to x or y, or, for a cylinder, as a band shows most clearly from its side.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parent))
from curves import arrays, plt


def clearest_direction(place: np.ndarray, shear: np.ndarray) -> np.ndarray:
    """Horizontal, in the vertical plane in which the sheared grains lie most unevenly."""
    known = np.isfinite(shear)
    hot = shear[known] > np.quantile(shear[known], 0.7)
    spread = []
    for degrees in range(0, 180, 5):
        direction = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
        plane = np.column_stack([place[known, :2] @ direction, place[known, 2]])
        spread.append((np.linalg.eigvalsh(np.cov(plane[hot].T))[0], tuple(direction)))
    return np.array(min(spread)[1])


def main() -> None:
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    files = sorted(Path(sys.argv[1]).glob("fields/strain_*.vtp"))
    if not files:
        sys.exit(f"{sys.argv[1]} has no strains: run `reckon analyse` on it first")
    last = arrays(files[-1])
    after, radius, turn = last["Points"], last["equivalent_radius"], last["rotation"]
    shear = np.where(last["strain_is_known"] != 0, last["shear_strain"], np.nan)
    chosen = {"x": np.array([0.0, 1.0]), "y": np.array([1.0, 0.0])}
    direction = chosen[sys.argv[3]] if len(sys.argv) == 4 else clearest_direction(after, shear)
    after = after - np.array([*after[:, :2].mean(axis=0), 0])
    across = after[:, :2] @ np.array([-direction[1], direction[0]])
    slice_of = np.abs(across) < 2.5 * radius.mean()
    figure, axes = plt.subplots(1, 2, figsize=(8, 4.2), sharey=True)
    for each, values, title, top in (
        (axes[0], shear, "local shear strain", np.nanquantile(shear, 0.97)),
        (axes[1], turn, "rotation [deg]", np.quantile(turn, 0.97)),
    ):
        order = np.argsort(-np.abs(across))
        order = order[slice_of[order]]
        place = 1e3 * np.column_stack([after[order, :2] @ direction, after[order, 2]])
        circles = [plt.Circle(p, 1e3 * r) for p, r in zip(place, radius[order])]
        from matplotlib.collections import PatchCollection

        patches = PatchCollection(circles, cmap="inferno", edgecolor="0.4", linewidth=0.3)
        patches.set_array(values[order])
        patches.set_clim(0, top)
        each.add_collection(patches)
        each.set_aspect("equal")
        each.autoscale_view()
        each.set_title(title, fontsize=10)
        each.set_xlabel("[mm]")
        figure.colorbar(patches, ax=each, shrink=0.7)
    axes[0].set_ylabel("[mm]")
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
