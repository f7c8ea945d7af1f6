// analysis.R: mixed models with R's lme4.

#include "study/tables/block_model.h"
#include "study/tables/events.h"
#include "study/tables/export.h"

#include <fmt/format.h>

namespace study {
namespace {

constexpr char kLme4Beginning[] =
    R"R(# Mixed models of the experiment {0}: generated, a beginning to be changed. Needs R and lme4 (Bates et al. 2015, J. Stat.
# Software 67(1)). Run it in its own folder: Rscript analysis.R
suppressPackageStartupMessages(library(lme4))
trials <- read.csv({1}, stringsAsFactors = FALSE, na.strings = "NA", check.names = FALSE)
trials <- trials[trials$analysis %in% c("counted", "counted though invalid"), ]
trials$correct <- trials$correct %in% c("true", "TRUE", TRUE)

# The columns that vary in the data; others cannot be estimated and are printed.
varying <- function(data, columns) {{
  constant <- Filter(function(column) length(unique(data[[column]])) < 2, columns)
  for (column in constant) cat("left out, it has one level only:", column, "\n")
  setdiff(columns, constant)
}}

# All interactions of up to three columns, of pairs if there are more.
crossed <- function(columns) {{
  ticked <- paste0("`", columns, "`")
  if (length(columns) == 0) return("1")
  if (length(columns) <= 3) return(paste(ticked, collapse = " * "))
  paste0("(", paste(ticked, collapse = " + "), ")^2")
}}

# Probit above the proportion of correct answers by guessing: P = guess + (1 - guess) pnorm(eta).
guessing <- function(guess) structure(list(
  linkfun = function(mu) qnorm(pmin(pmax((mu - guess) / (1 - guess), 1e-6), 1 - 1e-6)),
  linkinv = function(eta) guess + (1 - guess) * pmin(pmax(pnorm(eta), 1e-9), 1 - 1e-9),
  mu.eta = function(eta) (1 - guess) * pmax(dnorm(eta), 1e-9),
  valideta = function(eta) TRUE, name = paste("probit above", guess)), class = "link-glm")

run <- function(formula, data, family = NULL, guess = 0) {{
  print(formula, showEnv = FALSE)
  if (nrow(data) == 0) {{ cat("no trials\n"); return(invisible(NULL)) }}
  if (length(unique(data$participant)) < 2) {{
    cat("fewer than two participants: no mixed model\n")
    return(invisible(NULL))
  }}
  control <- glmerControl(optimizer = "bobyqa", optCtrl = list(maxfun = 1e5))
  if (is.null(family)) return(lmer(formula, data))
  data$start <- guess + (1 - guess) * ifelse(eval(formula[[2]], data), 0.75, 0.25)
  glmer(formula, data, family = family, mustart = start, control = control)
}}

# The model with all interactions; each term that no other contains is tested by the likelihood ratio.
fit <- function(response, columns, data, random = "(1 | participant)", family = NULL, guess = 0) {{
  columns <- varying(data, columns)
  formula <- as.formula(paste(response, "~", crossed(columns), "+", random))
  model <- run(formula, data, family, guess)
  if (is.null(model)) return(invisible(NULL))
  print(summary(model), correlation = FALSE)
  for (term in drop.scope(nobars(formula))) {{
    cat("\nwithout", term, ":\n")
    other <- run(update(formula, paste(". ~ . -", term)), data, family, guess)
    print(anova(other, model))
  }}
  invisible(model)
}}

models <- list() # by block
)R";

constexpr char kLme4Pairs[] =
    R"R(# Thurstone's case V as a mixed model: a column per level, 1 where it is first, -1 where it is second; the first level is
# 0. The intercept is the preference for what is first. Participants differ in all of them. 1 JOD = 0.6745. Whether
# scores differ with a factor is tested by the likelihood ratio. Ties are left out.
d <- d[d$response %in% c("first", "second"), ]
levels <- c({0})
x <- sapply(levels[-1], function(l) (d$first == l) - (d$second == l))
x <- matrix(x, nrow = nrow(d), dimnames = list(NULL, paste0("level_", seq_along(levels)[-1])))
d <- cbind(d, x)
scores <- paste(colnames(x), collapse = " + ")
random <- paste0("(1 + ", scores, " || participant)")
model <- run(as.formula(paste("response == 'first' ~", scores, "+", random)), d, binomial("probit"))
models[[{2}]] <- model
if (!is.null(model)) {{
  print(summary(model), correlation = FALSE)
  cat("level_i is", paste(seq_along(levels), levels, collapse = ", "), "; scores are against", levels[1], "\n")
  for (column in varying(d, c({1}))) {{
    other <- run(as.formula(paste0("response == 'first' ~ (", scores, ") * `", column, "` + ", random)), d,
                 binomial("probit"))
    print(summary(other), correlation = FALSE)
    print(anova(model, other))
  }}
}}
)R";

std::string r_list(std::vector<std::string> const& words)
{
    std::string out;
    for (std::string const& w : words) out += (out.empty() ? "" : ", ") + quoted(w);
    return out;
}

std::string r_text(BlockModel const& m)
{
    std::vector<std::string> columns = m.factors;
    std::string prepared;
    if (m.has_level) {
        prepared = m.is_log ? "d <- d[d$level > 0, ]\nd$x <- log2(d$level)\n" : "d$x <- d$level\n";
        columns.insert(columns.begin(), "x");
    } else if (m.compares_factor) {
        prepared = m.compares_pairs ? "d$compared <- factor(paste(d$cond_a, \"vs\", d$cond_b))\n"
                                    : "d$compared <- factor(d$cond_a)\n";
        columns.insert(columns.begin(), "compared");
    }
    std::string const names = "c(" + r_list(columns) + ")", put = "models[[" + quoted(m.block) + "]] <- ";
    switch (m.kind) {
    case ModelKind::pairs:
        return fmt::format(kLme4Pairs, r_list(m.items), r_list(m.factors), quoted(m.block));
    case ModelKind::values:
        if (m.is_log) return fmt::format("d <- d[d$value > 0, ]\n{}fit(\"log(value)\", {}, d)\n", put, names);
        return fmt::format("{}fit(\"value\", {}, d)\n", put, names);
    case ModelKind::detection:
        if (m.has_level)
            return prepared + put +
                   fmt::format("fit(\"correct\", {}, d, \"(1 | participant)\", binomial(guessing({:.9g})), "
                               "{:.9g})\n",
                               names, m.guess, m.guess);
        return "# A condition may be at chance, where a proportion by guessing has no probit: 2ifc has d' = "
               "sqrt(2) eta.\n" +
               prepared + put +
               fmt::format("fit(\"correct\", {}, d, \"(1 | participant)\", binomial(\"probit\"))\n", names);
    case ModelKind::yes_no:
        break;
    }
    std::string const signal = "d$says_yes <- d$response == \"yes\"\nd$signal <- d$says_yes == d$correct\n";
    if (m.has_level)
        return signal + prepared + "d <- d[d$signal, ]\n" + put +
               fmt::format("fit(\"says_yes\", {}, d, \"(1 | participant)\", binomial(\"probit\"))\n", names);
    columns.insert(columns.begin(), "signal");
    return "# d' is the effect of the signal on the probit of \"yes\" (DeCarlo 1998).\n" + signal + prepared +
           put +
           fmt::format("fit(\"says_yes\", c({}), d, \"(1 + signal | participant)\", binomial(\"probit\"))\n",
                       r_list(columns));
}

} // namespace

std::string lme4_script(Script const& script, std::string const& trials_file)
{
    std::string r = fmt::format(kLme4Beginning, quoted(script.id), quoted(trials_file));
    auto const columns = factor_columns(script);
    for (LevelChoice const& c : script.reference) {
        Factor const& f = script.factors[std::size_t(c.factor)];
        r += fmt::format("if (any(trials[[{0}]] %in% {1})) trials[[{0}]] <- relevel(factor(trials[[{0}]]), {1})\n",
                         quoted(columns[std::size_t(c.factor)]), quoted(f.levels[std::size_t(c.level)].name));
    }
    for (BlockModel const& m : block_models(script))
        r += fmt::format(
            "\ncat(\"\\n== {} ({})\\n\")\nd <- trials[trials$block == {}, ]\nif (nrow(d) > 0) {{\n{}}}\n", m.block,
            m.task, quoted(m.block), r_text(m));
    return r;
}

} // namespace study
