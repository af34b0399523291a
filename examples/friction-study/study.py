# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# A triaxial study in Python: the same dense sample is sheared with three friction coefficients
# between its grains. Cells begin with `# %%`: run them one by one in an editor that supports them,
# or the whole file:
#
#   PYTHONPATH=build/release/python /usr/bin/python3 examples/friction-study/study.py [FOLDER]
# %% Shapes and a scene to begin with
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402
import reckon  # noqa: E402

here = pathlib.Path(__file__).resolve().parent
folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else here.parents[1] / "build/examples/friction-study")
folder.mkdir(parents=True, exist_ok=True)
reckon.save_shapes(reckon.generate_shapes(50, seed=7, median_diameter=1e-3), folder / "sand.h5")
text = (here.parent / "triaxial-servo" / "scene.toml").read_text()
scene = reckon.Scene.from_text(text, folder)
print(f"{scene.title}: {scene.grain_count} grains")

# %% Three runs; an existing one continues where it stopped
frictions = [0.2, 0.5, 0.8]
runs = {}
for friction in frictions:
    name = f"friction-{friction}"
    runs[friction] = reckon.run(scene.changed({"material.friction": friction}), folder / name, resume=True,
                                progress=lambda step, steps: print(f"\r{name}: step {step}", end="", flush=True))
    print()

# %% Curves, and the numbers that matter
figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(6, 7), layout="constrained")
for friction, run in runs.items():
    shear = run.history["stage"] == 3
    strain, angle, volumetric = (run.history[name][shear] for name in
                                 ("strain_z", "friction_angle_deg", "volumetric_strain"))
    above.plot(100 * strain, angle, label=f"friction {friction}")
    below.plot(100 * strain, -100 * volumetric)
    peak = numpy.argmax(angle)
    print(f"friction {friction}: peak friction angle {angle[peak]:.1f} degrees at {100 * strain[peak]:.1f} % strain")
above.set_ylabel("mobilised friction angle [degrees]")
above.legend()
below.set_xlabel("axial strain [%]")
below.set_ylabel("dilation [%]")
figure.savefig(folder / "friction-study.png", dpi=120)
print(f"drawn: {folder / 'friction-study.png'}")
