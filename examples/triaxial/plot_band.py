# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Shows where a sheared cylinder deforms: local shear strain and rotation of grains in a vertical slice.

usage: plot_band.py RUN PICTURE
From the first and the last ParaView file of the run's last stage. The local strain is that of the
tetrahedra of a Delaunay triangulation of the centres at the start, sqrt(2/3 e:e) of the deviator of
the logarithmic strain, averaged over the tetrahedra of each grain by volume; a grain's rotation is the
angle between its orientations.
"""
import base64
import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.spatial import Delaunay


def arrays(path: Path) -> dict[str, np.ndarray]:
    """The named arrays of a .vtp file with raw appended data."""
    data = path.read_bytes()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    head = data[:start].decode("utf-8", "replace")
    kinds = {"Float64": "<f8", "Float32": "<f4", "UInt32": "<u4", "UInt8": "u1", "Int64": "<i8"}
    found = {}
    for tag in re.findall(r"<DataArray[^>]*>", head):
        fields = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        if fields.get("format") != "appended" or fields["type"] not in kinds:
            continue
        at = start + int(fields["offset"])
        size = int.from_bytes(data[at : at + 8], "little")
        values = np.frombuffer(data[at + 8 : at + 8 + size], kinds[fields["type"]])
        width = int(fields.get("NumberOfComponents", 1))
        found[fields.get("Name", "")] = values.reshape(-1, width) if width > 1 else values
    return found


def frames_of_last_stage(run: Path) -> tuple[Path, Path]:
    """The file at the start of the last stage, or the next after it, and the last."""
    import csv

    with open(run / "history.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    start = max(int(row["step"]) for row in rows if row["stage"] != rows[-1]["stage"])
    files = {int(re.search(r"(\d+)\.vtp$", path.name)[1]): path for path in run.rglob("grains_*.vtp")}
    steps = sorted(files)
    return files[next(step for step in steps if step >= start)], files[steps[-1]]


def local_shear(before: np.ndarray, after: np.ndarray, longest: float) -> np.ndarray:
    """By grain. Tetrahedra with an edge longer than `longest` are left out: they bridge the outside."""
    corners = Delaunay(before).simplices
    edges = before[corners[:, 1:]] - before[corners[:, :1]]
    new_edges = after[corners[:, 1:]] - after[corners[:, :1]]
    sides = np.concatenate([edges, edges[:, [1, 2, 0]] - edges], axis=1)
    good = (np.linalg.norm(sides, axis=2).max(axis=1) < longest) & (np.abs(np.linalg.det(edges)) > 1e-3 * longest**3 / 6)
    corners, edges, new_edges = corners[good], edges[good], new_edges[good]
    gradient = np.transpose(np.linalg.solve(edges, new_edges), (0, 2, 1))
    stretch = np.linalg.eigvalsh(np.transpose(gradient, (0, 2, 1)) @ gradient)
    strain = 0.5 * np.log(np.maximum(stretch, 1e-12))
    deviator = strain - strain.mean(axis=1, keepdims=True)
    shear = np.sqrt(2 / 3 * (deviator**2).sum(axis=1))
    volume = np.abs(np.linalg.det(edges))
    total = np.zeros(len(before))
    weight = np.zeros(len(before))
    for corner in range(4):
        np.add.at(total, corners[:, corner], shear * volume)
        np.add.at(weight, corners[:, corner], volume)
    return np.divide(total, weight, out=np.full(len(before), np.nan), where=weight > 0)


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    first, last = (arrays(path) for path in frames_of_last_stage(Path(sys.argv[1])))
    before, after = first["Points"], last["Points"]
    radius = last["equivalent_radius"]
    shear = local_shear(before, after, 5 * radius.mean() * 2)
    cosine = np.abs((first["orientation"] * last["orientation"]).sum(axis=1))
    turn = np.degrees(2 * np.arccos(np.minimum(cosine, 1)))
    # The vertical plane in which the sheared grains lie most unevenly shows a band from its side.
    spread = []
    for degrees in range(0, 180, 5):
        direction = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
        known = np.isfinite(shear)
        plane = np.column_stack([after[known, :2] @ direction, after[known, 2], np.ones(known.sum())])
        hot = shear[known] > np.quantile(shear[known], 0.7)
        moments = np.linalg.eigvalsh(np.cov(plane[hot, :2].T))
        spread.append((moments[0], direction))
    direction = min(spread, key=lambda pair: pair[0])[1]
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
