// Sounds and cues of scripts.

#include "study/script/script_file.h"

#include <gtest/gtest.h>

namespace study::test {
namespace {

std::string script_of(std::string const& sounds, std::string const& cues, std::string const& defaults = "")
{
    return "schema: study/1\nid: x\nseed: 1\nparticipants: {count: 1}\nfactors: {q: [a, b]}\nsounds: {" + sounds +
           "}\ndefaults: {" + defaults +
           "}\nsequence: [b]\nblocks:\n  b: {task: rating, scale: {min: 1, max: 5}, cross: [q], cues: " + cues +
           "}\n";
}

TEST(Cues, AreReadWithTheirSounds)
{
    Script const s = parse_script(script_of("beep: {tone_hz: 440, duration_ms: 60, ramp_ms: 10, level_db: -12, "
                                            "channel: left}, word: {file: w.wav}",
                                            "[{sound: word, at: first_stimulus, offset_ms: -200}, {sound: beep}]"),
                                  "x.yaml");
    ASSERT_EQ(s.sounds.size(), 2u);
    EXPECT_EQ(s.sounds[0].tone_hz, 440);
    EXPECT_EQ(s.sounds[0].channel, SoundChannel::left);
    EXPECT_EQ(s.sounds[0].level_db, -12);
    EXPECT_EQ(s.sounds[1].file, "w.wav");
    EXPECT_EQ(s.sounds[1].level_db, 0) << "a file as it is";
    auto const& cues = s.blocks[0].cues;
    ASSERT_EQ(cues.size(), 2u);
    EXPECT_EQ(cues[0].sound, 1);
    EXPECT_EQ(cues[0].at, CueMoment::first_stimulus);
    EXPECT_EQ(cues[0].offset_ms, -200);
    EXPECT_EQ(cues[1].at, CueMoment::each_stimulus);
}

TEST(Cues, OfDefaultsCanBeSwitchedOff)
{
    std::string const beep = "beep: {tone_hz: 440}", usual = "cues: [{sound: beep}]";
    std::string text = script_of(beep, "none", usual);
    EXPECT_THROW(parse_script(text, "x.yaml"), ScriptError) << "nothing plays the sound";
    text.replace(text.find(", cues: none"), 12, "");
    EXPECT_EQ(parse_script(text, "x.yaml").blocks[0].cues.size(), 1u);
}

TEST(Cues, SayWhatIsWrong)
{
    struct Mistake {
        char const *sounds, *cues, *told;
    };
    for (auto const& [sounds, cues, told] :
         {Mistake{"beep: {tone_hz: 440, file: w.wav}", "[{sound: beep}]", "a file and a tone"},
          {"beep: {level_db: -3}", "[{sound: beep}]", "neither file nor tone"},
          {"beep: {tone_hz: 440, duration_ms: 8}", "[{sound: beep}]", "before it has risen"},
          {"beep: {file: w.wav, ramp_ms: 8}", "[{sound: beep}]", "only tones have it"},
          {"beep: {tone_hz: 440, level_db: 3}", "[{sound: beep}]", "between -120 and 0"},
          {"beep: {tone_hz: 440}", "[{sound: beep, at: fixation, offset_ms: -5}]", "between 0 and"},
          {"beep: {tone_hz: 440}", "[]", "sound 'beep' is not used"}}) {
        try {
            parse_script(script_of(sounds, cues), "x.yaml");
            ADD_FAILURE() << sounds << cues;
        } catch (std::exception const& e) {
            EXPECT_NE(std::string(e.what()).find(told), std::string::npos) << e.what();
            EXPECT_EQ(std::string(e.what()).find("x.yaml:"), 0u) << e.what();
        }
    }
}

} // namespace
} // namespace study::test
