#pragma once
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace gi {

/// Parses the whole text as a finite number, independent of the locale; nullopt if it is none.
inline std::optional<double> to_number(std::string_view text)
{
    double value = 0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

} // namespace gi
