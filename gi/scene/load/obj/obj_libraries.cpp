#include "gi/scene/load/obj/obj_libraries.h"

#include "gi/core/text.h"
#include "gi/scene/load/import_text.h"
#include "gi/scene/load/obj/obj_materials.h"
#include "gi/scene/load/obj/obj_text.h"

#include <algorithm>
#include <assimp/IOSystem.hpp>

namespace gi {
namespace {

bool ends_as_library(std::string_view name)
{
    return name.size() > 4 && equals_caseless(name.substr(name.size() - 4), ".mtl");
}

std::string with_slashes(std::string name)
{
    std::ranges::replace(name, '\\', '/');
    return name;
}

} // namespace

std::vector<std::string> library_names(std::string_view names)
{
    std::vector<std::string> all;
    bool has_ending = true; // a later word may end in .mtl
    for (names = trimmed(names); !names.empty(); names = trimmed(names)) {
        if (names.front() == '"' && names.find('"', 1) != names.npos) {
            names.remove_prefix(1);
            all.emplace_back(take_until(names, '"'));
            continue;
        }
        // Up to the next word that ends in .mtl; without one, the next word.
        std::string_view rest = names;
        std::size_t end = 0;
        while (has_ending && end == 0 && !rest.empty()) {
            std::string_view const word = take_word(rest);
            if (ends_as_library(word)) end = std::size_t(word.data() - names.data()) + word.size();
        }
        has_ending = end > 0;
        if (end == 0) {
            all.emplace_back(take_word(names));
        } else {
            all.emplace_back(names.substr(0, end));
            names.remove_prefix(end);
        }
    }
    return all;
}

/// Assimp's files also find "a/b.mtl" as "b.mtl" beside the model; names are told apart here.
bool ObjLibraries::exists(std::filesystem::path const& file) const { return files_.Exists(file.string().c_str()); }

void ObjLibraries::read(std::string_view names)
{
    std::string const whole{trimmed(names)};
    if (exists(obj_.parent_path() / with_slashes(whole))) return read_one(whole);
    for (std::string const& name : library_names(names)) read_one(name);
}

void ObjLibraries::read_one(std::string const& name)
{
    if (name.empty() || !asked_.insert(name).second) return;
    std::filesystem::path const folder = obj_.parent_path(), written = folder / with_slashes(name),
                                beside = folder / written.filename(),
                                own = std::filesystem::path(obj_).replace_extension("mtl");
    auto const is_file = [](std::filesystem::path const& file) {
        std::error_code error;
        return std::filesystem::is_regular_file(file, error);
    };
    std::filesystem::path const* const taken = is_file(written)  ? &written
                                               : is_file(beside) ? &beside
                                               : exists(written) ? &written
                                               : exists(own)     ? &own
                                                                 : nullptr;
    if (taken == nullptr) return notes_.lose("material libraries that could not be read", 1, written.string());
    if (!is_file(written))
        notes_.lose("material libraries not found, another one taken", 1,
                    written.string() + ": " + taken->string());
    if (!read_.insert(taken->lexically_normal().string()).second) return;
    if (auto const mtl = import_text(taken->string(), files_))
        materials_.read(*mtl, taken->string());
    else
        notes_.lose("material libraries that could not be read", 1, taken->string());
}

} // namespace gi
