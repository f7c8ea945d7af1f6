// Includes run one way: what docs/architecture.md says of each folder is what its files do.

#include "tests/viewer/run_program.h"

#include <functional>
#include <map>
#include <optional>
#include <set>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

/// Folder -> the folders it may include (itself is always allowed).
using Table = std::map<std::string, std::set<std::string>>;

struct Include {
    std::string where;    ///< file:line: #include "..."
    std::string from, to; ///< folders
};

std::string trimmed(std::string const& text, std::string const& blanks = " `")
{
    auto const first = text.find_first_not_of(blanks);
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> split(std::string const& text, char at)
{
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, at);) parts.push_back(trimmed(part));
    return parts;
}

/// The rows of the table "folder | what it knows | may include".
Table allowed_includes()
{
    std::vector<std::pair<std::string, std::string>> rows;
    std::istringstream in(file_text(LIGHTWELL_SOURCE_DIR "/docs/architecture.md"));
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("| `"))
            if (auto const cells = split(line, '|'); cells.size() == 4) rows.emplace_back(cells[1], cells[3]);

    Table table;
    for (auto const& [folder, may] : rows) {
        std::set<std::string>& targets = table[folder];
        for (std::string const& name : split(may, ',')) {
            std::size_t const before = targets.size();
            for (auto const& [target, unused] : rows) {
                // Folders of study, ar and viewer/ar are named in full: `base` alone is gi/base.
                bool const in_full =
                    target.starts_with("study/") || target.starts_with("ar/") || target.starts_with("viewer/ar/");
                bool const is_named = target == name || (!in_full && target.ends_with("/" + name));
                bool const in_all = name == "all" && target != "tests" && target != "python";
                bool const in_gi = name == "all of `gi" && target.starts_with("gi/");
                if (is_named || in_all || in_gi) targets.insert(target);
            }
            EXPECT_TRUE(name == "—" || targets.size() > before)
                << "docs/architecture.md: '" << folder << "' may include '" << name
                << "', which names nothing new";
        }
    }
    return table;
}

/// The longest folder of the table that holds the path; empty = none.
std::string folder_of(std::string const& path, Table const& table)
{
    std::string best;
    for (auto const& [folder, unused] : table)
        if (path.starts_with(folder + "/") && folder.size() > best.size()) best = folder;
    return best;
}

std::vector<Include> all_includes(fs::path const& root, Table const& table)
{
    static std::set<std::string> const kGenerated{"git_hash.h"};
    std::vector<Include> found;
    for (char const* top : {"gi", "ar", "study", "viewer", "python", "tests"}) {
        if (!fs::is_directory(root / top)) continue;
        for (auto const& entry : fs::recursive_directory_iterator(root / top)) {
            static std::set<std::string> const kCode{".h", ".cpp", ".cu", ".cuh"};
            if (!kCode.contains(entry.path().extension().string())) continue;
            std::string const file = fs::relative(entry.path(), root).string();
            std::ifstream in(entry.path());
            int number = 0;
            for (std::string line; std::getline(in, line);) {
                ++number;
                if (!line.starts_with("#include \"")) continue;
                std::string const target = line.substr(10, line.find('"', 10) - 10);
                std::string const where = file + ":" + std::to_string(number) + ": " + line;
                if (kGenerated.contains(target)) continue;
                EXPECT_TRUE(fs::exists(root / target))
                    << where << "\n  is no path from the root of the repository";
                found.push_back({where, folder_of(file, table), folder_of(target, table)});
            }
        }
    }
    return found;
}

/// A way from `at` back to `goal`, both included; empty = none.
std::vector<std::string> way_back(std::string const& at, std::string const& goal,
                                  std::map<std::string, std::map<std::string, std::string>> const& arrows)
{
    std::set<std::string> seen;
    std::function<std::vector<std::string>(std::string const&)> const walk = [&](std::string const& from) {
        if (from == goal) return std::vector<std::string>{from};
        if (!seen.insert(from).second || !arrows.contains(from)) return std::vector<std::string>{};
        for (auto const& [to, unused] : arrows.at(from))
            if (auto rest = walk(to); !rest.empty()) {
                rest.insert(rest.begin(), from);
                return rest;
            }
        return std::vector<std::string>{};
    };
    return walk(at);
}

TEST(IncludeGraph, FollowsTheTable)
{
    Table const table = allowed_includes();
    for (char const* folder : {"gi/base", "gi/scene", "gi/image", "viewer", "tests"})
        ASSERT_TRUE(table.contains(folder)) << folder << " has no row in docs/architecture.md";
    ASSERT_FALSE(table.at("gi/base").contains("gi/scene"));
    std::vector<Include> const includes = all_includes(LIGHTWELL_SOURCE_DIR, table);
    EXPECT_GT(includes.size(), 100u);
    for (Include const& i : includes) {
        EXPECT_FALSE(i.from.empty()) << i.where << "\n  lies in a folder without a row in docs/architecture.md";
        EXPECT_TRUE(i.from == i.to || i.from.empty() || table.at(i.from).contains(i.to))
            << i.where << "\n  '" << i.from << "' may not include '" << i.to << "'";
    }
}

TEST(IncludeGraph, HasNoCircles)
{
    Table const table = allowed_includes();
    std::map<std::string, std::map<std::string, std::string>> arrows; // from, to, an include that draws it
    for (Include const& i : all_includes(LIGHTWELL_SOURCE_DIR, table))
        if (i.from != i.to) arrows[i.from].emplace(i.to, i.where);
    for (auto const& [from, targets] : arrows)
        for (auto const& [to, where] : targets) {
            std::string circle;
            for (std::string const& folder : way_back(to, from, arrows)) circle += " -> " + folder;
            EXPECT_TRUE(circle.empty()) << where << "\n  closes the circle " << from << circle;
        }
}

} // namespace
} // namespace viewer::test
