#include "gi/scene/load/obj/mtl_map.h"

#include "gi/core/text.h"
#include "gi/scene/load/obj/obj_text.h"

#include <array>

namespace gi {
namespace {

enum class MtlValue : std::uint8_t { numbers, on_off, word };

struct MtlOption {
    std::string_view name;
    MtlValue value;
    std::size_t most = 1; ///< numbers that may follow
};
constexpr MtlOption kMtlOptions[]{
    {"-s", MtlValue::numbers, 3},  {"-o", MtlValue::numbers, 3},    {"-t", MtlValue::numbers, 3},
    {"-mm", MtlValue::numbers, 2}, {"-bm", MtlValue::numbers, 1},   {"-boost", MtlValue::numbers, 1},
    {"-blendu", MtlValue::on_off}, {"-blendv", MtlValue::on_off},   {"-cc", MtlValue::on_off},
    {"-clamp", MtlValue::on_off},  {"-imfchan", MtlValue::word},    {"-texres", MtlValue::word},
    {"-type", MtlValue::word},     {"-colorspace", MtlValue::word},
};

/// An option with its values, as it is written.
struct WrittenOption {
    MtlOption const* option = nullptr; ///< null = not known
    std::string text;
    std::vector<float> numbers;
    std::string word; ///< in lower case
};

std::string in_lower_case(std::string_view word)
{
    std::string lower(word);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lower;
}

bool is_on_or_off(std::string_view word) { return equals_caseless(word, "on") || equals_caseless(word, "off"); }

std::string_view next_word(std::string_view text) { return take_word(text); }

/// Takes an option from the front. A known one without its value is taken alone, if it need not be right.
/// @return nothing if there is none
std::optional<WrittenOption> take_option(std::string_view& text, bool must_be_right)
{
    std::string_view rest = text;
    std::string_view const name = take_word(rest);
    WrittenOption o;
    for (MtlOption const& known : kMtlOptions)
        if (equals_caseless(name, known.name)) o.option = &known;
    bool const looks_like_one = name.size() > 1 && name[0] == '-' && !number_word(name);
    if (o.option == nullptr && (must_be_right || !looks_like_one)) return std::nullopt;
    o.text = name;
    auto const take_value = [&] { o.text += " " + std::string(take_word(rest)); };
    if (o.option == nullptr) {
        while (number_word(next_word(rest)) || is_on_or_off(next_word(rest))) take_value();
    } else if (o.option->value == MtlValue::numbers) {
        while (o.numbers.size() < o.option->most && number_word(next_word(rest))) {
            o.numbers.push_back(*number_word(next_word(rest)));
            take_value();
        }
        if (o.numbers.empty() && must_be_right) return std::nullopt;
    } else if (o.option->value == MtlValue::word || is_on_or_off(next_word(rest))) {
        o.word = in_lower_case(next_word(rest));
        if (o.word.empty() && must_be_right) return std::nullopt;
        take_value();
    } else if (must_be_right) {
        return std::nullopt;
    }
    text = rest;
    return o;
}

void apply(WrittenOption const& o, MtlMap& map)
{
    auto const number = [&](std::size_t i, float otherwise) {
        return i < o.numbers.size() ? o.numbers[i] : otherwise;
    };
    std::string_view const name = o.option != nullptr ? o.option->name : "";
    bool is_used = false, changes_nothing = false;
    if (name == "-s") {
        map.scale_u = number(0, 1);
        map.scale_v = number(1, 1);
        is_used = !o.numbers.empty();
    } else if (name == "-o") {
        map.offset_u = number(0, 0);
        map.offset_v = number(1, 0);
        is_used = !o.numbers.empty();
    } else if (name == "-clamp") {
        map.clamped = o.word == "on";
        is_used = !o.word.empty();
    } else if (name == "-bm") {
        map.bump = number(0, 1);
        is_used = !o.numbers.empty();
    } else if (name == "-imfchan") {
        map.channel = o.word.size() == 1 && std::string_view("rgbmlz").find(o.word[0]) != std::string_view::npos
                          ? o.word[0]
                          : '\0';
        is_used = map.channel != 0;
    } else if (name == "-t") {
        changes_nothing = number(0, 0) == 0 && number(1, 0) == 0 && number(2, 0) == 0;
    } else if (name == "-mm") {
        changes_nothing = number(0, 0) == 0 && number(1, 1) == 1;
    } else if (name == "-boost") {
        changes_nothing = number(0, 0) == 0;
    } else if (name == "-cc") {
        changes_nothing = o.word == "off";
    } else if (name == "-blendu" || name == "-blendv") {
        changes_nothing = o.word == "on";
    } else if (name == "-colorspace") {
        changes_nothing = o.word == "auto";
    }
    if (!is_used && !changes_nothing) map.dropped.push_back(o.text);
}

/// Removes options at the end of a text, if it has anything before them.
std::vector<WrittenOption> take_options_at_end(std::string_view& text)
{
    std::vector<bool> fails(text.size() + 1); // from that character on there are not only options
    for (std::size_t at = text.find(" -"); at != text.npos; at = text.find(" -", at + 1)) {
        if (trimmed(text.substr(0, at)).empty()) continue;
        std::string_view rest = text.substr(at);
        std::vector<WrittenOption> options;
        std::vector<std::size_t> begins;
        while (!(rest = trimmed(rest)).empty()) {
            begins.push_back(std::size_t(rest.data() - text.data()));
            if (fails[begins.back()]) break;
            auto option = take_option(rest, true);
            if (!option) break;
            options.push_back(std::move(*option));
        }
        if (!rest.empty()) {
            for (std::size_t const begin : begins) fails[begin] = true;
            continue;
        }
        text = text.substr(0, at);
        return options;
    }
    return {};
}

} // namespace

std::optional<float> number_word(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    auto const value = parse_number<float>(word);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

MtlMap read_mtl_map(std::string_view values)
{
    MtlMap map;
    values = trimmed(values);
    while (auto const option = take_option(values, false)) apply(*option, map);
    values = trimmed(values);
    for (WrittenOption const& option : take_options_at_end(values)) apply(option, map);
    values = trimmed(values);
    if (values.size() > 1 && values.front() == '"' && values.back() == '"')
        values = values.substr(1, values.size() - 2);
    map.file = values;
    return map;
}

} // namespace gi
