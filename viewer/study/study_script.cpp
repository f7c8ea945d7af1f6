#include "viewer/study/study_script.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"
#include "study/script/script_file.h"

#include <fmt/format.h>
#include <numeric>
#include <set>
#include <sstream>

namespace viewer {

LoadedScript load_script(std::string const& file)
{
    ScriptToCheck read = load_script_to_check(file);
    if (!read.mistakes.empty()) throw read.mistakes.in_order().front();
    return std::move(read.loaded);
}

ScriptToCheck load_script_to_check(std::string const& file)
{
    auto const bytes = gi::read_bytes(file, std::size_t(1) << 20);
    ScriptToCheck out;
    out.loaded.text = {bytes.begin(), bytes.end()};
    out.loaded.folder = std::filesystem::path(file).parent_path();
    study::ReadScript read = study::read_script(out.loaded.text, file);
    out.loaded.script = std::move(read.script);
    out.mistakes = std::move(read.mistakes);
    out.is_whole = read.is_whole;
    if (out.is_whole) find_missing_texts(out.loaded.script, out.loaded.folder, out.mistakes);
    return out;
}

std::vector<int> parse_participants(std::string const& text, int count)
{
    std::vector<int> all(static_cast<std::size_t>(count));
    std::iota(all.begin(), all.end(), 1);
    if (text.empty()) return all;
    auto const number = [&](std::string const& part) {
        auto const n = gi::parse_number<int>(part);
        if (!n || *n < 1 || *n > count)
            throw gi::InputError(fmt::format("participants '{}'", text),
                                 fmt::format("'{}' is not one of 1 to {}", part, count),
                                 "write 3, 1..24 or 1,4,7..9, or raise participants.count");
        return *n;
    };
    std::set<int> chosen;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, ',');) {
        auto const dots = part.find("..");
        int const first = number(part.substr(0, dots));
        int const last = dots == std::string::npos ? first : number(part.substr(dots + 2));
        if (last < first) number(""); // throws the message with the suggestion
        for (int n = first; n <= last; ++n) chosen.insert(n);
    }
    return {chosen.begin(), chosen.end()};
}

void print_doubts(std::vector<std::string> const& doubts)
{
    std::fflush(stdout);
    for (std::string const& doubt : doubts) std::fputs(("doubt: " + doubt + "\n").c_str(), stderr);
}

} // namespace viewer
