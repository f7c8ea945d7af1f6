#include "viewer/batch/former_command.h"

#include "gi/methods/names.h"
#include "viewer/batch/command_words.h"

namespace viewer::batch {
namespace {

/// Names of methods, separated by commas, each maybe with a variant: "slhb:stored,reference".
std::string current_methods(std::string const& names)
{
    std::string out;
    for (std::size_t at = 0; at <= names.size();) {
        std::size_t const end = std::min(names.find_first_of(":,", at), names.size());
        bool const is_variant = at > 0 && names[at - 1] == ':';
        std::string const name = names.substr(at, end - at);
        out += is_variant ? name : std::string(gi::method_of_0_1(name));
        if (end < names.size()) out += names[end];
        at = end + 1;
    }
    return out;
}

} // namespace

std::vector<std::string> current_command(std::vector<std::string> command)
{
    if (command.empty()) return command;
    bool const is_render = command.front() == "render";
    bool const is_pictures = command.size() > 1 && command[0] == "bench" && command[1] == "pictures";
    CommandWords words(std::move(command));
    for (char const* const option : {"--method", "--methods"})
        if (auto const names = words.value(option)) words.set(option, current_methods(*names));
    for (std::string& w : words.all()) // of --set
        for (std::string_view const key : {"method=", "compare=", "--set=method=", "--set=compare="})
            if (w.starts_with(key)) w = std::string(key) + std::string(gi::method_of_0_1(w.substr(key.size())));
    auto const add = [&](char const* option, std::string const& usual) {
        if (!words.has(option)) words.all().insert(words.all().end(), {option, usual});
    };
    if (is_render) add("--method", std::string(gi::kRenderMethodOf01));
    if (is_pictures)
        add("--methods",
            current_methods(words.has("--interactive") ? "reference,slhb" : "reference,slhb,vpl_slhb"));
    return std::move(words.all());
}

} // namespace viewer::batch
