#pragma once
// An option: a named value in a struct of settings that people give as text. A table of options is all that the
// command line, the panel, scripts, the remote protocol and Python know about the struct.

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace gi {

/// The value of an option with the words on and off.
enum class Switch : std::uint8_t { on, off };

enum class OptionType : std::uint8_t { word, number, whole_number, yes_or_no };
char const* name_of(OptionType type);

/// The range of a number, in which whole numbers are not negative, or words.
struct OptionValues {
    OptionValues() = default;
    OptionValues(double low_, double high_) : low(low_), high(high_) {}
    OptionValues(std::initializer_list<char const*> all) : words(all.begin(), all.end()) {}
    OptionValues(std::vector<std::string> all) : words(std::move(all)) {}

    double low = 0, high = 1;
    std::vector<std::string> words;
    bool takes_other_words = false; ///< the words are examples
};

/// What people need to know of an option.
struct OptionFacts : OptionValues {
    /// @param names  the name and former ones, comma-separated: "light-samples,lamps"
    OptionFacts(std::string const& names, OptionValues values, std::string meaning, OptionType type);

    std::string name;                ///< on the command line, without dashes in front: "hit-buffer"
    std::string key;                 ///< in scripts, files and Python: "hit_buffer"
    std::vector<std::string> former; ///< earlier keys, which are still understood
    std::string meaning;             ///< for users, with the unit
    OptionType type;

    /// True for the name, the key and former ones.
    bool is_called(std::string_view text) const;
    /// "whole number from 0 to 64" or "cpu, cuda"
    std::string values_text() const;
};

struct OptionValue {
    double number = 0;
    std::uint64_t whole = 0; ///< a whole number, the index of a word, or 1 for true
};
/// Throws InputError about `given`, the option and its value as the user wrote them, if the text is no value.
OptionValue parse_value(OptionFacts const& option, std::string const& text, std::string const& given);
std::string number_text(double value);
std::string number_text(float value);

template <class Settings>
struct Option : OptionFacts {
    std::function<void(Settings&, std::string const& text, std::string const& given)> set; ///< as parse_value()
    std::function<std::string(Settings const&)> get;                                       ///< as text for set()
};

/// @param member  returns a reference to the value in given settings: a bool, number, text, or an enumerator whose
/// number is an index in `words`
template <class Settings, class Member>
Option<Settings> make_option(std::string const& names, OptionValues values, std::string meaning, Member member)
{
    using T = std::remove_cvref_t<decltype(member(std::declval<Settings&>()))>;
    constexpr bool kWord = std::is_same_v<T, std::string> || std::is_enum_v<T>;
    constexpr auto kType = kWord                         ? OptionType::word
                           : std::is_same_v<T, bool>     ? OptionType::yes_or_no
                           : std::is_floating_point_v<T> ? OptionType::number
                                                         : OptionType::whole_number;
    OptionFacts const facts(names, std::move(values), std::move(meaning), kType);
    auto const set = [facts, member](Settings& s, std::string const& text, std::string const& given) {
        OptionValue const v = parse_value(facts, text, given);
        if constexpr (std::is_same_v<T, std::string>)
            member(s) = text;
        else
            member(s) = std::is_floating_point_v<T> ? T(v.number) : T(v.whole);
    };
    auto const get = [facts, member](Settings const& s) -> std::string {
        T const& value = member(s);
        if constexpr (std::is_same_v<T, std::string>) return value;
        if constexpr (std::is_same_v<T, bool>) return value ? "true" : "false";
        if constexpr (std::is_enum_v<T>) return facts.words[std::size_t(value)];
        if constexpr (std::is_floating_point_v<T>) return number_text(value);
        if constexpr (std::is_integral_v<T>) return std::to_string(value);
    };
    return {facts, set, get};
}

} // namespace gi
