#include "viewer/protocol/recording/export_csv.h"

#include "tests/viewer/run_program.h"
#include "tests/viewer_recording/walk.h"

#include <map>

namespace viewer::test {
namespace {

using Row = std::vector<std::string>;

/// Rows of a CSV (RFC 4180) after its comments.
std::vector<Row> parse_csv(std::string const& text)
{
    std::vector<Row> rows;
    Row row{""};
    bool quoted = false;
    std::size_t i = 0;
    while (text[i] == '#') i = text.find('\n', i) + 1;
    for (; i < text.size(); ++i) {
        char const c = text[i];
        if (quoted && c == '"' && text[i + 1] == '"')
            row.back() += text[i++];
        else if (c == '"')
            quoted = !quoted;
        else if (!quoted && c == ',')
            row.emplace_back();
        else if (!quoted && c == '\n')
            rows.push_back(std::exchange(row, Row{""}));
        else
            row.back() += c;
    }
    return rows;
}

TEST(ExportCsv, HoldsEveryFrameExactly)
{
    TemporaryFolder const folder;
    gi::Report report;
    {
        Recorder recorder(folder / "walk.lwr", walk_header(), report);
        for (std::uint64_t n = 0; n < 21; ++n) recorder.append(walk_frame(n));
    }
    RecordingReader reader(folder / "walk.lwr");
    EXPECT_EQ(export_csv(reader, folder / "walk.csv").frames, 21u);
    std::string const text = text_of(folder / "walk.csv");
    EXPECT_NE(text.find("# scene: \"atrium\"\n"), std::string::npos);
    std::vector<Row> const rows = parse_csv(text);
    ASSERT_EQ(rows.size(), 22u);
    for (std::string const& name : rows[0])
        EXPECT_NE(text.find("\n# " + name + " - "), std::string::npos) << name << " is not explained";
    for (std::uint64_t n = 0; n < 21; ++n) {
        ASSERT_EQ(rows[n + 1].size(), rows[0].size()) << n;
        std::map<std::string, std::string> row;
        for (std::size_t c = 0; c < rows[0].size(); ++c) row[rows[0][c]] = rows[n + 1][c];
        ASSERT_EQ(row.size(), rows[0].size()) << "two columns of one name";
        RecordedFrame const f = walk_frame(n);
        FrameCommand const& o = f.command;
        EXPECT_EQ(row["frame"], std::to_string(n));
        EXPECT_EQ(std::stod(row["pose_s"]), o.pose_s);
        EXPECT_EQ(std::stod(row["light_scale"]), o.light_scale);
        EXPECT_EQ(std::stod(row["surface_scale"]), o.surface_scale);
        EXPECT_EQ(std::stod(row["room_z_m"]), o.world_from_room[3].z);
        EXPECT_NEAR(std::stod(row["room_scale"]), 1, 1e-12);
        EXPECT_EQ(std::stod(row["head_x_m"]), o.tracked.head->position.x);
        EXPECT_EQ(std::stod(row["head_qy"]), o.tracked.head->rotation.y);
        EXPECT_EQ(row["left_hand_qw"], n % 3 == 0 ? "1" : "");
        EXPECT_EQ(row["right_hand_x_m"], "");
        EXPECT_EQ(row["left_foot_x_m"], "");
        EXPECT_EQ(row["user2_head_x_m"], "");
        EXPECT_EQ(row["user3_head_x_m"], n % 5 == 4 ? row["head_x_m"] : "");
        EXPECT_EQ(std::stoull(row["pixel_hash"], nullptr, 16), *f.pixel_hash);
        EXPECT_EQ(row["render_ms"], n % 2 == 0 ? "11.25" : "");
        EXPECT_EQ(row["view0_name"], "wall, 0");
        EXPECT_EQ(row["view0_margin_x_px"], n % 16 == 7 ? "20" : "0");
        EXPECT_EQ(row["view0_margin_y_px"], "0");
        EXPECT_NEAR(std::stod(row["view0_top"]), std::tan(std::acos(-1.0) / 6), 1e-12);
        EXPECT_NEAR(std::stod(row["view0_right"]), std::tan(std::acos(-1.0) / 6) * 4 / 3, 1e-12);
        EXPECT_EQ(row["view1_left"], n % 2 == 1 ? "-1" : "");
        gi::dquat const q(std::stod(row["view0_qw"]), std::stod(row["view0_qx"]), std::stod(row["view0_qy"]),
                          std::stod(row["view0_qz"]));
        gi::dvec3 const along = q * gi::dvec3(0, 0, -1);
        EXPECT_NEAR(glm::distance(along, -gi::dvec3(o.views[0].camera.world_from_camera[2])), 0, 1e-12);
        auto const changes = nlohmann::json::parse(row["changes"]);
        ASSERT_EQ(changes.size(), o.changes.size());
        for (std::size_t i = 0; i < changes.size(); ++i) {
            EXPECT_EQ(changes[i][0], o.changes[i].key);
            EXPECT_EQ(changes[i][1], o.changes[i].value);
        }
    }
}

TEST(ExportCsv, OfNoFramesIsAnEmptyTable)
{
    TemporaryFolder const folder;
    gi::Report report;
    Recorder(folder / "walk.lwr", walk_header(), report).finish();
    RecordingReader reader(folder / "walk.lwr");
    EXPECT_EQ(export_csv(reader, folder / "walk.csv").state, RecordingState::finished);
    EXPECT_EQ(parse_csv(text_of(folder / "walk.csv")).size(), 1u);
}

} // namespace
} // namespace viewer::test
