# %% [markdown]
# # Error of each method against time
#
# A notebook as a script: editors that support `# %%` run it cell by cell, `python error_over_time.py` in one go.
# Needs numpy; the plot needs matplotlib (`pip install matplotlib`) and is skipped without it.

# %%
import argparse

import lightwell

parser = argparse.ArgumentParser()
parser.add_argument("--scene", default="cornell")
parser.add_argument("--methods", default="reference,paths")
parser.add_argument("--size", default="160x120")
parser.add_argument("--budgets", default="0.1,0.3,1,3", help="seconds")
parser.add_argument("--reference-s", type=float, default=30.0, help="seconds for the reference picture")
parser.add_argument("--out", default="error_over_time")
arguments, _ = parser.parse_known_args()  # a notebook has arguments of its own

width, height = (int(n) for n in arguments.size.split("x"))
budgets = [float(s) for s in arguments.budgets.split(",")]

# %% [markdown]
# ## The scene

# %%
world = lightwell.load(arguments.scene)
low, high = world.bounds
print(f"{world.name}: {len(world.triangles)} triangles, {high - low} m, cameras {[c.name for c in world.cameras]}")

# %% [markdown]
# ## The reference
#
# It uses a different seed: methods with the same seed may share random numbers, and therefore noise.

# %%
reference = world.render("reference", size=(width, height), budget_s=arguments.reference_s, bounces=8, seed=1)
print(f"reference: {reference.paths} paths, its own estimated relMSE {reference.relmse:.2g}")
lightwell.write_png(f"{arguments.out}_reference.png", reference.uint8())

# %% [markdown]
# ## Methods at several budgets

# %%
curves: dict[str, list[tuple[float, float, float]]] = {}
for method in arguments.methods.split(","):
    for budget_s in budgets:
        picture = world.render(method, size=(width, height), budget_s=budget_s, bounces=8)
        errors = lightwell.compare(picture, reference, ["relmse", "flip"])
        curves.setdefault(method, []).append((picture.seconds, errors["relmse"], errors["flip"]))
        print(f"{method:12} {picture.seconds:7.2f} s {picture.paths:6} paths  relMSE {errors['relmse']:.4g}")

# %% [markdown]
# ## The plot
#
# The error of unbiased methods falls with slope -1; that of a biased method levels out at its bias.

# %%
try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    print("no plot: matplotlib is not installed")
else:
    for method, points in curves.items():
        plt.loglog([p[0] for p in points], [p[1] for p in points], "o-", label=method)
    plt.xlabel("time, s")
    plt.ylabel("relMSE")
    plt.legend()
    plt.savefig(f"{arguments.out}.svg")
    print(f"{arguments.out}.svg")
