#pragma once
// Calibrations of projectors as files.

#include "tests/viewer_display/map_samples.h"

#include <fmt/format.h>

namespace viewer::test {

/// <MPCDI> with one buffer. @param regions,files  what is within <buffer> and <files>
inline std::string mpcdi_xml(std::string const& profile, std::string const& regions, std::string const& files = "",
                             std::string const& buffer = "")
{
    return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- a comment -->
<MPCDI profile="{}" geometry="1" level="1" date="2020-01-01 00:00:00" version="2.0">
<display><buffer id="b" {}>
{}
</buffer></display>
<files>{}</files>
</MPCDI>
)",
                       profile, buffer, regions, files);
}

inline std::string mpcdi_region(std::string const& id, int width, int height, std::string const& within = "",
                                std::string const& place = R"(x="0" y="0" xsize="1" ysize="1")")
{
    return fmt::format(R"(<region id="{}" Xresolution="{}" Yresolution="{}" {}>{}</region>)", id, width, height,
                       place, within);
}

inline std::string mpcdi_frustum(double yaw, double pitch, double roll, double across = 45, double upward = 45)
{
    return fmt::format("<frustum><yaw>{}</yaw><pitch>{}</pitch><roll>{}</roll><rightAngle>{}</rightAngle>"
                       "<leftAngle>{}</leftAngle><upAngle>{}</upAngle><downAngle>{}</downAngle></frustum>",
                       yaw, pitch, roll, across, -across, upward, -upward);
}

inline std::string mpcdi_warp(std::string const& path, std::string const& unit,
                              std::string const& origin = "idealEyePoint")
{
    return fmt::format("<geometryWarpFile><path>{}</path><interpolation>linear</interpolation><geometricUnit>{}"
                       "</geometricUnit><originOf3DData>{}</originOf3DData></geometryWarpFile>",
                       path, unit, origin);
}

inline std::string mpcdi_light(std::string const& element, std::string const& path, double gamma)
{
    return fmt::format("<{0}><path>{1}</path><componentDepth>1</componentDepth><bitDepth>8</bitDepth>"
                       "<gammaEmbedded>{2}</gammaEmbedded></{0}>",
                       element, path, gamma);
}

inline std::string mpcdi_fileset(std::string const& region, std::string const& within)
{
    return "<fileset region=\"" + region + "\">" + within + "</fileset>";
}

} // namespace viewer::test
