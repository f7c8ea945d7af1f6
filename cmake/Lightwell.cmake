# What every target of the project shares, and the one way to declare a library or a test.

add_library(lightwell_options INTERFACE)
target_include_directories(lightwell_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
target_compile_definitions(lightwell_options INTERFACE GLM_FORCE_SILENT_WARNINGS GLM_FORCE_XYZW_ONLY) # plain members: nvcc 13 miscompiles constants of unions
set(warnings -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wno-unknown-pragmas -Werror)
target_compile_options(lightwell_options INTERFACE
  "$<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:${warnings}>>"
  # GCC 12 warns of std::string concatenation that is right (its bugs 105329 and 105651).
  "$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-restrict>"
  # GCC 13 and 14 warn of every reference from a function that is given a temporary.
  "$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-dangling-reference>"
  "$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:Clang>>:-Wno-bitwise-instead-of-logical>" # loops without branches
  "$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:Clang>>:-Wno-inconsistent-missing-override>" # members of templates with one of two bases
  # Without contraction: a function that is inlined at several places, as TBB does it, must round alike at all of them.
  "$<$<COMPILE_LANGUAGE:CXX>:-march=${LIGHTWELL_MARCH};-fno-math-errno;-ffp-contract=off>"
  "$<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr;-diag-suppress=20012;-Werror=all-warnings>")
if(LIGHTWELL_FUZZ)
  target_compile_options(lightwell_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(LIGHTWELL_SANITIZE)
  target_compile_options(lightwell_options INTERFACE -fsanitize=${LIGHTWELL_SANITIZE} -fno-sanitize-recover=undefined -fno-omit-frame-pointer
    # GCC 12 with ASan warns of its own std::regex.
    "$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-Wno-maybe-uninitialized>")
  # The sanitizer calls dlopen for us: only an old-style path holds for its calls too.
  target_link_options(lightwell_options INTERFACE -fsanitize=${LIGHTWELL_SANITIZE} LINKER:--disable-new-dtags)
endif()

# lightwell_precompile(TARGET headers...): the precompiled header of a target, as others reuse it.
function(lightwell_precompile target)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>) # for ccache
  target_precompile_headers(${target} PRIVATE ${ARGN})
endfunction()
function(lightwell_reuse_precompiled target from)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  target_precompile_headers(${target} REUSE_FROM ${from})
endfunction()

option(LIGHTWELL_UNITY "Compile all sources of a folder as one unit: a build from nothing takes a third of the time" ON)

# lightwell_unity(TARGET): one unit of all sources, which CMake writes. Names of its anonymous namespaces differ.
function(lightwell_unity target)
  if(LIGHTWELL_UNITY) # GCC takes sources that the unit includes for headers
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${LIGHTWELL_UNITY} UNITY_BUILD_BATCH_SIZE 0)
endfunction()

# lightwell_sources(TARGET units...): adds the .cpp files (and with CUDA the .cu files) of folders. Each unit is a folder, or several joined
# by "+", that are compiled as one; "FOLDER:regex" takes the files whose names fit, "FOLDER:!regex" the others.
function(lightwell_sources target)
  lightwell_unity(${target})
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  foreach(unit ${ARGN})
    string(MAKE_C_IDENTIFIER "${unit}" group)
    string(REPLACE "+" ";" folders "${unit}")
    foreach(folder ${folders})
      set(regex ".")
      if(folder MATCHES "^([^:]+):(.+)$")
        set(folder ${CMAKE_MATCH_1})
        set(regex "${CMAKE_MATCH_2}")
      endif()
      set(kind INCLUDE)
      if(regex MATCHES "^!(.+)$")
        set(kind EXCLUDE)
        set(regex "${CMAKE_MATCH_1}")
      endif()
      file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/${folder} ${folder}/*.cpp)
      list(FILTER sources ${kind} REGEX "^(${regex})")
      list(TRANSFORM sources PREPEND "${folder}/")
      set_source_files_properties(${sources} PROPERTIES UNITY_GROUP "${group}")
      if(LIGHTWELL_CUDA)
        file(GLOB cuda_sources CONFIGURE_DEPENDS ${folder}/*.cu)
      endif()
      target_sources(${target} PRIVATE ${sources} ${cuda_sources})
    endforeach()
  endforeach()
endfunction()

# lightwell_headers(TARGET [COLD]): the precompiled header of the libraries. COLD: what waits for people and disks, which -O1 compiles in
# 60 % of the time of -O3.
function(lightwell_headers target)
  if(ARGN STREQUAL COLD)
    target_compile_options(${target} PRIVATE "$<$<AND:$<CONFIG:Release>,$<COMPILE_LANGUAGE:CXX>>:-O1>")
    target_link_libraries(${target} PRIVATE fmt::fmt) # whose macro the precompiled header has
  endif()
  if(NOT LIGHTWELL_CUDA AND ARGN STREQUAL COLD)
    lightwell_reuse_precompiled(${target} lightwell_cold_headers)
  elseif(NOT LIGHTWELL_CUDA)
    lightwell_reuse_precompiled(${target} lightwell_library_headers)
  endif()
endfunction()

# lightwell_library(NAME units... [COLD] [PUBLIC targets...] [PRIVATE targets...]): units as of lightwell_sources, COLD as of
# lightwell_headers. What PUBLIC names is what its headers may include.
function(lightwell_library name)
  cmake_parse_arguments(arg "COLD" "" "PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} STATIC)
  lightwell_sources(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PUBLIC lightwell_options ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  if(arg_COLD)
    lightwell_headers(${name} COLD)
  else()
    lightwell_headers(${name})
  endif()
endfunction()

# lightwell_separate(files...): sources that are compiled by themselves.
function(lightwell_separate)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# lightwell_for_any_processor(files...): sources that run before it is known what the processor can do.
function(lightwell_for_any_processor)
  if(CMAKE_SYSTEM_PROCESSOR STREQUAL x86_64)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -march=x86-64 SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

# One precompiled header for all libraries, one for the cold ones and one for all tests; GCC wants the same kind of code in what reuses it.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/headers.cpp CONTENT "int main() {}\n")
if(NOT LIGHTWELL_CUDA)
  add_library(lightwell_library_headers STATIC ${PROJECT_BINARY_DIR}/headers.cpp)
  target_link_libraries(lightwell_library_headers PRIVATE lightwell_options)
  lightwell_precompile(lightwell_library_headers
    <glm/glm.hpp> <string> <vector> <map> <memory> <filesystem> <functional> <algorithm> <optional> <span>)
  add_library(lightwell_cold_headers STATIC ${PROJECT_BINARY_DIR}/headers.cpp)
  target_link_libraries(lightwell_cold_headers PRIVATE lightwell_options CLI11::CLI11 nlohmann_json::nlohmann_json fmt::fmt)
  target_compile_options(lightwell_cold_headers PRIVATE $<$<CONFIG:Release>:-O1>)
  lightwell_precompile(lightwell_cold_headers
    <glm/glm.hpp> <string> <vector> <map> <memory> <filesystem> <functional> <algorithm> <optional> <span>
    <CLI/CLI.hpp> <nlohmann/json.hpp> <fmt/format.h>)
endif()
set(lightwell_quick "$<$<COMPILE_LANGUAGE:CXX>:-Og>")
if(NOT LIGHTWELL_FUZZ)
  foreach(headers lightwell_test_headers lightwell_quick_test_headers)
    add_executable(${headers} ${PROJECT_BINARY_DIR}/headers.cpp)
    target_link_libraries(${headers} PRIVATE lightwell_options GTest::gtest)
    if(headers MATCHES quick)
      target_compile_options(${headers} PRIVATE ${lightwell_quick})
    endif()
    lightwell_precompile(${headers}
      <gtest/gtest.h> <glm/glm.hpp> <string> <vector> <map> <memory> <filesystem> <functional> <algorithm> <optional> <span>
      <fstream> <sstream>)
  endforeach()
endif()

add_custom_target(slow_tests) # compiled only for those who run them

# lightwell_tests(FOLDER libraries... [SERIAL suites...])
# The suffix of a file gives its label: x_test.cpp unit, x_analytic_test.cpp analytic, x_image_test.cpp image,
# x_slow_test.cpp slow. One executable per label, one test of ctest per suite. SERIAL: suites that run alone, for they measure
# how soon something answers.
function(lightwell_tests folder)
  cmake_parse_arguments(arg "" "" "SERIAL" ${ARGN})
  list(JOIN arg_SERIAL "|" serial)
  file(GLOB all CONFIGURE_DEPENDS *_test.cpp)
  foreach(label unit analytic image slow)
    set(sources ${all})
    if(label STREQUAL unit)
      list(FILTER sources EXCLUDE REGEX "_(analytic|image|slow)_test\\.cpp$")
    else()
      list(FILTER sources INCLUDE REGEX "_${label}_test\\.cpp$")
    endif()
    if(sources)
      set(target test_${folder}_${label})
      add_executable(${target} ${sources})
      target_link_libraries(${target} PRIVATE ${arg_UNPARSED_ARGUMENTS} GTest::gtest GTest::gtest_main)
      if(label STREQUAL slow)
        set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
        add_dependencies(slow_tests ${target})
      endif()
      target_compile_definitions(${target} PRIVATE
        LIGHTWELL_SOURCE_DIR="${PROJECT_SOURCE_DIR}" LIGHTWELL_PROGRAM="${PROJECT_BINARY_DIR}/lightwell")
      lightwell_unity(${target})
      target_compile_options(${target} PRIVATE ${test_options})
      lightwell_reuse_precompiled(${target} ${test_headers})
      configure_file(${PROJECT_SOURCE_DIR}/cmake/suites.cmake.in ${target}_suites.cmake.in @ONLY)
      file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake
        INPUT ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake.in)
      set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
    endif()
  endforeach()
endfunction()
