#include "gi/core/edit_distance.h"

#include <algorithm>
#include <numeric>

namespace gi {

int edit_distance(std::string const& a, std::string const& b)
{
    std::vector<int> before, above(b.size() + 1), row(b.size() + 1);
    std::iota(above.begin(), above.end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = int(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = above;
        above = row;
    }
    return above.back();
}

std::string suggest(std::string const& word, std::vector<std::string> const& known)
{
    std::string all;
    std::string const* nearest = nullptr;
    int least = std::max(1, int(word.size()) / 2) + 1;
    for (std::size_t i = 0; i < known.size(); ++i) {
        int const distance = edit_distance(known[i], word);
        if (distance < least) {
            least = distance;
            nearest = &known[i];
        }
        if (i < 24) all += (i ? ", " : "") + known[i];
    }
    if (nearest != nullptr) return "did you mean '" + *nearest + "'?";
    return known.empty() ? "remove it" : "there are: " + all;
}

} // namespace gi
