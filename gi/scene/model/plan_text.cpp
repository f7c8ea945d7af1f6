#include "gi/scene/model/plan_text.h"

#include <fmt/format.h>

namespace gi {

Figure figure(std::string key, double value, int digits)
{
    return {{std::move(key), value}, fmt::format("{:.{}g}", value, digits)};
}

Figure figure_of_bytes(std::string key, std::uint64_t bytes)
{
    return {{std::move(key), std::int64_t(bytes)}, fmt::format("{:.3g} MB", double(bytes) * 1e-6)};
}

PlanText::PlanText(char const* words, std::initializer_list<Figure> figures) : text(words)
{
    std::size_t at = 0;
    for (Figure const& f : figures) {
        at = text.find("{}", at);
        text.replace(at, 2, f.text); // throws std::out_of_range where there are more numbers than places
        at += f.text.size();
        numbers.push_back(f.number);
    }
}

PlanText& PlanText::operator+=(PlanText const& more)
{
    text += more.text;
    numbers.insert(numbers.end(), more.numbers.begin(), more.numbers.end());
    return *this;
}

} // namespace gi
