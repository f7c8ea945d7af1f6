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
    auto const bytes = gi::read_bytes(file, std::size_t(1) << 20);
    LoadedScript loaded{{}, {bytes.begin(), bytes.end()}, std::filesystem::path(file).parent_path()};
    loaded.script = study::parse_script(loaded.text, file);
    check_text_files(loaded.script, loaded.folder);
    return loaded;
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
