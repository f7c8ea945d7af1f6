#include "gi/scene/load/scene_file_yaml.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <map>
#include <sstream>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

namespace gi {
namespace {

/// Builds the tree from the parser's events.
class TreeBuilder : public YAML::EventHandler {
public:
    explicit TreeBuilder(std::shared_ptr<std::string const> file) : file_(std::move(file)) {}

    YamlValue take_root() { return std::move(root_); }

    void OnDocumentStart(YAML::Mark const& mark) override
    {
        if (documents_++ > 0)
            throw at(mark).error("a second document begins here", "a scene file is one document", "remove the '---'");
    }
    void OnDocumentEnd() override {}
    void OnNull(YAML::Mark const& mark, YAML::anchor_t anchor) override { add(at(mark), anchor); }
    void OnAlias(YAML::Mark const& mark, YAML::anchor_t anchor) override
    {
        auto const found = anchors_.find(anchor);
        if (found == anchors_.end())
            throw at(mark).error("the alias stands inside its own anchor", "it would never end", "write it out");
        if (depth_of(found->second) + open_.size() > kDeepestYaml) throw too_deep(at(mark));
        count(at(mark), found->second.size);
        place(YamlValue(found->second));
    }
    void OnScalar(YAML::Mark const& mark, std::string const& tag, YAML::anchor_t anchor,
                  std::string const& text) override
    {
        YamlValue v = at(mark);
        v.kind = YamlValue::Kind::scalar;
        v.quoted = tag == "!";
        v.text = text;
        add(std::move(v), anchor);
    }
    void OnSequenceStart(YAML::Mark const& mark, std::string const&, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value) override
    {
        open(mark, YamlValue::Kind::sequence, anchor);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(YAML::Mark const& mark, std::string const&, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value) override
    {
        open(mark, YamlValue::Kind::map, anchor);
    }
    void OnMapEnd() override { close(); }

private:
    struct Open {
        YamlValue value;
        YAML::anchor_t anchor;
    };

    YamlValue at(YAML::Mark const& mark) const
    {
        YamlValue v;
        v.file = file_;
        v.line = mark.line + 1;
        v.column = mark.column + 1;
        return v;
    }
    static InputError too_deep(YamlValue const& v)
    {
        return v.error(fmt::format("this is nested deeper than {} levels", kDeepestYaml),
                       "no scene needs that, and it would exhaust the stack", "flatten it");
    }
    static std::size_t depth_of(YamlValue const& v)
    {
        std::size_t depth = 0;
        for (YamlValue const& item : v.items) depth = std::max(depth, depth_of(item));
        return depth + 1;
    }
    void count(YamlValue const& v, std::size_t more)
    {
        values_ += more;
        if (values_ > kMostYamlValues)
            throw v.error(fmt::format("more than {} values", kMostYamlValues),
                          "aliases are counted as often as they are used", "write a smaller scene file");
    }
    void open(YAML::Mark const& mark, YamlValue::Kind kind, YAML::anchor_t anchor)
    {
        YamlValue v = at(mark);
        v.kind = kind;
        if (open_.size() >= kDeepestYaml) throw too_deep(v);
        count(v, 1);
        open_.push_back({std::move(v), anchor});
    }
    void close()
    {
        Open done = std::move(open_.back());
        open_.pop_back();
        remember(done.value, done.anchor);
        place(std::move(done.value));
    }
    void add(YamlValue v, YAML::anchor_t anchor)
    {
        count(v, 1);
        remember(v, anchor);
        place(std::move(v));
    }
    void remember(YamlValue const& v, YAML::anchor_t anchor)
    {
        if (anchor == 0) return;
        count(v, v.size);
        anchors_[anchor] = v;
    }
    void place(YamlValue v)
    {
        if (open_.empty()) {
            root_ = std::move(v);
            return;
        }
        YamlValue& parent = open_.back().value;
        parent.size += v.size;
        if (parent.kind == YamlValue::Kind::map && parent.keys.size() == parent.items.size())
            add_key(parent, std::move(v));
        else
            parent.items.push_back(std::move(v));
    }
    static void add_key(YamlValue& map, YamlValue key)
    {
        if (key.kind != YamlValue::Kind::scalar)
            throw key.error("this key is not a word", "keys of a scene file are plain words", "remove it");
        if (map.keys.size() >= kMostKeys)
            throw key.error(fmt::format("more than {} keys in one mapping", kMostKeys),
                            "no mapping of a scene file has so many", "remove those that are not known");
        for (YamlValue const& k : map.keys)
            if (k.text == key.text)
                throw key.error("'" + key.text + "' is given twice",
                                fmt::format("first in line {}; it is not clear which one counts", k.line),
                                "remove one of them");
        map.keys.push_back(std::move(key));
    }

    static constexpr std::size_t kMostKeys = 100;
    std::shared_ptr<std::string const> file_;
    YamlValue root_;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, YamlValue> anchors_;
    std::size_t values_ = 0;
    int documents_ = 0;
};

std::string shown(YamlValue const& v)
{
    switch (v.kind) {
    case YamlValue::Kind::null:
        return "nothing";
    case YamlValue::Kind::scalar:
        return v.text.size() > 40 ? "'" + v.text.substr(0, 40) + "...'" : "'" + v.text + "'";
    case YamlValue::Kind::sequence:
        return fmt::format("a list of {}", v.items.size());
    case YamlValue::Kind::map:
        return "a mapping";
    }
    return {};
}

InputError wrong_type(YamlValue const& v, std::string const& what, std::string const& wanted)
{
    return v.error("'" + what + "' is " + shown(v), "it has to be " + wanted, "write " + wanted);
}

} // namespace

YamlValue parse_yaml(std::string const& text, std::string const& name)
{
    auto const file = std::make_shared<std::string const>(name);
    if (text.size() > kMostYamlBytes)
        throw InputError(name + " has " + std::to_string(text.size()) + " bytes",
                         "a scene file holds names and numbers, at most 4 MiB of them", "put geometry into glTF");
    TreeBuilder builder(file);
    try {
        std::istringstream stream(text);
        YAML::Parser parser(stream);
        if (!parser.HandleNextDocument(builder))
            throw InputError(name + " is empty", "a scene file names models, lights or cameras",
                             "see data/example.yaml");
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (YAML::Exception const& e) {
        throw InputError(TextLocation{name, e.mark.line + 1, e.mark.column + 1}, "this is not YAML", e.msg,
                         "check indentation, colons and brackets");
    }
    return builder.take_root();
}

double read_number(YamlValue const& value, std::string const& what, Range range)
{
    std::string const& s = value.text;
    char const* const first = s.data() + (s.starts_with('+') ? 1 : 0);
    char const* const last = s.data() + s.size();
    double number = 0;
    auto const [end, error] = std::from_chars(first, last, number);
    if (value.kind != YamlValue::Kind::scalar || value.quoted || error != std::errc{} || end != last || first == last)
        throw wrong_type(value, what, "a number");
    if (!(number >= range.low) || !(number <= range.high))
        throw value.error("'" + what + "' is " + s, fmt::format("it has to lie in {:g} .. {:g}", range.low, range.high),
                          "choose a value in that range");
    return number;
}

std::uint64_t read_integer(YamlValue const& value, std::string const& what, Range range)
{
    double const number = read_number(value, what, range);
    if (number != std::floor(number)) throw wrong_type(value, what, "a whole number");
    return std::uint64_t(number);
}

bool read_bool(YamlValue const& value, std::string const& what)
{
    bool const plain = value.kind == YamlValue::Kind::scalar && !value.quoted;
    if (!plain || (value.text != "true" && value.text != "false")) throw wrong_type(value, what, "true or false");
    return value.text == "true";
}

std::string read_text(YamlValue const& value, std::string const& what)
{
    if (value.kind != YamlValue::Kind::scalar || value.text.empty()) throw wrong_type(value, what, "a text");
    return value.text;
}

std::vector<double> read_numbers(YamlValue const& value, std::string const& what, std::size_t count, Range range)
{
    if (value.kind != YamlValue::Kind::sequence || value.items.size() != count)
        throw wrong_type(value, what, fmt::format("a list of {} numbers", count));
    std::vector<double> numbers;
    for (YamlValue const& item : value.items) numbers.push_back(read_number(item, what, range));
    return numbers;
}

dvec3 read_dvec3(YamlValue const& value, std::string const& what, Range range)
{
    std::vector<double> const v = read_numbers(value, what, 3, range);
    return {v[0], v[1], v[2]};
}

dvec3 read_dvec3_or_number(YamlValue const& value, std::string const& what, Range range)
{
    if (value.kind == YamlValue::Kind::sequence) return read_dvec3(value, what, range);
    return dvec3{read_number(value, what, range)};
}

std::vector<YamlValue> const& read_list(YamlValue const& value, std::string const& what)
{
    if (value.kind != YamlValue::Kind::sequence) throw wrong_type(value, what, "a list ('- ...' per entry)");
    return value.items;
}

} // namespace gi
