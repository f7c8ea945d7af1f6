#pragma once
// A sentence of a plan together with the numbers in it, so that people read what programs get as data.

#include <cstdint>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace gi {

/// A number of a plan. The key ends in the unit, if there is one: "cell_m", "memory_bytes", "triangles".
struct PlanNumber {
    std::string key;
    std::variant<std::int64_t, double> value;
};

/// A number as a sentence shows it.
struct Figure {
    PlanNumber number;
    std::string text;
};
Figure figure(std::string key, double value, int digits); ///< @param digits  significant ones
template <class T>
requires std::is_integral_v<T> Figure figure(std::string key, T value)
{
    return {{std::move(key), std::int64_t(value)}, std::to_string(value)};
}
/// Shown in MB, with three significant digits.
Figure figure_of_bytes(std::string key, std::uint64_t bytes);

class PlanText {
public:
    std::string text;
    std::vector<PlanNumber> numbers;

    PlanText(char const* words) : text(words) {}
    PlanText(std::string words) : text(std::move(words)) {}
    /// @param words  with "{}" where each of the numbers is shown
    PlanText(char const* words, std::initializer_list<Figure> figures);
    PlanText& operator+=(PlanText const& more);
    friend PlanText operator+(PlanText one, PlanText const& more) { return std::move(one += more); }
};

} // namespace gi
