#pragma once
// An option: a named value in a struct of settings that people give as text. A table of options is all that the
// command line, the panel, scripts, the remote protocol and Python know about the struct.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace gi {

enum class OptionType : std::uint8_t { word, number, whole_number, yes_or_no };
char const* name_of(OptionType type);

/// What people need to know of an option.
struct OptionFacts {
    std::string name;                ///< on the command line, without dashes in front: "hit-buffer"
    std::string key;                 ///< in scripts, files and Python: "hit_buffer"
    std::vector<std::string> former; ///< earlier keys, which are still understood
    OptionType type = OptionType::word;
    std::string meaning; ///< for users, with the unit
    std::vector<std::string> words;
    bool takes_other_words = false; ///< the words are examples
    double low = 0, high = 0;       ///< range of numbers; whole numbers are not negative
};

/// @param names  the name and former ones, comma-separated: "light-samples,lamps"
OptionFacts word_option(std::string const& names, std::vector<std::string> words, std::string meaning);
OptionFacts number_option(std::string const& names, double low, double high, std::string meaning);
OptionFacts whole_option(std::string const& names, double low, double high, std::string meaning);
OptionFacts flag_option(std::string const& names, std::string meaning);

/// "a whole number from 0 to 64", "true or false" or "cpu, cuda".
std::string values_text(OptionFacts const& option);

/// True for the name, the key and former ones.
bool is_called(OptionFacts const& option, std::string_view name);

/// Parse the text of a value. Throw InputError about `given`: the option and its value as the user wrote them.
double parse_number(OptionFacts const& option, std::string const& text, std::string const& given);
std::uint64_t parse_whole(OptionFacts const& option, std::string const& text, std::string const& given);
bool parse_flag(OptionFacts const& option, std::string const& text, std::string const& given);
/// Returns the index in `words`.
std::size_t parse_word(OptionFacts const& option, std::string const& text, std::string const& given);

std::string option_text(double value);
std::string option_text(float value);
std::string option_text(std::uint64_t value);

template <class Settings>
struct Option : OptionFacts {
    /// Throws InputError about `given`, the option and its value as the user wrote them, if the text is no value.
    std::function<void(Settings&, std::string const& text, std::string const& given)> set;
    std::function<std::string(Settings const&)> get; ///< as text for set()
};

/// @param member  returns a reference to the value in given settings: a bool, number, text, or an enumerator whose
/// number is an index in `words`
template <class Settings, class Member>
Option<Settings> make_option(OptionFacts facts, Member member)
{
    using T = std::remove_cvref_t<decltype(member(std::declval<Settings&>()))>;
    Option<Settings> o{facts, {}, {}};
    o.set = [facts, member](Settings& s, std::string const& text, std::string const& given) {
        T& value = member(s);
        if constexpr (std::is_same_v<T, bool>)
            value = parse_flag(facts, text, given);
        else if constexpr (std::is_same_v<T, std::string>)
            value = facts.words[parse_word(facts, text, given)];
        else if constexpr (std::is_enum_v<T>)
            value = T(parse_word(facts, text, given));
        else if constexpr (std::is_integral_v<T>)
            value = T(parse_whole(facts, text, given));
        else
            value = T(parse_number(facts, text, given));
    };
    o.get = [facts, member](Settings const& s) -> std::string {
        T const& value = member(s);
        if constexpr (std::is_same_v<T, bool>)
            return value ? "true" : "false";
        else if constexpr (std::is_same_v<T, std::string>)
            return value;
        else if constexpr (std::is_enum_v<T>)
            return facts.words[std::size_t(value)];
        else if constexpr (std::is_integral_v<T>)
            return option_text(std::uint64_t(value));
        else
            return option_text(value);
    };
    return o;
}

} // namespace gi
