#include "study/journal/entry_line.h"

#include "gi/core/checked_line.h"
#include "study/journal/entry_fields.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

namespace study {
namespace {

using Json = nlohmann::ordered_json;

constexpr char const* kFormat = "journal/1";

struct Put {
    Json& out;

    template <class T>
    void operator()(char const* name, T const& value) const
    {
        out[name] = json(value);
    }
    template <class T>
    void operator()(LaterField field, std::optional<T> const& value) const
    {
        if (value) out[field.name] = json(*value);
    }
    template <class T>
    requires requires(T const& t) { t.empty(); }
    void operator()(LaterField field, T const& value) const
    {
        if (!value.empty()) out[field.name] = json(value);
    }

    static Json json(double v)
    {
        if (std::isfinite(v)) return v;
        return std::isnan(v) ? "nan" : v > 0 ? "inf" : "-inf";
    }
    static Json json(int v) { return v; }
    static Json json(bool v) { return v; }
    static Json json(std::uint64_t v) { return v; }
    static Json json(char v) { return std::string(1, v); }
    static Json json(std::string const& v) { return v; }
    static Json json(std::pair<std::string, std::string> const& v) { return Json::array({v.first, v.second}); }
    template <EntryPart T>
    static Json json(T const& v)
    {
        Json out = Json::object();
        Fields<T>::visit(v, Put{out});
        return out;
    }
    template <class T>
    static Json json(std::optional<T> const& v)
    {
        return v ? json(*v) : Json(nullptr);
    }
    template <class T>
    static Json json(std::vector<T> const& v)
    {
        Json out = Json::array();
        for (T const& item : v) out.push_back(json(item));
        return out;
    }
};

struct Take {
    Json const& in;
    std::set<std::string>& known;

    template <class T>
    void operator()(char const* name, T& value) const
    {
        known.insert(name);
        auto const found = in.find(name);
        if (found == in.end()) throw BadLine(fmt::format("it has no '{}'", name), false);
        if (!read(*found, value)) throw BadLine(fmt::format("its '{}' has another type", name), false);
    }

    template <class T>
    void operator()(LaterField field, T& value) const
    {
        known.insert(field.name);
        value = T{};
        auto const found = in.find(field.name);
        if (found != in.end() && !read(*found, value))
            throw BadLine(fmt::format("its '{}' has another type", field.name), false);
    }

    static bool read(Json const& j, double& v)
    {
        if (j == "nan")
            v = std::numeric_limits<double>::quiet_NaN();
        else if (j == "inf")
            v = std::numeric_limits<double>::infinity();
        else if (j == "-inf")
            v = -std::numeric_limits<double>::infinity();
        else if (j.is_number())
            v = j.get<double>();
        else
            return false;
        return true;
    }
    static bool read(Json const& j, int& v)
    {
        if (!j.is_number_integer()) return false;
        bool const fits = j.is_number_unsigned() ? j.get<std::uint64_t>() <= std::uint64_t(INT32_MAX)
                                                 : j.get<std::int64_t>() >= INT32_MIN;
        v = fits ? j.get<int>() : 0;
        return fits;
    }
    static bool read(Json const& j, bool& v) { return j.is_boolean() && (v = j.get<bool>(), true); }
    static bool read(Json const& j, std::uint64_t& v)
    {
        return j.is_number_unsigned() && (v = j.get<std::uint64_t>(), true);
    }
    static bool read(Json const& j, std::string& v) { return j.is_string() && (v = j.get<std::string>(), true); }
    static bool read(Json const& j, char& v)
    {
        std::string text;
        return read(j, text) && text.size() == 1 && (v = text[0], true);
    }
    static bool read(Json const& j, std::pair<std::string, std::string>& v)
    {
        return j.is_array() && j.size() == 2 && read(j[0], v.first) && read(j[1], v.second);
    }
    template <EntryPart T>
    static bool read(Json const& j, T& v)
    {
        if (!j.is_object()) return false;
        take_all(j, v, {});
        return true;
    }
    template <class T>
    static bool read(Json const& j, std::optional<T>& v)
    {
        v.reset();
        return j.is_null() || read(j, v.emplace());
    }
    template <class T>
    static bool read(Json const& j, std::vector<T>& v)
    {
        if (!j.is_array()) return false;
        v.clear();
        for (Json const& item : j) {
            T value{};
            if (!read(item, value)) return false;
            v.push_back(std::move(value));
        }
        return true;
    }

    /// All fields of the object and no others.
    template <class T>
    static void take_all(Json const& j, T& value, std::set<std::string> known)
    {
        Fields<T>::visit(value, Take{j, known});
        for (auto const& [key, unused] : j.items())
            if (!known.contains(key)) throw BadLine("'" + key + "' is a key unknown to this version", true);
    }
};

template <std::size_t I = 0>
JournalEntry entry_of(std::string const& kind, Json const& j)
{
    if constexpr (I == std::variant_size_v<JournalEntry>) {
        throw BadLine("'" + kind + "' is a kind of entry unknown to this version", true);
    } else {
        using Entry = std::variant_alternative_t<I, JournalEntry>;
        if (kind != Fields<Entry>::kKind) return entry_of<I + 1>(kind, j);
        std::set<std::string> frame{"n", "kind", "crc32"};
        if (I == 0) frame.insert("format");
        Entry entry;
        Take::take_all(j, entry, frame);
        return entry;
    }
}

} // namespace

std::string entry_line(JournalEntry const& entry, int number)
{
    Json j{{"n", number}};
    std::visit(
        [&](auto const& e) {
            using Entry = std::remove_cvref_t<decltype(e)>;
            j["kind"] = Fields<Entry>::kKind;
            if (std::is_same_v<Entry, SessionStarted>) j["format"] = kFormat;
            Fields<Entry>::visit(e, Put{j});
        },
        entry);
    return gi::checked_line(j.dump(-1, ' ', false, Json::error_handler_t::replace));
}

JournalEntry entry_of_line(std::string_view line, int number)
{
    if (!gi::has_checksum(line)) throw BadLine("it has no checksum at its end", false);
    if (!gi::checksum_holds(line))
        throw BadLine("its checksum does not match: it was changed after it was written", false);
    Json const j = Json::parse(line, nullptr, false);
    if (!j.is_object()) throw BadLine("it is not a JSON object", false);
    std::set<std::string> frame;
    int n = 0;
    std::string kind;
    Take const take{j, frame};
    take("n", n);
    take("kind", kind);
    if (kind == Fields<SessionStarted>::kKind) {
        std::string format;
        take("format", format);
        if (format != kFormat)
            throw BadLine(fmt::format("its format is '{}', this version knows '{}'", format, kFormat), true);
    }
    if (n != number)
        throw BadLine(fmt::format("its number is {}, it should be {}: lines are missing or duplicated", n, number),
                      false);
    return entry_of(kind, j);
}

} // namespace study
