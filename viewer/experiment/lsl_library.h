#pragma once
// Lab Streaming Layer (liblsl, lsl_c.h of version 1.16): loaded at run time, because few systems package it. It is
// looked for in $PYLSL_LIB, as pylsl does, then by its names on the loader's path.

#include <cstdint>
#include <memory>
#include <string>

namespace viewer {

struct LslLibrary {
    static constexpr int kStringFormat = 3;

    using Info = void*;
    using Xml = void*;
    Info (*create_streaminfo)(char const* name, char const* type, int channels, double rate_hz, int format,
                              char const* source_id) = nullptr;
    void (*destroy_streaminfo)(Info) = nullptr;
    Xml (*get_desc)(Info) = nullptr;
    Xml (*append_child)(Xml, char const* name) = nullptr;
    Xml (*append_child_value)(Xml, char const* name, char const* value) = nullptr;
    Xml (*child)(Xml, char const* name) = nullptr;
    Xml (*next_sibling_n)(Xml, char const* name) = nullptr;
    int (*empty)(Xml) = nullptr;
    char const* (*child_value_n)(Xml, char const* name) = nullptr;
    char const* (*get_name)(Info) = nullptr;
    int (*get_channel_count)(Info) = nullptr;
    double (*get_nominal_srate)(Info) = nullptr;
    void* (*create_outlet)(Info, int chunk_size, int max_buffered) = nullptr;
    void (*destroy_outlet)(void*) = nullptr;
    int (*have_consumers)(void* outlet) = nullptr;
    int (*push_sample_strt)(void* outlet, char const** sample, double time_s) = nullptr;
    int (*resolve_byprop)(Info* found, std::uint32_t most, char const* property, char const* value,
                          std::int32_t least, double timeout_s) = nullptr;
    void* (*create_inlet)(Info, int max_buffered, int chunk_size, int recover) = nullptr;
    void (*destroy_inlet)(void*) = nullptr;
    Info (*get_fullinfo)(void* inlet, double timeout_s, std::int32_t* error) = nullptr;
    void (*open_stream)(void* inlet, double timeout_s, std::int32_t* error) = nullptr;
    double (*time_correction)(void* inlet, double timeout_s, std::int32_t* error) = nullptr;
    double (*pull_sample_d)(void* inlet, double* values, std::int32_t count, double timeout_s,
                            std::int32_t* error) = nullptr;
    double (*local_clock)() = nullptr;
    int (*library_version)() = nullptr;

    /// Null if it is not installed, or lacks a function.
    static std::shared_ptr<LslLibrary const> open();
    /// LSL's clock minus the steady clock, s: 0 on Linux, but for the rounding of a reading.
    double clock_offset_s() const;
    std::string version() const; ///< "1.18"
    ~LslLibrary();
    LslLibrary(LslLibrary const&) = delete;
    LslLibrary& operator=(LslLibrary const&) = delete;

private:
    LslLibrary() = default;
    bool load();
    void* library_ = nullptr;
};

} // namespace viewer
