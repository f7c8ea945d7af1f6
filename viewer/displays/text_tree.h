#pragma once
// Nested blocks of keywords and values, as Equalizer and Vrui write them.

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

/// A keyword with what stands behind it up to the next one, or with a block of others.
struct TextNode {
    std::string key;
    std::vector<TextToken> values;
    std::vector<TextNode> children;
    int line = 0, column = 0;

    /// nullptr where there is none.
    TextNode const* find(std::string const& wanted) const;
    /// The first value of the child, or `otherwise`.
    std::string text(std::string const& wanted, std::string const& otherwise = {}) const;
};

/// Texts in double quotes are one token; '#' starts a comment up to the end of its line; each of `marks` is a
/// token of its own. Throws InputError on an open quote or more than 1 MiB.
std::vector<TextToken> tokens_of(std::string const& text, std::string const& marks, std::string const& file);
/// Throws InputError naming the token.
double number_of(TextToken const& token, std::string const& file);
/// The values of the node must be `count` numbers.
std::vector<double> numbers_of(TextNode const& node, std::size_t count, std::string const& file);
gi::dvec3 point_of(TextNode const& node, std::string const& file);

inline constexpr int kDeepestBlock = 100;

} // namespace viewer
