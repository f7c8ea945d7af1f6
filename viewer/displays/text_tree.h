#pragma once
// Nested blocks of keywords and values, as in files of Equalizer and Vrui.

#include "gi/core/error.h"
#include "gi/core/math.h"

#include <string>
#include <vector>

namespace viewer {

struct TextToken {
    std::string text;
    bool is_quoted = false;
    int line = 0, column = 0;
};

/// A keyword with its values, or with a block of child nodes.
struct TextNode {
    std::string key;
    std::vector<TextToken> values;
    std::vector<TextNode> children;
    int line = 0, column = 0;
    int file = 0; ///< index, where several files are merged

    /// Child with this key; nullptr if there is none.
    TextNode const* find(std::string const& wanted) const;
    /// The first value of the child, or `otherwise`.
    std::string text(std::string const& wanted, std::string const& otherwise = {}) const;
};

/// Text in double quotes is one token, as is a character in single ones; '#' starts a comment to the end of the
/// line; each character of `marks` is a separate token. Throws InputError on an unclosed quote or more than 1 MiB.
std::vector<TextToken> tokens_of(std::string const& text, std::string const& marks, std::string const& file);
/// Throws InputError, naming the token, if it is not a number.
double number_of(TextToken const& token, std::string const& file);
/// Values of a node; throws InputError unless they are `count` numbers.
std::vector<double> numbers_of(TextNode const& node, std::size_t count, std::string const& file);
gi::dvec3 point_of(TextNode const& node, std::string const& file);

inline constexpr int kDeepestBlock = 100;

} // namespace viewer
