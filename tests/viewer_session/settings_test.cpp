// One table of options for all front ends: values as text, former names, and what viewers make of them.

#include "gi/core/error.h"
#include "gi/hit_buffers/settings.h"
#include "gi/methods/paths/settings.h"
#include "gi/methods/registry.h"
#include "gi/methods/vpl/settings.h"
#include "viewer/engine/settings.h"

#include <gtest/gtest.h>
#include <map>
#include <set>

namespace viewer {
namespace {

std::string refusal(std::function<void()> const& call)
{
    try {
        call();
    } catch (gi::InputError const& e) {
        EXPECT_FALSE(e.problem().empty() || e.why().empty() || e.suggestion().empty()) << e.what();
        return e.what();
    }
    return {};
}

TEST(RenderOptions, EachHasOneNameAndTakesTheTextOfItsValue)
{
    std::set<std::string> names;
    for (gi::RenderOption const& o : gi::render_options()) {
        EXPECT_TRUE(names.insert(o.key).second) << o.key;
        for (std::string const& former : o.former) EXPECT_TRUE(names.insert(former).second) << former;
        EXPECT_FALSE(o.meaning.empty()) << o.name;
        gi::RenderSettings s;
        std::string const value = o.get(s);
        o.set(s, value, "");
        EXPECT_EQ(o.get(s), value) << o.name;
        for (std::string const& word : o.words) {
            o.set(s, word, "");
            EXPECT_EQ(o.get(s), word) << o.name;
        }
        EXPECT_TRUE(o.methods.empty() ||
                    std::ranges::any_of(gi::methods(), [&](gi::Method const& m) { return o.read_by(m.name); }))
            << o.name;
    }
}

TEST(RenderOptions, NumbersAreWholeExactAndInRange)
{
    gi::RenderSettings s;
    auto const set = [&](char const* name, char const* text) {
        gi::render_option(name).set(s, text, std::string("value ") + text);
    };
    set("seed", "18446744073709551615");
    EXPECT_EQ(s.seed, UINT64_MAX);
    set("bounces", "12.0");
    EXPECT_EQ(s.bounces, 12);
    set("ao_radius", "0.8");
    EXPECT_EQ(s.of<gi::VirtualLightSettings>().ao_radius_m, 0.8f);
    EXPECT_EQ(gi::render_option("ao-radius").get(s), "0.8");
    for (auto const& [name, text] : {std::pair{"seed", "18446744073709551616"},
                                     {"seed", "-1"},
                                     {"seed", "1.5"},
                                     {"bounces", "1025"},
                                     {"bounces", ""},
                                     {"bounces", "3x"},
                                     {"bounces", "many"},
                                     {"cone", "nan"},
                                     {"cone", "inf"},
                                     {"roulette", "1e9"},
                                     {"packed", "1"},
                                     {"schedule", "now"},
                                     {"directions", "cube:6"},
                                     {"points", "%"},
                                     {"points", "0"},
                                     {"points", "nan"},
                                     {"points", "1e30"},
                                     {"points", "-5%"},
                                     {"points", "1e9%"}})
        EXPECT_FALSE(refusal([&] { set(name, text); }).empty()) << name << " " << text;
    EXPECT_EQ(s.seed, UINT64_MAX);
    EXPECT_NE(refusal([&] { set("axes", "99"); }).find("99 (it takes a whole number from 0 to 64)"),
              std::string::npos);
}

TEST(RenderOptions, AShareOfPointsFollowsTheMap)
{
    gi::RenderSettings s;
    gi::render_option("points").set(s, "25%", "");
    EXPECT_EQ(s.of<gi::VirtualLightSettings>().points_per_map(), 64 * 64 / 4);
    gi::render_option("point-map").set(s, "32", "");
    EXPECT_EQ(s.of<gi::VirtualLightSettings>().points_per_map(), 32 * 32 / 4);
    gi::render_option("points").set(s, "77", "");
    EXPECT_EQ(s.of<gi::VirtualLightSettings>().points_per_map(), 77);
}

TEST(Settings, FormerKeysAndValuesAreUnderstood)
{
    Settings s;
    s.method = "slhb";
    for (Change const& c : std::vector<Change>{
             {"resolution", 64}, {"lamps", 8}, {"fresh_lamps", 2}, {"followed", 16}, {"share_endings", false}})
        set(s, c);
    EXPECT_EQ(s.render.of<gi::SlhbSettings>().resolution, 64);
    EXPECT_EQ(s.render.of<gi::SlhbSettings>().light_samples, 8);
    EXPECT_EQ(s.render.of<gi::SlhbSettings>().fresh_light_samples, 2);
    EXPECT_EQ(s.updated_axes, 16);
    EXPECT_EQ(s.render.of<gi::PathsSettings>().cache, gi::RadianceCaching::off);
    set(s, {"radiance_cache", true});
    EXPECT_EQ(get(s, "share_endings"), "auto");
    EXPECT_EQ(get(s, "resolution"), 64);
    EXPECT_EQ(current_key("resolution"), "hit_buffer");
    EXPECT_EQ(current_key("nonsense"), "nonsense");
    EXPECT_FALSE(is_setting("threads")); // of the whole viewer
}

/// What version 0.1 called slhb is rays or look-ups by its options; files of that version have it.
TEST(Settings, OfVersion01NameMethodsAsThatDid)
{
    EXPECT_EQ(made_for("lightwell 0.1.0 (git 1234567)"), MadeFor::version_0_1);
    EXPECT_EQ(made_for("lightwell 0.2.0 (git 1234567)"), MadeFor::this_version);
    EXPECT_EQ(first_settings(MadeFor::this_version).method, "auto");
    Settings s = first_settings(MadeFor::version_0_1);
    EXPECT_EQ(s.method, "slhb_0_1");
    for (Change const& c : std::vector<Change>{{"look_ups", "all"}, {"shadows", "rays"}, {"compare", "slhb"}})
        set(s, current(c, MadeFor::version_0_1));
    EXPECT_EQ(s.compare, "slhb_0_1");
    EXPECT_EQ(all_settings(s).at("look_ups"), "all");
    set(s, current({"method", "reference"}, MadeFor::version_0_1));
    EXPECT_EQ(s.method, "reference");
    set(s, {"shadows", "auto"}); // as 0.1 recorded with any method
    Settings now;
    EXPECT_FALSE(all_settings(now).contains("look_ups"));
    EXPECT_NE(refusal([&] { check_offered(now, "look_ups"); }).find("give --method slhb"), std::string::npos);
    EXPECT_NE(refusal([&] { set(now, {"method", "slhp"}); }).find("slhb"), std::string::npos);
}

TEST(Settings, DifferencesMakeOneOfTheOther)
{
    Settings before, now;
    set(now, {"points", "30%"});
    set(now, {"exposure", 1.5});
    set(now, {"roulette", 2});
    std::vector<Change> const changes = differences(before, now);
    EXPECT_EQ(changes.size(), 3u);
    for (Change const& c : changes) set(before, c);
    EXPECT_EQ(all_settings(before), all_settings(now));
    EXPECT_TRUE(differences(before, now).empty());
}

TEST(Settings, ValuesThatAreNoneAreRefused)
{
    Settings s;
    for (Change const& c : std::vector<Change>{{"panel", 1},
                                               {"bounces", 1.5},
                                               {"bounces", nullptr},
                                               {"schedule", true},
                                               {"tone", 3},
                                               {"axes", {1, 2}}})
        EXPECT_NE(refusal([&] { set(s, c); }).find("'" + c.key + "' = "), std::string::npos) << c.key;
    EXPECT_EQ(all_settings(s), all_settings({}));
}

TEST(Settings, HaveLabelsInPlainWords)
{
    std::map<std::string, std::string> labels;
    for (SettingKey const& k : setting_keys()) {
        labels[k.key] = label_of(k);
        EXPECT_GE(label_of(k).size(), 4u) << k.key;
        EXPECT_LE(label_of(k).size(), 50u) << k.key;
        EXPECT_EQ(label_of(k).find('_'), std::string::npos) << k.key;
    }
    EXPECT_EQ(labels.at("rate"), "Target frame rate, Hz");
    EXPECT_EQ(labels.at("exposure"), "Exposure, stops");
    EXPECT_EQ(labels.at("ao_radius"), "Ao radius, m");
    EXPECT_EQ(labels.at("play"), "Animation clips run");
    EXPECT_EQ(labels.at("schedule"), "Schedule");
    EXPECT_EQ(labels.at("radiance_cache"), "Radiance cache");
    EXPECT_EQ(labels.at("reflections"), "Reflections");
    EXPECT_EQ(labels.at("reuse"), "Frames that light is averaged over, 1 = none");
}

} // namespace
} // namespace viewer
