#include "gi/core/option.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/core/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>

namespace gi {

char const* name_of(OptionType type)
{
    constexpr char const* kNames[] = {"word", "number", "whole number", "yes or no"};
    return kNames[int(type)];
}

OptionFacts::OptionFacts(std::string const& names, OptionValues values, std::string meaning_, OptionType type_)
    : OptionValues(std::move(values)), meaning(std::move(meaning_)), type(type_)
{
    std::istringstream in(names);
    std::getline(in, name, ',');
    key = name;
    std::ranges::replace(key, '-', '_');
    for (std::string one; std::getline(in, one, ',');) {
        std::ranges::replace(one, '-', '_');
        former.push_back(one);
    }
    if (type == OptionType::yes_or_no) words = {"false", "true"};
}

bool OptionFacts::is_called(std::string_view text) const
{
    std::string asked(text);
    std::ranges::replace(asked, '-', '_');
    return asked == key || std::ranges::find(former, asked) != former.end();
}

std::string OptionFacts::values_text() const
{
    if (takes_other_words) return "text";
    if (type == OptionType::number) return fmt::format("number from {} to {}", low, high);
    if (type == OptionType::whole_number) {
        double const most = double(UINT64_MAX);
        return fmt::format("whole number from {:.0f} to {}", low, high < most ? std::uint64_t(high) : UINT64_MAX);
    }
    std::string all = fmt::format("{}", fmt::join(words, ", "));
    return all.starts_with(',') ? "\"\"" + all : all;
}

OptionValue parse_value(OptionFacts const& o, std::string const& text, std::string const& given)
{
    auto const known = std::ranges::find(o.words, text);
    if (known != o.words.end()) return {0, std::uint64_t(known - o.words.begin())};
    if (!o.words.empty()) {
        std::string const near = suggest(text, o.words);
        throw InputError(given, "it is none of the known words",
                         (near.starts_with("did") ? near + " " : "") + "choose from: " + o.values_text());
    }
    OptionValue v{parse_finite(text).value_or(std::nan("")), 0};
    bool is_valid = v.number >= o.low && v.number <= o.high;
    if (is_valid && o.type == OptionType::whole_number) {
        auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), v.whole);
        if (error != std::errc{} || *end != 0) { // not all digits: 64.0
            is_valid = v.number < 0x1p64 && v.number == std::floor(v.number);
            v.whole = is_valid ? std::uint64_t(v.number) : 0;
        }
    }
    if (!is_valid) throw InputError(given, "it takes a " + o.values_text(), "give one of these");
    return v;
}

std::string number_text(double value) { return fmt::format("{}", value); }
std::string number_text(float value) { return fmt::format("{}", value); }

} // namespace gi
