#include "study/analysis/table_parts.h"

#include "study/stats/pair_scale.h"

namespace study {

ResultTable hierarchy_table(Analysis const& a)
{
    ResultTable t{
        "hierarchical_scores",
        "Scores of pairs with observers as random effects",
        "Bayesian: means over observers of their own scales, larger than those of pooled choices, which shrink "
        "where observers differ. 1 JOD: one observer chooses the better one in 75 %.",
        false,
        {}};
    t.table.columns = {name_column("block", "Block"),
                       name_column("group", "Trials that share this level"),
                       name_column("item", "Scored item; 'between observers': standard deviation of their scores"),
                       estimate_column("score", "Posterior mean", "JOD"),
                       {"low", "Lower end of the credible interval"},
                       {"high", "Upper end"},
                       {"r_hat", "Convergence of chains: up to 1.01"},
                       {"bulk", "Effective number of draws of the centre"},
                       {"tail", "Effective number of draws of the tails"}};
    double const jod = jod_per_unit(PairModel::thurstone_v);
    for (BlockResult const& b : a.blocks)
        for (ScaleResult const& s : b.scales) {
            if (!s.hierarchy) continue;
            auto const row = [&](std::string const& item, Posterior const& p) {
                t.table.rows.push_back({cell(b.name), cell(s.group), cell(item), cell(jod * p.mean),
                                        cell(jod * p.low), cell(jod * p.high), cell(p.convergence.r_hat),
                                        cell(p.convergence.bulk), cell(p.convergence.tail)});
            };
            for (std::size_t i = 0; i < s.items.size(); ++i) row(s.items[i].name, s.hierarchy->score[i]);
            row("between observers", s.hierarchy->between_sd);
            if (s.hierarchy->tie_threshold.mean > 0) row("threshold of ties", s.hierarchy->tie_threshold);
        }
    return t;
}

ResultTable effects_table(Analysis const& a)
{
    ResultTable t{
        "effects",
        "Effects of conditions and groups of participants",
        "Analysis of variance of observers' means (type III; groups have equal weight). p_gg: with the epsilon of "
        "Greenhouse and Geisser, p_hf: of Huynh and Feldt; p_perm: by permutation, without assuming normality; "
        "p_holm: p_gg corrected for all effects of the measure. eta2: partial eta squared, interval by the "
        "noncentral "
        "F distribution, or up to the estimate where F is smaller than chance makes it.",
        false,
        {}};
    t.table.columns = {name_column("block", "Block or questionnaire"),
                       name_column("measure", "What was averaged by observer and condition"),
                       name_column("effect", "Factors; x: their interaction"),
                       {"observers", "Observers with all cells"},
                       {"F", "F ratio"},
                       {"df1", "Degrees of freedom of the effect, uncorrected"},
                       {"df2", "Degrees of freedom of the error, uncorrected"},
                       {"p", "Probability of that F or more"},
                       {"eps_gg", "Epsilon of Greenhouse and Geisser"},
                       {"p_gg", "p with it"},
                       {"eps_hf", "Epsilon of Huynh and Feldt (Lecoutre), at most 1"},
                       {"p_hf", "p with it"},
                       {"p_perm", "p by permutation"},
                       {"p_holm", "p_gg, corrected (Holm)"},
                       estimate_column("eta2", "Partial eta squared"),
                       {"low", "Lower end of its interval"},
                       {"high", "Upper end"}};
    for (EffectResult const& e : a.effects)
        t.table.rows.push_back({cell(e.block), cell(e.measure), cell(e.effect), cell(e.observers), cell(e.test.f),
                                cell(e.test.df1), cell(e.test.df2), cell(e.test.p),
                                cell(e.test.greenhouse_geisser), cell(e.test.p_gg), cell(e.test.huynh_feldt),
                                cell(e.test.p_hf), cell(e.test.p_permutation), cell(e.p_holm),
                                cell(e.test.partial_eta2), cell(e.test.eta2.low), cell(e.test.eta2.high)});
    return t;
}

ResultTable group_differences_table(Analysis const& a)
{
    ResultTable t{
        "group_differences",
        "Differences between groups of participants",
        "Welch's test of observers' means; p_holm corrected for all comparisons of the measure and factor. "
        "g: Hedges' standardised difference with its interval.",
        false,
        {}};
    t.table.columns = {name_column("block", "Block or questionnaire"),
                       name_column("measure", "What was averaged by observer"),
                       name_column("cell", "Condition; mean: of all"),
                       name_column("a", "Group"),
                       name_column("b", "Other group"),
                       {"n_a", "Observers in a"},
                       {"n_b", "Observers in b"},
                       {"mean_a", "Mean of a"},
                       {"mean_b", "Mean of b"},
                       estimate_column("difference", "a minus b"),
                       {"low", "Lower end of the interval"},
                       {"high", "Upper end"},
                       {"t", "Welch's t"},
                       {"df", "Its degrees of freedom"},
                       {"p", "p-value"},
                       {"p_holm", "Corrected (Holm)"},
                       estimate_column("g", "Hedges' g"),
                       {"g_low", "Lower end of its interval"},
                       {"g_high", "Upper end"}};
    for (GroupDifference const& d : a.group_differences) {
        WelchTest const& w = d.test;
        t.table.rows.push_back({cell(d.block), cell(d.measure), cell(d.cell), cell(d.a), cell(d.b), cell(w.n_a),
                                cell(w.n_b), full_cell(w.mean_a), full_cell(w.mean_b), full_cell(w.difference),
                                full_cell(w.interval.low), full_cell(w.interval.high), cell(w.t), cell(w.df),
                                cell(w.p), cell(d.p_holm), cell(w.hedges_g), cell(w.g.low), cell(w.g.high)});
    }
    t.is_long = t.table.rows.size() > 40;
    return t;
}

} // namespace study
