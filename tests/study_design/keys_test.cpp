// data/study.schema.json, docs/study/reference.md and the program list the same keys.

#include "study/script/examples.h"
#include "study/script/keys.h"
#include "tests/study_design/samples.h"

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace study::test {
namespace {

TEST(StudySchema, HasTheKeysOfTheProgram)
{
    auto const schema = nlohmann::json::parse(file_text(LIGHTWELL_SOURCE_DIR "/data/study.schema.json"));
    std::map<std::string, std::set<std::string>> in_schema;
    for (auto const& [name, def] : schema.at("$defs").items()) {
        if (!def.contains("properties")) continue;
        EXPECT_EQ(def.value("additionalProperties", true), false) << name;
        for (auto const& [key, what] : def.at("properties").items()) {
            in_schema[name].insert(key);
            EXPECT_TRUE(what.contains("description")) << name << "." << key;
        }
    }
    EXPECT_EQ(in_schema, script_keys());
}

TEST(StudyDocs, HaveTheTablesOfTheSchema)
{
    char const* const check = "/usr/bin/python3 '" LIGHTWELL_SOURCE_DIR "/scripts/study-reference' --check";
    EXPECT_EQ(std::system(check), 0) << "run scripts/study-reference";
}

TEST(StudyDocs, NameEveryKey)
{
    std::string const docs = file_text(LIGHTWELL_SOURCE_DIR "/docs/study/reference.md");
    for (auto const& [kind, keys] : script_keys())
        for (std::string const& key : keys)
            EXPECT_NE(docs.find("`" + key + "`"), std::string::npos)
                << kind << "." << key << " is not in docs/study/reference.md";
    for (Task const t : kTasks)
        EXPECT_NE(docs.find("`" + std::string(facts(t).name) + "`"), std::string::npos) << facts(t).name;
}

TEST(StudyDocs, HaveExamplesThatArePlanned)
{
    std::string const docs = file_text(LIGHTWELL_SOURCE_DIR "/docs/study/reference.md");
    int count = 0;
    for (std::size_t at = 0; (at = docs.find("```yaml\n", at)) != std::string::npos; ++at) {
        std::string const text = docs.substr(at + 8, docs.find("```\n", at + 8) - at - 8);
        if (!text.starts_with("schema:")) continue;
        Script const s = parse_script(text, "docs/study/reference.md");
        EXPECT_EQ(trials_of(make_plan(s, 1), Phase::main).size(), 12u);
        ++count;
    }
    EXPECT_EQ(count, 1);
}

TEST(BlockKeys, AreThoseOfBlocks)
{
    std::set<std::string> used;
    for (Task const t : kTasks)
        for (std::string const& key : block_keys(t)) {
            EXPECT_TRUE(script_keys().at("block").contains(key)) << key;
            used.insert(key);
        }
    EXPECT_EQ(used, script_keys().at("block"));
}

TEST(StudyExamples, TheProgramCarriesThem)
{
    std::set<std::string> carried, on_disk;
    for (StudyExample const& example : study_examples()) {
        carried.emplace(example.name);
        EXPECT_EQ(example.text, example_text(std::string(example.name)));
    }
    for (auto const& entry : std::filesystem::directory_iterator(LIGHTWELL_SOURCE_DIR "/data/study"))
        if (entry.path().extension() == ".yaml") on_disk.insert(entry.path().stem().string());
    EXPECT_EQ(carried, on_disk);
}

} // namespace
} // namespace study::test
