#include "study/tables/events.h"
#include "study/tables/export.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// Quotes a text as a string of R.
std::string quoted_for_r(std::string const& text)
{
    std::string out = "\"";
    for (char const c : text)
        if (c == '"' || c == '\\')
            out += std::string("\\") + c;
        else
            out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    return out + "\"";
}

/// Quotes a name of R, which may contain anything except a backtick.
std::string named(std::string const& column) { return "`" + column + "`"; }

std::string listed(std::vector<std::string> const& words)
{
    std::string out = "c(";
    for (std::size_t i = 0; i < words.size(); ++i) out += (i ? ", " : "") + quoted_for_r(words[i]);
    return out + ")";
}

/// Factors that vary within a block, as columns of the table, except the one that it compares.
std::vector<std::string> varying(Script const& s, Block const& b)
{
    auto const names = factor_columns(s);
    std::vector<std::string> out;
    for (std::size_t f = 0; f < s.factors.size(); ++f) {
        bool const is_crossed =
            std::find(b.cross.begin(), b.cross.end(), int(f)) != b.cross.end() ||
            std::any_of(b.nest.begin(), b.nest.end(), [&](Nest const& n) { return n.factor == int(f); });
        bool const is_nested_in = [&] {
            std::vector<SequenceItem> open = s.sequence;
            for (std::size_t i = 0; i < open.size(); ++i) {
                if (open[i].kind == SequenceKind::per && open[i].index == int(f)) return true;
                std::vector<SequenceItem> const inner = open[i].items; // `open` may move
                open.insert(open.end(), inner.begin(), inner.end());
            }
            return false;
        }();
        bool const is_alone = b.only[f].size() == 1;
        if ((is_crossed || is_nested_in) && !is_alone && compared_factor(b) != int(f)) out.push_back(names[f]);
    }
    return out;
}

std::string terms(std::vector<std::string> const& columns)
{
    std::string out;
    for (std::string const& c : columns) out += " + " + named(c);
    return out;
}

std::string pairs_model(Script const& s, Block const& b)
{
    std::vector<std::string> levels;
    for (auto const& [i, j] : b.pairs->pairs)
        for (int const level : {i, j}) {
            std::string const& name = s.factors[std::size_t(b.pairs->factor)].levels[std::size_t(level)].name;
            if (std::find(levels.begin(), levels.end(), name) == levels.end()) levels.push_back(name);
        }
    return fmt::format(
        R"R(# Thurstone's case V as a mixed model: a column per level, 1 where it is first, -1 where it is second; the first level is
# 0. The intercept is the preference for what is first, which may differ between participants. 1 JOD = 0.6745.
d <- d[d$response %in% c("first", "second"), ]
levels <- {}
x <- sapply(levels[-1], function(l) (d$first == l) - (d$second == l))
colnames(x) <- paste0("level_", seq_along(levels)[-1])
d <- cbind(d, x)
terms <- paste(colnames(x), collapse = " + ")
fit(as.formula(paste("response == 'first' ~", terms, "+ (1 | participant)")), d, binomial("probit"))
cat("level_i is", paste(seq_along(levels), levels, collapse = ", "), "; scores are against", levels[1], "\n")
)R",
        listed(levels));
}

std::string compare_model(Script const& s, Block const& b)
{
    auto const others = varying(s, b);
    if (b.compare->vary.empty())
        return "d$compared <- factor(d$cond_a)\nfit(correct ~ compared" + terms(others) +
               " + (1 | participant), d, binomial(\"probit\"))\n";
    std::string const x = b.compare->scale == Scale::linear ? "d$level" : "log2(d$level)";
    return fmt::format("d$x <- {}\nfit(correct ~ x{} + (1 | participant), d, binomial(\"logit\"))\n", x,
                       terms(others));
}

std::string model(Script const& s, Block const& b)
{
    auto const columns = varying(s, b);
    switch (b.task) {
    case Task::pair:
    case Task::pair_with_reference:
        return pairs_model(s, b);
    case Task::rating:
    case Task::adjustment:
        return "fit(value ~ 1" + terms(columns) + " + (1 | participant), d)\n";
    case Task::magnitude:
        return "d <- d[d$value > 0, ]\nfit(log(value) ~ 1" + terms(columns) + " + (1 | participant), d)\n";
    case Task::two_interval:
    case Task::same_different:
    case Task::abx:
    case Task::oddity:
    case Task::yes_no:
        if (b.compare) return compare_model(s, b);
        return "fit(correct ~ 1" + terms(columns) + " + (1 | participant), d, binomial(\"probit\"))\n";
    case Task::ranking:
    case Task::questionnaire:
    case Task::free_walk:
        break;
    }
    return {};
}

} // namespace

std::string lme4_script(Script const& script, std::string const& trials_file)
{
    std::string r = fmt::format(
        R"(# Mixed models of the experiment {}: generated, a beginning to be changed. Needs R and lme4 (Bates et al. 2015, J. Stat.
# Software 67(1)). Run it in its own folder: Rscript analysis.R
library(lme4)
trials <- read.csv({}, stringsAsFactors = FALSE, na.strings = "NA", check.names = FALSE)
trials <- trials[trials$analysis %in% c("counted", "counted though invalid"), ]
trials$correct <- trials$correct == "true"

# Terms with only one level cannot be estimated: they are left out and printed.
fit <- function(formula, data, family = NULL) {{
  fixed <- attr(terms(lme4::nobars(formula)), "term.labels")
  constant <- Filter(function(t) length(unique(data[[gsub("`", "", t)]])) < 2, fixed)
  for (t in constant) {{
    cat("left out, it has one level only:", t, "\n")
    formula <- update(formula, paste(". ~ . -", t))
  }}
  if (nrow(data) == 0) return(cat("no trials\n"))
  if (length(unique(data$participant)) < 2) return(cat("fewer than two participants: no mixed model\n"))
  print(summary(if (is.null(family)) lmer(formula, data) else glmer(formula, data, family = family)))
}}
)",
        quoted_for_r(script.id), quoted_for_r(trials_file));
    auto const columns = factor_columns(script);
    for (LevelChoice const& c : script.reference) {
        Factor const& f = script.factors[std::size_t(c.factor)];
        std::string const column = quoted_for_r(columns[std::size_t(c.factor)]),
                          level = quoted_for_r(f.levels[std::size_t(c.level)].name);
        r += fmt::format("if (any(trials[[{0}]] %in% {1})) trials[[{0}]] <- relevel(factor(trials[[{0}]]), {1})\n",
                         column, level);
    }
    for (Block const& b : script.blocks) {
        std::string const text = model(script, b);
        if (text.empty()) continue;
        r += fmt::format(
            "\ncat(\"\\n== {} ({})\\n\")\nd <- trials[trials$block == {}, ]\nif (nrow(d) > 0) {{\n{}}}\n", b.name,
            study::facts(b.task).name, quoted_for_r(b.name), text);
    }
    return r;
}

} // namespace study
