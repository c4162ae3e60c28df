# cmake -DOUTPUT=shader_sources.cpp -DSHADERS="a.glsl;b.glsl" -P embed_shaders.cmake: the shaders' texts as one table of C++ strings.
set(text "#include \"shader_sources.h\"\n\nnamespace dupin {\n\nstd::string_view shader_source(std::string_view name) {\n")
foreach(shader IN LISTS SHADERS)
  file(READ ${shader} source)
  get_filename_component(name ${shader} NAME)
  string(APPEND text "  if (name == \"${name}\") return R\"GLSL(${source})GLSL\";\n")
endforeach()
string(APPEND text "  return {};\n}\n\n}  // namespace dupin\n")
file(WRITE ${OUTPUT} "${text}")
