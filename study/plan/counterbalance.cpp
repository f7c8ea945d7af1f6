#include "study/plan/counterbalance.h"

#include "study/plan/squares.h"

#include <algorithm>
#include <numeric>

namespace study {

int item_count(Script const& script, Counterbalance const& balance)
{
    return int(balance.factor >= 0 ? script.factors[std::size_t(balance.factor)].levels.size()
                                   : balance.blocks.size());
}

int cycle_length(Balance method, int items)
{
    if (items == 0) return 1; // of a script with mistakes
    switch (method) {
    case Balance::alternate:
        return items > 1 ? 2 : 1;
    case Balance::latin:
    case Balance::between:
        return items;
    case Balance::williams:
        return items % 2 == 1 && items > 1 ? 2 * items : items;
    default:
        return 1;
    }
}

std::int64_t full_cycle(Script const& script)
{
    constexpr std::int64_t kMost = std::int64_t(1) << 40;
    std::int64_t product = 1;
    for (Counterbalance const& c : script.counterbalances)
        product = std::min(kMost, product * cycle_length(c.method, item_count(script, c)));
    return product;
}

std::vector<int> digits(Script const& script, int participant)
{
    std::vector<int> out;
    int rest = participant - 1;
    for (Counterbalance const& c : script.counterbalances) {
        int const base = cycle_length(c.method, item_count(script, c));
        out.push_back(rest % base);
        rest /= base;
    }
    return out;
}

std::vector<int> balanced_order(Balance method, int items, int digit, Random& random)
{
    std::vector<int> order(static_cast<std::size_t>(items));
    std::iota(order.begin(), order.end(), 0);
    if (items == 0) return order;
    switch (method) {
    case Balance::fixed:
        break;
    case Balance::alternate:
        if (digit == 1) std::reverse(order.begin(), order.end());
        break;
    case Balance::latin:
        return latin_square(items)[std::size_t(digit)];
    case Balance::williams:
        return williams_square(items)[std::size_t(digit)];
    case Balance::random:
        random.shuffle(order);
        break;
    case Balance::between:
        return {digit};
    }
    return order;
}

} // namespace study
