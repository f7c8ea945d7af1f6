#include "study/plan/squares.h"

#include <algorithm>

namespace study {

Square latin_square(int n)
{
    Square rows;
    for (int r = 0; r < n; ++r) {
        rows.emplace_back();
        for (int i = 0; i < n; ++i) rows.back().push_back((r + i) % n);
    }
    return rows;
}

Square williams_square(int n)
{
    std::vector<int> zigzag; // 0, 1, n-1, 2, n-2, ...: neighbours differ by 1, -2, 3, ..., each once mod n
    for (int i = 0; i < n; ++i) zigzag.push_back(i % 2 == 1 ? (i + 1) / 2 : (n - i / 2) % n);
    Square rows;
    for (int r = 0; r < n; ++r) {
        rows.emplace_back();
        for (int const z : zigzag) rows.back().push_back((z + r) % n);
    }
    if (n % 2 == 1 && n > 1)
        for (int r = 0; r < n; ++r) rows.emplace_back(rows[std::size_t(r)].rbegin(), rows[std::size_t(r)].rend());
    return rows;
}

} // namespace study
