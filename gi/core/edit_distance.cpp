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

std::optional<std::string> nearest_word(std::string const& word, std::vector<std::string> const& known)
{
    std::optional<std::string> nearest;
    int least = std::max(1, int(word.size()) / 2) + 1;
    for (std::string const& name : known)
        if (int const distance = edit_distance(name, word); distance < least) {
            least = distance;
            nearest = name;
        }
    return nearest;
}

std::string suggest(std::string const& word, std::vector<std::string> const& known, std::string const& otherwise)
{
    if (auto const nearest = nearest_word(word, known)) return "did you mean '" + *nearest + "'?";
    if (!otherwise.empty()) return otherwise;
    if (known.empty()) return "remove it";
    constexpr std::size_t kAll = 48, kSome = 24;
    std::size_t const told = known.size() > kAll ? kSome : known.size();
    std::string all;
    for (std::size_t i = 0; i < told; ++i) all += (i ? ", " : "") + known[i];
    if (told < known.size()) all += " and " + std::to_string(known.size() - told) + " more";
    return "there are: " + all;
}

} // namespace gi
