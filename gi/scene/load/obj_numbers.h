#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace gi {

/// Writes numbers such as ".3" in vertex lines of an OBJ text as "0.3": Assimp 5.2 takes only the latter for a
/// number and drops the vertex. @returns nothing if there is none
std::optional<std::string> with_leading_zeros(std::string_view obj);

} // namespace gi
