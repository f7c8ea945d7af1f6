#include "ar/capture/picture_source.h"
#include "gi/core/error.h"
#include "gi/core/text.h"

#include <algorithm>
#include <set>

namespace ar {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string lower(std::string s)
{
    std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return s;
}

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

std::vector<NumberedPicture> find_pictures(fs::path const& what)
{
    std::vector<NumberedPicture> pictures;
    std::string const name = what.filename().string();
    if (name.find('%') != std::string::npos && !fs::is_directory(what)) {
        Pattern const pattern = parse_pattern(name);
        for (fs::path const& file : files_in(what.has_parent_path() ? what.parent_path() : fs::path(".")))
            if (auto const number = number_in(file.filename().string(), pattern))
                pictures.push_back({*number, file});
        std::sort(pictures.begin(), pictures.end(), [](auto const& a, auto const& b) {
            return a.number != b.number ? a.number < b.number : a.file < b.file;
        });
        return pictures;
    }
    static std::set<std::string> const kPictures{".png",  ".jpg", ".jpeg", ".bmp",  ".tif",
                                                 ".tiff", ".ppm", ".pgm",  ".webp", ".exr"};
    for (fs::path const& file : files_in(what))
        if (kPictures.contains(lower(file.extension().string()))) pictures.push_back({0, file});
    std::sort(pictures.begin(), pictures.end(), [](auto const& a, auto const& b) {
        return is_before_naturally(a.file.filename().string(), b.file.filename().string());
    });
    for (std::size_t i = 0; i < pictures.size(); ++i) pictures[i].number = i;
    return pictures;
}

} // namespace ar
