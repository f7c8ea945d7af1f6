// analysis.py: the twin of analysis.R for Python's statsmodels.

#include "study/tables/block_model.h"
#include "study/tables/events.h"
#include "study/tables/export.h"

#include <fmt/format.h>

namespace study {
namespace {

constexpr char kPythonBeginning[] =
    R"PY(# Models of the experiment {0}: generated, a beginning to be changed. Needs Python with pandas and statsmodels (Seabold &
# Perktold 2010). Run it in its own folder: python3 analysis.py
# Ratings and other numbers: linear mixed models (REML), participants as random intercepts. Choices and correct answers:
# generalised estimating equations with participants as clusters and bias-reduced robust errors (Mancl & DeRouen 2001);
# their coefficients are those of the population's average, so a little smaller than those of a mixed model (analysis.R).
import warnings

import numpy as np
import pandas as pd
import statsmodels.api as sm
import statsmodels.formula.api as smf
from scipy.stats import norm

trials = pd.read_csv({1}, na_values=["NA"], keep_default_na=False, low_memory=False)
trials = trials[trials["analysis"].isin(["counted", "counted though invalid"])].copy()
trials["correct"] = trials["correct"].astype(str).str.lower() == "true"
reference = {2}


class Guessing(sm.families.links.Probit):
    """Probit above the proportion of correct answers by guessing: P = guess + (1 - guess) Phi(eta)."""

    def __init__(self, guess):
        super().__init__()
        self.guess = guess

    def __call__(self, p):
        return norm.ppf(np.clip((p - self.guess) / (1 - self.guess), 1e-6, 1 - 1e-6))

    def inverse(self, z):
        return self.guess + (1 - self.guess) * np.clip(norm.cdf(z), 1e-9, 1 - 1e-9)

    def deriv(self, p):
        return 1 / self.inverse_deriv(self(p))

    def inverse_deriv(self, z):
        return (1 - self.guess) * np.maximum(norm.pdf(z), 1e-9)

    def inverse_deriv2(self, z):
        return -z * (1 - self.guess) * norm.pdf(z)


def varying(data, columns):
    """The columns that vary in the data; others cannot be estimated and are printed."""
    for column in columns:
        if data[column].nunique() < 2:
            print("left out, it has one level only:", column)
    return [column for column in columns if data[column].nunique() > 1]


def term(data, column):
    if pd.api.types.is_numeric_dtype(data[column]) and column in ("x", "signal"):
        return f"Q({{column!r}})"
    level = reference.get(column)
    if level in set(data[column].astype(str)):
        return f"C(Q({{column!r}}), Treatment({{level!r}}))"
    return f"C(Q({{column!r}}))"


def crossed(data, columns):
    """All interactions of up to three columns, of pairs if there are more."""
    terms = [term(data, column) for column in columns]
    if not terms:
        return "1"
    return " * ".join(terms) if len(terms) <= 3 else "(" + " + ".join(terms) + ") ** 2"


def too_few(data):
    if len(data) == 0:
        print("no trials")
    elif data["participant"].nunique() < 2:
        print("fewer than two participants: no model over them")
    return len(data) == 0 or data["participant"].nunique() < 2


def report(model, columns):
    print(model.summary())
    if columns:
        print(model.wald_test_terms(scalar=True))
    return model


def fit_values(data, response, columns):
    """A number per trial: linear mixed model."""
    data = data.dropna(subset=["value"])
    if too_few(data):
        return None
    columns = varying(data, columns)
    model = smf.mixedlm(f"{{response}} ~ {{crossed(data, columns)}}", data, groups=data["participant"])
    return report(model.fit(reml=True), columns)


def fit_answers(data, response, columns, link):
    """A binary answer per trial: population-averaged model with robust errors."""
    if too_few(data):
        return None
    columns = varying(data, columns)
    data = data.assign(answer=data[response].astype(float))
    model = smf.gee(f"answer ~ {{crossed(data, columns)}}", "participant", data,
                    family=sm.families.Binomial(link), cov_struct=sm.cov_struct.Independence())
    start = np.zeros(model.exog.shape[1])
    return report(model.fit(maxiter=200, start_params=start, cov_type="bias_reduced"), columns)


def fit_pairs(data, items, columns):
    """Thurstone's case V: a column per item, 1 where it is first, -1 where it is second; the first item is 0. The
    intercept is the preference for what is first. 1 JOD = 0.6745. Ties are left out."""
    data = data[data["response"].isin(["first", "second"])]
    if too_few(data):
        return None

    def scores(rows):
        return pd.DataFrame({{item: 1.0 * (rows["first"].astype(str) == item) - (rows["second"].astype(str) == item)
                             for item in items[1:]}})

    y, clusters, x = 1.0 * (data["response"] == "first"), data["participant"], scores(data)
    x.insert(0, "first", 1.0)

    def estimated(design):
        return sm.GEE(y, design, groups=clusters, family=sm.families.Binomial(sm.families.links.Probit())).fit(
            start_params=np.zeros(design.shape[1]), cov_type="bias_reduced")

    model = estimated(x)
    print(model.summary())
    print("scores are against", items[0])
    for column in varying(data, columns):
        base, more = reference.get(column), []
        levels = sorted(set(data[column].astype(str)))
        base = base if base in levels else levels[0]
        design = x.copy()
        for level in levels:
            for item in items[1:]:
                if level != base:
                    design[f"{{item}}: {{column}}={{level}}"] = x[item] * (data[column].astype(str) == level)
                    more.append(design.shape[1] - 1)
        other = estimated(design)
        print(other.summary())
        print("do scores differ with", column, "?", other.wald_test(np.eye(design.shape[1])[more], scalar=True))
    return model


warnings.simplefilter("ignore", sm.tools.sm_exceptions.ConvergenceWarning)
models = {{}}
)PY";

std::string python_list(std::vector<std::string> const& words)
{
    std::string out;
    for (std::string const& w : words) out += (out.empty() ? "" : ", ") + quoted(w);
    return "[" + out + "]";
}

std::string python_text(BlockModel const& m)
{
    std::vector<std::string> columns = m.factors;
    std::string prepared;
    if (m.has_level) {
        prepared = m.is_log ? "    d = d[d[\"level\"] > 0].assign(x=lambda t: np.log2(t[\"level\"]))\n"
                            : "    d = d.assign(x=d[\"level\"])\n";
        columns.insert(columns.begin(), "x");
    } else if (m.compares_factor) {
        prepared = m.compares_pairs
                       ? "    d = d.assign(compared=d[\"cond_a\"].astype(str) + \" vs \" + d[\"cond_b\"].astype(str))\n"
                       : "    d = d.assign(compared=d[\"cond_a\"])\n";
        columns.insert(columns.begin(), "compared");
    }
    std::string const put = "    models[" + quoted(m.block) + "] = ";
    std::string const probit = "sm.families.links.Probit()";
    switch (m.kind) {
    case ModelKind::pairs:
        return put + fmt::format("fit_pairs(d, {}, {})\n", python_list(m.items), python_list(m.factors));
    case ModelKind::values:
        if (m.is_log)
            return "    d = d[d[\"value\"] > 0]\n" + put +
                   fmt::format("fit_values(d, \"np.log(value)\", {})\n", python_list(columns));
        return put + fmt::format("fit_values(d, \"value\", {})\n", python_list(columns));
    case ModelKind::detection:
        if (m.has_level)
            return prepared + put +
                   fmt::format("fit_answers(d, \"correct\", {}, Guessing({:.9g}))\n", python_list(columns),
                               m.guess);
        return "    # A condition may be at chance, where a proportion by guessing has no probit: 2ifc has d' = "
               "sqrt(2) "
               "eta.\n" +
               prepared + put + fmt::format("fit_answers(d, \"correct\", {}, {})\n", python_list(columns), probit);
    case ModelKind::yes_no:
        break;
    }
    std::string const signal = "    d = d.assign(says_yes=d[\"response\"] == \"yes\")\n"
                               "    d = d.assign(signal=1.0 * (d[\"says_yes\"] == d[\"correct\"]))\n";
    if (m.has_level)
        return signal + prepared + "    d = d[d[\"signal\"] == 1]\n" + put +
               fmt::format("fit_answers(d, \"says_yes\", {}, {})\n", python_list(columns), probit);
    columns.insert(columns.begin(), "signal");
    return "    # d' is the effect of the signal on the probit of \"yes\" (DeCarlo 1998).\n" + signal + prepared +
           put + fmt::format("fit_answers(d, \"says_yes\", {}, {})\n", python_list(columns), probit);
}

} // namespace

std::string statsmodels_script(Script const& script, std::string const& trials_file)
{
    auto const columns = factor_columns(script);
    std::string reference;
    for (LevelChoice const& c : script.reference)
        reference += (reference.empty() ? "" : ", ") + quoted(columns[std::size_t(c.factor)]) + ": " +
                     quoted(script.factors[std::size_t(c.factor)].levels[std::size_t(c.level)].name);
    std::string py = fmt::format(kPythonBeginning, quoted(script.id), quoted(trials_file), "{" + reference + "}");
    for (BlockModel const& m : block_models(script))
        py +=
            fmt::format("\nd = trials[trials[\"block\"] == {0}]\nif len(d):\n    print(\"\\n== {1} ({2})\")\n{3}",
                        quoted(m.block), m.block, m.task, python_text(m));
    return py;
}

} // namespace study
