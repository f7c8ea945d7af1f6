#include "study/stats/mixed_anova.h"

#include "study/numeric/error.h"
#include "study/numeric/random.h"
#include "study/numeric/rounding.h"
#include "study/numeric/special.h"
#include "study/stats/effect_size.h"
#include "study/stats/summary.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace study {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Orthonormal columns that are orthogonal to (1, ..., 1): Helmert's contrasts.
MatrixXd helmert(int levels)
{
    MatrixXd c = MatrixXd::Zero(levels, levels - 1);
    for (int k = 1; k < levels; ++k) {
        c.col(k - 1).head(k).setConstant(1);
        c(k, k - 1) = -k;
        c.col(k - 1).normalize();
    }
    return c;
}

/// Columns that sum to 0 over the levels.
MatrixXd sum_coded(BetweenFactor const& f)
{
    MatrixXd x = MatrixXd::Zero(Index(f.level.size()), f.levels - 1);
    for (Index o = 0; o < x.rows(); ++o) {
        int const level = f.level[std::size_t(o)];
        if (level + 1 == f.levels)
            x.row(o).setConstant(-1);
        else
            x(o, level) = 1;
    }
    return x;
}

MatrixXd kronecker(MatrixXd const& a, MatrixXd const& b)
{
    MatrixXd out(a.rows() * b.rows(), a.cols() * b.cols());
    for (Index i = 0; i < a.rows(); ++i)
        for (Index j = 0; j < a.cols(); ++j)
            out.block(i * b.rows(), j * b.cols(), b.rows(), b.cols()) = a(i, j) * b;
    return out;
}

/// A group of columns of the between design, or of contrasts of cells, named after its factors.
struct Term {
    std::string name; ///< empty = the mean
    MatrixXd columns;
};

void append(std::string& name, std::string const& factor) { name += (name.empty() ? "" : " x ") + factor; }

std::vector<Term> within_terms(std::vector<WithinFactor> const& factors)
{
    std::vector<Term> terms;
    for (unsigned chosen = 0; chosen < (1u << factors.size()); ++chosen) {
        Term t{"", MatrixXd::Ones(1, 1)};
        for (std::size_t f = 0; f < factors.size(); ++f) {
            int const n = factors[f].levels;
            bool const has = (chosen >> f) & 1u;
            t.columns = kronecker(t.columns,
                                  has ? helmert(n) : MatrixXd(MatrixXd::Constant(n, 1, 1 / std::sqrt(double(n)))));
            if (has) append(t.name, factors[f].name);
        }
        terms.push_back(std::move(t));
    }
    return terms;
}

std::vector<Term> between_terms(std::vector<BetweenFactor> const& factors, Index observers)
{
    std::vector<Term> terms;
    for (unsigned chosen = 0; chosen < (1u << factors.size()); ++chosen) {
        Term t{"", MatrixXd::Ones(observers, 1)};
        for (std::size_t f = 0; f < factors.size(); ++f) {
            if (!((chosen >> f) & 1u)) continue;
            MatrixXd const own = sum_coded(factors[f]);
            MatrixXd product(observers, t.columns.cols() * own.cols());
            for (Index a = 0; a < t.columns.cols(); ++a)
                for (Index b = 0; b < own.cols(); ++b)
                    product.col(a * own.cols() + b) = t.columns.col(a).cwiseProduct(own.col(b));
            t.columns = std::move(product);
            append(t.name, factors[f].name);
        }
        terms.push_back(std::move(t));
    }
    return terms;
}

/// Orthonormal basis of the columns of `own` after removal of what `others` explain.
MatrixXd basis(MatrixXd const& own, MatrixXd const& others)
{
    MatrixXd rest = own;
    if (others.cols() > 0) rest -= others * others.colPivHouseholderQr().solve(own);
    Eigen::HouseholderQR<MatrixXd> const qr(rest);
    return qr.householderQ() * MatrixXd::Identity(rest.rows(), rest.cols());
}

struct Squares {
    double effect = 0, error = 0;
};
/// The error is that of the residuals: a difference of sums of squares would be lost in rounding where it is small.
Squares squares_of(MatrixXd const& z, MatrixXd const& effect, MatrixXd const& all)
{
    return {(effect.transpose() * z).squaredNorm(), (z - all * (all.transpose() * z)).squaredNorm()};
}

/// What the other effects leave is permuted, so that they do not matter (Freedman & Lane 1983).
double permuted_p(MatrixXd const& z, MatrixXd const& effect, MatrixXd const& others, MatrixXd const& all,
                  bool const by_groups, AnovaSettings const& settings, std::uint64_t which)
{
    Squares const found = squares_of(z, effect, all);
    double const least = found.effect / std::max(found.error, 1e-300) * (1 - 1e-9);
    Random random = Random::part(settings.seed, which);
    std::vector<Index> order(std::size_t(z.rows()));
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = Index(i);
    MatrixXd rest = z;
    if (others.cols() > 0) rest -= others * others.colPivHouseholderQr().solve(z);
    int reached = 1;
    MatrixXd moved = rest;
    for (int i = 0; i < settings.permutations; ++i) {
        if (by_groups) random.shuffle(order);
        for (Index o = 0; o < z.rows(); ++o)
            if (by_groups)
                moved.row(o) = rest.row(order[std::size_t(o)]);
            else
                moved.row(o) = ((random.next() & 1u) != 0 ? -1.0 : 1.0) * rest.row(o);
        Squares const s = squares_of(moved, effect, all);
        reached += s.effect / std::max(s.error, 1e-300) >= least;
    }
    return double(reached) / (settings.permutations + 1);
}

/// Of an effect whose observers do not differ.
AnovaEffect without_test(AnovaEffect e)
{
    double const unknown = std::numeric_limits<double>::quiet_NaN();
    e.f = e.p = e.greenhouse_geisser = e.p_gg = e.huynh_feldt = e.p_hf = e.partial_eta2 = e.p_permutation =
        unknown;
    e.eta2 = {unknown, unknown};
    return e;
}

void check(Matrix const& cells, MixedDesign const& d)
{
    std::size_t count = 1;
    for (WithinFactor const& f : d.within) count *= std::size_t(std::max(0, f.levels));
    if (cells.columns != count)
        refuse(std::to_string(cells.columns) + " cells",
               "the factors have " + std::to_string(count) + " combinations", "give one column for each");
    for (BetweenFactor const& f : d.between)
        if (f.level.size() != cells.rows)
            refuse("groups of " + std::to_string(f.level.size()) + " observers",
                   "the table has " + std::to_string(cells.rows), "give the group of each observer");
    for (double const v : cells.values)
        if (!std::isfinite(v))
            refuse("a cell without a value", "the analysis needs all cells of every observer",
                   "leave incomplete observers out");
}

} // namespace

std::vector<AnovaEffect> mixed_anova(Matrix const& cells, MixedDesign const& design, AnovaSettings const& settings)
{
    check(cells, design);
    auto const observers = Index(cells.rows);
    MatrixXd y = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> const>(
        cells.values.data(), observers, Index(cells.columns));
    // Sums of squares that rounding of numbers of this size makes of 0.
    double const nothing = kRounding * kRounding * y.squaredNorm();
    y.array() -= mean(cells.values); // which no effect depends on, and which would take digits from all of them
    std::vector<Term> const between = between_terms(design.between, observers);
    Index columns = 0;
    for (Term const& t : between) columns += t.columns.cols();
    MatrixXd x(observers, columns);
    columns = 0;
    for (Term const& t : between) {
        x.middleCols(columns, t.columns.cols()) = t.columns;
        columns += t.columns.cols();
    }
    if (observers <= columns)
        refuse(std::to_string(observers) + " observers in " + std::to_string(columns) + " groups",
               "the variation within groups cannot be estimated", "test more observers");
    if (x.colPivHouseholderQr().rank() < columns)
        refuse("a combination of groups without observers", "its effects cannot be separated",
               "analyse one factor of groups at a time");
    MatrixXd const all = basis(x, MatrixXd(observers, 0));

    std::vector<AnovaEffect> effects;
    for (Term const& w : within_terms(design.within)) {
        MatrixXd const z = y * w.columns;
        MatrixXd const residual = z - all * (all.transpose() * z);
        double const k = double(z.cols()), error_df = double(observers - columns);
        MatrixXd const spread = residual.transpose() * residual / error_df;
        double gg = spread.trace() * spread.trace() / (k * spread.squaredNorm());
        double hf = ((error_df + 1) * k * gg - 2) / (k * (error_df - k * gg));
        if (!(hf > 0 && hf < 1)) hf = 1;
        if (!std::isfinite(gg)) gg = 1;
        for (Term const& b : between) {
            if (w.name.empty() && b.name.empty()) continue; // the mean of everything
            MatrixXd others(observers, columns - b.columns.cols());
            Index at = 0;
            for (Term const& other : between) {
                if (&other == &b) continue;
                others.middleCols(at, other.columns.cols()) = other.columns;
                at += other.columns.cols();
            }
            MatrixXd const own = basis(b.columns, others);
            Squares s = squares_of(z, own, all);
            if (!(s.effect > nothing)) s.effect = 0;
            AnovaEffect e;
            e.name = b.name;
            if (!w.name.empty()) append(e.name, w.name);
            e.is_between = !b.name.empty();
            e.is_within = !w.name.empty();
            e.squares = s.effect;
            e.df1 = double(b.columns.cols()) * k;
            e.df2 = error_df * k;
            if (!(s.error > nothing) && s.effect == 0) continue; // such as the mean of relative scores
            e.is_tested = s.error > nothing;
            if (!e.is_tested) {
                effects.push_back(without_test(std::move(e)));
                continue;
            }
            e.f = (s.effect / e.df1) / (s.error / e.df2);
            e.p = f_tail(e.f, e.df1, e.df2);
            e.greenhouse_geisser = gg;
            e.huynh_feldt = std::max(hf, gg);
            e.p_gg = f_tail(e.f, gg * e.df1, gg * e.df2);
            e.p_hf = f_tail(e.f, e.huynh_feldt * e.df1, e.huynh_feldt * e.df2);
            e.partial_eta2 = s.effect / (s.effect + s.error);
            e.eta2 = eta2_interval(e.f, e.df1, e.df2, settings.confidence);
            e.eta2.high = std::max(e.eta2.high, e.partial_eta2);
            e.p_permutation = settings.permutations > 0 ? permuted_p(z, own, others, all, e.is_between, settings,
                                                                     std::uint64_t(effects.size()))
                                                        : std::numeric_limits<double>::quiet_NaN();
            effects.push_back(std::move(e));
        }
    }
    if (effects.empty() && !(design.within.empty() && design.between.empty()))
        refuse("no variation", "all values are equal", "check the table");
    return effects;
}

} // namespace study
