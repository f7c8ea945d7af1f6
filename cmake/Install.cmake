# What is installed, and the Debian packages. Programs lie together in lib/lightwell, where they look for each other and for their modules; bin has a link to
# the one that people call. Everything else that programs need is within them.
# Packages have the programs that render once more for better processors, from builds of their own, in lib/lightwell/LEVEL: lightwell chooses
# (viewer/cli/main/lightwell.cpp), for Python python/lightwell/__init__.py.

set(LIGHTWELL_LEVEL "" CACHE STRING "Install only what renders, into folders of this level of processors (x86-64-v3)")
include(GNUInstallDirs)
set(programs ${CMAKE_INSTALL_LIBDIR}/lightwell)
set(of_level ${programs})
set(modules "\$ORIGIN")
set(python_module lib/python3/dist-packages/lightwell)
set(python_modules "\$ORIGIN/../../../../${programs}")
if(LIGHTWELL_LEVEL)
  string(APPEND of_level /${LIGHTWELL_LEVEL})
  string(APPEND modules /..)
  string(APPEND python_module /${LIGHTWELL_LEVEL})
  set(python_modules "\$ORIGIN/../../../../../${programs}")
endif()
function(lightwell_install component)
  foreach(target ${ARGN})
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "${modules}")
    install(TARGETS ${target} COMPONENT ${component} RUNTIME DESTINATION ${of_level} LIBRARY DESTINATION ${of_level})
  endforeach()
endfunction()
lightwell_install(lightwell lightwell_render lightwell_bench)
lightwell_install(view lightwell_view lightwell_trials)
lightwell_install(ar lightwell_ar)
if(TARGET lightwell_python)
  set_target_properties(lightwell_python PROPERTIES INSTALL_RPATH "${python_modules}")
  install(TARGETS lightwell_python LIBRARY DESTINATION ${python_module} COMPONENT python)
endif()
if(LIGHTWELL_LEVEL)
  return()
endif()
lightwell_install(lightwell lightwell_launcher lightwell_study lightwell_batch)
lightwell_install(ar lightwell_capture)
lightwell_install(cluster lightwell_cluster)

install(CODE "
  set(link \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}/lightwell)
  get_filename_component(folder \${link} DIRECTORY)
  file(RELATIVE_PATH target \${folder} \${CMAKE_INSTALL_PREFIX}/${programs}/lightwell)
  file(MAKE_DIRECTORY \$ENV{DESTDIR}\${folder})
  file(CREATE_LINK \${target} \$ENV{DESTDIR}\${link} SYMBOLIC)
  list(APPEND CMAKE_INSTALL_MANIFEST_FILES \${link})"
  COMPONENT lightwell)
install(FILES data/desktop/lightwell.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT view)
install(FILES data/desktop/lightwell.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT view)

# Another system's package is another release: 1+deb13.
set(system "ID=unknown")
if(EXISTS /etc/os-release)
  file(READ /etc/os-release system)
endif()
string(REGEX MATCH "(^|\n)ID=\"?([a-z]+)" none "${system}")
string(SUBSTRING "${CMAKE_MATCH_2}" 0 3 of)
string(REGEX MATCH "(^|\n)VERSION_ID=\"?([0-9.]+)" none "${system}")
set(LIGHTWELL_VARIANT "" CACHE STRING "What tells packages from the usual ones of their version (cuda)")
set(CPACK_DEBIAN_PACKAGE_RELEASE "1+${of}${CMAKE_MATCH_2}")
if(LIGHTWELL_VARIANT)
  string(APPEND CPACK_DEBIAN_PACKAGE_RELEASE "+${LIGHTWELL_VARIANT}")
endif()

# Written by the programs themselves: manual pages of their commands, completions of shells.
set(written ${PROJECT_BINARY_DIR}/written)
add_custom_target(written DEPENDS man VERBATIM COMMENT "Writing completions and compressed manual pages to ${written}"
  COMMAND ${CMAKE_COMMAND} -DBINARY=${PROJECT_BINARY_DIR} -DOUT=${written}
          -DRELEASE=${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE} -DVARIANT=${LIGHTWELL_VARIANT} -P ${PROJECT_SOURCE_DIR}/cmake/written.cmake)
install(DIRECTORY ${written}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT lightwell OPTIONAL)
install(FILES ${written}/lightwell.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME lightwell COMPONENT lightwell OPTIONAL)
install(FILES ${written}/lightwell.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _lightwell COMPONENT lightwell OPTIONAL)
install(FILES ${written}/lightwell.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT lightwell OPTIONAL)

set(components lightwell view ar cluster dev)
if(TARGET lightwell_python)
  list(APPEND components python)
  install(DIRECTORY python/lightwell/ DESTINATION ${python_module} COMPONENT python PATTERN __pycache__ EXCLUDE)
endif()

# For programs of one's own: find_package(lightwell), then link lightwell::gi or lightwell::study.
set(of_gi gi_core gi_image_io gi_scene gi_scene_io gi_filter gi_raster gi_bvh gi_render gi_surfaces gi_light_paths gi_methods)
set(of_study study_display study_adaptive study_design study_stats study_run study_tables study_gaze study_report)
install(TARGETS lightwell_options ${of_gi} ${of_study} EXPORT lightwell COMPONENT dev
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lightwell)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/lightwell)
install(EXPORT lightwell NAMESPACE lightwell:: FILE targets.cmake DESTINATION ${package} COMPONENT dev)
install(DIRECTORY gi study DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lightwell COMPONENT dev FILES_MATCHING PATTERN "*.h")
include(CMakePackageConfigHelpers)
configure_package_config_file(cmake/lightwell-config.cmake.in ${PROJECT_BINARY_DIR}/lightwell-config.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lightwell-config-version.cmake COMPATIBILITY ExactVersion) # headers and libraries of one build
install(FILES ${PROJECT_BINARY_DIR}/lightwell-config.cmake ${PROJECT_BINARY_DIR}/lightwell-config-version.cmake DESTINATION ${package} COMPONENT dev)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Lightwell authors <lightwell@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENTS_ALL ${components})
# lightwell_package(COMPONENT NAME SECTION SUMMARY DETAILS [DEPENDS ...] [RECOMMENDS ...] [SUGGESTS ...])
macro(lightwell_package component name section summary details)
  cmake_parse_arguments(arg "" "" "DEPENDS;RECOMMENDS;SUGGESTS" ${ARGN})
  string(TOUPPER ${component} COMPONENT)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_SECTION ${section})
  set(CPACK_COMPONENT_${COMPONENT}_DESCRIPTION "${summary}\n${details}")
  list(JOIN arg_DEPENDS ", " CPACK_DEBIAN_${COMPONENT}_PACKAGE_DEPENDS)
  list(JOIN arg_RECOMMENDS ", " CPACK_DEBIAN_${COMPONENT}_PACKAGE_RECOMMENDS)
  list(JOIN arg_SUGGESTS ", " CPACK_DEBIAN_${COMPONENT}_PACKAGE_SUGGESTS)
  # Every package has its licence and what changed where Debian looks for them.
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} RENAME copyright COMPONENT ${component})
  install(FILES ${written}/NEWS.gz ${written}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component} OPTIONAL)
  if("${component}" MATCHES "lightwell|python") # others depend on these
    install(FILES ${written}/NOTICES.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component} OPTIONAL)
  endif()
endmacro()
set(same "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
# Loaded when a JPEG, TIFF or HDR picture is read or written.
get_target_property(codecs opencv_imgcodecs IMPORTED_SONAME_RELEASE)
string(REGEX REPLACE "^libopencv_imgcodecs\\.so\\.([0-9]+)d?$" "libopencv-imgcodecs\\1" codecs "${codecs}")
lightwell_package(lightwell lightwell graphics "global illumination renderer for laboratories"
  "Renders 3D scenes with path-traced light, compares pictures and analyses\nperceptual experiments." RECOMMENDS ${codecs} SUGGESTS ffmpeg)
lightwell_package(view lightwell-view graphics "immersive viewer of globally lit scenes"
  "Windows, stereo walls and CAVEs, OpenXR headsets; runs perceptual\nexperiments and records their trials."
  DEPENDS "lightwell ${same}" libgl1-mesa-dri fonts-dejavu-core)
lightwell_package(ar lightwell-ar graphics "globally lit virtual objects in camera frames"
  "Calibrates cameras, finds markers, and composites virtual objects with the\nlight of the real place. Also reads videos."
  DEPENDS "lightwell ${same}")
lightwell_package(cluster lightwell-cluster graphics "Lightwell on several machines"
  "Shares pictures and walls between machines, by MPI." DEPENDS "lightwell ${same}" openmpi-bin RECOMMENDS "lightwell-view ${same}")
if(TARGET lightwell_python)
  string(REGEX REPLACE "^3\\." "" minor "${LIGHTWELL_PYTHON_VERSION}")
  math(EXPR next "${minor} + 1")
  lightwell_package(python python3-lightwell python "globally lit pictures in Python"
    "Pictures as numpy arrays, live frames for stimuli, and experiments."
    DEPENDS "python3 (>= ${LIGHTWELL_PYTHON_VERSION})" "python3 (<< 3.${next}~)" python3-numpy RECOMMENDS "lightwell ${same}")
  # Compile the modules, and remove what they were compiled to.
  set(scripts ${PROJECT_SOURCE_DIR}/cmake/python3-lightwell)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${scripts}/postinst;${scripts}/prerm")
endif()
lightwell_package(dev liblightwell-dev libdevel "libraries for programs that render by Lightwell"
  "Static libraries and headers of the renderer and of experiments."
  DEPENDS libglm-dev libopenexr-dev libpng-dev libopencv-dev libtbb-dev libembree-dev libassimp-dev libdraco-dev libmeshoptimizer-dev libyaml-cpp-dev
  nlohmann-json3-dev libfmt-dev libsqlite3-dev libhwy-dev libeigen3-dev libboost-dev zlib1g-dev nettle-dev pkg-config RECOMMENDS cmake g++)
include(CPack)
