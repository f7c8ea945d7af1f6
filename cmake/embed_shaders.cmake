# cmake -DFILES="a;b" -DOUT=shader_sources.cpp -P embed_shaders.cmake: shaders become string constants of the program.
set(code "#include \"viewer/devices/gl/shader_source.h\"\n\nnamespace viewer {\n\nstd::string_view shader_source(std::string_view file)\n{\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND code "    if (file == \"${name}\")\n        return R\"GLSL(${text})GLSL\";\n")
endforeach()
string(APPEND code "    return {};\n}\n\n} // namespace viewer\n")
file(WRITE ${OUT} "${code}")
