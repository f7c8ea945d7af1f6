#include "gi/core/option.h"

#include "gi/core/error.h"
#include "gi/core/to_number.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gi {
namespace {

std::string key_of(std::string name)
{
    std::ranges::replace(name, '-', '_');
    return name;
}

OptionFacts named(std::string const& names, OptionType type, std::string meaning)
{
    OptionFacts o;
    o.type = type;
    o.meaning = std::move(meaning);
    std::size_t const end = std::min(names.find(','), names.size());
    o.name = names.substr(0, end);
    o.key = key_of(o.name);
    for (std::size_t at = end; at < names.size();) {
        std::size_t const next = std::min(names.find(',', at + 1), names.size());
        o.former.push_back(key_of(names.substr(at + 1, next - at - 1)));
        at = next;
    }
    return o;
}

InputError bad(OptionFacts const& o, std::string const& given)
{
    return {given, "it takes " + values_text(o), "give one of these"};
}

} // namespace

char const* name_of(OptionType type)
{
    constexpr char const* kNames[] = {"word", "number", "whole number", "yes or no"};
    return kNames[int(type)];
}

OptionFacts word_option(std::string const& names, std::vector<std::string> words, std::string meaning)
{
    OptionFacts o = named(names, OptionType::word, std::move(meaning));
    o.words = std::move(words);
    return o;
}

OptionFacts number_option(std::string const& names, double low, double high, std::string meaning)
{
    OptionFacts o = named(names, OptionType::number, std::move(meaning));
    o.low = low;
    o.high = high;
    return o;
}

OptionFacts whole_option(std::string const& names, double low, double high, std::string meaning)
{
    OptionFacts o = number_option(names, low, high, std::move(meaning));
    o.type = OptionType::whole_number;
    return o;
}

OptionFacts flag_option(std::string const& names, std::string meaning)
{
    OptionFacts o = named(names, OptionType::yes_or_no, std::move(meaning));
    o.high = 1;
    return o;
}

std::string values_text(OptionFacts const& o)
{
    constexpr double kAll = 0x1p64;
    std::vector<std::string> words = o.words;
    std::ranges::replace(words, std::string(), std::string("\"\""));
    switch (o.type) {
    case OptionType::number:
        return fmt::format("a number from {} to {}", o.low, o.high);
    case OptionType::whole_number:
        return fmt::format("a whole number from {:.0f} to {}", o.low,
                           o.high < kAll ? fmt::format("{:.0f}", o.high) : std::to_string(UINT64_MAX));
    case OptionType::yes_or_no:
        return "true or false";
    case OptionType::word:
        break;
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

bool is_called(OptionFacts const& o, std::string_view name)
{
    std::string const key = key_of(std::string(name));
    return key == o.key || std::ranges::find(o.former, key) != o.former.end();
}

double parse_number(OptionFacts const& o, std::string const& text, std::string const& given)
{
    auto const v = to_number(text);
    if (!v || *v < o.low || *v > o.high) throw bad(o, given);
    return *v;
}

std::uint64_t parse_whole(OptionFacts const& o, std::string const& text, std::string const& given)
{
    std::uint64_t value = 0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size()) { // numbers may have more bits than a double
        if (double(value) < o.low || double(value) > o.high) throw bad(o, given);
        return value;
    }
    double const v = parse_number(o, text, given); // 64.0
    if (v != std::floor(v) || v < 0 || v >= 0x1p64) throw bad(o, given);
    return std::uint64_t(v);
}

bool parse_flag(OptionFacts const& o, std::string const& text, std::string const& given)
{
    if (text == "true" || text == "false") return text == "true";
    throw bad(o, given);
}

std::size_t parse_word(OptionFacts const& o, std::string const& text, std::string const& given)
{
    auto const found = std::ranges::find(o.words, text);
    if (found != o.words.end()) return std::size_t(found - o.words.begin());
    throw InputError(given, "it is none of the known words", "choose from: " + values_text(o));
}

std::string option_text(double value) { return fmt::format("{}", value); }
std::string option_text(float value) { return fmt::format("{}", value); }
std::string option_text(std::uint64_t value) { return std::to_string(value); }

} // namespace gi
