#include "viewer/protocol/remote/request.h"

#include "gi/core/error.h"
#include "tests/viewer/run_program.h"

#include <fmt/format.h>

namespace viewer::test {
namespace {

using nlohmann::json;

std::string why_refused(std::string const& line)
{
    try {
        check_request(parse_request(line));
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "";
}

TEST(Request, HasItsArguments)
{
    RemoteRequest const r =
        check_request(parse_request(R"({"id": 7, "do": "set", "key": "exposure", "value": 1.5})"));
    EXPECT_EQ(r.id, 7);
    EXPECT_EQ(r.what, "set");
    EXPECT_EQ(r.arguments, (json{{"key", "exposure"}, {"value", 1.5}}));
    EXPECT_TRUE(check_request(parse_request(R"({"do": "ping"})")).id.is_null());
}

/// A value of each type.
json example_of(ArgumentRule const& a)
{
    switch (a.type) {
    case ArgumentType::text:
        return *a.choices == '\0' ? "x" : std::string(a.choices).substr(0, std::string(a.choices).find(' '));
    case ArgumentType::number:
        return 0.5;
    case ArgumentType::integer:
        return -3;
    case ArgumentType::boolean:
        return true;
    case ArgumentType::point:
        return {1, 2.5, -3};
    case ArgumentType::rotation:
        return {0, 0, 0, 1};
    case ArgumentType::any:
        return {{"deep", {1, nullptr}}};
    }
    return {};
}

TEST(Request, EveryRuleTakesWhatItSaysAndNothingElse)
{
    for (RequestRule const& rule : request_rules()) {
        json request{{"id", "a"}, {"do", rule.name}};
        for (ArgumentRule const& a : rule.arguments) request[a.name] = example_of(a);
        EXPECT_EQ(why_refused(request.dump()), "") << request;
        json more = request;
        more["bogus"] = 1;
        EXPECT_NE(why_refused(more.dump()).find("bogus"), std::string::npos) << more;
        for (ArgumentRule const& a : rule.arguments) {
            json without = request;
            without.erase(a.name);
            EXPECT_EQ(why_refused(without.dump()).empty(), a.presence == Presence::optional) << without;
            if (a.type == ArgumentType::any) continue;
            json wrong = request;
            wrong[a.name] = {{"an", "object"}};
            EXPECT_NE(why_refused(wrong.dump()).find(name_of(a.type)), std::string::npos) << wrong;
        }
    }
}

TEST(Request, WhatIsWrongIsSaid)
{
    std::pair<char const*, char const*> const cases[] = {
        {"", "no request"},
        {"{", "no request"},
        {"[1]", "no object"},
        {"7", "no object"},
        {R"({"id": 1})", "\"do\""},
        {R"({"do": 5})", "5 is no request"},
        {R"({"do": "fly"})", "ping, stats, load"},
        {R"({"do": "ping", "id": [1]})", "cannot be echoed"},
        {R"({"do": "ping", "id": 1.5})", "cannot be echoed"},
        {R"({"do": "key", "key": "w", "action": "smash"})", "tap press release"},
        {R"({"do": "camera", "position": [1, 2]})", "point"},
        {R"({"do": "camera", "position": [1, 2, "3"]})", "point"},
        {R"({"do": "camera", "rotation": [0, 0, 0, 0]})", "rotation"},
        {R"({"do": "seek", "time_s": 1e999})", "no request"},
        {R"({"do": "screenshot", "file": "a.png", "view": 3000000000})", "integer"},
        {R"({"do": "set", "key": "k", "value": "\xff"})", "no request"},
    };
    for (auto const& [line, word] : cases)
        EXPECT_NE(why_refused(line).find(word), std::string::npos) << line << ": " << why_refused(line);
    std::string deep = R"({"do": "set", "key": "k", "value": )";
    deep += std::string(200000, '[') + std::string(200000, ']') + "}";
    EXPECT_NE(why_refused(deep).find("deeper"), std::string::npos);
    std::string const long_id = R"({"do": "ping", "id": ")" + std::string(257, 'a') + "\"}";
    EXPECT_LT(why_refused(long_id).size(), 300u);
}

/// The table of docs/remote.md.
std::string requests_as_markdown()
{
    std::string table = "| do | what it does | arguments | result |\n|---|---|---|---|\n";
    for (RequestRule const& r : request_rules()) {
        std::string arguments;
        for (ArgumentRule const& a : r.arguments)
            arguments += fmt::format("{}`{}` {}{}{}: {}", arguments.empty() ? "" : "; ", a.name, name_of(a.type),
                                     a.presence == Presence::optional ? ", optional" : "",
                                     *a.choices == '\0' ? "" : fmt::format(" (one of {})", a.choices), a.meaning);
        table += fmt::format("| `{}` | {} | {} | {} |\n", r.name, r.meaning, arguments.empty() ? "—" : arguments,
                             r.result);
    }
    return table;
}

TEST(Request, DocumentationIsTheTable)
{
    std::string const text = file_text(LIGHTWELL_SOURCE_DIR "/docs/remote.md");
    EXPECT_NE(text.find(requests_as_markdown()), std::string::npos) << "docs/remote.md should hold this table:\n"
                                                                    << requests_as_markdown();
}

} // namespace
} // namespace viewer::test
