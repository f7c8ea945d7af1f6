#pragma once
// The likelihood of choices between two items with an order effect and a threshold of ties: see pair_scale.h.

#include "study/stats/likelihood.h"
#include "study/stats/pair_scale.h"

namespace study {

/// Layout of the parameters: scores of all items except the first, which is 0, then the order effect b and the
/// threshold t of ties, if they are fitted.
struct PairParameters {
    int items = 0;
    bool has_order = false, has_threshold = false;

    std::size_t order_at() const { return std::size_t(items - 1); }
    std::size_t threshold_at() const { return order_at() + has_order; }
    std::size_t count() const { return threshold_at() + has_threshold; }
};

inline constexpr double kLeastTieThreshold = 1e-3; ///< below, a tie has no probability

/// Adds the choices of one pair to log-likelihood, gradient and expected information. Without a threshold ties
/// count half for each item.
void add_pair(PairModel model, PairParameters const& layout, PairCount const& pair, std::span<double const> at,
              Likelihood& sum);

} // namespace study
