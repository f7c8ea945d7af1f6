#include "study/analysis/effect_tables.h"

namespace study {

ResultTable effects_table(Analysis const& a)
{
    ResultTable t{
        "effects",
        "Effects of conditions and groups of participants",
        "Analysis of variance of observers' means (type III; groups have equal weight). p_gg: with the epsilon of "
        "Greenhouse and Geisser, p_hf: of Huynh and Feldt; p_perm: by permutation, without assuming normality; "
        "p_holm: p_gg corrected for all effects of the measure. eta2: partial eta squared.",
        false,
        {}};
    t.table.columns = {{"block", "Block or questionnaire"},
                       {"measure", "What was averaged by observer and condition"},
                       {"effect", "Factors; x: their interaction"},
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
                       {"eta2", "Partial eta squared"},
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
    t.table.columns = {{"block", "Block or questionnaire"},
                       {"measure", "What was averaged by observer"},
                       {"cell", "Condition; mean: of all"},
                       {"a", "Group"},
                       {"b", "Other group"},
                       {"n_a", "Observers in a"},
                       {"n_b", "Observers in b"},
                       {"mean_a", "Mean of a"},
                       {"mean_b", "Mean of b"},
                       {"difference", "a minus b"},
                       {"low", "Lower end of the interval"},
                       {"high", "Upper end"},
                       {"t", "Welch's t"},
                       {"df", "Its degrees of freedom"},
                       {"p", "p-value"},
                       {"p_holm", "Corrected (Holm)"},
                       {"g", "Hedges' g"},
                       {"g_low", "Lower end of its interval"},
                       {"g_high", "Upper end"}};
    for (GroupDifference const& d : a.group_differences) {
        WelchTest const& w = d.test;
        t.table.rows.push_back({cell(d.block), cell(d.measure), cell(d.cell), cell(d.a), cell(d.b), cell(w.n_a),
                                cell(w.n_b), cell(w.mean_a), cell(w.mean_b), cell(w.difference),
                                cell(w.interval.low), cell(w.interval.high), cell(w.t), cell(w.df), cell(w.p),
                                cell(d.p_holm), cell(w.hedges_g), cell(w.g.low), cell(w.g.high)});
    }
    t.is_long = t.table.rows.size() > 40;
    return t;
}

} // namespace study
