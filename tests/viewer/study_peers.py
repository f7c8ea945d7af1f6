"""Analyses of `lightwell study` beside those of psignifit, questplus, choix, statsmodels and scipy, from the same tables.

study_peers.py PROGRAM DATA WORK: DATA has the published tables (study/, perceptual/), WORK is an empty folder. Prints the
differences, worst first, as a Markdown table; exit code 1 if one is above its tolerance.
"""

import json
import math
import subprocess
import sys
import warnings
from pathlib import Path

import choix
import numpy as np
import pandas as pd
import psignifit
import questplus
import statsmodels.api as sm
import statsmodels.formula.api as smf
from scipy import stats

warnings.simplefilter("ignore")
PROGRAM, DATA, WORK = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
JOD = stats.norm.ppf(0.75)
rows = []  # what, ours, peer, difference, tolerance


def lightwell(*arguments):
    done = subprocess.run([PROGRAM, "study", *map(str, arguments)], capture_output=True, text=True, cwd=WORK)
    if done.returncode != 0:
        sys.exit(f"study {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


def analysed(*arguments):
    return json.loads(lightwell("analyze", *arguments, "--json", "--replicates", 100))["tables"]


def compare(what, ours, peer, tolerance, relative=False):
    ours, peer = np.atleast_1d(np.asarray(ours, float)), np.atleast_1d(np.asarray(peer, float))
    difference = np.abs(ours - peer) / (np.abs(peer) if relative else 1)
    worst = int(np.argmax(difference))
    rows.append((what, ours[worst], peer[worst], float(difference[worst]), tolerance, "relative" if relative else ""))


def tone_mappers():
    file = DATA / "study/pairs_tmo_video.csv"
    t = analysed("--table", file, "--columns",
                 "participant=observer,first=condition_A,second=condition_B,first_chosen=is_A_selected")
    names = [r["item"] for r in t["scores"]]
    data = pd.read_csv(file)
    a, b = data["condition_A"].map(names.index), data["condition_B"].map(names.index)
    won = data["is_A_selected"] == 1
    pairs = [(i, j) if w else (j, i) for i, j, w in zip(a, b, won)]
    scores = choix.ilsr_pairwise(len(names), pairs, max_iter=500, tol=1e-10)
    ours = {r["number"]: r["value"] for r in t["fits"]}
    compare("choix: Bradley-Terry scores of tone mappers",
            [ours["Bradley-Terry JOD " + n] * math.log(3) for n in names], scores - scores.mean(), 1e-5)
    x = np.zeros((len(data), len(names)))
    x[np.arange(len(data)), a] = 1
    x[np.arange(len(data)), b] -= 1
    model = sm.GLM(won.astype(float), x[:, 1:], family=sm.families.Binomial(sm.families.links.Probit()))
    plain, robust = model.fit(), model.fit(cov_type="cluster", cov_kwds={"groups": pd.factorize(data["observer"])[0]})
    fitted = np.concatenate([[0], plain.params])
    compare("statsmodels: Thurstone scores, JOD", [r["score"] for r in t["scores"]],
            (fitted - fitted.mean()) / JOD, 1e-6)
    centre = np.eye(len(names))[:, 1:] - 1 / len(names)
    errors = np.sqrt(np.diag(centre @ robust.cov_params() @ centre.T)) / JOD
    n = data["observer"].nunique()
    half = stats.t.ppf(0.975, n - 1) * errors
    compare("statsmodels: half width of the interval of a score, clustered by observers, t (ours: corrected, moderated)",
            [(r["high"] - r["low"]) / 2 for r in t["scores"]], half, 0.25, relative=True)


def counts():
    file = DATA / "study/psychometric_qpdat.csv"
    t = analysed("--table", file, "--columns", "participant=participant,level=phase,yes_count=k,trials=n", "--factors",
                 "cond", "--guess", 0, "--lapse", 0, "--draws", 0)
    data = pd.read_csv(file)
    ours, peer = [], []
    for r in t["runs"]:
        if r["method"] != "maximum likelihood":
            continue
        part = data[(data["participant"] == r["participant"]) & (data["cond"] == int(r["cell"].split("=")[1]))]
        fit = sm.GLM(np.column_stack([part["k"], part["n"] - part["k"]]), sm.add_constant(part["phase"]),
                     family=sm.families.Binomial(sm.families.links.Probit())).fit()
        ours.append(r["level"])
        peer.append(-fit.params.iloc[0] / fit.params.iloc[1])
    compare("statsmodels: thresholds of 6 cumulative normals (quickpsy's data)", ours, peer, 1e-6, relative=True)


def two_alternatives():
    file = DATA / "perceptual/psychometric_psignifit_2afc.csv"
    t = analysed("--table", file, "--columns", "level=level,correct_count=n_correct,trials=n_total")
    data = pd.read_csv(file)[["level", "n_correct", "n_total"]].to_numpy()
    fit = psignifit.psignifit(data, experiment_type="2AFC", sigmoid="norm")
    compare("psignifit: threshold of its 2AFC example (posterior mode; ours: mode with weak priors)",
            t["curves"][0]["threshold"], fit.parameter_estimate_MAP["threshold"], 0.03, relative=True)


def ratings():
    file = DATA / "study/ratings_nflx_public.csv"
    t = analysed("--table", file, "--columns", "participant=subject,item=asset_id,value=rating")
    wide = pd.read_csv(file).pivot(index="subject", columns="asset_id", values="rating")
    compare("scipy: mean ratings of 79 videos", [r["score"] for r in t["scores"]], wide.mean().to_numpy(), 1e-8)
    friedman = stats.friedmanchisquare(*[wide[c] for c in wide.columns])
    ours = {r["number"]: r["value"] for r in t["fits"]}
    compare("scipy: Friedman's chi-square", ours["Friedman chi-square"], friedman.statistic, 2e-8, relative=True)
    difference = next(r for r in t["differences"] if r["a"] == "0" and r["b"] == "40")
    test = stats.ttest_rel(wide[0], wide[40])
    compare("scipy: paired test of two videos, t interval", [difference["low"], difference["high"]],
            test.confidence_interval(), 1e-7)


SCRIPT = """schema: study/1
id: groups
seed: 5
participants: {count: 17}
factors:
  light: {day: {exposure: 0}, dusk: {exposure: -2}}
  scene: [hall, yard]
  method: [exact, good, bad]
reference: {method: exact}
defaults: {stimulus_ms: 500}
counterbalance: {light: {method: between}}
sequence: [rated]
blocks:
  rated: {task: rating, cross: [scene, method], repeats: 2, scale: {min: 0, max: 100}}
"""


def helmert(k):
    c = np.zeros((k, k - 1))
    for j in range(1, k):
        c[:j, j - 1], c[j, j - 1] = 1, -j
        c[:, j - 1] /= np.linalg.norm(c[:, j - 1])
    return c


def groups():
    (WORK / "groups.yaml").write_text(SCRIPT)
    lightwell("simulate", "--any-settings", "groups.yaml", "--out", "groups")
    lightwell("export", "groups", "--script", "groups.yaml", "--out", "exported")
    file = WORK / "exported/data/study-groups_description-trials_data.csv"
    t = analysed("--table", file, "--columns", "participant=participant,item=method,value=value", "--factors",
                 "light,scene", "--only", "analysis=counted")
    own = analysed("groups", "--script", "groups.yaml")
    data = pd.read_csv(file)
    data = data[data["analysis"] == "counted"]
    cells = data.groupby(["participant", "light", "scene", "method"])["value"].mean().reset_index()
    wide = cells.pivot(index=["participant", "light"], columns=["scene", "method"], values="value")
    y, group = wide.to_numpy(), wide.index.get_level_values("light")
    one = lambda k: np.ones((k, 1)) / math.sqrt(k)
    within = {"": np.kron(one(2), one(3)), "scene": np.kron(helmert(2), one(3)), "item": np.kron(one(2), helmert(3)),
              "scene x item": np.kron(helmert(2), helmert(3))}
    found = {r["effect"]: r for r in t["effects"]}
    f, p, gg, f_peer, p_peer, gg_peer = [], [], [], [], [], []
    for name, contrasts in within.items():
        z, total = y @ contrasts, 0
        for column in z.T:
            table = sm.stats.anova_lm(smf.ols("z ~ C(g, Sum)", pd.DataFrame({"z": column, "g": group})).fit(), typ=3)
            total = total + table[["sum_sq", "df"]]
        rest = z - pd.DataFrame(z).groupby(np.asarray(group)).transform("mean").to_numpy()
        spread, k = rest.T @ rest, z.shape[1]
        epsilon = np.trace(spread) ** 2 / (k * np.trace(spread @ spread))
        error = total.loc["Residual"]
        for term, prefix in (("Intercept", ""), ("C(g, Sum)", "light")):
            effect = " x ".join(filter(None, [prefix, name]))
            if not effect:
                continue
            ratio = total.loc[term, "sum_sq"] / total.loc[term, "df"] / (error["sum_sq"] / error["df"])
            f.append(found[effect]["F"])
            gg.append(found[effect]["eps_gg"])
            p.append(found[effect]["p_gg"])
            f_peer.append(ratio)
            gg_peer.append(epsilon)
            p_peer.append(stats.f.sf(ratio, epsilon * total.loc[term, "df"], epsilon * error["df"]))
    compare("statsmodels: F of a mixed analysis of variance, type III, groups of 9 and 8", f, f_peer, 1e-7, True)
    compare("statsmodels: its p with Greenhouse and Geisser's epsilon", p, p_peer, 1e-7, True)
    compare("numpy: Greenhouse and Geisser's epsilon", gg, gg_peer, 1e-7, True)
    mean = next(r for r in t["group_differences"] if r["cell"] == "mean")
    test = stats.ttest_ind(y[group == "day"].mean(1), y[group == "dusk"].mean(1), equal_var=False)
    compare("scipy: Welch's test of two groups: t, df, p, interval",
            [mean[c] for c in ("t", "df", "p", "low", "high")],
            [test.statistic, test.df, test.pvalue, *test.confidence_interval()], 1e-7, True)
    own_f = {r["effect"].replace("method", "item"): r["F"] for r in own["effects"]}
    compare("own records and the same trials as a table: F", f, [own_f[e] for e in found], 2e-8, True)


QUEST = """schema: study/1
id: quest
seed: 9
participants: {count: 3}
factors: {scene: [hall]}
reference: {scene: hall}
defaults: {stimulus_ms: 500}
sequence: [find]
blocks:
  find:
    task: 2ifc
    cross: [scene]
    compare: {vary: contrast, against: reference, scale: log10, range: [0.01, 1], harder: down}
    procedure: {name: qp, method: questplus, threshold: 0.01..1/41, slope: 1..8/8, guess: 0.5, lapse: 0.02, stop: {trials: 30}}
"""


def quest():
    (WORK / "quest.yaml").write_text(QUEST)
    lightwell("simulate", "--any-settings", "quest.yaml", "--out", "quest")
    lightwell("export", "quest", "--script", "quest.yaml", "--out", "quest_tables")
    t = analysed("quest", "--script", "quest.yaml")
    data = pd.read_csv(WORK / "quest_tables/data/study-quest_description-trials_data.csv", low_memory=False)
    data = data[data["analysis"] == "counted"]
    levels = np.linspace(-40, 0, 41)  # dB
    different, ours, peer = 0, [], []
    for who, trials in data.groupby("participant"):
        q = questplus.QuestPlus(
            stim_domain={"intensity": levels},
            param_domain={"threshold": levels, "slope": np.linspace(1, 8, 8), "lower_asymptote": np.array([0.5]),
                          "lapse_rate": np.array([0.02])},
            outcome_domain={"response": ["yes", "no"]}, func="weibull", stim_scale="dB",
            stim_selection_method="min_entropy", param_estimation_method="mean")
        for level, correct in zip(trials["level"], trials["correct"]):
            shown = levels[np.argmin(np.abs(levels - 20 * math.log10(level)))]
            different += abs(q.next_stim["intensity"] - shown) > 1e-6
            right = str(correct).lower() == "true"
            q.update(stim={"intensity": shown}, outcome={"response": "yes" if right else "no"})
        # The median, over its posterior, of the level (dB) at which 75 % are right.
        cells = q.posterior.stack(cell=[...])
        share = 0.25 / (0.5 - cells["lapse_rate"].values)
        at = cells["threshold"].values + 20 * np.log10(-np.log(1 - share)) / cells["slope"].values
        order = np.argsort(at)
        middle = np.cumsum(cells.values[order]) - cells.values[order] / 2
        peer.append(10 ** (np.interp(0.5, middle, at[order]) / 20))
        ours.append(next(r for r in t["runs"] if r["participant"] == who and r["method"] == "QUEST+ posterior")["level"])
    compare(f"questplus: levels that differ, of {len(data)} choices", different, 0, 0.5)
    compare("questplus: thresholds of 3 runs (75 %)", ours, peer, 1e-6, relative=True)


def main():
    tone_mappers()
    counts()
    two_alternatives()
    ratings()
    groups()
    quest()
    print("| compared | ours | peer | difference | tolerance |\n|---|---|---|---|---|")
    for what, a, b, difference, tolerance, kind in sorted(rows, key=lambda r: -r[3] / r[4]):
        print(f"| {what} | {a:.9g} | {b:.9g} | {difference:.2g} {kind} | {tolerance:g} |")
    return any(r[3] > r[4] or math.isnan(r[3]) for r in rows)


sys.exit(main())
