#include "ar/capture/picture_source.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"

#include <algorithm>
#include <map>
#include <set>

namespace ar {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A name with one %d in it.
struct Pattern {
    std::string before, after;
    std::size_t width = 0; ///< digits at least
    bool has_zeros = false;
};

Pattern parse_pattern(std::string const& name)
{
    auto const refuse = [&](std::string const& why) -> Pattern {
        throw gi::InputError("the pattern '" + name + "'", why, "write the number as %d or %04d");
    };
    Pattern p;
    std::size_t const percent = name.find('%');
    p.before = name.substr(0, percent);
    std::size_t at = percent + 1;
    if (at < name.size() && name[at] == '0') {
        p.has_zeros = true;
        ++at;
    }
    for (; at < name.size() && is_digit(name[at]); ++at) p.width = 10 * p.width + std::size_t(name[at] - '0');
    if (at >= name.size() || name[at] != 'd' || p.width > 20) return refuse("after % there is no number in it");
    p.after = name.substr(at + 1);
    if (p.after.find('%') != std::string::npos) return refuse("there is more than one % in it");
    return p;
}

/// The number of a name that printf would have made of the pattern.
std::optional<std::uint64_t> number_in(std::string const& name, Pattern const& p)
{
    if (name.size() <= p.before.size() + p.after.size() || !name.starts_with(p.before) || !name.ends_with(p.after))
        return std::nullopt;
    std::string digits = name.substr(p.before.size(), name.size() - p.before.size() - p.after.size());
    if (digits.size() < p.width) return std::nullopt;
    if (!p.has_zeros) digits.erase(0, std::min(digits.find_first_not_of(' '), digits.size()));
    if (digits.empty() || !std::all_of(digits.begin(), digits.end(), is_digit)) return std::nullopt;
    bool const is_padded = digits.size() > 1 && digits.front() == '0';
    if (is_padded && !(p.has_zeros && digits.size() == p.width)) return std::nullopt;
    return gi::parse_number<std::uint64_t>(digits);
}

std::vector<fs::path> files_in(fs::path const& folder)
{
    std::error_code error;
    fs::directory_iterator all(folder, error);
    if (error)
        throw gi::InputError("the folder '" + folder.string() + "' cannot be read", error.message(),
                             "name a folder of pictures");
    std::vector<fs::path> files;
    for (auto const& entry : all)
        if (!entry.is_directory(error)) files.push_back(entry.path());
    return files;
}

/// A name without its ending: texts and the runs of digits between them.
struct Name {
    std::string texts; ///< each run of digits is a zero byte
    std::vector<std::string> digits;
};

Name split_name(std::string const& stem)
{
    Name n;
    for (std::size_t i = 0; i < stem.size();) {
        if (!is_digit(stem[i])) {
            n.texts += stem[i++];
            continue;
        }
        std::size_t end = i;
        while (end < stem.size() && is_digit(stem[end])) ++end;
        n.texts += '\0';
        n.digits.push_back(stem.substr(i, end - i));
        i = end;
    }
    return n;
}

using Group = std::vector<std::pair<fs::path, Name>>;

/// The one run of digits in which the names differ; the last one of a single file. Nothing: none, or more than one.
std::optional<std::size_t> field_of_number(Group const& group)
{
    std::size_t const fields = group.front().second.digits.size();
    if (fields == 0) return std::nullopt;
    if (group.size() == 1) return fields - 1;
    std::optional<std::size_t> differs;
    for (std::size_t k = 0; k < fields; ++k) {
        std::set<std::string> values;
        for (auto const& [unused, name] : group) {
            std::string const& d = name.digits[k];
            values.insert(d.substr(std::min(d.find_first_not_of('0'), d.size() - 1)));
        }
        if (values.size() == 1) continue;
        if (differs) return std::nullopt;
        differs = k;
    }
    return differs.value_or(fields - 1); // 3.png and 03.png: one number twice
}

FoundPictures in_order(std::vector<fs::path> const& files, std::string why)
{
    FoundPictures found{.why_not = std::move(why)};
    for (fs::path const& file : files) found.pictures.push_back({found.pictures.size(), file});
    return found;
}

/// Where three quarters of the files have names that differ in one number alone, this is their number, and the
/// others are left out. Else, and where hardly any of the numbers between the first and the last is there (time
/// stamps), their number is their place in the order.
FoundPictures numbered_by_names(std::vector<fs::path> const& files, std::string const& folder)
{
    constexpr std::uint64_t kMostNumbersPerFile = 100;
    std::map<std::string, Group> groups;
    for (fs::path const& file : files) {
        Name name = split_name(file.stem().string());
        groups[name.texts].emplace_back(file, std::move(name));
    }
    if (groups.empty()) return {};
    Group const& largest = std::max_element(groups.begin(), groups.end(), [](auto const& a, auto const& b) {
                               return a.second.size() < b.second.size();
                           })->second;
    bool const have_digits = std::any_of(groups.begin(), groups.end(),
                                         [](auto const& g) { return !g.second.front().second.digits.empty(); });
    if (!have_digits) return in_order(files, {});
    std::optional<std::size_t> const field = field_of_number(largest);
    if (!field || 4 * largest.size() < 3 * files.size())
        return in_order(files, "the names do not differ in one number alone");
    FoundPictures found{.has_numbers = true};
    for (auto const& [file, name] : largest) {
        auto const number = gi::parse_number<std::uint64_t>(name.digits[*field]);
        if (!number) return in_order(files, "their numbers are too large for frames");
        found.pictures.push_back({*number, file});
    }
    std::stable_sort(found.pictures.begin(), found.pictures.end(),
                     [](auto const& a, auto const& b) { return a.number < b.number; });
    for (std::size_t i = 1; i < found.pictures.size(); ++i) {
        NumberedPicture const &a = found.pictures[i - 1], &b = found.pictures[i];
        if (a.number == b.number)
            throw gi::InputError("two pictures of '" + folder + "' have the number " + std::to_string(a.number),
                                 "a frame has one, and these are '" + a.file.filename().string() + "' and '" +
                                     b.file.filename().string() + "'",
                                 "remove one of the two, or write a pattern like '" + folder + "/%06d.png'");
    }
    std::uint64_t const span = found.pictures.back().number - found.pictures.front().number;
    if (span / kMostNumbersPerFile >= found.pictures.size())
        return in_order(files, "hardly any number between the first and the last is there");
    for (auto const& [unused, group] : groups)
        for (auto const& [file, name] : group)
            if (&group != &largest) found.left_out.push_back(file);
    return found;
}

} // namespace

bool is_before_naturally(std::string const& a, std::string const& b)
{
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (is_digit(a[i]) && is_digit(b[j])) {
            auto const skip_zeros = [](std::string const& s, std::size_t at) {
                while (at + 1 < s.size() && s[at] == '0' && is_digit(s[at + 1])) ++at;
                return at;
            };
            auto const end_of = [](std::string const& s, std::size_t at) {
                while (at < s.size() && is_digit(s[at])) ++at;
                return at;
            };
            i = skip_zeros(a, i);
            j = skip_zeros(b, j);
            std::size_t const i_end = end_of(a, i), j_end = end_of(b, j);
            if (i_end - i != j_end - j) return i_end - i < j_end - j;
            if (int const order = a.compare(i, i_end - i, b, j, j_end - j); order != 0) return order < 0;
            i = i_end;
            j = j_end;
        } else {
            if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
            ++i;
            ++j;
        }
    }
    if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
    return a < b;
}

std::vector<fs::path> picture_files(fs::path const& folder)
{
    static std::set<std::string> const kPictures{".png",  ".jpg", ".jpeg", ".bmp",  ".tif",
                                                 ".tiff", ".ppm", ".pgm",  ".webp", ".exr"};
    std::vector<fs::path> files = files_in(folder);
    std::erase_if(files, [](fs::path const& f) { return !kPictures.contains(gi::lower_extension(f)); });
    std::sort(files.begin(), files.end(), [](fs::path const& a, fs::path const& b) {
        return is_before_naturally(a.filename().string(), b.filename().string());
    });
    return files;
}

FoundPictures find_pictures(fs::path const& what)
{
    std::string const name = what.filename().string();
    if (name.find('%') == std::string::npos || fs::is_directory(what))
        return numbered_by_names(picture_files(what), what.string());
    FoundPictures found{.has_numbers = true};
    Pattern const pattern = parse_pattern(name);
    for (fs::path const& file : files_in(what.has_parent_path() ? what.parent_path() : fs::path(".")))
        if (auto const number = number_in(file.filename().string(), pattern))
            found.pictures.push_back({*number, file});
    std::sort(found.pictures.begin(), found.pictures.end(), [](auto const& a, auto const& b) {
        return a.number != b.number ? a.number < b.number : a.file < b.file;
    });
    return found;
}

std::string missing_numbers(std::vector<NumberedPicture> const& pictures, std::optional<std::uint64_t> first)
{
    constexpr int kMostNamed = 8;
    std::string text;
    int gaps = 0;
    auto const add = [&](std::uint64_t from, std::uint64_t to) {
        if (gaps++ >= kMostNamed) return;
        text += (text.empty() ? "" : ", ") + std::to_string(from);
        if (to > from) text += " to " + std::to_string(to);
    };
    std::optional<std::uint64_t> next = first;
    for (NumberedPicture const& p : pictures) {
        if (next && p.number > *next) add(*next, p.number - 1);
        next = p.number + 1;
    }
    if (gaps > kMostNamed) text += ", " + std::to_string(gaps - kMostNamed) + " more gaps";
    return text;
}

} // namespace ar
